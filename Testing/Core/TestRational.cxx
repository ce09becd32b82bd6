#include "FitTesting.h"

#include "Common/CounterRandom.h"
#include "Spline/EvolutionStrategy.h"
#include "Spline/ModelCheck.h"
#include "Spline/Topology.h"
#include "Spline/WeightProblem.h"

#include <tbb/global_control.h>

using namespace bsr;
using namespace fits;

namespace
{
/// A sphere with bumps; its points are fixed points of `onto`.
Vec3 toBumps(const Vec3& p)
{
  const Vec3 d = p.normalized();
  return (1.0 + 0.08 * std::sin(5.0 * d[0] + 1.0) * std::cos(4.0 * d[1]) * std::sin(3.0 * d[2])) *
         d;
}

QuadMesh sphereLayout()
{
  QuadMesh m = meshes::cube();
  for (Vec3& p : m.Points)
  {
    p = toBumps(p - Vec3::Constant(0.5));
  }
  return m;
}

G1FitOptions rational(WeightOptimizer optimizer)
{
  G1FitOptions o;
  o.DataWeight = 1e5;
  o.Robust = false;
  o.Rational = true;
  o.Weights.Optimizer = optimizer;
  return o;
}

/// Mean distance of the points over all patches, by the report.
double meanDistance(const G1FitResult& r)
{
  double sum = 0.0;
  for (const PatchReport& p : r.Patches)
  {
    sum += p.Gain.MeanAfter / static_cast<double>(r.Patches.size());
  }
  return sum;
}

void checkSound(const G1FitResult& r)
{
  EXPECT_TRUE(checkModel(r.Model));
  EXPECT_LE(r.MaxNormalJump, 1e-6);
  EXPECT_EQ(r.FoldedPatches, 0);
  for (std::size_t p = 0; p < r.Model.Patches.size(); ++p)
  {
    for (int s = 0; s < 4; ++s)
    {
      EXPECT_TRUE(matchSide(r.Model, static_cast<std::int64_t>(p), s).Same) << p << " side " << s;
    }
  }
}
} // namespace

TEST(EvolutionStrategy, FindsTheOptimumOfAQuadratic)
{
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
  {
    EvolutionOptions o;
    o.Generations = 150;
    o.Patience = 150;
    o.Seed = seed;
    const auto r = evolve(
      6,
      [](const Eigen::VectorXd& x)
      {
        double f = 0.0;
        for (int i = 0; i < x.size(); ++i)
        {
          f += (i + 1) * std::pow(x[i] - 0.1 * (i + 2), 2);
        }
        return f;
      },
      o);
    EXPECT_LT(r.Fitness, 1e-4);
    for (int i = 0; i < 6; ++i)
    {
      EXPECT_NEAR(r.Best[i], 0.1 * (i + 2), 0.01);
    }
    for (std::size_t g = 1; g < r.History.size(); ++g)
    {
      EXPECT_LE(r.History[g], r.History[g - 1]) << "parents survive: the best never gets worse";
    }
    EXPECT_GE(r.Evaluations, 10 + 50 * (static_cast<int>(r.History.size()) - 1));
  }
}

TEST(EvolutionStrategy, FiltersInfeasibleIndividuals)
{
  EvolutionOptions o;
  o.Generations = 60;
  const auto r = evolve(
    3,
    [](const Eigen::VectorXd& x)
    {
      EXPECT_GT(x.minCoeff(), 0.0);
      return x.sum() < 1.0 ? std::numeric_limits<double>::infinity() : x.squaredNorm();
    },
    o);
  EXPECT_NEAR(r.Fitness, 1.0 / 3.0, 0.02); // the nearest point with sum 1
  const auto never = evolve(
    2, [](const Eigen::VectorXd&) { return std::numeric_limits<double>::quiet_NaN(); }, o);
  EXPECT_FALSE(std::isfinite(never.Fitness));
}

TEST(EvolutionStrategy, StopsAtTheToleranceAndRepeats)
{
  EvolutionOptions o;
  o.Tolerance = 0.05;
  o.Seed = 7;
  const auto f = [](const Eigen::VectorXd& x) { return (x.array() - 0.5).matrix().norm(); };
  const auto a = evolve(4, f, o);
  const auto b = evolve(4, f, o);
  EXPECT_LT(a.Fitness, 0.05);
  EXPECT_TRUE(a.Best == b.Best);
  EXPECT_GE(a.History[a.History.size() - 2], 0.05);
  o.Stream = 1;
  EXPECT_FALSE(evolve(4, f, o).Best == a.Best);
}

TEST(RationalPatch, RefinementDoesNotChangeTheSurface)
{
  RationalPatch p(3, 4);
  CounterRandom random(1, 1);
  for (Vec4& c : p.ControlPoints)
  {
    c = Vec4(random.uniform(), random.uniform(), random.uniform(), random.uniform(0.3, 3.0));
  }
  const RationalPatch fine = refined(p, 4, 2);
  EXPECT_EQ(fine.countU(), 26);
  EXPECT_EQ(fine.countV(), 18);
  for (int i = 0; i <= 20; ++i)
  {
    for (int j = 0; j <= 20; ++j)
    {
      const SurfacePoint a = p.at(i / 20.0, j / 20.0);
      const SurfacePoint b = fine.at(i / 20.0, j / 20.0);
      EXPECT_LT((a.Point - b.Point).norm(), 1e-13);
      EXPECT_LT((a.Du - b.Du).norm(), 1e-11);
      EXPECT_LT((a.Duv - b.Duv).norm(), 1e-9);
    }
  }
}

