#include "ImageTestHelpers.h"

#include "Image/ClosedDistance.h"
#include "Image/Closing.h"
#include "Image/CrossingDistance.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

using namespace bsrtest;
using bsr::Double3;
using bsr::Int3;

namespace
{
/// Gray values that fall linearly through 500 at the surface of a shape given by its signed
/// distance (world units, negative inside).
template <class T, class F>
bsr::Volume<T> grayImage(const Int3& dims, const Double3& spacing, const F& distance)
{
  return makeVolume<T>(dims, spacing,
    [&](const Int3& p)
    {
      const double d = distance(static_cast<double>(p[0]) * spacing[0],
        static_cast<double>(p[1]) * spacing[1], static_cast<double>(p[2]) * spacing[2]);
      return static_cast<T>(500.0 - std::min(400.0, std::max(-400.0, 200.0 * d)));
    });
}

/// A tube along x: walls between the radii, from x0 to x1.
struct Tube
{
  double Inner, Outer, X0, X1, Y, Z;
  double operator()(double x, double y, double z) const
  {
    const double r = std::hypot(y - this->Y, z - this->Z);
    return std::max({this->Inner - r, r - this->Outer, this->X0 - x, x - this->X1});
  }
};

struct Ball
{
  double Radius, X, Y, Z;
  double operator()(double x, double y, double z) const
  {
    return std::hypot(x - this->X, y - this->Y, z - this->Z) - this->Radius;
  }
};

bsr::ClosingResult closed(const bsr::Volume<float>& image, const bsr::ClosingOptions& o)
{
  bsr::Monitor monitor;
  auto r = bsr::closing<float>(image.view(), o, monitor);
  EXPECT_TRUE(r) << r.status().message();
  return r ? std::move(*r) : bsr::ClosingResult();
}

bsr::ClosingOptions withRadius(double radius)
{
  bsr::ClosingOptions o;
  o.AutoIsoValue = false;
  o.IsoValue = 500.0;
  o.AutoRadius = false;
  o.Radius = radius;
  return o;
}

/// Calls f(world point of a zero crossing, world gradient) for all grid edges the surface crosses.
template <class F>
void forEachCrossing(const bsr::Volume<float>& d, const F& f)
{
  const Int3& n = d.Extent.Size;
  const auto v = d.view();
  forEachVoxel({{n[0] - 3, n[1] - 3, n[2] - 3}},
    [&](const Int3& q)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        Int3 a{{q[0] + 1, q[1] + 1, q[2] + 1}};
        Int3 b = a;
        ++b[axis];
        const double va = v(a[0], a[1], a[2]);
        const double vb = v(b[0], b[1], b[2]);
        if ((va < 0.0) == (vb < 0.0))
        {
          continue;
        }
        Double3 point{};
        Double3 gradient{};
        for (int c = 0; c < 3; ++c)
        {
          point[c] =
            (static_cast<double>(a[c] + d.Extent.Lo[c]) + (c == axis ? va / (va - vb) : 0.0)) *
            d.Spacing[c];
          Int3 lo = a;
          Int3 hi = a;
          --lo[c];
          ++hi[c];
          gradient[c] = (v(hi[0], hi[1], hi[2]) - v(lo[0], lo[1], lo[2])) / (2.0 * d.Spacing[c]);
        }
        f(point, gradient);
      }
    });
}

/// RMS and largest distance of the zero level to a surface, in voxels, where `use` holds.
template <class F, class Use>
Double3 deviation(const bsr::Volume<float>& d, const F& truth, const Use& use)
{
  double sum = 0.0;
  double largest = 0.0;
  double count = 0.0;
  forEachCrossing(d,
    [&](const Double3& p, const Double3&)
    {
      if (use(p))
      {
        const double e = truth(p[0], p[1], p[2]) / bsr::voxelLength(d.Spacing);
        sum += e * e;
        largest = std::max(largest, std::abs(e));
        ++count;
      }
    });
  EXPECT_GT(count, 100.0);
  return {{std::sqrt(sum / count), largest, count}};
}
} // namespace

