#pragma once

#include "Spline/Basis.h"
#include "Spline/SplineModel.h"
#include "Spline/SurfacePoint.h"

namespace bsr
{
/// Parameter range of a patch: {u minimum, u maximum, v minimum, v maximum}.
std::array<double, 4> patchDomain(const SplineModel& model, const SplinePatch& patch);

/// Evaluates a (rational) patch at (u, v), clamped to its domain, with derivatives up to the
/// second.
SurfacePoint evaluatePatch(const SplineModel& model, const SplinePatch& patch, double u, double v);

/// The same from basis values that the caller keeps (grids of samples share them).
SurfacePoint evaluatePatch(const SplineModel& model, const SplinePatch& patch,
  const BasisValues& basisU, const BasisValues& basisV);
} // namespace bsr
