#pragma once

#include "Spline/FitPoints.h"

namespace bsr
{
/// How data points move to the nearest parameters on their patch (paper 000, section 4.2.1).
enum class CorrectionMethod
{
  Taylor, ///< one first-order step
  Newton  ///< to convergence, with second derivatives
};

/**
 * Moves the parameters of the points (sorted by patch) toward the foot of their perpendicular:
 * steps are limited to 0.25 and clamped to the unit square; on an active border the step runs along
 * it. With a complex given, a point whose step leaves its patch across an inner side goes on to
 * the neighbor; without, it stays (as in the paper). Fixed points do not move.
 */
void correctParameters(const PatchNet& net, const NetPoints& surface, CorrectionMethod method,
  std::vector<FitPoint>& points, const QuadComplex* complex = nullptr);

/// The same on any surface of a net, e.g. with rational patches of their own.
void correctParameters(const NetEvaluator& surface, CorrectionMethod method,
  std::vector<FitPoint>& points, const QuadComplex* complex = nullptr);

/// Steps of Newton's method for the points of one patch.
void correctOnPatch(
  const RationalPatch& patch, FitPoint* first, FitPoint* last, int iterations = 12);

/// Distance of each point to the surface at its parameters, and its component along the normal.
struct Residual
{
  double Distance = 0.0;
  double Normal = 0.0; ///< positive where the point lies outside
  double Cosine = 1.0; ///< of the angle between the point's normal and the surface's, either sign
};
std::vector<Residual> residuals(
  const PatchNet& net, const NetPoints& surface, const std::vector<FitPoint>& points);
std::vector<Residual> residuals(const NetEvaluator& surface, const std::vector<FitPoint>& points);

/// Root mean square of the distances at the parameters as they are, by the points' weights.
double weightedRms(
  const PatchNet& net, const NetPoints& surface, const std::vector<FitPoint>& points);
} // namespace bsr