TEST(CrossingDistance, EqualsTheNearestCrossingPoint)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1.0F, 3.0F);
  const auto field =
    makeVolume<float>({{9, 8, 7}}, {{1.0, 1.4, 0.8}}, [&](const Int3&) { return uniform(random); });
  bsr::Monitor monitor;
  bsr::DistanceOptions o;
  o.Extent = {{{-4, 1, -2}}, {{15, 5, 12}}};
  const auto d = bsr::crossingDistance(field.view(), o, monitor);
  ASSERT_TRUE(d);
  std::vector<Double3> points;
  const auto view = field.view();
  forEachVoxel(field.Extent.Size,
    [&](const Int3& p)
    {
      for (int a = 0; a < 3; ++a)
      {
        Int3 q = p;
        if (++q[a] == field.Extent.Size[a])
        {
          continue;
        }
        const float u = view(p[0], p[1], p[2]);
        const float v = view(q[0], q[1], q[2]);
        if ((u < 0.0F) != (v < 0.0F))
        {
          points.push_back(
            {{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}});
          points.back()[a] += u / (u - v);
        }
      }
    });
  forEachVoxel(d->Extent.Size,
    [&](const Int3& p)
    {
      double best = 1e30;
      for (const Double3& c : points)
      {
        double sum = 0.0;
        for (int a = 0; a < 3; ++a)
        {
          const double x = (static_cast<double>(p[a] + o.Extent.Lo[a]) - c[a]) * field.Spacing[a];
          sum += x * x / (0.8 * 0.8);
        }
        best = std::min(best, sum);
      }
      ASSERT_NEAR(d->view()(p[0], p[1], p[2]), std::sqrt(best), 1e-4);
    });
}

TEST(Closing, BallKeepsItsSurfaceSmoothly)
{
  const Ball ball{10.3, 16.2, 15.7, 16.1};
  const auto image = grayImage<float>({{33, 33, 33}}, {{1.0, 1.0, 1.0}}, ball);
  for (double radius : {0.0, 1.0, 1.5, 3.0, 8.0})
  {
    const auto r = closed(image, withRadius(radius));
    const auto e = deviation(r.SignedDistance, ball, [](const Double3&) { return true; });
    EXPECT_LT(e[0], radius < 2.0 && radius >= 1.0 ? 0.12 : 0.05) << radius;
    EXPECT_LT(e[1], radius < 2.0 && radius >= 1.0 ? 0.35 : 0.15) << radius;
    EXPECT_TRUE(r.After.isBall());
    EXPECT_TRUE(r.Surface.isBall());
    EXPECT_TRUE(r.Warning.empty()) << r.Warning;
  }
}

TEST(Closing, NormalsOfTheZeroLevelDoNotStep)
{
  const Ball ball{12.3, 16.2, 15.7, 16.1};
  const auto image = grayImage<float>({{33, 33, 33}}, {{1.0, 1.0, 1.0}}, ball);
  const auto r = closed(image, withRadius(6.0));
  double sum = 0.0;
  double count = 0.0;
  forEachCrossing(r.SignedDistance,
    [&](const Double3& p, const Double3& g)
    {
      const Double3 n{{p[0] - ball.X, p[1] - ball.Y, p[2] - ball.Z}};
      const double dot = n[0] * g[0] + n[1] * g[1] + n[2] * g[2];
      const double length = std::hypot(n[0], n[1], n[2]) * std::hypot(g[0], g[1], g[2]);
      const double angle = std::acos(std::min(1.0, dot / length));
      sum += angle * angle;
      ++count;
    });
  EXPECT_LT(std::sqrt(sum / count) * 180.0 / 3.14159265, 4.0);
}

