#pragma once

#include "Spline/Basis.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/// A point of a surface with its partial derivatives in the patch's parameters.
struct SurfacePoint
{
  Vec3 Point = Vec3::Zero();
  Vec3 Du = Vec3::Zero();
  Vec3 Dv = Vec3::Zero();
  Vec3 Duu = Vec3::Zero();
  Vec3 Duv = Vec3::Zero();
  Vec3 Dvv = Vec3::Zero();

  /// Du x Dv, not normalized; zero where the patch is singular.
  Vec3 normal() const { return this->Du.cross(this->Dv); }
};

/// Parameter range of a patch: {u minimum, u maximum, v minimum, v maximum}.
std::array<double, 4> patchDomain(const SplineModel& model, const SplinePatch& patch);

/// Evaluates a (rational) patch at (u, v), clamped to its domain, with derivatives up to the
/// second.
SurfacePoint evaluatePatch(const SplineModel& model, const SplinePatch& patch, double u, double v);

/// The same from basis values that the caller keeps (grids of samples share them).
SurfacePoint evaluatePatch(const SplineModel& model, const SplinePatch& patch,
  const BasisValues& basisU, const BasisValues& basisV);
} // namespace bsr
