#include "Spline/WallThickness.h"

#include "Common/Parallel.h"
#include "Spline/PointTree.h"

#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr int Samples = 9;

std::vector<PatchPoint> sampleShell(const PatchNet& net, const NetPoints& shell)
{
  const NetEvaluator surface(net, shell);
  constexpr std::int64_t Own = Samples * Samples;
  std::vector<PatchPoint> samples(net.patches() * Own);
  parallelFor(0, net.patches(), 8,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin * Own; i < end * Own; ++i)
      {
        const auto k = static_cast<int>(i % Own);
        samples[i] = surface.at(static_cast<Index>(i / Own), k % Samples / (Samples - 1.0),
          k / Samples / (Samples - 1.0));
      }
    });
  return samples;
}
} // namespace

double minimumWall(const PatchNet& net, const NetPoints& outer, const NetPoints& inner)
{
  const auto outside = sampleShell(net, outer);
  const auto inside = sampleShell(net, inner);
  std::vector<Vec3> places;
  places.reserve(outside.size());
  for (const PatchPoint& p : outside)
  {
    places.push_back(p.Point);
  }
  const PointTree tree(std::move(places));
  return parallelReduce<double>(
    0, static_cast<std::int64_t>(inside.size()), 2048, std::numeric_limits<double>::max(),
    [&](std::int64_t begin, std::int64_t end)
    {
      double least = std::numeric_limits<double>::max();
      for (std::int64_t i = begin; i < end; ++i)
      {
        const auto [nearest, distance2] = tree.nearest(inside[i].Point);
        const PatchPoint& o = outside[nearest];
        const Vec3 across = o.Point - inside[i].Point;
        // Beyond an open rim the nearest sample lies aside, not above: that is no crossing.
        const double height = across.dot(o.normal());
        const bool crossed = height < -0.7 * std::sqrt(distance2) * o.normal().norm();
        least = std::min(least, crossed ? -std::sqrt(distance2) : std::sqrt(distance2));
      }
      return least;
    },
    [](double a, double b) { return std::min(a, b); });
}
} // namespace bsr
