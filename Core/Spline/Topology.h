#pragma once

#include "Spline/SplineModel.h"

namespace bsr
{
/// How a side of a patch meets the side of its neighbor.
struct SideMatch
{
  std::int64_t Patch = -1; ///< the neighbor; -1 at a border
  int Side = 0;            ///< its side
  bool Same = false;       ///< same degree, knots (up to scale) and control points: may be shared
  bool Reversed = false;   ///< the two sides' parameters run against each other
  /// The two patches' normals Du x Dv lie on the same side of the surface.
  bool Coherent = true;
};

/// Compares a side (v=0, u=1, v=1, u=0) with its neighbor's; the model must be valid.
SideMatch matchSide(const SplineModel& model, std::int64_t patch, int side);

/// Number of points along u and v of a grid laid over each patch.
using GridSize = std::array<std::int64_t, 2>;

/// Index, in a grid with u running fastest, of the k-th point of a side (k along its parameter).
inline std::int64_t gridSideIndex(const GridSize& grid, int side, std::int64_t k)
{
  switch (side)
  {
  case 0:
    return k;
  case 1:
    return k * grid[0] + grid[0] - 1;
  case 2:
    return (grid[1] - 1) * grid[0] + k;
  default:
    return k * grid[0];
  }
}

/// Grids over all patches with the points of shared sides counted once.
struct StitchedGrids
{
  std::vector<std::int64_t> First; ///< first grid point of each patch, in the unstitched numbering
  std::vector<Index> Id;           ///< stitched point of each grid point
  std::vector<std::int64_t> Owner; ///< for each stitched point the first grid point that is it
};

/**
 * Numbers the points of grids over the patches so that matching sides share them, and, with
 * `joinPoles`, the points of a collapsed side are one (their weights may differ). Sides with
 * different numbers of points are not joined. With `sizes` chosen per strip of patches, a closed
 * model gives a closed mesh.
 */
StitchedGrids stitchGrids(
  const SplineModel& model, const std::vector<GridSize>& sizes, bool joinPoles = true);

/// True for a side whose control points all coincide (a pole).
bool sideCollapsed(const SplineModel& model, std::int64_t patch, int side);

/**
 * One flag a patch: turn it over to give each connected component of the patch network one
 * orientation, the one most of its outer patches have. A component that is not orientable keeps
 * some conflicts.
 */
std::vector<char> orientationFlips(const SplineModel& model);

/// Connected component of each patch, numbered by first appearance, and their count.
std::pair<std::vector<Index>, Index> patchComponents(const SplineModel& model);

/// Number of sides without neighbor that are not collapsed, for each component.
std::vector<std::int64_t> openSides(
  const SplineModel& model, const std::vector<Index>& component, Index count);
} // namespace bsr