TEST(Closing, TubeFillsAndItsOuterWallIsWithinATenthOfAVoxel)
{
  const Tube tube{6.2, 9.4, 8.0, 52.0, 14.1, 13.8};
  const auto image = grayImage<float>({{60, 29, 28}}, {{1.0, 1.0, 1.0}}, tube);
  const auto r = closed(image, withRadius(8.0));
  EXPECT_EQ(r.Before.Tunnels, 1);
  EXPECT_TRUE(r.After.isBall());
  EXPECT_TRUE(r.Surface.isBall());
  const Tube solid{-1e9, 9.4, 8.0, 52.0, 14.1, 13.8};
  const auto wall = [](const Double3& p) { return p[0] > 12.0 && p[0] < 48.0; };
  const auto e = deviation(r.SignedDistance, solid, wall);
  EXPECT_LT(e[0], 0.1);
  EXPECT_LT(e[1], 0.3);
  // The depth in the middle is the distance to the outer wall.
  EXPECT_NEAR(r.SignedDistance.view()(30 - r.SignedDistance.Extent.Lo[0],
                14 - r.SignedDistance.Extent.Lo[1], 14 - r.SignedDistance.Extent.Lo[2]),
    -9.2, 0.3);
}

TEST(Closing, CapBowsInwardAsTheBallDoes)
{
  const double lumen = 6.2;
  const double radius = 8.0;
  const Tube tube{lumen, 10.4, 8.0, 52.0, 14.0, 14.0};
  const auto image = grayImage<float>({{60, 29, 29}}, {{1.0, 1.0, 1.0}}, tube);
  const auto r = closed(image, withRadius(radius));
  const auto v = r.SignedDistance.view();
  const Int3& lo = r.SignedDistance.Extent.Lo;
  double cap = 0.0;
  for (std::int64_t i = 0; i < 30 && cap == 0.0; ++i)
  {
    const double a = v(i - lo[0], 14 - lo[1], 14 - lo[2]);
    const double b = v(i + 1 - lo[0], 14 - lo[1], 14 - lo[2]);
    cap = a >= 0.0 && b < 0.0 ? static_cast<double>(i) + a / (a - b) : 0.0;
  }
  EXPECT_NEAR(cap - 8.0, radius - std::sqrt(radius * radius - lumen * lumen), 0.35);
}

TEST(Closing, AnisotropicSpacingIsHonored)
{
  const Double3 spacing{{0.879, 0.879, 1.5}};
  const Tube tube{6.0, 10.0, 10.0, 50.0, 14.1, 14.3};
  const auto image = grayImage<float>({{70, 33, 20}}, spacing, tube);
  const auto r = closed(image, withRadius(8.0));
  EXPECT_TRUE(r.After.isBall());
  EXPECT_TRUE(r.Surface.isBall());
  const Tube solid{-1e9, 10.0, 10.0, 50.0, 14.1, 14.3};
  const auto e =
    deviation(r.SignedDistance, solid, [](const Double3& p) { return p[0] > 14.0 && p[0] < 46.0; });
  EXPECT_LT(e[0], 0.15);
}

TEST(Closing, SignAgreesWithClosedWithinAVoxel)
{
  const Tube tube{6.2, 9.4, 8.0, 52.0, 14.1, 13.8};
  const auto image = grayImage<float>({{60, 29, 28}}, {{1.0, 1.0, 1.0}}, tube);
  const auto r = closed(image, withRadius(8.0));
  for (std::int64_t i = 0; i < r.Closed.Extent.volume(); ++i)
  {
    const float d = r.SignedDistance.Data[i];
    ASSERT_TRUE((r.Closed.Data[i] != 0) == (d < 0.0F) || std::abs(d) < 1.0F) << d;
  }
}

