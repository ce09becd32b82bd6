#include "Common/CounterRandom.h"
#include "Image/FiberPhantom.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace
{
using bsr::FiberPhantom;
using bsr::FiberPhantomOptions;
using bsr::Vec3;

FiberPhantomOptions small()
{
  FiberPhantomOptions o;
  o.Dimensions = {96, 48, 48};
  return o;
}

/// Without anything that is not in the truth.
FiberPhantomOptions clean(FiberPhantomOptions o)
{
  o.Holes = o.Pits = o.Tunnels = o.Cavities = o.Debris = 0;
  o.Roughness = o.Noise = o.Rings = o.Shading = 0.0;
  return o;
}

FiberPhantom make(const FiberPhantomOptions& o)
{
  auto phantom = bsr::makeFiberPhantom(o);
  EXPECT_TRUE(phantom.isOk()) << phantom.status().message();
  return *phantom;
}

std::vector<std::uint16_t> image(const FiberPhantom& phantom)
{
  const auto& d = phantom.Options.Dimensions;
  bsr::Monitor monitor;
  auto values = bsr::fiberImage(phantom, {0, d[0] - 1, 0, d[1] - 1, 0, d[2] - 1}, monitor);
  EXPECT_TRUE(values.isOk()) << values.status().message();
  return *values;
}

/// Trilinear interpolation at a world point.
double sample(const FiberPhantom& phantom, const std::vector<std::uint16_t>& values, const Vec3& p)
{
  const auto& o = phantom.Options;
  std::int64_t b[3];
  double w[3];
  for (int a = 0; a < 3; ++a)
  {
    const double x = std::clamp(p[a] / o.Spacing[a], 0.0, o.Dimensions[a] - 1.000001);
    b[a] = static_cast<std::int64_t>(x);
    w[a] = x - static_cast<double>(b[a]);
  }
  double sum = 0.0;
  for (int c = 0; c < 8; ++c)
  {
    const int d[3] = {c & 1, (c >> 1) & 1, c >> 2};
    const std::int64_t n =
      ((b[2] + d[2]) * o.Dimensions[1] + b[1] + d[1]) * o.Dimensions[0] + b[0] + d[0];
    sum +=
      values[n] * (d[0] ? w[0] : 1 - w[0]) * (d[1] ? w[1] : 1 - w[1]) * (d[2] ? w[2] : 1 - w[2]);
  }
  return sum;
}

/// Number of 6-connected components of voxels below or above the iso value.
int components(const FiberPhantom& phantom, const std::vector<std::uint16_t>& values, bool above)
{
  const auto& d = phantom.Options.Dimensions;
  const double iso = phantom.isoValue();
  std::vector<char> seen(values.size(), 0);
  const std::int64_t stride[3] = {1, d[0], static_cast<std::int64_t>(d[0]) * d[1]};
  int count = 0;
  for (std::int64_t seed = 0; seed < static_cast<std::int64_t>(values.size()); ++seed)
  {
    if (seen[seed] || (values[seed] >= iso) != above)
    {
      continue;
    }
    ++count;
    std::vector<std::int64_t> stack{seed};
    seen[seed] = 1;
    while (!stack.empty())
    {
      const std::int64_t n = stack.back();
      stack.pop_back();
      const std::int64_t at[3] = {n % d[0], n / d[0] % d[1], n / stride[2]};
      for (int a = 0; a < 3; ++a)
      {
        for (int step = -1; step <= 1; step += 2)
        {
          if (at[a] + step < 0 || at[a] + step >= d[a])
          {
            continue;
          }
          const std::int64_t m = n + step * stride[a];
          if (!seen[m] && (values[m] >= iso) == above)
          {
            seen[m] = 1;
            stack.push_back(m);
          }
        }
      }
    }
  }
  return count;
}

/// Distance in voxels from a true point to the gray value iso along the wall's normal, which the
/// caller approximates by the image's gradient; capped at 3.
double missDistance(
  const FiberPhantom& phantom, const std::vector<std::uint16_t>& values, const Vec3& p)
{
  const double iso = phantom.isoValue();
  const double h = phantom.Shape.voxel();
  Vec3 g;
  for (int a = 0; a < 3; ++a)
  {
    const Vec3 step = 0.7 * h * Vec3::Unit(a);
    g[a] = sample(phantom, values, p + step) - sample(phantom, values, p - step);
  }
  g.normalize();
  const double here = sample(phantom, values, p) - iso;
  for (double t = 0.02; t < 3.0; t += 0.02)
  {
    for (const double s : {-t, t})
    {
      if ((sample(phantom, values, p + s * h * g) - iso) * here <= 0.0)
      {
        return t;
      }
    }
  }
  return 3.0;
}

/// Root mean square and share above one voxel of the true points' distances to the iso surface.
std::pair<double, double> misfit(const FiberPhantom& phantom, double away)
{
  const auto values = image(phantom);
  const auto truth = bsr::fiberTruth(phantom);
  double square = 0.0;
  double large = 0.0;
  double n = 0.0;
  for (std::size_t i = 0; i < truth.Points.size(); i += 7)
  {
    const Vec3& p = truth.Points[i];
    const bool nearEnd = phantom.Options.OpenEnds && (p.x() < phantom.Shape.begin() + away ||
                                                       p.x() > phantom.Shape.end() - away);
    if (!nearEnd)
    {
      const double d = missDistance(phantom, values, p);
      square += d * d;
      large += d > 1.0;
      n += 1.0;
    }
  }
  EXPECT_GT(n, 1000);
  return {std::sqrt(square / n), large / n};
}
} // namespace

