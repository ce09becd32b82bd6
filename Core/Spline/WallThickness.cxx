#include "Spline/WallThickness.h"

#include "Common/Parallel.h"
#include "Spline/FoldCheck.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace bsr
{
namespace
{
constexpr int Samples = 13;
constexpr std::int64_t Own = Samples * Samples;

double parameter(std::int64_t k)
{
  return static_cast<double>(k) / (Samples - 1.0);
}

std::vector<SurfacePoint> sampleShell(const PatchNet& net, const NetPoints& shell)
{
  const NetEvaluator surface(net, shell);
  std::vector<SurfacePoint> samples(net.patches() * Own);
  parallelFor(0, net.patches(), 8,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin * Own; i < end * Own; ++i)
      {
        const std::int64_t k = i % Own;
        const std::int64_t row = k / Samples;
        samples[i] =
          surface.at(static_cast<Index>(i / Own), parameter(k % Samples), parameter(row));
      }
    });
  return samples;
}

std::vector<Vec3> placesOf(const std::vector<SurfacePoint>& samples)
{
  std::vector<Vec3> places;
  places.reserve(samples.size());
  for (const SurfacePoint& p : samples)
  {
    places.push_back(p.Point);
  }
  return places;
}

std::vector<WallGauge::Wall> wallsAt(
  const WallGauge& outer, std::int64_t count, const std::function<Vec3(std::int64_t)>& place)
{
  std::vector<WallGauge::Wall> walls(count);
  parallelFor(0, count, 1024,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        walls[i] = outer.at(place(i));
      }
    });
  return walls;
}
} // namespace

WallGauge::WallGauge(const PatchNet& net, const NetPoints& outer)
    : Outside(sampleShell(net, outer)), Tree(placesOf(this->Outside))
{
}

WallGauge::Wall WallGauge::at(const Vec3& place) const
{
  const auto [nearest, distance2] = this->Tree.nearest(place);
  const SurfacePoint& o = this->Outside[nearest];
  Wall w;
  w.Normal = o.normal().normalized();
  w.Height = (o.Point - place).dot(w.Normal);
  const double distance = std::sqrt(distance2);
  // Beyond an open rim the nearest sample lies aside, not above: that is no crossing.
  w.Thickness = w.Height < -0.7 * distance ? -distance : distance;
  return w;
}

double minimumWall(const PatchNet& net, const WallGauge& outer, const NetPoints& inner)
{
  const auto inside = sampleShell(net, inner);
  const auto walls = wallsAt(outer, static_cast<std::int64_t>(inside.size()),
    [&](std::int64_t i) { return inside[i].Point; });
  double least = std::numeric_limits<double>::max();
  for (const auto& w : walls)
  {
    least = std::min(least, w.Thickness);
  }
  return least;
}

double medianWall(const WallGauge& outer, const std::vector<FitPoint>& points)
{
  const auto walls = wallsAt(outer, static_cast<std::int64_t>(points.size()),
    [&](std::int64_t i) { return points[i].Position; });
  std::vector<double> positive;
  for (const auto& w : walls)
  {
    if (w.Thickness > 0.0)
    {
      positive.push_back(w.Thickness);
    }
  }
  if (positive.empty())
  {
    return 0.0;
  }
  const auto middle = positive.begin() + static_cast<std::ptrdiff_t>(positive.size() / 2);
  std::nth_element(positive.begin(), middle, positive.end());
  return *middle;
}

std::vector<FitPoint> thinPlaces(
  const PatchNet& net, const WallGauge& outer, const NetPoints& inner, double least)
{
  const auto inside = sampleShell(net, inner);
  const auto walls = wallsAt(outer, static_cast<std::int64_t>(inside.size()),
    [&](std::int64_t i) { return inside[i].Point; });
  std::vector<FitPoint> thin;
  for (std::size_t i = 0; i < walls.size(); ++i)
  {
    if (walls[i].Thickness >= least)
    {
      continue;
    }
    FitPoint p;
    p.Patch = static_cast<Index>(i / Own);
    p.U = parameter(static_cast<std::int64_t>(i % Own) % Samples);
    p.V = parameter(static_cast<std::int64_t>(i % Own) / Samples);
    p.Position = inside[i].Point - std::max(0.0, 1.5 * least - walls[i].Height) * walls[i].Normal;
    p.Robust = walls[i].Thickness <= 0.0 ? 2.0 : 1.0;
    p.Fixed = true;
    thin.push_back(p);
  }
  return thin;
}

std::vector<Index> foldedWalls(
  const QuadComplex& complex, const PatchNet& net, const NetPoints& outer, const NetPoints& inner)
{
  constexpr int Grid = 25;
  const NetEvaluator outside(net, outer);
  const NetEvaluator inside(net, inner);
  std::vector<Index> folded;
  for (const auto& loop : complex.borderLoops())
  {
    for (const Index h : loop)
    {
      std::vector<Vec3> normals;
      for (int i = 0; i < Grid; ++i)
      {
        const double t = i / (Grid - 1.0);
        const double uv[4][2] = {{t, 0.0}, {1.0, t}, {1.0 - t, 1.0}, {0.0, 1.0 - t}};
        const SurfacePoint o = outside.at(h / 4, uv[h % 4][0], uv[h % 4][1]);
        const SurfacePoint n = inside.at(h / 4, uv[h % 4][0], uv[h % 4][1]);
        const Vec3& along = h % 2 ? o.Dv : o.Du;
        const Vec3& alongInner = h % 2 ? n.Dv : n.Du;
        for (int j = 0; j < Grid; ++j)
        {
          const double s = j / (Grid - 1.0);
          normals.push_back(((1.0 - s) * along + s * alongInner).cross(n.Point - o.Point));
        }
      }
      if (normalsFold(normals, Grid))
      {
        folded.push_back(h);
      }
    }
  }
  return folded;
}
} // namespace bsr