TEST(Closing, ObjectAtTheBorderWidensTheExtent)
{
  const auto full = makeVolume<float>({{6, 5, 4}}, {{1.0, 1.0, 1.0}},
    [](const Int3& p) { return p[0] == 3 && p[1] == 2 && p[2] == 2 ? 0.0F : 1000.0F; });
  const auto r = closed(full, withRadius(2.0));
  EXPECT_EQ(r.Closed.Extent.Lo, (Int3{{-2, -2, -2}}));
  EXPECT_EQ(r.Closed.Extent.Size, (Int3{{10, 9, 8}}));
  EXPECT_EQ(
    std::count(r.Closed.Data.get(), r.Closed.Data.get() + r.Closed.Extent.volume(), 1), 120);
  EXPECT_TRUE(r.Surface.isBall());
  // The surface closes half a voxel outside of the border.
  EXPECT_NEAR(r.SignedDistance.view()(1, 4, 4), 0.5, 0.25);
}

TEST(Closing, SeveralObjectsOrTheLargest)
{
  const Ball a{6.0, 10.0, 10.0, 10.0};
  const Ball b{4.0, 30.0, 10.0, 10.0};
  const auto image = grayImage<float>({{40, 20, 20}}, {{1.0, 1.0, 1.0}},
    [&](double x, double y, double z) { return std::min(a(x, y, z), b(x, y, z)); });
  auto o = withRadius(2.0);
  const auto one = closed(image, o);
  EXPECT_EQ(one.Components, 2);
  EXPECT_EQ(one.After.Components, 1);
  o.LargestComponent = false;
  const auto two = closed(image, o);
  EXPECT_EQ(two.After.Components, 2);
  EXPECT_EQ(two.Surface.Components, 2);
}

TEST(Closing, OneVoxelBecomesASmallBall)
{
  const auto image = makeVolume<float>({{7, 7, 7}}, {{1.0, 1.0, 1.0}},
    [](const Int3& p) {
      return p == Int3{{3, 3, 3}} ? 1000.0F : 0.0F;
    });
  for (double radius : {0.0, 2.0})
  {
    const auto r = closed(image, withRadius(radius));
    EXPECT_TRUE(r.Surface.isBall()) << radius;
  }
  bsr::ClosingOptions automatic;
  EXPECT_TRUE(closed(image, automatic).Surface.isBall());
}

TEST(Closing, AutomaticRadiusJustFillsTheLumen)
{
  struct Case
  {
    Tube Shape;
    Int3 Dims;
  };
  // The second is large enough to be searched on every second voxel.
  for (const Case& c : {Case{{7.0, 10.0, 8.0, 82.0, 14.0, 14.0}, {{90, 29, 29}}},
         Case{{27.0, 40.0, 6.0, 196.0, 43.0, 43.0}, {{202, 87, 87}}}})
  {
    const auto image = grayImage<float>(c.Dims, {{1.0, 1.0, 1.0}},
      [&](double x, double y, double z)
      {
        // A hole in the wall.
        const double hole = 3.0 - std::hypot(x - 0.5 * c.Shape.X1, y - c.Shape.Y);
        return std::max(c.Shape(x, y, z), z > c.Shape.Z ? hole : -1e9);
      });
    auto o = withRadius(0.0);
    o.AutoRadius = true;
    const auto r = closed(image, o);
    EXPECT_TRUE(r.Plateau);
    EXPECT_GT(r.Radius, c.Shape.Inner);
    EXPECT_LT(r.Radius, 1.35 * c.Shape.Inner);
    EXPECT_TRUE(r.After.isBall());
    EXPECT_TRUE(r.Warning.empty()) << r.Warning;
  }
}

TEST(Closing, SolidObjectGetsTheSmallestRadiusAndSaysSo)
{
  const auto image =
    grayImage<float>({{40, 40, 40}}, {{1.0, 1.0, 1.0}}, Ball{14.0, 20.0, 20.0, 20.0});
  const auto r = closed(image, bsr::ClosingOptions());
  EXPECT_LE(r.Radius, 2.0);
  EXPECT_FALSE(r.Plateau);
  EXPECT_NE(r.Warning.find("no lumen"), std::string::npos);
}

