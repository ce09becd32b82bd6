#include "FitTesting.h"

#include "Spline/CoverageEnds.h"
#include "Spline/ModelCheck.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <utility>

using namespace bsr;
using namespace fits;

namespace
{
std::string failure(const PartitionedPoints& p, const QuadMesh& m, const G1FitOptions& o = {})
{
  Monitor monitor;
  const auto r = fitG1(p, m, o, monitor);
  EXPECT_FALSE(r);
  return r.status().message();
}

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
} // namespace

TEST(G1Fit, SphereIsAsCloseAsTheSpecificationSays)
{
  const QuadMesh m = meshes::sphere(1);
  const PartitionedPoints p = sample(m, 12, toSphere);
  G1FitOptions o;
  o.DataWeight = 1e6;
  const G1FitResult r = fitted(p, m, o);
  const auto [rms, worst] = deviation(r.Model, toSphere, Shell::Outer);
  EXPECT_LE(rms, 1e-4);
  EXPECT_LE(worst, 5e-4);
  EXPECT_LE(r.MaxNormalJump, 1e-8);
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_EQ(r.Unknowns, 816);
  EXPECT_EQ(r.Model.Patches.size(), 24u);
  EXPECT_TRUE(checkModel(r.Model));
  EXPECT_NE(r.Message.find("outer shell"), std::string::npos);
}

TEST(G1Fit, BalanceFollowsTheNoise)
{
  const QuadMesh m = meshes::sphere(2);
  const G1FitResult clean = fitted(sample(m, 12, toSphere), m, {});
  const G1FitResult noisy = fitted(sample(m, 12, toSphere, 0.01), m, {});
  EXPECT_GE(clean.Shells[0].DataWeight, 1e3);
  EXPECT_LE(noisy.Shells[0].DataWeight, 300);
  EXPECT_LE(deviation(clean.Model, toSphere, Shell::Outer).first, 2e-4);
  EXPECT_LE(deviation(noisy.Model, toSphere, Shell::Outer).first, 2.5e-3);
}

/// Roughness of a wavelength: a sum of plane waves in directions of their own.
double roughness(const Vec3& p, double wavelength)
{
  constexpr int Waves = 40;
  double sum = 0.0;
  for (int i = 0; i < Waves; ++i)
  {
    const double z = (2.0 * i + 1.0) / Waves - 1.0;
    const double phi = 2.39996 * i; // the golden angle
    const Vec3 k(std::sqrt(1.0 - z * z) * std::cos(phi), std::sqrt(1.0 - z * z) * std::sin(phi), z);
    sum += std::cos(2.0 * M_PI / wavelength * k.dot(p) + 1.7 * i * i);
  }
  return sum * std::sqrt(2.0 / Waves);
}

TEST(G1Fit, MorePatchesFollowNoMoreRoughness)
{
  // Of all lengths down to the spacing of the points, as that of CT surfaces: what were long only
  // could as well be shape.
  const auto rough = [](const Vec3& p)
  {
    const Vec3 on = toSphere(p);
    double sum = 0.0;
    for (const double wavelength : {0.2, 0.14, 0.1, 0.07, 0.05})
    {
      sum += 0.004 * roughness(on, wavelength);
    }
    return Vec3((1.0 + sum) * on);
  };
  double rms[2] = {0.0, 0.0};
  double weight[2] = {0.0, 0.0};
  double patches[2] = {0.0, 0.0};
  for (int i = 0; i < 2; ++i)
  {
    const QuadMesh m = meshes::sphere(2 + i);
    const G1FitResult r = fitted(sample(m, i == 0 ? 16 : 8, rough, 0.001), m, {});
    rms[i] = deviation(r.Model, toSphere, Shell::Outer).first;
    weight[i] = r.Shells[0].DataWeight;
    patches[i] = static_cast<double>(m.Quads.size());
    std::printf("  %g patches: rms %.4f, K %.3g\n", patches[i], rms[i], weight[i]);
  }
  EXPECT_LE(rms[0], 0.004); // of 0.009
  EXPECT_LE(rms[1], 1.2 * rms[0]);
  // K n^2 is the same: fairing of the same length.
  const double ratio = weight[0] / weight[1] / std::pow(patches[1] / patches[0], 2.0);
  EXPECT_GE(ratio, 0.4);
  EXPECT_LE(ratio, 2.5);
}

