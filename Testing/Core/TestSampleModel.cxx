#include "SampleModels.h"
#include "Spline/Evaluate.h"
#include "Spline/ModelCheck.h"
#include "Spline/SampleModel.h"
#include "Spline/Topology.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <map>

using namespace bsr;

namespace
{
/// Uses of each directed edge; closed and coherent when each is met once by its reverse.
struct MeshFacts
{
  bool Closed = true;
  int Euler = 0;
  double Volume = 0.0;
};

MeshFacts factsOf(const SampledModel& s)
{
  std::map<std::pair<Index, Index>, int> edges;
  MeshFacts f;
  for (const auto& q : s.Polygons)
  {
    const int n = q[3] < 0 ? 3 : 4;
    for (int k = 0; k < n; ++k)
    {
      ++edges[{q[k], q[(k + 1) % n]}];
    }
    for (int k = 1; k + 1 < n; ++k)
    {
      f.Volume += s.Points[q[0]].dot(s.Points[q[k]].cross(s.Points[q[k + 1]])) / 6.0;
    }
  }
  for (const auto& e : edges)
  {
    const auto back = edges.find({e.first.second, e.first.first});
    f.Closed = f.Closed && e.second == 1 && back != edges.end();
  }
  f.Euler = static_cast<int>(s.Points.size()) - static_cast<int>(edges.size() / 2) +
            static_cast<int>(s.Polygons.size());
  return f;
}

SampledModel sampled(const SplineModel& m, const SampleOptions& o = {})
{
  Monitor monitor;
  auto s = sampleModel(m, o, monitor);
  EXPECT_TRUE(s.isOk()) << s.status().message();
  return s.isOk() ? *s : SampledModel{};
}

class Cancelling : public Monitor
{
public:
  bool cancelled() override { return true; }
};
} // namespace

TEST(SampleModel, SampleModelsAreValid)
{
  for (const SplineModel& m : {samples::ball(), samples::hollowBall(), samples::torus(),
         samples::octantSphere(), samples::tube()})
  {
    const Status s = checkModel(m);
    EXPECT_TRUE(s.isOk()) << s.message();
  }
}

TEST(SampleModel, ClosedModelsGiveClosedMeshes)
{
  const MeshFacts ball = factsOf(sampled(samples::ball(2.0, 2, 3)));
  EXPECT_TRUE(ball.Closed);
  EXPECT_EQ(ball.Euler, 2);
  EXPECT_GT(ball.Volume, 0.0);
  const MeshFacts hollow = factsOf(sampled(samples::hollowBall()));
  EXPECT_TRUE(hollow.Closed);
  EXPECT_EQ(hollow.Euler, 4);
  const MeshFacts tube = factsOf(sampled(samples::tube()));
  EXPECT_TRUE(tube.Closed);
  EXPECT_EQ(tube.Euler, 0);
  EXPECT_GT(tube.Volume, 0.0);
  const MeshFacts torus = factsOf(sampled(samples::torus(), {16, 0.0, false}));
  EXPECT_TRUE(torus.Closed);
  EXPECT_EQ(torus.Euler, 0);
  EXPECT_NEAR(torus.Volume, 2 * samples::Pi * samples::Pi * 3, 0.3);
  const MeshFacts sphere = factsOf(sampled(samples::octantSphere()));
  EXPECT_TRUE(sphere.Closed);
  EXPECT_EQ(sphere.Euler, 2);
}

TEST(SampleModel, ToleranceKeepsTheMeshClosed)
{
  const MeshFacts tube = factsOf(sampled(samples::tube(), {4, 0.002, false}));
  EXPECT_TRUE(tube.Closed);
  EXPECT_EQ(tube.Euler, 0);
}

TEST(SampleModel, ToleranceBoundsTheChordalError)
{
  for (const double tolerance : {0.1, 0.01, 0.001})
  {
    const SampledModel s = sampled(samples::torus(), {4, tolerance, false});
    double worst = 0.0;
    for (const auto& q : s.Polygons)
    {
      const Vec3 c = 0.25 * (s.Points[q[0]] + s.Points[q[1]] + s.Points[q[2]] + s.Points[q[3]]);
      worst = std::max(worst, std::abs(std::hypot(std::hypot(c[0], c[1]) - 3.0, c[2]) - 1.0));
    }
    EXPECT_LE(worst, tolerance);
    EXPECT_GT(worst, 0.05 * tolerance);
  }
}

TEST(SampleModel, PointsNormalsAndCurvaturesOfTheTorusAreExact)
{
  const SampledModel s = sampled(samples::torus(3.0, 1.0), {5, 0.0, true});
  for (std::size_t i = 0; i < s.Points.size(); ++i)
  {
    const Vec3& p = s.Points[i];
    const double rho = std::hypot(p[0], p[1]);
    const double c = rho - 3.0; // cosine of the small circle's angle
    EXPECT_NEAR(std::hypot(c, p[2]), 1.0, 1e-14);
    const Vec3 n(p[0] / rho * c, p[1] / rho * c, p[2]);
    EXPECT_LT((s.Normals[i] - n).norm(), 1e-12);
    EXPECT_NEAR(s.MeanCurvature[i], 0.5 * (1.0 + c / rho), 1e-11);
    EXPECT_NEAR(s.GaussCurvature[i], c / rho, 1e-11);
  }
}

