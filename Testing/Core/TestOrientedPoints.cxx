#include "Common/CounterRandom.h"
#include "Mesh/PointDistance.h"

#include <gtest/gtest.h>

#include <cmath>

using bsr::Monitor;
using bsr::Vec3;

namespace
{
/// Points of the unit sphere, spread evenly (Fibonacci), without those below z = `low`.
std::vector<Vec3> sphere(int count, double low = -2.0)
{
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i)
  {
    const double z = 1.0 - 2.0 * (i + 0.5) / count;
    const double r = std::sqrt(1.0 - z * z);
    const double a = 2.399963229728653 * i;
    if (z > low)
    {
      points.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
  }
  return points;
}

/// The surface of a plate of sides 2, 2 and `thickness`, its points on a grid of the given step.
std::vector<Vec3> plate(double thickness, double step)
{
  std::vector<Vec3> points;
  const int n = static_cast<int>(std::lround(2.0 / step));
  const int m = static_cast<int>(std::lround(thickness / step));
  for (int k = 0; k <= m; ++k)
  {
    for (int j = 0; j <= n; ++j)
    {
      for (int i = 0; i <= n; ++i)
      {
        if (i == 0 || i == n || j == 0 || j == n || k == 0 || k == m)
        {
          points.emplace_back(-1.0 + step * i, -1.0 + step * j, step * k);
        }
      }
    }
  }
  return points;
}
} // namespace

TEST(OrientedPoints, NormalsOfASpherePointOutward)
{
  Monitor monitor;
  const auto r = bsr::orientPoints(sphere(2000), 16, monitor);
  ASSERT_TRUE(r);
  for (std::size_t i = 0; i < r->Points.size(); ++i)
  {
    EXPECT_GT(r->Normals[i].dot(r->Points[i]), 0.99);
    EXPECT_GT(r->Spacing[i], 0.0);
  }
}

TEST(OrientedPoints, NormalsAgreeOnBothSidesOfAThinPlate)
{
  // Three samples thick, with sharp edges: signs must not leak through the plate.
  Monitor monitor;
  const auto r = bsr::orientPoints(plate(0.15, 0.05), 16, monitor);
  ASSERT_TRUE(r);
  for (std::size_t i = 0; i < r->Points.size(); ++i)
  {
    const Vec3& p = r->Points[i];
    if (std::abs(p[0]) < 0.9 && std::abs(p[1]) < 0.9)
    {
      EXPECT_GT(r->Normals[i][2] * (p[2] > 0.07 ? 1.0 : -1.0), 0.9);
    }
  }
}

TEST(OrientedPoints, PartsAreTurnedOutwardEachAndRepetitionsLeftOut)
{
  auto points = sphere(500);
  const auto second = points;
  for (const Vec3& p : second)
  {
    points.push_back(p + Vec3(10.0, 0.0, 0.0));
  }
  points.insert(points.end(), second.begin(), second.end());
  Monitor monitor;
  const auto r = bsr::orientPoints(points, 12, monitor);
  ASSERT_TRUE(r);
  ASSERT_EQ(r->Points.size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i)
  {
    const Vec3 center(r->Points[i][0] > 5.0 ? 10.0 : 0.0, 0.0, 0.0);
    EXPECT_GT(r->Normals[i].dot(r->Points[i] - center), 0.9);
  }
}

TEST(OrientedPoints, BadPointsAreRefused)
{
  Monitor monitor;
  EXPECT_FALSE(bsr::orientPoints({}, 16, monitor));
  EXPECT_FALSE(bsr::orientPoints(std::vector<Vec3>(100, Vec3::Zero()), 16, monitor));
  auto points = sphere(50);
  EXPECT_FALSE(bsr::orientPoints(points, 3, monitor));
  points[7][1] = NAN;
  EXPECT_FALSE(bsr::orientPoints(points, 16, monitor));
}

