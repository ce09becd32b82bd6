#include "FitTesting.h"

#include "Spline/CoverageEnds.h"
#include "Spline/ModelCheck.h"

#include <gtest/gtest.h>

#include <utility>

using namespace bsr;
using namespace fits;

namespace
{
/// A thick tube along x of radii 1 and 0.7 with capped ends, the caps in regions 1 and 2.
QuadMesh cappedTube(int along)
{
  QuadMesh m = meshes::tube(8, along);
  m.Region.assign(m.Quads.size(), 0);
  for (int end = 0; end < 2; ++end)
  {
    const Index first = end ? 8 * along : 0;
    const double x = end ? 4.0 : 0.0;
    const Index inside = static_cast<Index>(m.Points.size());
    for (int i = 0; i < 8; ++i)
    {
      m.Points.emplace_back(x, 0.5 * std::cos(M_PI * i / 4), 0.5 * std::sin(M_PI * i / 4));
    }
    m.Points.emplace_back(x, 0, 0);
    const auto add = [&](std::array<Index, 4> q)
    {
      if (end == 0)
      {
        std::swap(q[1], q[3]);
      }
      m.Quads.push_back(q);
      m.Region.push_back(end + 1);
    };
    for (int i = 0; i < 8; ++i)
    {
      add({first + i, first + (i + 1) % 8, inside + (i + 1) % 8, inside + i});
    }
    for (int i = 0; i < 8; i += 2)
    {
      add({inside + i, inside + (i + 1) % 8, inside + (i + 2) % 8, inside + 8});
    }
  }
  return m;
}

Vec3 toTube(const Vec3& p, double radius)
{
  const double r = std::hypot(p[1], p[2]);
  return {p[0], radius * p[1] / r, radius * p[2] / r};
}

/// Root mean square distance of the outer border's points near x = 4 from a curve, a polyline.
double borderOff(const SplineModel& model, const std::vector<Vec3>& curve)
{
  double squares = 0.0;
  int count = 0;
  for (const SplinePatch& patch : model.Patches)
  {
    // A wall's first row of control points is the outer border's.
    for (int k = 0; patch.Side == Shell::Wall && k < 10; ++k)
    {
      const Vec3 p = evaluatePatch(model, patch, (k + 0.5) / 10.0, 0.0).Point;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < curve.size() && p[0] > 2.0; ++i)
      {
        const Vec3& a = curve[i];
        const Vec3 d = curve[(i + 1) % curve.size()] - a;
        const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (a + t * d - p).squaredNorm());
      }
      squares += p[0] > 2.0 ? least : 0.0;
      count += p[0] > 2.0;
    }
  }
  return std::sqrt(squares / count);
}
} // namespace

TEST(G1FitWalls, HollowTubeWithOpenEnds)
{
  const QuadMesh m = cappedTube(8);
  const auto outer = [](const Vec3& x) { return toTube(x, 1.0); };
  const auto inner = [](const Vec3& x) { return toTube(x, 0.7); };
  PartitionedPoints p = sample(m, 10, outer, 0.0, 0);
  append(p, sample(m, 10, inner, 0.0, 1));
  for (std::size_t i = 0; i < p.Points.size(); ++i)
  {
    p.Side[i] = m.Region[p.QuadId[i]] > 0 ? 255 : p.Side[i];
  }
  const G1FitResult r = fitted(p, m, {});
  EXPECT_EQ(r.OpenEndCount, 2);
  ASSERT_TRUE(checkModel(r.Model));
  EXPECT_EQ(r.Model.Patches.size(), 64u + 64u + 16u);
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_LE(r.MaxNormalJump, 1e-8);
  EXPECT_LE(deviation(r.Model, outer, Shell::Outer).second, 0.01);
  EXPECT_LE(deviation(r.Model, inner, Shell::Inner).second, 0.01);
  // The walls lie in the end planes, and every normal points out of the solid.
  for (const SplinePatch& patch : r.Model.Patches)
  {
    const SurfacePoint s = evaluatePatch(r.Model, patch, 0.5, 0.5);
    const Vec3 radial(0, s.Point[1], s.Point[2]);
    if (patch.Side == Shell::Wall)
    {
      EXPECT_NEAR(std::abs(s.Point[0] - 2.0), 2.0, 0.03);
      EXPECT_GT(s.normal()[0] * (s.Point[0] - 2.0), 0.0);
    }
    else
    {
      EXPECT_GT(s.normal().dot(radial) * (patch.Side == Shell::Outer ? 1 : -1), 0.0);
    }
  }
  for (const auto& n : r.Model.Neighbors)
  {
    EXPECT_TRUE(n[0] >= 0 && n[1] >= 0 && n[2] >= 0 && n[3] >= 0);
  }
  G1FitOptions closed;
  closed.Ends = OpenEnds::KeepClosed;
  EXPECT_EQ(fitted(p, m, closed).OpenEndCount, 0);
}