TEST(CounterRandom, IsTheSameForever)
{
  bsr::CounterRandom r(1, 2);
  const std::uint64_t first = r.bits();
  EXPECT_EQ(first, bsr::CounterRandom(1, 2).bits());
  EXPECT_NE(first, bsr::CounterRandom(2, 2).bits());
  EXPECT_NE(first, bsr::CounterRandom(1, 3).bits());
  // First output of SplitMix64 with state 0, from its reference implementation.
  EXPECT_EQ(bsr::mixBits(0), 0xe220a8397b1dcdafULL);
}

TEST(CounterRandom, HasTheMomentsItNames)
{
  bsr::CounterRandom r(5, 0);
  double mean = 0, square = 0, least = 1, most = 0, noise = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i)
  {
    const double u = r.uniform();
    least = std::min(least, u);
    most = std::max(most, u);
    const double g = r.normal();
    mean += g / n;
    square += g * g / n;
    const double l =
      bsr::latticeNoise(7, Vec3(r.uniform(-900, 900), r.uniform(-900, 900), r.uniform(-900, 900)));
    noise += l * l / n;
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LT(most, 1.0);
  EXPECT_NEAR(mean, 0.0, 0.01);
  EXPECT_NEAR(square, 1.0, 0.01);
  EXPECT_NEAR(noise, std::pow(26.0 / 35.0, 3) / 3.0, 0.002);
}

TEST(FiberPhantom, ImageDoesNotDependOnThreads)
{
  const auto many = image(make(small()));
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(many, image(make(small())));
}

TEST(FiberPhantom, PiecesAreTheWholeBitForBit)
{
  const auto phantom = make(small());
  const auto whole = image(phantom);
  const auto& d = phantom.Options.Dimensions;
  const std::array<int, 6> e{30, 61, 7, 40, 20, 47};
  bsr::Monitor monitor;
  auto piece = bsr::fiberImage(phantom, e, monitor);
  ASSERT_TRUE(piece);
  std::size_t n = 0;
  for (int k = e[4]; k <= e[5]; ++k)
  {
    for (int j = e[2]; j <= e[3]; ++j)
    {
      for (int i = e[0]; i <= e[1]; ++i)
      {
        ASSERT_EQ((*piece)[n++], whole[(static_cast<std::size_t>(k) * d[1] + j) * d[0] + i]);
      }
    }
  }
}