TEST(G1Fit, FullSpaceIsFiveTimesCloserThanTheVertexSpace)
{
  const QuadMesh m = meshes::torus(12, 8);
  const auto toTorus = [](const Vec3& p)
  {
    const Vec3 c = 3.0 * Vec3(p[0], p[1], 0).normalized();
    return Vec3(c + (p - c).normalized());
  };
  const PartitionedPoints p = sample(m, 12, toTorus);
  const auto rms = [&](Continuity c)
  {
    G1FitOptions o;
    o.Smoothness = c;
    const G1FitResult r = fitted(p, m, o);
    const double d = deviation(r.Model, toTorus, Shell::Outer).first;
    std::printf("  continuity %d: unknowns %d, rms %.3g, jump %.3g deg, K %g\n",
      static_cast<int>(c), static_cast<int>(r.Unknowns), d, r.MaxNormalJump,
      r.Shells[0].DataWeight);
    if (c == Continuity::FullG1 || c == Continuity::VertexG1)
    {
      EXPECT_LE(r.MaxNormalJump, 1e-8);
    }
    return d;
  };
  const double full = rms(Continuity::FullG1);
  EXPECT_LE(5.0 * full, rms(Continuity::VertexG1));
  EXPECT_LE(rms(Continuity::C0Reduction), 1e-3);
}

TEST(G1Fit, MultipliersAndReductionAgree)
{
  const QuadMesh m = meshes::sphere(1);
  const PartitionedPoints p = sample(m, 8, toSphere);
  G1FitOptions o;
  o.DataWeight = 1e3;
  o.Smoothness = Continuity::C0Reduction;
  const G1FitResult a = fitted(p, m, o);
  o.Smoothness = Continuity::C0Multipliers;
  const G1FitResult b = fitted(p, m, o);
  EXPECT_GT(b.Unknowns, a.Unknowns);
  ASSERT_EQ(a.Model.ControlPoints.size(), b.Model.ControlPoints.size());
  for (std::size_t i = 0; i < a.Model.ControlPoints.size(); ++i)
  {
    EXPECT_LE((a.Model.ControlPoints[i] - b.Model.ControlPoints[i]).norm(), 1e-7);
  }
}

TEST(G1Fit, ScaleDoesNotMatter)
{
  const QuadMesh m = meshes::sphere(1);
  PartitionedPoints p = sample(m, 8, toSphere, 0.01);
  const G1FitResult a = fitted(p, m, {});
  QuadMesh large = m;
  for (auto* list : {&large.Points, &p.Points})
  {
    for (Vec3& x : *list)
    {
      x *= 1024.0;
    }
  }
  const G1FitResult b = fitted(p, large, {});
  EXPECT_EQ(a.Shells[0].DataWeight, b.Shells[0].DataWeight);
  for (std::size_t i = 0; i < a.Model.ControlPoints.size(); ++i)
  {
    EXPECT_LE(
      (1024.0 * a.Model.ControlPoints[i] - b.Model.ControlPoints[i]).head<3>().norm(), 1e-7);
  }
}

