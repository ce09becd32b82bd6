#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"
#include "Layout/Sizing.h"

#include <limits>

namespace bsr
{
struct ParametrizedOptions
{
  int Quads = 500;
  int Seed = 0;
  bool ToCoarsen = false; ///< the count does not matter, nor, of many quads, the cost
  int MostFolds = std::numeric_limits<int>::max(); ///< of the first map; with more it is the last
};

struct ParametrizedLayout
{
  LayoutDraft Draft;     ///< no quads: none was found, and another road must be taken
  bool Hopeless = false; ///< the maps fold in so many places that those of more quads will, too
  int Folds = 0;         ///< triangles that the first map turned over or nearly so
};

/**
 * A layout of one component by an integer-grid map of a cross field. Where all regions other than 0
 * are discs, the map covers region 0 and ends along their borders, which are then capped; else it
 * covers all regions and follows their borders. Where a map folds, there is no room for its cells:
 * they shrink there, and the map is made again. Several fields are tried; the best valid layout is
 * relaxed and returned. That there is none is not an error.
 */
Result<ParametrizedLayout> parametrizedLayout(const TriangleSurface& s,
  const ReferenceSurface& reference, const Sizing& sizing, const ParametrizedOptions& options,
  Monitor& monitor);

/// Small is good: angles, count, irregular vertices, bad quads, distance to the surface.
double layoutCost(const LayoutDraft& draft, const LayoutReport& report, const TriangleSurface& s,
  const ReferenceSurface& reference, int wanted, Monitor& monitor);
} // namespace bsr