TEST(PointDistance, IsTheDistanceToASphereWhereItsPointsAre)
{
  Monitor monitor;
  const auto points = bsr::orientPoints(sphere(4000, -0.3), 16, monitor);
  ASSERT_TRUE(points);
  const bsr::PointDistance distance(*points);
  bsr::CounterRandom random(3, 0);
  for (int i = 0; i < 200; ++i)
  {
    const double a = 6.28 * random.uniform();
    const double z = -0.2 + 1.15 * random.uniform();
    const Vec3 n(std::sqrt(1.0 - z * z) * std::cos(a), std::sqrt(1.0 - z * z) * std::sin(a), z);
    for (const double d : {-0.05, 0.0, 0.05})
    {
      EXPECT_NEAR(distance.at((1.0 + d) * n), d, 2e-3);
    }
    EXPECT_LT(distance.remoteness(n), 1.0);
  }
  EXPECT_GT(distance.remoteness(Vec3(0.0, 0.0, -1.0)), 5.0);
}

namespace
{
/// The unit sphere, its upper half with 25 times as many points as the lower one.
std::vector<Vec3> unevenSphere()
{
  auto points = sphere(20000, 0.0);
  for (const Vec3& p : sphere(800))
  {
    if (p[2] <= 0.0)
    {
      points.push_back(p);
    }
  }
  return points;
}
} // namespace

TEST(PointDistance, CoarsePointsBesideDenseOnesReachAsFarAsElsewhere)
{
  Monitor monitor;
  const auto points = bsr::orientPoints(unevenSphere(), 16, monitor);
  ASSERT_TRUE(points);
  const bsr::PointDistance distance(*points);
  bsr::CounterRandom random(5, 0);
  for (int i = 0; i < 3000; ++i)
  {
    const double a = 6.2831853 * random.uniform();
    const double z = -0.4 + 0.5 * random.uniform(); // about the border of the halves
    const Vec3 n(std::sqrt(1.0 - z * z) * std::cos(a), std::sqrt(1.0 - z * z) * std::sin(a), z);
    EXPECT_LT(distance.remoteness(n), 1.1);
    EXPECT_LT(distance.overhang(n), 1.2);
    EXPECT_NEAR(distance.at(n), 0.0, 0.02);
  }
}

TEST(PointDistance, OverhangIsOneOnARim)
{
  Monitor monitor;
  const auto points = bsr::orientPoints(sphere(8000, -0.3), 16, monitor);
  ASSERT_TRUE(points);
  const bsr::PointDistance distance(*points);
  const double spacing = points->Spacing[0];
  for (int i = 0; i < 60; ++i)
  {
    const auto at = [&](double spacings)
    {
      const double t = std::asin(-0.3) + spacings * spacing;
      const double a = 0.1047 * i;
      return distance.overhang({std::cos(t) * std::cos(a), std::cos(t) * std::sin(a), std::sin(t)});
    };
    EXPECT_NEAR(at(-0.4), 1.0, 0.2); // half a sample beyond the last points
    EXPECT_LT(at(4.0), 0.3);
    EXPECT_GT(at(-1.0), 1.3);
  }
}

TEST(PointDistance, GridIsKnownNearPointsOnly)
{
  Monitor monitor;
  const auto points = bsr::orientPoints(sphere(1000), 16, monitor);
  ASSERT_TRUE(points);
  const bsr::PointDistance distance(*points);
  const auto grid = bsr::sampleDistance(*points, distance, 0.05, 2.0, monitor);
  ASSERT_TRUE(grid);
  std::size_t known = 0;
  for (std::size_t v = 0; v < grid->Values.size(); ++v)
  {
    const auto x = static_cast<int>(v) % grid->Size[0];
    const auto y = static_cast<int>(v) / grid->Size[0] % grid->Size[1];
    const auto z = static_cast<int>(v) / grid->Size[0] / grid->Size[1];
    const Vec3 p = grid->Origin + 0.05 * Vec3(x, y, z);
    if (grid->Values[v] < grid->Unknown)
    {
      ++known;
      EXPECT_NEAR(grid->Values[v], p.norm() - 1.0, 0.03);
    }
    else
    {
      EXPECT_GT(std::abs(p.norm() - 1.0), 0.05);
    }
  }
  EXPECT_GT(known, 5000U);
  EXPECT_FALSE(bsr::sampleDistance(*points, distance, 1e-6, 2.0, monitor));
}