TEST(G1FitWalls, BordersFollowRimsThatTheLayoutCutsShort)
{
  // The rim at x = 4 waves three times around; eight straight sides cannot follow it.
  const auto reach = [](double turn) { return 4.0 + 0.12 * std::sin(3.0 * turn); };
  QuadMesh m = cappedTube(8);
  for (Vec3& p : m.Points)
  {
    p[0] += p[0] > 3.99 ? reach(std::atan2(p[2], p[1])) - 4.0 : 0.0;
  }
  const auto outer = [](const Vec3& x) { return toTube(x, 1.0); };
  PartitionedPoints p = sample(m, 10, outer, 0.0, 0);
  append(p, sample(
              m, 10, [](const Vec3& x) { return toTube(x, 0.7); }, 0.0, 1));
  for (std::size_t i = 0; i < p.Points.size(); ++i)
  {
    p.Side[i] = m.Region[p.QuadId[i]] > 0 ? 255 : p.Side[i];
  }
  std::vector<Vec3> rim;
  for (int i = 0; i < 200; ++i)
  {
    const double turn = -0.01 * M_PI * i; // either way around
    rim.emplace_back(reach(turn), std::cos(turn), std::sin(turn));
  }
  const double without = borderOff(fitted(p, m, {}).Model, rim);
  p.Rims = {{}, {Vec3(9, 9, 9), Vec3(9, 9, 8), Vec3(9, 8, 8)}, rim}; // the others are no rims here
  const G1FitResult r = fitted(p, m, {});
  const double with = borderOff(r.Model, rim);
  EXPECT_LE(with, 0.015);
  EXPECT_GE(without, 3.0 * with);
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_LE(r.MaxNormalJump, 1e-8);
}

TEST(G1FitWalls, EndsThatNobodyMarkedAreFoundByCoverage)
{
  QuadMesh m = cappedTube(8);
  const std::vector<Index> caps = std::exchange(m.Region, {});
  const auto outer = [](const Vec3& x) { return toTube(x, 1.0); };
  const auto inner = [](const Vec3& x) { return toTube(x, 0.7); };
  PartitionedPoints p = sample(m, 10, outer, 0.0, 0);
  append(p, sample(m, 10, inner, 0.0, 1));
  // Holes in the wall: single quads and two neighbors without points are no ends.
  const auto hole = [](Index q) { return q == 27 || q == 28 || q == 45; };
  PartitionedPoints open = p;
  for (std::size_t i = 0; i < p.Points.size(); ++i)
  {
    const Index q = p.QuadId[i];
    open.Side[i] = caps[q] > 0 || hole(q) ? 255 : p.Side[i];
    p.Side[i] = hole(q) || (p.Side[i] == 1 && caps[q] > 0) ? 255 : p.Side[i];
  }
  const G1FitResult r = fitted(open, m, {});
  EXPECT_EQ(r.OpenEndCount, 2);
  EXPECT_EQ(r.Shells.size(), 2u);
  EXPECT_EQ(r.Model.Patches.size(), 64u + 64u + 16u);
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_TRUE(checkModel(r.Model));
  EXPECT_LE(deviation(r.Model, outer, Shell::Outer).second, 0.03);
  // Caps that have outer points are closed ends; so is an end that a layout marks as none.
  EXPECT_EQ(markOpenEnds(p, m).Region.size(), 0u);
  m.Region.assign(m.Quads.size(), 0);
  G1FitOptions o;
  o.DataWeight = 100;
  EXPECT_EQ(fitted(open, m, o).OpenEndCount, 0);
}