TEST(FiberPhantom, SeedsDiffer)
{
  auto o = small();
  const auto a = make(o);
  o.Seed = 2;
  const auto b = make(o);
  EXPECT_NE(image(a), image(b));
  EXPECT_GT((a.Shape.station(40).Center - b.Shape.station(40).Center).norm(), 0.1);
}

class FiberTruthOfSeeds : public testing::TestWithParam<int>
{
};

TEST_P(FiberTruthOfSeeds, LiesOnTheIsoValueOfACleanImage)
{
  auto o = clean(small());
  o.Seed = GetParam();
  o.Collapse = 0.3 * (GetParam() % 4);
  o.Dimensions = {128, 80, 80};
  const auto open = misfit(make(o), 3.0);
  EXPECT_LT(open.first, 0.12);
  EXPECT_LT(open.second, 0.002);
  o.OpenEnds = false;
  const auto closed = misfit(make(o), 0.0);
  EXPECT_LT(closed.first, 0.12);
  EXPECT_LT(closed.second, 0.002);
}
INSTANTIATE_TEST_SUITE_P(Some, FiberTruthOfSeeds, testing::Range(1, 5));

TEST(FiberPhantom, TruthLiesOnTheIsoValueForUnevenVoxels)
{
  auto o = clean(small());
  o.Dimensions = {64, 80, 40};
  o.Spacing = {0.8, 0.5, 1.0};
  o.Blur = 0.5;
  const auto m = misfit(make(o), 3.0);
  EXPECT_LT(m.first, 0.25); // trilinear interpolation of voxels two units long
}

TEST(FiberPhantom, RoughnessIsAsLargeAsAsked)
{
  auto o = clean(small());
  o.Dimensions = {128, 96, 96};
  o.Roughness = 0.6;
  o.Blur = 0.3;
  const auto m = misfit(make(o), 4.0);
  EXPECT_GT(m.first, 0.35);
  EXPECT_LT(m.first, 0.8);
}

TEST(FiberPhantom, OpenTubeHasOneVoidClosedTubeTwo)
{
  auto o = clean(small());
  const auto open = make(o);
  EXPECT_EQ(components(open, image(open), false), 1);
  EXPECT_EQ(components(open, image(open), true), 1);
  o.OpenEnds = false;
  const auto closed = make(o);
  EXPECT_EQ(components(closed, image(closed), false), 2);
  EXPECT_EQ(components(closed, image(closed), true), 1);
}

TEST(FiberPhantom, HolesOpenAClosedTubeAndDebrisAddsParts)
{
  auto o = clean(small());
  o.Dimensions = {128, 64, 64};
  o.OpenEnds = false;
  o.Holes = 8;
  const auto holes = make(o);
  EXPECT_EQ(components(holes, image(holes), false), 1);
  o.Debris = 40;
  const auto debris = make(o);
  EXPECT_GT(components(debris, image(debris), true), 1);
}

TEST(FiberPhantom, StaysInsideTheVolume)
{
  for (int seed = 1; seed <= 30; ++seed)
  {
    auto o = small();
    o.Seed = seed;
    o.Collapse = (seed % 5) * 0.25;
    const auto phantom = make(o);
    const auto truth = bsr::fiberTruth(phantom);
    double outside = 0;
    for (const Vec3& p : truth.Points)
    {
      for (int a = 0; a < 3; ++a)
      {
        outside = std::max({outside, -p[a], p[a] - (o.Dimensions[a] - 1)});
      }
    }
    EXPECT_EQ(outside, 0.0) << "seed " << seed << " collapse " << o.Collapse;
  }
}

