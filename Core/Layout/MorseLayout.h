#pragma once

#include "Layout/LayoutDraft.h"
#include "Layout/MorseCells.h"
#include "Layout/Sizing.h"

namespace bsr
{
struct MorseOptions
{
  int NumberOfQuads = 500;
  int Eigenfunction = 0;     ///< place in the spectrum, from 1; 0: the best one for NumberOfQuads
  double Persistence = 0.01; ///< noise: extrema that stand out less, as a share of the range
  double TrianglesPerCell = 60.0;
};

/// What was found on the way.
struct MorseReport
{
  int Eigenfunction = 0; ///< the one taken
  double Eigenvalue = 0.0;
  Index Minima = 0;
  Index Maxima = 0;
  Index Saddles = 0;
  Index Cells = 0;      ///< of the complex, before degenerate ones were mended
  Index Cancelled = 0;  ///< pairs cancelled as noise or to meet the number asked for
  int Subdivisions = 0; ///< 1: every cell was cut in 2 x 2, as no valid layout was had without
};

struct MorseLayout
{
  LayoutDraft Draft;
  PartitionedSurface Surface;
  MorseReport Report;
};

/**
 * A quad layout from the Morse-Smale complex of an eigenfunction of the Laplace-Beltrami operator
 * (Dong et al. 2006; paper 003, section 3). The surface is remeshed evenly; eigenfunctions are
 * taken around the place of the spectrum whose complex has as many cells as quads are asked for
 * (found by shifts, without the functions below), noise is cancelled by persistence, the cells
 * become quads, degenerate ones are mended, vertices are relaxed over the surface, and the function
 * with the best layout wins. `sizing` scales the metric, so that cells are smaller where the
 * surface bends.
 *
 * Fails if no function gives a valid layout.
 */
Result<MorseLayout> morseLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const MorseOptions& options, Monitor& monitor);
} // namespace bsr
