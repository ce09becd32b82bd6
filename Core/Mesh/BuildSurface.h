#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
/// What had to be mended to make surfaces of a triangle mesh.
struct RepairReport
{
  Index MergedPoints = 0;    ///< points at the place of another (only where that closes gaps)
  Index DegenerateFaces = 0; ///< faces that name a point twice
  Index DuplicateFaces = 0;  ///< faces with the corners of another
  Index TurnedFaces = 0;     ///< faces whose orientation was reversed
  Index SplitVertices = 0;   ///< vertices whose faces formed several fans
  Index BoundaryLoops = 0;
};

/**
 * Makes one editable surface of each connected component of a mesh, largest area first.
 *
 * Faces that name a point twice and repeated faces are dropped, faces are oriented alike (the first
 * face of a component decides), vertices with several fans of faces are split, coincident points
 * are merged if the mesh has boundary edges. Edges between two regions are creases, also edges
 * where the normals turn by more than `featureAngle` degrees (180 and more: none).
 *
 * Fails with InvalidInput on an empty mesh, non-finite points, indices out of range, edges of three
 * or more faces, and one-sided (Moebius) surfaces.
 */
Result<std::vector<TriangleSurface>> buildSurfaces(
  const TriangleMesh& mesh, double featureAngle, RepairReport& report, Monitor& monitor);
} // namespace bsr
