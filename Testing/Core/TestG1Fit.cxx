#include "FitTesting.h"

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
