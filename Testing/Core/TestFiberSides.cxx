#include "ImageTestHelpers.h"

#include "Image/FiberSides.h"
#include "Image/Lumen.h"
#include "Image/SmoothWall.h"
#include "Image/SurfaceVoxels.h"

#include <gtest/gtest.h>

#include <limits>

using namespace bsr;

namespace
{
/// A tube along x: outer radius 12, inner 8, from x = 10 to 70, with a hole through the wall
/// and, where `closed`, bottoms.
struct Tube
{
  Int3 Dims{80, 40, 40};
  Double3 Spacing{1.0, 1.0, 1.0};
  bool Closed = false;
  double HoleRadius = 3.0;

  double r(const Int3& p) const
  {
    const double y = (static_cast<double>(p[1]) - 19.5) * this->Spacing[1];
    const double z = (static_cast<double>(p[2]) - 19.5) * this->Spacing[2];
    return std::hypot(y, z);
  }
  bool filled(const Int3& p) const { return this->r(p) <= 12.0 && p[0] >= 10 && p[0] <= 70; }
  bool wall(const Int3& p) const
  {
    const double x = static_cast<double>(p[0]) - 40.0;
    const double z = (static_cast<double>(p[2]) - 19.5) * this->Spacing[2];
    const bool hole = p[1] > this->Dims[1] / 2 && std::hypot(x, z) <= this->HoleRadius;
    const bool lumen = this->r(p) < 8.0 && !(this->Closed && (p[0] < 16 || p[0] > 64));
    return this->filled(p) && !lumen && !hole;
  }
};

Volume<std::uint8_t> maskOf(const Tube& tube)
{
  return bsrtest::makeVolume<std::uint8_t>(
    tube.Dims, tube.Spacing, [&](const Int3& p) { return tube.wall(p) ? 1 : 0; });
}

Result<LumenResult> lumenOf(const Tube& tube, const LumenOptions& options = {})
{
  const auto near = bsrtest::makeVolume<std::uint8_t>(tube.Dims, tube.Spacing,
    [&](const Int3& p)
    {
      const bool within = tube.r(p) <= 10.0 && p[0] >= 12 && p[0] <= 68;
      const bool close = tube.r(p) <= 15.0 && p[0] >= 7 && p[0] <= 73;
      return within ? WithinObject : static_cast<std::uint8_t>(close);
    });
  Monitor monitor;
  return findLumen(maskOf(tube), near, options, monitor);
}

/// An axis-parallel box of triangles, facing outwards.
TriangleMesh boxMesh(const Vec3& lo, const Vec3& hi)
{
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c)
  {
    mesh.Points.emplace_back(
      c & 1 ? hi.x() : lo.x(), c & 2 ? hi.y() : lo.y(), c & 4 ? hi.z() : lo.z());
  }
  const int quads[6][4] = {
    {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads)
  {
    mesh.Triangles.push_back({q[0], q[1], q[2]});
    mesh.Triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}
} // namespace

TEST(SurfaceVoxels, FillsABoxOfEitherOrientation)
{
  const Box extent{{-2, 0, 0}, {12, 8, 8}};
  for (const bool turned : {false, true})
  {
    TriangleMesh mesh = boxMesh({0.5, 1.5, 2.5}, {6.5, 5.5, 4.5});
    for (auto& t : mesh.Triangles)
    {
      if (turned)
      {
        std::swap(t[1], t[2]);
      }
    }
    Monitor monitor;
    const auto mask = voxelizeSurface(mesh, extent, {1.0, 1.0, 1.0}, monitor);
    ASSERT_TRUE(mask);
    std::int64_t n = 0;
    bsrtest::forEachVoxel(extent.Size,
      [&](const Int3& p)
      {
        const Int3 q{p[0] + extent.Lo[0], p[1], p[2]};
        const bool inside =
          q[0] >= 1 && q[0] <= 6 && q[1] >= 2 && q[1] <= 5 && q[2] >= 3 && q[2] <= 4;
        EXPECT_EQ(mask->view()(p[0], p[1], p[2]) != 0, inside);
        n += inside;
      });
    EXPECT_EQ(n, 48);
  }
}

TEST(SurfaceVoxels, RefusesAnEmptySurface)
{
  Monitor monitor;
  EXPECT_FALSE(voxelizeSurface({}, {{0, 0, 0}, {4, 4, 4}}, {1.0, 1.0, 1.0}, monitor));
}

TEST(Lumen, TellsTheLumenFromTheOutsideAndFindsBothEnds)
{
  const Tube tube;
  const auto lumen = lumenOf(tube);
  ASSERT_TRUE(lumen) << lumen.status().message();
  ASSERT_TRUE(lumen->Found);
  EXPECT_NEAR(lumen->LumenRadius, 8.0, 1.0);
  ASSERT_EQ(lumen->Mouths.size(), 2u); // the hole is none
  double sum = 0.0;
  for (const LumenMouth& m : lumen->Mouths)
  {
    EXPECT_NEAR(m.Radius, 8.0, 1.5);
    EXPECT_GT(std::abs(m.Direction.x()), 0.95);
    EXPECT_LT(std::min(std::abs(m.Center.x() - 10.0), std::abs(m.Center.x() - 70.0)), 5.0);
    EXPECT_GT((m.Center.x() - 40.0) * m.Direction.x(), 0.0);
    sum += m.Direction.x();
  }
  EXPECT_NEAR(sum, 0.0, 0.1);
  std::int64_t wrong = 0;
  bsrtest::forEachVoxel(tube.Dims,
    [&](const Int3& p)
    {
      const auto label = static_cast<VoidLabel>(lumen->Label.view()(p[0], p[1], p[2]));
      if (tube.r(p) < 7.0 && p[0] > 15 && p[0] < 65)
      {
        wrong += label != VoidLabel::Lumen;
      }
      if (tube.r(p) > 13.0)
      {
        wrong += label == VoidLabel::Lumen;
      }
    });
  EXPECT_EQ(wrong, 0);
}

TEST(Lumen, AWideHoleIsNoPartOfIt)
{
  Tube tube;
  tube.HoleRadius = 5.0; // wider than every pore that is sealed at once
  LumenOptions options;
  options.PoreRadius = 6.0;
  const auto result = lumenOf(tube, options);
  ASSERT_TRUE(result) << result.status().message();
  ASSERT_TRUE(result->Found);
  const auto label = result->Label.view();
  int hole = 0;
  for (std::int64_t k = 0; k < 40; ++k)
  {
    for (std::int64_t i = 20; i < 60; ++i)
    {
      for (std::int64_t j = 0; j < 40; ++j)
      {
        const Int3 p{i, j, k};
        const auto l = static_cast<VoidLabel>(label(i, j, k));
        hole += l == VoidLabel::Hole;
        EXPECT_FALSE(l == VoidLabel::Lumen && tube.r(p) > 10.0) << i << " " << j << " " << k;
        EXPECT_FALSE(l == VoidLabel::Hole && tube.r(p) < 6.0) << i << " " << j << " " << k;
      }
    }
  }
  EXPECT_GT(hole, 30);
}

TEST(Lumen, ClosedEndsAreNoMouths)
{
  Tube tube;
  tube.Closed = true;
  const auto lumen = lumenOf(tube);
  ASSERT_TRUE(lumen);
  EXPECT_TRUE(lumen->Found);
  EXPECT_TRUE(lumen->Mouths.empty());
}

TEST(Lumen, AHoleAsWideAsTheLumenIsNoEnd)
{
  Tube tube;
  tube.HoleRadius = 6.5;
  const auto lumen = lumenOf(tube);
  ASSERT_TRUE(lumen);
  EXPECT_TRUE(lumen->Found);
  ASSERT_EQ(lumen->Mouths.size(), 2u);
  for (const LumenMouth& m : lumen->Mouths)
  {
    EXPECT_GT(std::abs(m.Direction.x()), 0.9);
  }
}

TEST(Lumen, ASolidObjectHasNone)
{
  const Int3 dims{40, 40, 40};
  const auto ball = bsrtest::makeVolume<std::uint8_t>(dims, {1.0, 1.0, 1.0},
    [](const Int3& p) { return std::hypot(p[0] - 20.0, p[1] - 20.0, p[2] - 20.0) < 14.0 ? 1 : 0; });
  Monitor monitor;
  const auto lumen = findLumen(ball, ball, {}, monitor);
  ASSERT_TRUE(lumen);
  EXPECT_FALSE(lumen->Found);
}

TEST(Lumen, HonorsAnisotropicSpacing)
{
  Tube tube;
  tube.Spacing = {1.0, 1.0, 2.0};
  tube.Dims = {80, 40, 40};
  const auto lumen = lumenOf(tube);
  ASSERT_TRUE(lumen);
  EXPECT_TRUE(lumen->Found);
  EXPECT_NEAR(lumen->LumenRadius, 8.0, 1.5);
  EXPECT_EQ(lumen->Mouths.size(), 2u);
}

TEST(Lumen, CanBeCancelled)
{
  const Tube tube;
  bsrtest::CancelAfter monitor(3);
  const auto lumen = findLumen(maskOf(tube), maskOf(tube), {}, monitor);
  ASSERT_FALSE(lumen);
  EXPECT_EQ(lumen.status().code(), StatusCode::Cancelled);
}

TEST(SmoothWall, MeasuresAPlaneAndABallInVoxels)
{
  const Int3 dims{48, 48, 48};
  const Double3 spacing{1.0, 1.0, 1.0};
  Monitor monitor;
  const auto plane = bsrtest::makeVolume<std::uint8_t>(
    dims, spacing, [](const Int3& p) { return p[0] >= 24 ? 1 : 0; });
  const auto d = smoothWallDistance(
    plane, nullptr, {{20.5, 24, 24}, {23.5, 24, 24}, {25.0, 24, 24}}, 3.0, monitor);
  ASSERT_TRUE(d);
  EXPECT_NEAR((*d)[0], -3.0, 0.1);
  EXPECT_NEAR((*d)[1], 0.0, 0.05);
  EXPECT_NEAR((*d)[2], 1.5, 0.1);
  const auto ball = bsrtest::makeVolume<std::uint8_t>(dims, spacing,
    [](const Int3& p) { return std::hypot(p[0] - 24.0, p[1] - 24.0, p[2] - 24.0) < 12.0 ? 1 : 0; });
  const auto b = smoothWallDistance(ball, nullptr, {{36, 24, 24}, {24, 13.5, 24}}, 3.0, monitor);
  ASSERT_TRUE(b);
  EXPECT_NEAR((*b)[0], 0.0, 0.25);
  EXPECT_NEAR((*b)[1], 1.5, 0.35);
}

TEST(DepthValley, LiesBetweenTwoClassesOrFallsBack)
{
  std::vector<float> depth;
  for (int i = 0; i < 1000; ++i)
  {
    depth.push_back(0.001f * static_cast<float>(i));
    depth.push_back(7.0f + 0.002f * static_cast<float>(i));
  }
  const double valley = depthValley(depth, 2.0);
  EXPECT_GT(valley, 1.0);
  EXPECT_LT(valley, 7.0);
  depth.assign(500, 0.1f);
  EXPECT_DOUBLE_EQ(depthValley(depth, 2.0), 2.0);
}

TEST(FiberSides, RefusesWhatItCannotUse)
{
  Monitor monitor;
  const TriangleMesh box = boxMesh({1.5, 1.5, 1.5}, {5.5, 5.5, 5.5});
  auto mask =
    bsrtest::makeVolume<std::uint8_t>({8, 8, 8}, {1.0, 1.0, 1.0}, [](const Int3&) { return 0; });
  auto distance =
    bsrtest::makeVolume<float>({8, 8, 8}, {1.0, 1.0, 1.0}, [](const Int3&) { return 1.0f; });
  const ClosedObject object{mask.view(), distance.view()};
  EXPECT_FALSE(classifySides({}, object, {}, monitor));
  EXPECT_FALSE(classifySides(box, {}, {}, monitor));
  EXPECT_FALSE(classifySides(box, object, {}, monitor)); // nothing closed
  FiberSidesOptions negative;
  negative.PoreRadius = -1.0;
  EXPECT_EQ(
    classifySides(box, object, negative, monitor).status().code(), StatusCode::InvalidParameter);
  distance.Data[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(classifySides(box, object, {}, monitor));
}