TEST(Closing, NetworkThatIsNoBallSaysSo)
{
  // A wide ring of a thin bar: filling it would more than double the volume.
  const auto image = grayImage<float>({{64, 64, 16}}, {{1.0, 1.0, 1.0}},
    [](double x, double y, double z)
    { return std::hypot(std::hypot(x - 32.0, y - 32.0) - 25.0, z - 8.0) - 3.0; });
  const auto r = closed(image, bsr::ClosingOptions());
  EXPECT_EQ(r.After.Tunnels, 1);
  EXPECT_EQ(r.Surface.Tunnels, 1);
  EXPECT_NE(r.Warning.find("not a ball"), std::string::npos);
}

TEST(Closing, RefusesBadInputWithOneReason)
{
  bsr::Monitor monitor;
  const auto fails = [&](const bsr::Volume<float>& v, const bsr::ClosingOptions& o)
  {
    const auto r = bsr::closing<float>(v.view(), o, monitor);
    EXPECT_FALSE(r);
    return r.status().message();
  };
  const auto constant =
    makeVolume<float>({{4, 4, 4}}, {{1.0, 1.0, 1.0}}, [](const Int3&) { return 7.0F; });
  EXPECT_NE(fails(constant, {}).find("constant"), std::string::npos);
  EXPECT_NE(fails(constant, withRadius(2.0)).find("constant"), std::string::npos);
  EXPECT_NE(fails(bsr::Volume<float>(), {}).find("empty"), std::string::npos);
  auto image = grayImage<float>({{20, 20, 20}}, {{1.0, 1.0, 1.0}}, Ball{5.0, 10.0, 10.0, 10.0});
  auto o = withRadius(2.0);
  o.IsoValue = 1e6;
  EXPECT_NE(fails(image, o).find("no object"), std::string::npos);
  o.IsoValue = -1e6;
  EXPECT_NE(fails(image, o).find("no background"), std::string::npos);
  EXPECT_NE(fails(image, withRadius(-1.0)).find("radius"), std::string::npos);
  EXPECT_NE(fails(image, withRadius(21.0)).find("largest width"), std::string::npos);
  image.Data[11] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(fails(image, {}).find("NaN"), std::string::npos);
  EXPECT_NE(fails(image, withRadius(2.0)).find("NaN"), std::string::npos);
}

TEST(Closing, RadiusAsLargeAsTheImageWorks)
{
  const auto image =
    grayImage<float>({{30, 29, 29}}, {{1.0, 1.0, 1.0}}, Tube{6.0, 9.0, 5.0, 25.0, 14.0, 14.0});
  EXPECT_TRUE(closed(image, withRadius(30.0)).Surface.isBall());
}

TEST(Closing, IsBitIdenticalForAnyNumberOfThreads)
{
  const auto image =
    grayImage<float>({{40, 29, 29}}, {{0.9, 1.0, 1.0}}, Tube{6.0, 9.0, 5.0, 32.0, 14.0, 14.0});
  const auto two = closed(image, bsr::ClosingOptions());
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = closed(image, bsr::ClosingOptions());
  EXPECT_EQ(two.Radius, single.Radius);
  const auto n = static_cast<std::size_t>(two.Closed.Extent.volume());
  EXPECT_EQ(std::memcmp(two.Closed.Data.get(), single.Closed.Data.get(), n), 0);
  EXPECT_EQ(std::memcmp(two.SignedDistance.Data.get(), single.SignedDistance.Data.get(), 4 * n), 0);
}

TEST(Closing, Cancels)
{
  const auto image =
    grayImage<float>({{40, 29, 29}}, {{1.0, 1.0, 1.0}}, Tube{6.0, 9.0, 5.0, 32.0, 14.0, 14.0});
  for (int after : {0, 10, 100, 1000})
  {
    CancelAfter monitor(after);
    EXPECT_EQ(
      bsr::closing<float>(image.view(), {}, monitor).status().code(), bsr::StatusCode::Cancelled)
      << after;
  }
}
