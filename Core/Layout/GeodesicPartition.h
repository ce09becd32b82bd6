#pragma once

#include "Layout/PartitionToQuads.h"

namespace bsr
{
struct GeodesicOptions
{
  /// One vector a point, or empty: a point takes the nearest triangle whose normal makes less than
  /// 90 degrees with it. Points of the mesh itself take their own place.
  std::vector<Vec3> Facing;
  bool Straighten = true; ///< geodesics; else the paths of edges that they start from
  int StretchRounds = 3;  ///< of the parametrization, see squareMap
};

struct GeodesicPartition
{
  Partition Points; ///< distances are those to the mesh
  /// Each side of the layout on the mesh, as a polyline from corner SideEnds[0] to SideEnds[1] of
  /// the layout; empty where no path was found.
  std::vector<std::vector<Vec3>> Sides;
  std::vector<std::array<Index, 2>> SideEnds;
  std::vector<std::array<Index, 2>> SideQuads; ///< left and right; -1: none
  std::vector<std::uint8_t> Failed; ///< per quad: its points got the nearest quad's (u, v)
  int FailedQuads = 0;
  int RoughSides = 0; ///< sides left as paths of edges
  /// Sides more than three times as long as the straight line (and 1.5 mean sides long): the
  /// layout, though of the mesh's topology, does not follow its shape; take more quads.
  int Detours = 0;
  int FoldedTriangles = 0; ///< of the refined mesh, in the plane
  double Stretch = 0.0;    ///< worst ratio of the longest to the shortest side of a quad
};

/**
 * Gives each point its quad and (u, v) by a map of the mesh itself (Branch, Prieto and Boulanger,
 * section 4): the layout's sides become geodesics of the mesh (fast marching in the union of both
 * quads of a side, so that they cannot cross), the mesh is cut along them, and each region is
 * mapped to the unit square without fold-over. Sides are divided by arc length, the same for both
 * neighbors. Points take the place of the nearest point of the mesh.
 *
 * Quads whose region is no disc, after several orders of the sides were tried, are reported; their
 * points take the nearest quad.
 *
 * Fails with InvalidInput on what partitionToQuads and buildSurfaces refuse, and where the
 * boundaries of layout and mesh do not correspond.
 */
Result<GeodesicPartition> partitionGeodesic(const std::vector<Vec3>& points,
  const TriangleMesh& mesh, const QuadMesh& quads, const GeodesicOptions& options,
  Monitor& monitor);
} // namespace bsr
