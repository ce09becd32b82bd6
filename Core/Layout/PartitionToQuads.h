#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/Meshes.h"

namespace bsr
{
struct PartitionOptions
{
  /// One vector a point, or empty. A point is given only quads whose normal makes less than 90
  /// degrees with its vector (a zero vector: any quad), or the nearest quad where there is none.
  /// The normals of a layout that is inside out as a whole are turned over.
  std::vector<Vec3> Facing;
};

/// For each point its quad, the bilinear parameters on it in [0, 1] and the distance to it.
struct Partition
{
  std::vector<Index> QuadId;
  std::vector<Vec2> UV;
  std::vector<double> Distance;
  /// 1 for points of an open mesh's boundary, at their place on a boundary side; empty: none.
  std::vector<std::uint8_t> Boundary;
  std::int64_t EmptyQuads = 0; ///< quads that no point belongs to
  double RMS = 0.0;            ///< of the distances
  double Max = 0.0;
};

/**
 * Gives each point its nearest quad of a layout (Mosbach et al., section 4.2), exactly, on the
 * bilinear patches that the quads span. The result does not depend on the number of threads.
 * Fails with InvalidInput on no point, no quad, a quad with a missing or repeated corner, and
 * coordinates that are not finite.
 */
Result<Partition> partitionToQuads(const std::vector<Vec3>& points, const QuadMesh& quads,
  const PartitionOptions& options, Monitor& monitor);
} // namespace bsr
