#include "ImageTestHelpers.h"

#include "Image/BallClosing.h"
#include "Image/DistanceTransform.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

using namespace bsrtest;

namespace
{
/// Squared distance in the arithmetic of the definition (double), in voxels.
double bruteForce(const bsr::Volume<std::uint8_t>& mask, const bsr::Int3& p, bool toZeros)
{
  const double unit = bsr::voxelLength(mask.Spacing);
  double best = std::numeric_limits<double>::infinity();
  forEachVoxel(mask.Extent.Size,
    [&](const bsr::Int3& q)
    {
      if ((mask.view()(q[0], q[1], q[2]) != 0) != toZeros)
      {
        double d = 0.0;
        for (int a = 0; a < 3; ++a)
        {
          const double x = static_cast<double>(p[a] - q[a]) * mask.Spacing[a] / unit;
          d += x * x;
        }
        best = std::min(best, d);
      }
    });
  return best;
}

void compareWithBruteForce(const bsr::Volume<std::uint8_t>& mask, const bsr::DistanceOptions& o)
{
  bsr::Monitor monitor;
  const auto d = bsr::squaredDistance(mask.view(), o, monitor);
  ASSERT_TRUE(d) << d.status().message();
  forEachVoxel(d->Extent.Size,
    [&](const bsr::Int3& q)
    {
      bsr::Int3 p{};
      for (int a = 0; a < 3; ++a)
      {
        p[a] = d->Extent.Lo[a] + q[a] * o.Step;
      }
      const double truth = bruteForce(mask, p, o.ToZeros);
      const double found = d->view()(q[0], q[1], q[2]);
      if (truth > o.Bound * o.Bound)
      {
        ASSERT_GT(found, o.Bound * o.Bound);
      }
      else if (std::isfinite(truth))
      {
        ASSERT_NEAR(found, truth, 4e-7 * truth) << p[0] << ' ' << p[1] << ' ' << p[2];
      }
      else
      {
        ASSERT_TRUE(std::isinf(found));
      }
    });
}
} // namespace

TEST(DistanceTransform, EqualsBruteForceOnRandomMasks)
{
  for (int seed = 0; seed < 12; ++seed)
  {
    const double share = std::array<double, 4>{{0.001, 0.02, 0.3, 0.9}}[seed % 4];
    const auto mask = randomMask({{9 + seed, 13, 7}}, {{1.0, 1.0, 1.0}}, share, seed);
    bsr::DistanceOptions o;
    o.ToZeros = seed % 3 == 2;
    compareWithBruteForce(mask, o);
  }
}

TEST(DistanceTransform, IsExactlyIntegerForEqualSpacing)
{
  const auto mask = randomMask({{21, 18, 17}}, {{0.7, 0.7, 0.7}}, 0.01, 5);
  bsr::Monitor monitor;
  const auto d = bsr::squaredDistance(mask.view(), {}, monitor);
  forEachVoxel(mask.Extent.Size, [&](const bsr::Int3& p)
    { ASSERT_EQ(d->view()(p[0], p[1], p[2]), std::round(bruteForce(mask, p, false))); });
}

TEST(DistanceTransform, HonorsAnisotropicSpacing)
{
  compareWithBruteForce(randomMask({{15, 11, 9}}, {{0.879, 0.879, 1.5}}, 0.02, 1), {});
  compareWithBruteForce(randomMask({{9, 15, 12}}, {{3.0, 0.5, 1.1}}, 0.05, 2), {});
}

TEST(DistanceTransform, CroppedPaddedBoundedAndCoarse)
{
  const auto mask = randomMask({{14, 12, 10}}, {{1.0, 1.3, 1.0}}, 0.01, 3);
  bsr::DistanceOptions o;
  o.Extent = {{{-5, -3, -4}}, {{25, 19, 18}}};
  compareWithBruteForce(mask, o);
  o.Step = 3;
  compareWithBruteForce(mask, o);
  o.Bound = 4.5;
  compareWithBruteForce(mask, o);
  o.Extent = {{{3, 4, 5}}, {{4, 3, 2}}};
  o.Step = 1;
  compareWithBruteForce(mask, o);
  o.Extent = {{{40, 4, 5}}, {{4, 3, 2}}};
  o.Step = 2;
  o.Bound = std::numeric_limits<double>::infinity();
  compareWithBruteForce(mask, o);
}

TEST(DistanceTransform, EmptyMaskIsInfinitelyFar)
{
  compareWithBruteForce(randomMask({{5, 4, 3}}, {{1.0, 1.0, 1.0}}, -1.0, 3), {});
  bsr::DistanceOptions o;
  o.ToZeros = true;
  compareWithBruteForce(randomMask({{5, 4, 3}}, {{1.0, 1.0, 1.0}}, 2.0, 3), o);
}

TEST(DistanceTransform, RefusesBadInput)
{
  bsr::Monitor monitor;
  EXPECT_EQ(bsr::squaredDistance({}, {}, monitor).status().code(), bsr::StatusCode::InvalidInput);
  auto mask = randomMask({{4, 4, 4}}, {{1.0, 0.0, 1.0}}, 0.1, 1);
  EXPECT_EQ(
    bsr::squaredDistance(mask.view(), {}, monitor).status().code(), bsr::StatusCode::InvalidInput);
}

