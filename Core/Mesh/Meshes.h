#pragma once

#include "Common/Types.h"

namespace bsr
{
/// An indexed triangle surface; counter-clockwise triangles seen from outside.
struct TriangleMesh
{
  std::vector<Vec3> Points;
  std::vector<std::array<Index, 3>> Triangles;
  /// Optional region of each triangle (empty: all one region); borders are features for layouts.
  std::vector<Index> Region;
};

/// An indexed pure-quad surface; corners counter-clockwise seen from outside.
struct QuadMesh
{
  std::vector<Vec3> Points;
  std::vector<std::array<Index, 4>> Quads;
  /// Optional region of each quad (empty: all one region).
  std::vector<Index> Region;
};
} // namespace bsr
