#pragma once

#include "Spline/QuadComplex.h"
#include "Spline/ShellFit.h"

namespace bsr
{
/// The layout without the caps of its open ends.
struct CutLayout
{
  QuadMesh Quads;           ///< all points, the remaining quads
  std::vector<Index> Kept;  ///< number of each remaining quad in the full layout
  std::vector<Index> NewId; ///< number of each quad of the full layout, -1 where removed
  int Ends = 0;
  std::string Message; ///< why ends were kept closed, where they were
};

/**
 * Removes the caps of open ends: of each region > 0 its largest connected group of quads, where
 * that leaves a sound open surface: the group a disc, borders simple loops, no other component or
 * vertex torn. Groups that fail are kept, and the message says so. An empty list: nothing to
 * remove.
 */
CutLayout cutEnds(const QuadMesh& quads, const std::vector<Index>& region);

/**
 * Samples of the ends' rims: smooth closed curves through the border's vertices, eight samples a
 * side. With `axialOnly` they hold the surface along the loop's normal only.
 */
std::vector<RimSample> rimSamples(
  const QuadComplex& complex, const std::vector<Vec3>& vertices, bool axialOnly);

/**
 * The same along given closed polylines: between two vertices of the border the samples are spaced
 * evenly along the polyline that all vertices of its loop are closest to. Loops that follow none
 * (a vertex is off by more than a quarter of the loop's mean side, or the vertices are not met in
 * order, once around) have samples as above.
 */
std::vector<RimSample> rimSamples(const QuadComplex& complex, const std::vector<Vec3>& vertices,
  const std::vector<std::vector<Vec3>>& rims, bool axialOnly);
} // namespace bsr
