#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Contour/ContourStack.h"
#include "Spline/SplineModel.h"

#include <algorithm>

namespace bsr
{
/// Share of values: 50, 75, 90, 95, 99 %, and the largest.
struct Percentiles
{
  std::array<double, 6> Value{};
  std::int64_t Count = 0;
};
Percentiles percentilesOf(std::vector<double> values);

/// Largest angle in degrees between the normals of each side of a patch and its neighbor's;
/// negative where there is no neighbor.
using SideJumps = std::array<double, 4>;
std::vector<SideJumps> normalJumps(const SplineModel& model, int samples = 65);

/// Smallest |Su x Sv| over its mean on a grid of 25 x 25; negative where the patch is folded.
double patchJacobian(const SplineModel& model, std::int64_t patch);
std::vector<double> patchJacobians(const SplineModel& model);

/// Distances of the points of some contours from a model, by patch.
struct InputError
{
  std::vector<std::int64_t> Points; ///< of each patch: those nearest to it
  std::vector<double> RMS;
  std::vector<double> Max;
  std::vector<double> ContourRMS; ///< of each of the contours given
  double TotalRMS = 0.0;
  double TotalMax = 0.0;
};
Result<InputError> inputError(const SplineModel& model, const ContourStack& stack,
  const std::vector<Index>& contours, Monitor& monitor);

/**
 * Re-slicing: the model cut by the planes of the slices again. `There`: distances of the contours'
 * points from the cut; `Back`: of the cut from the contours of its slice. The plane is the one that
 * fits the slice's contours; first and last slices are cut a thousandth of the slices' distance
 * inside, as the surface may end in the plane. Where a slice is not cut at all, its points count
 * with the mean diameter of the contours.
 */
struct ResliceError
{
  Percentiles There;
  Percentiles Back;
  double RMS = 0.0; ///< of both together
  double max() const { return std::max(this->There.Value[5], this->Back.Value[5]); }
};
Result<ResliceError> resliceError(const SplineModel& model, const ContourStack& stack,
  const std::vector<Index>& contours, Monitor& monitor);
} // namespace bsr