TEST(SampleModel, PolesHaveNormals)
{
  for (const SplineModel& m : {samples::octantSphere(2.0)})
  {
    const SampledModel s = sampled(m);
    for (std::size_t i = 0; i < s.Points.size(); ++i)
    {
      EXPECT_LT((s.Normals[i] - s.Points[i] / 2.0).norm(), 1e-3) << s.Points[i].transpose();
    }
  }
}

TEST(SampleModel, TurnedPatchIsTurnedBack)
{
  SplineModel m = samples::tube(4, 2, 1);
  const MeshFacts before = factsOf(sampled(m));
  // Turn the whole inner shell over by swapping u and v.
  for (std::size_t p = 0; p < m.Patches.size(); ++p)
  {
    SplinePatch& s = m.Patches[p];
    if (s.Side != Shell::Inner)
    {
      continue;
    }
    std::vector<Vec4> t;
    for (int i = 0; i < s.CountU; ++i)
    {
      for (int j = 0; j < s.CountV; ++j)
      {
        t.push_back(m.ControlPoints[s.FirstControlPoint + j * s.CountU + i]);
      }
    }
    std::copy(t.begin(), t.end(), m.ControlPoints.begin() + s.FirstControlPoint);
  }
  for (auto& n : m.Neighbors)
  {
    n = {-1, -1, -1, -1};
  }
  samples::connect(m);
  const MeshFacts after = factsOf(sampled(m));
  EXPECT_TRUE(after.Closed);
  EXPECT_NEAR(after.Volume, before.Volume, 1e-12);
}

TEST(SampleModel, SameBitsForAnyNumberOfThreads)
{
  const SplineModel m = samples::tube();
  const SampledModel two = sampled(m, {4, 0.0, true});
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const SampledModel single = sampled(m, {4, 0.0, true});
  EXPECT_EQ(two.Points, single.Points);
  EXPECT_EQ(two.Normals, single.Normals);
  EXPECT_EQ(two.GaussCurvature, single.GaussCurvature);
}

TEST(SampleModel, BadOptionsAreRefused)
{
  Monitor monitor;
  for (const SampleOptions& o :
    {SampleOptions{0, 0.0, false}, SampleOptions{257, 0.0, false}, SampleOptions{4, -1.0, false},
      SampleOptions{4, std::numeric_limits<double>::quiet_NaN(), false}})
  {
    const auto s = sampleModel(samples::ball(), o, monitor);
    EXPECT_EQ(s.status().code(), StatusCode::InvalidParameter);
  }
  const auto s = sampleModel(samples::tube(16, 16, 3), {256, 0.0, false}, monitor);
  EXPECT_EQ(s.status().code(), StatusCode::InvalidParameter);
}

TEST(SampleModel, CancelIsObeyed)
{
  Cancelling monitor;
  const auto s = sampleModel(samples::ball(), {}, monitor);
  EXPECT_EQ(s.status().code(), StatusCode::Cancelled);
}

TEST(ModelCheck, FindsEachDefect)
{
  const auto broken = [](const std::function<void(SplineModel&)>& harm)
  {
    SplineModel m = samples::tube(4, 2, 2);
    harm(m);
    const Status s = checkModel(m);
    EXPECT_EQ(s.code(), StatusCode::InvalidInput);
    EXPECT_FALSE(s.message().empty());
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  broken([](SplineModel& m) { m = SplineModel{}; });
  broken([](SplineModel& m) { m.Neighbors.pop_back(); });
  broken([](SplineModel& m) { m.Patches[1].DegreeU = 0; });
  broken([](SplineModel& m) { m.Patches[1].DegreeV = 10; });
  broken([](SplineModel& m) { m.Patches[1].CountU = 3; });
  broken([](SplineModel& m) { m.Patches[1].CountV = 1000; });
  broken([](SplineModel& m) { m.Patches[1].FirstControlPoint = -1; });
  broken([](SplineModel& m) { m.Patches.back().FirstControlPoint += 1; });
  broken(
    [](SplineModel& m) { m.Patches[0].FirstKnotU = std::numeric_limits<std::int64_t>::max() - 3; });
  broken([](SplineModel& m) { std::swap(m.Knots[0], m.Knots[8]); });
  broken([&](SplineModel& m) { m.Knots[4] = nan; });
  broken([&](SplineModel& m) { m.Knots[3] = 0.25; });
  broken([&](SplineModel& m) { m.ControlPoints[7][1] = nan; });
  broken([](SplineModel& m) { m.ControlPoints[7][3] = 0.0; });
  broken([](SplineModel& m) { m.Neighbors[0][0] = 4 * 1000; });
  broken([](SplineModel& m) { m.Neighbors[0][1] = -2; });
  broken([](SplineModel& m) { std::swap(m.Neighbors[0][0], m.Neighbors[1][1]); });
  broken([](SplineModel& m) { m.Patches[0].Side = static_cast<Shell>(7); });
}

TEST(Topology, ComponentsAndOpenSides)
{
  const SplineModel hollow = samples::hollowBall();
  const auto [component, count] = patchComponents(hollow);
  EXPECT_EQ(count, 2);
  EXPECT_EQ(openSides(hollow, component, count), (std::vector<std::int64_t>{0, 0}));
  SplineModel open;
  samples::addLattice(open, {2, 2, 3, 3, 1, 1, Shell::Outer},
    [](int i, int j) { return Vec4(i, j, 0.1 * i * j, 1.0); });
  samples::connect(open);
  const auto [c, n] = patchComponents(open);
  EXPECT_EQ(n, 1);
  EXPECT_EQ(openSides(open, c, n)[0], 8);
}