TEST(G1Fit, RobustWeightsDropDebris)
{
  const QuadMesh m = meshes::sphere(2);
  PartitionedPoints p = sample(m, 12, toSphere, 0.002);
  std::mt19937 random(11);
  for (std::size_t i = 0; i < p.Points.size(); ++i)
  {
    // A tenth of all points, in lumps, far outside.
    if ((i / 20) % 10 == 0)
    {
      p.Points[i] *= 1.05 + 0.1 * (random() / 4.3e9);
    }
  }
  G1FitOptions o;
  const double with = deviation(fitted(p, m, o).Model, toSphere, Shell::Outer).first;
  o.Robust = false;
  const double without = deviation(fitted(p, m, o).Model, toSphere, Shell::Outer).first;
  EXPECT_LE(with, 0.002);
  EXPECT_GE(without, 3.0 * with);
}

TEST(G1Fit, NormalsTellTheWallsOfHoles)
{
  // All points of a few quads lie on the side walls of deep holes: only their normals tell.
  const QuadMesh m = meshes::sphere(2);
  PartitionedPoints p = sample(m, 12, toSphere, 0.002);
  std::mt19937 random(7);
  for (std::size_t i = 0; i < p.Points.size(); ++i)
  {
    const Vec3 out = p.Points[i].normalized();
    p.Normals.push_back(out);
    if (p.QuadId[i] % 16 == 0)
    {
      p.Points[i] *= 1.0 - 0.15 * (random() / 4294967296.0);
      p.Normals.back() = out.unitOrthogonal();
    }
  }
  const double with = deviation(fitted(p, m, {}).Model, toSphere, Shell::Outer).first;
  p.Normals.clear();
  const double without = deviation(fitted(p, m, {}).Model, toSphere, Shell::Outer).first;
  EXPECT_LE(with, 0.004);
  EXPECT_GE(without, 2.0 * with);
}

TEST(G1Fit, HollowTubeWithOpenEnds)
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

