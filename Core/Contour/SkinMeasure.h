#pragma once

#include "Contour/SkinFit.h"
#include "Contour/SurfaceReport.h"
#include "Spline/SampleModel.h"

namespace bsr
{
/// What a finished skin is measured by. Lengths are in world units.
struct SkinMeasures
{
  ResliceError Reslice; ///< contours in whose plane the surface ends are left out
  /// Largest jump of a second derivative across a knot over the largest second derivative.
  double SecondDerivativeJump = 0.0;
  double EndHeight = 0.0;   ///< highest end of a leg over its last contour, in slice distances
  double ConvexShare = 1.0; ///< share of an end's points with the end below their tangent
                            ///< planes (by a twentieth of a slice distance), of the worst leg
  int SignChangesData = 0;  ///< of the curvature along the contours
  int SignChangesModel = 0; ///< along the surface at the same samples
};

/// Where a leg ends: its last contour, the direction out of it, the distance to the next slice, and
/// the patches there.
struct LegEnd
{
  Index Contour = -1;
  Vec3 Out = Vec3::Zero();
  double Room = 0.0;
  std::vector<Index> Patches; ///< sorted
};

/// EndHeight and ConvexShare of a sampled surface: of the points of the ends' patches beyond their
/// legs' last slices.
void measureEnds(const ContourStack& stack, const std::vector<LegEnd>& ends,
  const SampledModel& samples, SkinMeasures& out);

/// Measures a fitted skin against its contours.
SkinMeasures measureSkin(
  const ContourStack& stack, const SkinGrid& grid, const SkinSurface& surface);
} // namespace bsr
