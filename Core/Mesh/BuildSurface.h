#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/RepairReport.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
struct BuildSurfaceOptions
{
  /// Edges where the normals turn by more are creases; degrees, 180 and more: none.
  double FeatureAngle = 180.0;
  /// Components of less than this share of the whole area are dropped as specks (components
  /// without area always).
  double SmallestShare = 0.0;
};

/**
 * Makes one editable surface of each connected component of a mesh, largest area first.
 *
 * The topology is mended first (repairMesh). Edges between two regions are creases, also edges
 * sharper than the feature angle.
 *
 * Fails with InvalidInput on an empty mesh, faces of non-finite or missing points, one-sided
 * (Moebius) surfaces and surfaces without area.
 */
Result<std::vector<TriangleSurface>> buildSurfaces(const TriangleMesh& mesh,
  const BuildSurfaceOptions& options, RepairReport& report, Monitor& monitor);
} // namespace bsr
