#pragma once

#include "Common/Status.h"
#include "Mesh/Meshes.h"

namespace bsr
{
/// A closed boundary of a triangle mesh and what is known of the hole it bounds.
struct BoundaryLoop
{
  /// Points of the loop, each once, in the order in which a triangle that fills the hole runs
  /// through them (against the boundary edges of the triangles that are there).
  std::vector<Index> Points;
  std::vector<Index> Triangles; ///< the triangle at the edge from point i to point i + 1
  double Size = 0.0;            ///< largest distance between two of its points
  double Flatness = 0.0;        ///< largest distance to the plane through it, over its size
  /// Mean angle in degrees between the surface at the loop and the loop's plane: 0 where the
  /// surface would go on across the hole, 90 at the cut end of a tube.
  double Steepness = 0.0;
};

/**
 * The boundary loops of a consistently oriented mesh. Where several boundaries meet at a point, the
 * gaps between the fans of triangles are told apart by their direction around the point, and each
 * loop passes each point once. Fails with InvalidInput on an empty mesh, points that are not
 * finite, corners out of range or repeated, and edges of three triangles or two of opposite
 * orientation.
 */
Result<std::vector<BoundaryLoop>> boundaryLoops(const TriangleMesh& mesh);

/// The twin of each half-edge 3 * triangle + corner, -1 at a boundary; the checks of boundaryLoops.
Result<std::vector<Index>> halfEdgeTwins(const TriangleMesh& mesh);
} // namespace bsr
