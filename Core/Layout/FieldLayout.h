#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"
#include "Layout/Sizing.h"

namespace bsr
{
/// Which road gave the layout of a component.
enum class LayoutStage
{
  Parametrized = 0, ///< integer-grid map of a cross field
  Paired = 1,       ///< pairs of triangles, split and made coarser: the fallback
  MorseSmale = 2,   ///< Morse-Smale complex of an eigenfunction
  Coarsened = 3,    ///< a finer map, made coarser
  Box = 4           ///< a speck: six quads around it, or one in its boundary
};

struct FieldLayoutOptions
{
  int Quads = 500;
  int Seed = 0;
  QuadSizing Kind = QuadSizing::Uniform;
  Sizing::Field Field;   ///< QuadSizing::Array only
  bool MapsOnly = false; ///< no pairs of triangles: Failed where no map gives a layout
};

struct FieldLayout
{
  LayoutDraft Draft;
  LayoutStage Stage = LayoutStage::Parametrized;
};

/**
 * A layout of one component, by the first of these roads that gives a good one, else by the best:
 * the map of a cross field; the map of a finer layout, which has room for handles and holes
 * smaller than a quad, made coarser; pairs of triangles, made coarser. The last needs no map and
 * each of its steps keeps the layout valid and unfolded, so that there always is an answer.
 * \param sizing measured for the same number of quads
 */
Result<FieldLayout> fieldLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const FieldLayoutOptions& options, Monitor& monitor);
} // namespace bsr
