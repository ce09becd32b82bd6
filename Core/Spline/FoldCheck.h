#pragma once

#include "Spline/FitPoints.h"
#include "Spline/VertexFrames.h"

namespace bsr
{
/// What a grid of 25 x 25 normals says about a patch.
struct PatchShape
{
  bool Folded = false; ///< normals of neighboring samples turn by more than 90 degrees, or vanish
  /// Smallest |Su x Sv| over its mean; negative where the patch is folded.
  double MinJacobian = 1.0;
};

/// Whether neighboring normals of a grid x grid turn by more than 90 degrees, or one vanishes.
bool normalsFold(const std::vector<Vec3>& normals, int grid);

std::vector<PatchShape> checkShapes(const PatchNet& net, const NetPoints& surface);
PatchShape checkShape(const RationalPatch& patch);

/// Largest angle in degrees between the normals of two patches along their common sides that are no
/// creases.
double largestNormalJump(
  const QuadComplex& complex, const NetEvaluator& surface, const Creases& creases);
} // namespace bsr
