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
 * Removes the quads marked as caps (nonzero) where that leaves a sound open surface: each group of
 * marked quads a disc, borders simple loops, no other component or vertex torn; groups that fail
 * are kept, and the message says so.
 */
CutLayout cutEnds(const QuadMesh& quads, const std::vector<char>& marked);

/// Marks by Region > 0; empty where the layout has no such quads.
std::vector<char> markByRegion(const QuadMesh& quads);

/**
 * Samples of the ends' rims: smooth closed curves through the border's vertices, eight samples a
 * side. With `axialOnly` they hold the surface along the loop's normal only.
 */
std::vector<RimSample> rimSamples(
  const QuadComplex& complex, const std::vector<Vec3>& vertices, bool axialOnly);
} // namespace bsr
