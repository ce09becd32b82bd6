#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"

namespace bsr
{
struct FitMovesReport
{
  double Before = 0.0; ///< root mean square of the patches' weighted residuals, world units
  double After = 0.0;
  int Moved = 0;  ///< points, by a step each
  int Turned = 0; ///< edges
};

/**
 * Moves the points of a layout over the surface, and turns edges, where bicubic patches then fit
 * the surface better: the residual is that of a bicubic patch of its own in each quad, by least
 * squares through samples of the surface at their places on the bilinear quad, along the surface's
 * normals, and weighs more (up to five times) the more a quad is skewed. Irregular vertices are
 * shifted along their edges and diagonals, the points around following; edges at them are turned
 * where that leaves as many irregular vertices (so that a pair of valences 3 and 5 goes a quad on);
 * other points are shifted alone. A step is taken where the residual of the quads that it touches
 * falls by 2 % or more. The number of quads, creases and boundaries stay; no quad that was sound
 * gets worse than 0.4, and none is folded.
 *
 * One after the other, so that the result does not depend on the number of threads; when cancelled
 * the layout is that of the steps so far.
 */
Status moveToFit(LayoutDraft& draft, const TriangleSurface& s, const ReferenceSurface& reference,
  Monitor& monitor, FitMovesReport* report = nullptr);
} // namespace bsr
