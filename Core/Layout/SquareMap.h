#pragma once

#include "Mesh/Meshes.h"

namespace bsr
{
/// A disc of triangles whose boundary lies on the unit square's.
struct SquareDisc
{
  TriangleMesh Mesh;
  std::vector<Index> Boundary;  ///< vertices on the boundary
  std::vector<Vec2> BoundaryUV; ///< their places, in convex position along the square
};

/**
 * Maps a disc onto the unit square without fold-over: a convex combination map with mean value
 * weights (Floater 2003), which are positive, so that Tutte's theorem holds, and the boundary
 * fixed. Weights are then divided by the stretch at the neighbors as long as the L2 stretch falls
 * (Yoshizawa, Belyaev and Seidel 2004), which spreads what protrudes over the square and keeps the
 * weights positive. \pre no inner edge joins two vertices of the boundary.
 * \return (u, v) of each vertex; empty where the equations could not be solved
 */
std::vector<Vec2> squareMap(const SquareDisc& disc, int stretchRounds);

/// Number of triangles that are not counter-clockwise in the plane.
int foldedTriangles(const TriangleMesh& mesh, const std::vector<Vec2>& uv);
} // namespace bsr
