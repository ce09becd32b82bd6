#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/BoundaryLoops.h"

namespace bsr
{
struct FillHolesOptions
{
  double MaximumSize = 0.25; ///< larger holes stay; the size of a hole is its largest diameter
  bool Relative = true;      ///< MaximumSize is a share of the bounding box's diagonal
  /// Boundaries that lie in a plane (within 2 % of their size) from which the surface rises by more
  /// than 60 degrees are the cut ends of a tube, and stay.
  bool KeepCutEnds = true;
};

/// What became of a boundary.
enum class HoleState
{
  Filled = 0,
  FilledFlat = 1, ///< by a membrane: the implicit surface did not bridge the hole
  TooLarge = 2,
  CutEnd = 3,
  Failed = 4 ///< every triangulation of the loop uses an edge that exists
};

struct HoleReport
{
  HoleState State = HoleState::Filled;
  double Size = 0.0; ///< world units
  double Flatness = 0.0;
  double Steepness = 0.0; ///< degrees, see BoundaryLoop
  Index Edges = 0;
  Index Triangles = 0; ///< added
};

struct FilledMesh
{
  /// The input's points and triangles first, unchanged and in their order; no regions.
  TriangleMesh Mesh;
  std::vector<Index> NearPoint; ///< for each new point a point of its hole's loop near it
  std::vector<HoleReport> Holes;
  Index filled() const;
};

/**
 * Fills holes of a scan: each loop is triangulated with least area, refined to the edge length of
 * its surroundings, and moved onto the zero set of radial basis functions fitted to the points and
 * normals around it (Carr et al. 2001; Branch, Prieto and Boulanger, section 6.1), so that the
 * surface goes on with its tangent planes and its curvature. Points and triangles that are there do
 * not change. A mesh without holes is returned as it is.
 *
 * Fails with InvalidInput on what boundaryLoops refuses, with InvalidParameter on a size that is
 * negative or not finite.
 */
Result<FilledMesh> fillHoles(
  const TriangleMesh& mesh, const FillHolesOptions& options, Monitor& monitor);
} // namespace bsr