/// A quarter of a cylinder and a quarter of a torus' outside in their rational parameters.
TEST(WeightProblem, ReproducesConicsExactly)
{
  const auto arc = [](double t)
  {
    const double b[3] = {(1 - t) * (1 - t), std::sqrt(2.0) * t * (1 - t), t * t};
    const double w = b[0] + b[1] + b[2];
    return Vec2((b[0] + b[1]) / w, (b[1] + b[2]) / w);
  };
  for (int shape = 0; shape < 2; ++shape)
  {
    std::vector<FitPoint> points;
    for (int i = 0; i < 20 * 20; ++i)
    {
      FitPoint p;
      p.U = (i % 20) / 19.0;
      p.V = (i / 20) / 19.0;
      const Vec2 a = arc(p.U);
      const Vec2 b = arc(p.V);
      const double r = shape == 0 ? 1.0 : 2.0 + b[0];
      p.Position = Vec3(r * a[0], r * a[1], shape == 0 ? p.V : b[1]);
      points.push_back(p);
    }
    RationalPatch start(3, 3);
    std::fill(start.ControlPoints.begin(), start.ControlPoints.end(), Vec4(0, 0, 0, 1));
    const WeightProblem problem(
      start, points.data(), points.data() + points.size(), FreeControlPoints::All, {});
    WeightProblem::State state;
    ASSERT_TRUE(problem.solve(Eigen::VectorXd::Ones(problem.variables()), state));
    const double before = state.Rms;
    EXPECT_GT(before, 1e-6);
    problem.optimize(state, 200);
    EXPECT_LT(state.Rms, 1e-9) << "before: " << before;
    EXPECT_NEAR((state.Patch.at(0.3, 0.4).Point - points[0].Position).norm(),
      (state.Patch.at(0.3, 0.4).Point - Vec3(shape == 0 ? 1 : 3, 0, 0)).norm(), 1e-12);
  }
}

TEST(RationalFit, OptimizersLowerTheErrorAndKeepTangentPlanes)
{
  const QuadMesh m = sphereLayout();
  const PartitionedPoints p = sample(m, 16, toBumps);
  const auto none = fitted(p, m, rational(WeightOptimizer::None));
  const auto evolved = fitted(p, m, rational(WeightOptimizer::EvolutionStrategy));
  const auto deterministic = fitted(p, m, rational(WeightOptimizer::Deterministic));
  for (const auto* r : {&none, &evolved, &deterministic})
  {
    checkSound(*r);
    EXPECT_EQ(r->Patches.size(), 6u);
  }
  EXPECT_LT(meanDistance(evolved), 0.98 * meanDistance(none));
  EXPECT_LT(meanDistance(deterministic), 0.98 * meanDistance(none));
  EXPECT_LT(meanDistance(deterministic), 1.01 * meanDistance(evolved));
  EXPECT_GT(evolved.Shells[0].Convergence.size(), 5u);
  // Weights of 1 with the same second fit of the control points.
  const auto plain = fitted(p, m, rational(WeightOptimizer::ControlPoints));
  checkSound(plain);
  EXPECT_LT(meanDistance(plain), 0.98 * meanDistance(none));
  for (const Vec4& c : plain.Model.ControlPoints)
  {
    EXPECT_EQ(c[3], 1.0);
  }
  bool weighted = false;
  for (const Vec4& c : deterministic.Model.ControlPoints)
  {
    EXPECT_GT(c[3], 0.0);
    weighted = weighted || c[3] != 1.0;
  }
  EXPECT_TRUE(weighted);
}

TEST(RationalFit, SameSeedAndAnyThreadsGiveTheSameBits)
{
  const QuadMesh m = sphereLayout();
  const PartitionedPoints p = sample(m, 10, toBumps);
  auto o = rational(WeightOptimizer::EvolutionStrategy);
  o.Weights.Evolution.Generations = 40;
  const auto a = fitted(p, m, o);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto b = fitted(p, m, o);
  ASSERT_EQ(a.Model.ControlPoints.size(), b.Model.ControlPoints.size());
  for (std::size_t i = 0; i < a.Model.ControlPoints.size(); ++i)
  {
    EXPECT_TRUE(a.Model.ControlPoints[i] == b.Model.ControlPoints[i]);
  }
  o.Weights.Evolution.Seed = 5;
  const auto c = fitted(p, m, o);
  EXPECT_FALSE(std::equal(a.Model.ControlPoints.begin(), a.Model.ControlPoints.end(),
    c.Model.ControlPoints.begin(), c.Model.ControlPoints.end()));
}

TEST(RationalFit, RefinesWhereTheToleranceIsMissed)
{
  const QuadMesh m = sphereLayout();
  const PartitionedPoints p = sample(m, 30, toBumps);
  auto o = rational(WeightOptimizer::Deterministic);
  const auto coarse = fitted(p, m, o);
  o.Weights.Tolerance = 0.5 * meanDistance(coarse);
  const auto fine = fitted(p, m, o);
  checkSound(fine);
  EXPECT_EQ(fine.Patches.size(), coarse.Patches.size());
  EXPECT_GT(fine.Model.ControlPoints.size(), coarse.Model.ControlPoints.size());
  EXPECT_LT(meanDistance(fine), meanDistance(coarse));
  o.Weights.Tolerance = 1e-12; // out of reach: the best effort, and it says so
  const auto missed = fitted(p, m, o);
  checkSound(missed);
  EXPECT_EQ(missed.PatchesAboveTolerance, 6);
  EXPECT_NE(missed.Message.find("miss the tolerance"), std::string::npos) << missed.Message;
}
