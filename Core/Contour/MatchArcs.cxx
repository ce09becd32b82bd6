#include "Contour/MatchArcs.h"

#include <algorithm>
#include <limits>

namespace bsr
{
namespace
{
constexpr int Samples = 160;

/// Cheapest monotone path through the table of squared distances, as pairs of sample numbers.
std::vector<std::array<int, 2>> warpPath(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
  const auto n = static_cast<int>(a.size());
  const std::size_t width = b.size();
  std::vector<double> cost(a.size() * width, std::numeric_limits<double>::infinity());
  const auto at = [&](int i, int j) -> double& { return cost[i * width + j]; };
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      double before = i == 0 && j == 0 ? 0.0 : std::numeric_limits<double>::infinity();
      before = i > 0 ? std::min(before, at(i - 1, j)) : before;
      before = j > 0 ? std::min(before, at(i, j - 1)) : before;
      before = i > 0 && j > 0 ? std::min(before, at(i - 1, j - 1)) : before;
      at(i, j) = before + (a[i] - b[j]).squaredNorm();
    }
  }
  std::vector<std::array<int, 2>> path(1, {n - 1, n - 1});
  while (path.back()[0] > 0 || path.back()[1] > 0)
  {
    const auto [i, j] = path.back();
    if (i == 0 || (j > 0 && at(i, j - 1) < std::min(at(i - 1, j), at(i - 1, j - 1))))
    {
      path.push_back({i, j - 1});
    }
    else if (j == 0 || at(i - 1, j) < at(i - 1, j - 1))
    {
      path.push_back({i - 1, j});
    }
    else
    {
      path.push_back({i - 1, j - 1});
    }
  }
  std::reverse(path.begin(), path.end());
  return path;
}

/// Mean over a window, which shrinks towards the ends: monotone stays monotone.
std::vector<double> smoothed(const std::vector<double>& values, int window)
{
  const auto n = static_cast<int>(values.size());
  std::vector<double> out(values.size());
  for (int i = 0; i < n; ++i)
  {
    const int w = std::min({window, i, n - 1 - i});
    double sum = 0.0;
    for (int k = i - w; k <= i + w; ++k)
    {
      sum += values[k] / (2 * w + 1);
    }
    out[i] = sum;
  }
  return out;
}
} // namespace

ArcMatch matchArcs(const ArcPiece& first, const ArcPiece& second, const MatchOptions& options)
{
  const int steps = options.Steps;
  std::vector<Vec3> points[2];
  for (int i = 0; i <= Samples; ++i)
  {
    const double t = static_cast<double>(i) / Samples;
    points[0].push_back(first.Curve->at(first.From + t * first.Length));
    points[1].push_back(second.Curve->at(second.From + t * second.Length));
  }
  if (options.Center)
  {
    Vec3 shift = Vec3::Zero();
    for (std::size_t i = 0; i < points[0].size(); ++i)
    {
      shift += (points[1][i] - points[0][i]) / static_cast<double>(points[0].size());
    }
    for (Vec3& p : points[0])
    {
      p += shift;
    }
  }
  const auto path = warpPath(points[0], points[1]);
  ArcMatch m;
  std::size_t k = 0;
  for (int s = 0; s <= steps; ++s)
  {
    const double want = 2.0 * Samples * s / steps; // of the sum of both sample numbers
    while (k + 2 < path.size() && path[k + 1][0] + path[k + 1][1] <= want)
    {
      ++k;
    }
    const double from = path[k][0] + path[k][1];
    const double to = path[k + 1][0] + path[k + 1][1];
    const double r = std::clamp((want - from) / (to - from), 0.0, 1.0);
    const double even = static_cast<double>(s) / steps;
    const auto value = [&](int c)
    {
      const double x = ((1.0 - r) * path[k][c] + r * path[k + 1][c]) / Samples;
      return (1.0 - options.Evenness) * x + options.Evenness * even;
    };
    m.First.push_back(value(0));
    m.Second.push_back(value(1));
  }
  m.First = smoothed(m.First, std::max(1, steps / 10));
  m.Second = smoothed(m.Second, std::max(1, steps / 10));
  return m;
}
} // namespace bsr
