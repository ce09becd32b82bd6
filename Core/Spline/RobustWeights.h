#pragma once

#include "Spline/ParameterCorrection.h"

namespace bsr
{
/// 1.4826 times the median of the absolute normal residuals: sigma of what is not an outlier.
double robustScale(const std::vector<FitPoint>& points, const std::vector<Residual>& r);

/**
 * Sets FitPoint::Robust by Tukey's biweight (1 - (r / (c sigma))^2)^2, 0 beyond c sigma.
 * Debris and pits lie far on one side only; a redescending weight drops them whatever their
 * number on one side, as long as they are a minority where they are. Points whose normals lie
 * across the surface's (the walls of holes, which may be a majority there) lose theirs as well:
 * 0 beyond 75 degrees, whole below 60.
 */
void setRobustWeights(
  std::vector<FitPoint>& points, const std::vector<Residual>& r, double sigma, double c = 4.685);
} // namespace bsr