TEST(FiberTruth, WallsAreManifoldAndKeepTheirDistance)
{
  for (const bool open : {true, false})
  {
    auto o = small();
    o.OpenEnds = open;
    const auto phantom = make(o);
    const auto truth = bsr::fiberTruth(phantom);
    ASSERT_EQ(truth.Points.size(), truth.Side.size());
    ASSERT_EQ(truth.Points.size(), truth.End.size());
    std::map<std::pair<bsr::Index, bsr::Index>, int> edges;
    for (const auto& q : truth.Quads)
    {
      for (int c = 0; c < 4; ++c)
      {
        if (q[c] != q[(c + 1) % 4])
        {
          ++edges[{q[c], q[(c + 1) % 4]}];
        }
      }
    }
    int border = 0;
    for (const auto& [edge, count] : edges)
    {
      EXPECT_EQ(count, 1);
      if (!edges.count({edge.second, edge.first}))
      {
        ++border;
        EXPECT_EQ(truth.End[edge.first], truth.End[edge.second]);
        EXPECT_GT(truth.End[edge.first], 0);
      }
    }
    EXPECT_EQ(border > 0, open);
    double thinnest = 1e9;
    for (std::size_t i = 0; i < truth.Points.size(); i += 3)
    {
      const auto at = phantom.Shape.at(truth.Points[i], 20.0);
      ASSERT_TRUE(at.Near);
      const double own = truth.Side[i] == 0 ? at.OuterDistance : at.InnerDistance;
      EXPECT_NEAR(own, 0.0, 0.02);
      const double other = truth.Side[i] == 0 ? at.InnerDistance : -at.OuterDistance;
      thinnest = std::min(thinnest, other);
    }
    EXPECT_GT(thinnest, 1.0);
  }
}

TEST(FiberPhantom, AbsurdOptionsAreNamed)
{
  const auto message = [](auto change)
  {
    FiberPhantomOptions o;
    change(o);
    const auto phantom = bsr::makeFiberPhantom(o);
    EXPECT_FALSE(phantom.isOk());
    EXPECT_EQ(phantom.status().code(), bsr::StatusCode::InvalidParameter);
    return phantom.status().message();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message([](auto& o) { o.Holes = -3; }), "Holes is -3; choose 0 to 10000.");
  EXPECT_EQ(message([](auto& o) { o.Blur = 7.5; }), "Blur is 7.5; choose 0 to 5 voxels.");
  EXPECT_NE(
    message([](auto& o) { o.Dimensions[1] = 3; }).find("Dimensions is 3"), std::string::npos);
  EXPECT_NE(message([&](auto& o) { o.Noise = nan; }).find("Noise"), std::string::npos);
  EXPECT_NE(message([&](auto& o) { o.Spacing[2] = nan; }).find("Spacing"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.Spacing = {1, 1, 0}; }).find("Spacing"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.Spacing = {1, 1, 30}; }).find("20 to 1"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.AirValue = o.WallValue; }).find("larger"), std::string::npos);
  EXPECT_NE(message(
              [](auto& o) {
                o.Dimensions = {24, 96, 96};
              })
              .find("times as long"),
    std::string::npos);
}

TEST(FiberPhantom, StopsWhenCancelled)
{
  class Impatient : public bsr::Monitor
  {
  public:
    bool cancelled() override { return ++this->Asked > 3; }
    int Asked = 0;
  };
  const auto phantom = make(small());
  Impatient monitor;
  const auto values = bsr::fiberImage(phantom, {0, 95, 0, 47, 0, 47}, monitor);
  EXPECT_EQ(values.status().code(), bsr::StatusCode::Cancelled);
  EXPECT_EQ(monitor.Asked, 4);
}

TEST(FiberPhantom, OutsideExtentIsAnError)
{
  const auto phantom = make(small());
  bsr::Monitor monitor;
  EXPECT_FALSE(bsr::fiberImage(phantom, {0, 96, 0, 47, 0, 47}, monitor).isOk());
  EXPECT_FALSE(bsr::fiberImage(phantom, {5, 4, 0, 47, 0, 47}, monitor).isOk());
}
