#include "Spline/RobustWeights.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double Across = 0.25; ///< cosine below which a point is another surface's
constexpr double Along = 0.5;   ///< and above which nothing speaks against it
} // namespace

double robustScale(const std::vector<FitPoint>& points, const std::vector<Residual>& r)
{
  std::vector<double> size;
  size.reserve(r.size());
  for (std::size_t i = 0; i < r.size(); ++i)
  {
    if (!points[i].Fixed && points[i].Weight > 0.0)
    {
      size.push_back(std::abs(r[i].Normal));
    }
  }
  if (size.empty())
  {
    return 0.0;
  }
  const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
  std::nth_element(size.begin(), middle, size.end());
  return 1.4826 * *middle;
}

void setRobustWeights(
  std::vector<FitPoint>& points, const std::vector<Residual>& r, double sigma, double c)
{
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (points[i].Fixed)
    {
      continue;
    }
    const double x = sigma > 0.0 ? r[i].Distance / (c * sigma) : 0.0;
    points[i].Robust = x < 1.0 ? (1.0 - x * x) * (1.0 - x * x) : 0.0;
    points[i].Robust *= std::clamp((r[i].Cosine - Across) / (Along - Across), 0.0, 1.0);
  }
}
} // namespace bsr