TEST(DistanceTransform, IsBitIdenticalForAnyNumberOfThreads)
{
  const auto mask = randomMask({{40, 41, 42}}, {{0.7, 1.0, 0.9}}, 0.01, 9);
  bsr::Monitor monitor;
  const auto two = bsr::squaredDistance(mask.view(), {}, monitor);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = bsr::squaredDistance(mask.view(), {}, monitor);
  const auto n = static_cast<std::size_t>(mask.Extent.volume()) * sizeof(float);
  EXPECT_EQ(std::memcmp(two->Data.get(), single->Data.get(), n), 0);
}

TEST(DistanceTransform, CancelsBetweenPortions)
{
  const auto mask = randomMask({{40, 41, 42}}, {{1.0, 1.0, 1.0}}, 0.01, 9);
  for (int after : {0, 1, 5, 40})
  {
    CancelAfter monitor(after);
    EXPECT_EQ(
      bsr::squaredDistance(mask.view(), {}, monitor).status().code(), bsr::StatusCode::Cancelled);
  }
}

namespace
{
/// Dilation and then erosion by the ball, by definition, on a grid that is large enough.
bsr::Volume<std::uint8_t> closingByDefinition(const bsr::Volume<std::uint8_t>& mask, double radius)
{
  const bsr::Int3 pad = bsr::reach(radius, mask.Spacing);
  const double unit = bsr::voxelLength(mask.Spacing);
  std::vector<bsr::Int3> ball;
  forEachVoxel({{2 * pad[0] + 1, 2 * pad[1] + 1, 2 * pad[2] + 1}},
    [&](const bsr::Int3& p)
    {
      double d = 0.0;
      bsr::Int3 o{};
      for (int a = 0; a < 3; ++a)
      {
        o[a] = p[a] - pad[a];
        d += std::pow(static_cast<double>(o[a]) * mask.Spacing[a] / unit, 2);
      }
      if (d <= radius * radius * (1.0 + 1e-6))
      {
        ball.push_back(o);
      }
    });
  const bsr::Box whole{{{0, 0, 0}}, mask.Extent.Size};
  bsr::Volume<std::uint8_t> dilated(whole.padded(pad), mask.Spacing);
  std::fill_n(dilated.Data.get(), dilated.Extent.volume(), std::uint8_t{0});
  forEachVoxel(mask.Extent.Size,
    [&](const bsr::Int3& p)
    {
      for (const bsr::Int3& o : ball)
      {
        if (mask.view()(p[0], p[1], p[2]))
        {
          dilated.view()(p[0] + o[0] + pad[0], p[1] + o[1] + pad[1], p[2] + o[2] + pad[2]) = 1;
        }
      }
    });
  bsr::Volume<std::uint8_t> closed(whole, mask.Spacing);
  forEachVoxel(mask.Extent.Size,
    [&](const bsr::Int3& p)
    {
      bool all = true;
      for (const bsr::Int3& o : ball)
      {
        all = all &&
              dilated.view()(p[0] + o[0] + pad[0], p[1] + o[1] + pad[1], p[2] + o[2] + pad[2]) != 0;
      }
      closed.view()(p[0], p[1], p[2]) = all ? 1 : 0;
    });
  return closed;
}

void compareClosing(const bsr::Volume<std::uint8_t>& mask, double radius)
{
  bsr::Monitor monitor;
  const auto closed = bsr::closeByBall(mask.view(), radius, monitor);
  ASSERT_TRUE(closed) << closed.status().message();
  const auto truth = closingByDefinition(mask, radius);
  forEachVoxel(mask.Extent.Size,
    [&](const bsr::Int3& p)
    {
      const bsr::Box& box = closed->Extent;
      const int found =
        box.contains(p) ? closed->view()(p[0] - box.Lo[0], p[1] - box.Lo[1], p[2] - box.Lo[2]) : 0;
      ASSERT_EQ(found, truth.view()(p[0], p[1], p[2]))
        << "radius " << radius << " at " << p[0] << ' ' << p[1] << ' ' << p[2];
    });
}
} // namespace

TEST(BallClosing, EqualsDilationThenErosion)
{
  for (double radius : {0.0, 0.9, 1.0, std::sqrt(2.0), 2.0, 2.5, 3.7, 5.0})
  {
    compareClosing(randomMask({{15, 13, 14}}, {{1.0, 1.0, 1.0}}, 0.02, 4), radius);
    compareClosing(randomMask({{12, 13, 9}}, {{0.879, 0.879, 1.5}}, 0.03, 6), radius);
    compareClosing(randomMask({{12, 10, 11}}, {{2.0, 0.7, 0.9}}, 0.1, 8), radius);
  }
}

TEST(BallClosing, RadiusLargerThanTheImage)
{
  compareClosing(randomMask({{5, 6, 4}}, {{1.0, 1.0, 1.0}}, 0.1, 4), 9.0);
}

TEST(BallClosing, KeepsOneVoxelAndRefusesNone)
{
  auto mask = randomMask({{5, 6, 4}}, {{1.0, 1.0, 1.0}}, -1.0, 4);
  bsr::Monitor monitor;
  EXPECT_EQ(
    bsr::closeByBall(mask.view(), 3.0, monitor).status().code(), bsr::StatusCode::InvalidInput);
  mask.view()(0, 5, 2) = 1;
  compareClosing(mask, 3.0);
  EXPECT_EQ(bsr::closeByBall(mask.view(), -1.0, monitor).status().code(),
    bsr::StatusCode::InvalidParameter);
}