TEST(G1FitWalls, RimsOfFoundEndsFollowThePoints)
{
  // The wall ends a third of a quad before the quads do.
  QuadMesh m = cappedTube(8);
  const std::vector<Index> caps = std::exchange(m.Region, {});
  const auto outer = [](const Vec3& x) { return toTube(x, 1.0); };
  PartitionedPoints p = sample(m, 12, outer, 0.0, 0);
  for (std::size_t i = 0; i < p.Points.size(); ++i)
  {
    p.Side[i] = caps[p.QuadId[i]] > 0 || p.Points[i][0] > 3.83 ? 255 : 0;
  }
  const QuadMesh marked = markOpenEnds(p, m);
  ASSERT_EQ(marked.Region.size(), m.Quads.size());
  double low = 4.0;
  for (std::size_t v = 0; v < m.Points.size(); ++v)
  {
    const Vec3& x = marked.Points[v];
    if (std::abs(m.Points[v][0] - 4.0) < 1e-9 && std::hypot(x[1], x[2]) > 0.9)
    {
      low = std::min(low, x[0]);
      EXPECT_NEAR(x[0], 3.8, 0.06);
    }
  }
  EXPECT_LT(low, 3.9);
}

TEST(G1FitWalls, ShellsThatWouldCrossAreKeptApart)
{
  const QuadMesh m = cappedTube(8);
  PartitionedPoints p = sample(
    m, 10, [](const Vec3& x) { return toTube(x, 1.0); }, 0.0, 0);
  // A bump of the lumen's points leaves the tube over about a tenth of its wall.
  const auto bumped = [](const Vec3& x)
  { return toTube(x, 0.7 + (x[1] > 0.3 && std::abs(x[0] - 2.0) < 0.8 ? 0.5 : 0.0)); };
  append(p, sample(m, 10, bumped, 0.0, 1));
  const G1FitResult r = fitted(p, m, {});
  ASSERT_EQ(r.Shells.size(), 2u) << r.Message;
  EXPECT_GT(r.MinimumWall, 0.0);
  EXPECT_EQ(r.FoldedPatches, 0);
  for (const SplinePatch& patch : r.Model.Patches)
  {
    for (int k = 0; k < 49 && patch.Side == Shell::Inner; ++k)
    {
      const Vec3 x = evaluatePatch(r.Model, patch, k % 7 / 6.0, k / 7 / 6.0).Point;
      EXPECT_LT(std::hypot(x[1], x[2]), 1.0);
    }
  }
}

TEST(G1FitWalls, TheLumenLeavesNarrowEdges)
{
  // A lens of thickness 0.4 whose edge is sharper than its wall is thick.
  QuadMesh m = meshes::sphere(2);
  const auto onto = [](const Vec3& x, double size)
  {
    const Vec3 r = Vec3(x[0], x[1], x[2] / 0.2).normalized();
    return Vec3(size * r[0], size * r[1], 0.2 * size * r[2]);
  };
  for (Vec3& x : m.Points)
  {
    x = Vec3(x[0], x[1], 0.2 * x[2]);
  }
  PartitionedPoints p = sample(
    m, 8, [&](const Vec3& x) { return onto(x, 1.0); }, 0.0, 0);
  // The lumen's points leave the lens at a third of its edge.
  const auto inside = [&](const Vec3& x)
  { return onto(x, x[0] > 0.3 && std::hypot(x[0], x[1]) > 0.8 ? 1.06 : 0.5); };
  append(p, sample(m, 8, inside, 0.0, 1));
  const G1FitResult r = fitted(p, m, {});
  ASSERT_EQ(r.Shells.size(), 2u) << r.Message;
  EXPECT_GT(r.MinimumWall, 0.0);
  EXPECT_EQ(r.FoldedPatches, 0);
}

TEST(G1FitWalls, InnerPointsOutsideAreNoLumen)
{
  const QuadMesh m = cappedTube(8);
  PartitionedPoints p = sample(
    m, 10, [](const Vec3& x) { return toTube(x, 1.0); }, 0.0, 0);
  append(p, sample(
              m, 10, [](const Vec3& x) { return toTube(x, 1.3); }, 0.0, 1));
  const G1FitResult r = fitted(p, m, {});
  EXPECT_TRUE(r.Shells.size() == 1u || r.MinimumWall > 0.0);
  EXPECT_EQ(r.FoldedPatches, 0);
}

TEST(G1FitWalls, ScatteredInnerPointsGiveNoInnerShell)
{
  const QuadMesh m = meshes::sphere(2);
  PartitionedPoints p = sample(m, 10, toSphere, 0.0, 0);
  PartitionedPoints inner = sample(
    m, 10, [](const Vec3& x) { return Vec3(0.7 * x.normalized()); }, 0.0, 1);
  for (Index& q : inner.QuadId)
  {
    q = q % 4 == 0 ? q : -1;
  }
  append(p, inner);
  const G1FitResult r = fitted(p, m, {});
  EXPECT_EQ(r.Shells.size(), 1u);
  EXPECT_NE(r.Message.find("cover only"), std::string::npos) << r.Message;
}
