#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/Meshes.h"
#include "Mesh/RepairReport.h"

namespace bsr
{
/// An oriented triangle 2-manifold, perhaps of several components and with boundaries.
struct ManifoldMesh
{
  std::vector<Vec3> Points;
  std::vector<std::array<Index, 3>> Faces;
  std::vector<Index> Region;    ///< per face
  std::vector<Index> Source;    ///< per face: face of the input
  std::vector<Index> Twin;      ///< per half-edge 3 * face + corner; -1 at boundaries
  std::vector<Index> Component; ///< per face
  Index Components = 0;
};

/**
 * Mends the topology of any triangle mesh: drops faces that name a point twice and repeated ones,
 * merges coincident points at boundaries (within 1e-7 of the bounding box's diagonal), takes edges
 * of three or more faces apart (pairAtEdge), orients each component alike (as most of its area
 * is), and gives each fan of faces at a vertex a vertex of its own. Faces are never added.
 * Triangles without area are kept: they hold their neighbors together.
 *
 * Fails with InvalidInput on an empty mesh, faces of non-finite or missing points, and one-sided
 * (Moebius) surfaces. Points that no face uses do not matter.
 */
Result<ManifoldMesh> repairMesh(const TriangleMesh& mesh, RepairReport& report, Monitor& monitor);
} // namespace bsr