namespace
{
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

TEST(G1Fit, BordersFollowRimsThatTheLayoutCutsShort)
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

TEST(G1Fit, EndsThatNobodyMarkedAreFoundByCoverage)
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

TEST(G1Fit, RimsOfFoundEndsFollowThePoints)
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

TEST(G1Fit, ShellsThatWouldCrossAreKeptApart)
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

TEST(G1Fit, TheLumenLeavesNarrowEdges)
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

TEST(G1Fit, InnerPointsOutsideAreNoLumen)
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

TEST(G1Fit, ScatteredInnerPointsGiveNoInnerShell)
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

TEST(G1Fit, WildPointsFoldNoPatch)
{
  // Parameters that contradict the positions: without repair these fold.
  const QuadMesh m = meshes::sphere(2);
  PartitionedPoints p = sample(m, 8, toSphere, 0.002);
  std::mt19937 random(5);
  for (std::size_t i = 0; i < p.Points.size(); ++i)
  {
    if (p.QuadId[i] % 9 == 0)
    {
      p.UV[i] = Vec2(random() / 4294967296.0, random() / 4294967296.0);
      p.Points[i] *= 1.0 + 0.3 * (random() / 4294967296.0);
    }
  }
  G1FitOptions o;
  o.DataWeight = 1e5;
  o.Robust = false;
  const G1FitResult r = fitted(p, m, o);
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_LE(r.MaxNormalJump, 1e-6);
}

TEST(G1Fit, InwardLayoutsAreTurned)
{
  QuadMesh m = meshes::sphere(1);
  for (auto& q : m.Quads)
  {
    std::swap(q[1], q[3]);
  }
  G1FitOptions o;
  o.DataWeight = 1e4;
  const G1FitResult r = fitted(sample(m, 8, toSphere), m, o);
  for (const SplinePatch& p : r.Model.Patches)
  {
    const SurfacePoint s = evaluatePatch(r.Model, p, 0.5, 0.5);
    EXPECT_GT(s.normal().dot(s.Point), 0.0);
  }
  EXPECT_LE(deviation(r.Model, toSphere, Shell::Outer).first, 1e-3);
}

TEST(G1Fit, EmptyPatchesAreCarriedAndDoNotFold)
{
  const QuadMesh m = meshes::sphere(2);
  PartitionedPoints p = sample(m, 10, toSphere, 0.003);
  for (Index& q : p.QuadId)
  {
    q = q % 12 == 0 ? -1 : q;
  }
  const G1FitResult r = fitted(p, m, {});
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_LE(deviation(r.Model, toSphere, Shell::Outer).second, 0.03);
}

TEST(G1Fit, ThreadsDoNotChangeABit)
{
  const QuadMesh m = meshes::sphere(2);
  const PartitionedPoints p = sample(m, 10, toSphere, 0.01);
  std::vector<Vec4> first;
  for (const int threads : {1, 2})
  {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const G1FitResult r = fitted(p, m, {});
    if (first.empty())
    {
      first = r.Model.ControlPoints;
    }
    EXPECT_TRUE(first == r.Model.ControlPoints);
  }
}

TEST(G1Fit, BadInputIsOneClearError)
{
  const QuadMesh m = meshes::sphere(1);
  const PartitionedPoints good = sample(m, 6, toSphere);
  EXPECT_NE(failure({}, m).find("no points"), std::string::npos);
  PartitionedPoints p = good;
  p.QuadId[5] = 24;
  EXPECT_NE(failure(p, m).find("QuadId 24"), std::string::npos);
  p = good;
  p.UV.pop_back();
  EXPECT_NE(failure(p, m).find("PartitionToQuads"), std::string::npos);
  p = good;
  p.Normals.assign(3, Vec3::UnitX());
  EXPECT_NE(failure(p, m).find("Normals"), std::string::npos);
  p = good;
  p.Points[0][1] = std::nan("");
  EXPECT_NE(failure(p, m).find("NaN"), std::string::npos);
  p = good;
  p.Weights.assign(p.Points.size(), 1.0);
  p.Weights[3] = -1.0;
  EXPECT_NE(failure(p, m).find("weight"), std::string::npos);
  p = sample(m, 1, toSphere);
  EXPECT_NE(failure(p, m).find("points for 24 quads"), std::string::npos);
  QuadMesh torn = m;
  torn.Quads.push_back(torn.Quads[0]);
  EXPECT_NE(failure(good, torn).find("manifold"), std::string::npos);
  G1FitOptions o;
  o.Segments = 2;
  EXPECT_NE(failure(good, m, o).find("SegmentsPerSide"), std::string::npos);
  o = {};
  o.Fairing = {1.0};
  EXPECT_NE(failure(good, m, o).find("Fairing"), std::string::npos);
  o = {};
  o.DataWeight = -1;
  EXPECT_NE(failure(good, m, o).find("DataWeight"), std::string::npos);
}

TEST(G1Fit, CancelsWithoutResult)
{
  struct Stop : Monitor
  {
    bool cancelled() override { return ++this->Asked > 3; }
    int Asked = 0;
  } stop;
  const QuadMesh m = meshes::sphere(1);
  const auto r = fitG1(sample(m, 8, toSphere), m, {}, stop);
  ASSERT_FALSE(r);
  EXPECT_EQ(r.status().code(), StatusCode::Cancelled);
}

/// A cube stays a cube where its edges are creases, with flat faces and corners in place.
TEST(G1Fit, CreasesKeepSharpEdges)
{
  QuadMesh m = meshes::cells(
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}});
  const auto p = sample(m, 12, [](const Vec3& x) { return x; });
  G1FitOptions o;
  o.DataWeight = 1e5;
  o.CreaseAngle = 40.0;
  const auto r = fitted(p, m, o);
  EXPECT_EQ(r.CreaseEdges, 24); // two a side of the cube
  EXPECT_LE(r.MaxNormalJump, 1e-6);
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_LE(r.Max, 1e-3);
  o.CreaseAngle = 180.0;
  const auto round = fitted(p, m, o);
  EXPECT_EQ(round.CreaseEdges, 0);
  EXPECT_GE(round.Max, 10.0 * r.Max);
}
