#include "SampleModels.h"
#include "Spline/Bezier.h"
#include "Spline/ClosestPoint.h"
#include "Spline/Evaluate.h"
#include "Spline/Volume.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

using namespace bsr;

namespace
{
std::vector<Vec3> cloud(int n, double size)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> in(-size, size);
  std::vector<Vec3> p(static_cast<std::size_t>(n));
  for (Vec3& x : p)
  {
    x = Vec3(in(random), in(random), in(random));
  }
  return p;
}

double torusDistance(const Vec3& p)
{
  return std::hypot(std::hypot(p[0], p[1]) - 3.0, p[2]) - 1.0;
}

/// de Casteljau on the piece (i, j) of a Bezier patch, homogeneous.
Vec3 evaluatePiece(const BezierPatch& b, std::size_t i, std::size_t j, double s, double t)
{
  std::vector<Vec4> column;
  const auto blend = [](std::vector<Vec4> q, double x)
  {
    for (std::size_t n = q.size(); n > 1; --n)
    {
      for (std::size_t k = 0; k + 1 < n; ++k)
      {
        q[k] = (1 - x) * q[k] + x * q[k + 1];
      }
    }
    return q[0];
  };
  for (int l = 0; l <= b.DegreeV; ++l)
  {
    std::vector<Vec4> row;
    for (int k = 0; k <= b.DegreeU; ++k)
    {
      Vec4 p = b.Points[(j * b.DegreeV + l) * b.size()[0] + i * b.DegreeU + k];
      p.head<3>() *= p[3];
      row.push_back(p);
    }
    column.push_back(blend(row, s));
  }
  const Vec4 h = blend(column, t);
  return h.head<3>() / h[3];
}
} // namespace

TEST(Bezier, PiecesEqualThePatch)
{
  for (const SplineModel& m : {samples::tube(4, 2, 3), samples::torus(), samples::octantSphere()})
  {
    for (const SplinePatch& p : m.Patches)
    {
      for (const int split : {1, 3})
      {
        const BezierPatch b = bezierPieces(m, p, split);
        ASSERT_EQ(static_cast<std::int64_t>(b.Points.size()), b.size()[0] * b.size()[1]);
        for (std::size_t j = 0; j + 1 < b.EndsV.size(); ++j)
        {
          for (std::size_t i = 0; i + 1 < b.EndsU.size(); ++i)
          {
            const double u = b.EndsU[i] + 0.3 * (b.EndsU[i + 1] - b.EndsU[i]);
            const double v = b.EndsV[j] + 0.8 * (b.EndsV[j + 1] - b.EndsV[j]);
            const Vec3 d = evaluatePiece(b, i, j, 0.3, 0.8) - evaluatePatch(m, p, u, v).Point;
            EXPECT_LT(d.norm(), 1e-13);
          }
        }
      }
    }
  }
}

TEST(Volume, ExactBodies)
{
  const ModelMeasure torus = measureModel(samples::torus());
  EXPECT_TRUE(torus.Closed);
  EXPECT_NEAR(torus.Volume, 6 * samples::Pi * samples::Pi, 1e-10);
  EXPECT_NEAR(torus.Area, 12 * samples::Pi * samples::Pi, 1e-10);
  const ModelMeasure sphere = measureModel(samples::octantSphere(2.0));
  EXPECT_TRUE(sphere.Closed);
  EXPECT_NEAR(sphere.Volume, 32 * samples::Pi / 3, 1e-10);
  EXPECT_NEAR(sphere.Area, 16 * samples::Pi, 1e-9);
}

TEST(Volume, VoidsAreSubtractedAndOpenBodiesHaveNone)
{
  const double outer = measureModel(samples::hollowBall(1.0, 0.5)).Volume;
  SplineModel full;
  samples::addBall(full, 1.0, 2, 1, false);
  samples::connect(full);
  SplineModel core;
  samples::addBall(core, 0.5, 1, 1, false);
  samples::connect(core);
  EXPECT_NEAR(outer, measureModel(full).Volume - measureModel(core).Volume, 1e-13);
  SplineModel open;
  samples::addLattice(
    open, {1, 1, 3, 3, 1, 1, Shell::Outer}, [](int i, int j) { return Vec4(i, j, 0, 1); });
  samples::connect(open);
  const ModelMeasure m = measureModel(open);
  EXPECT_FALSE(m.Closed);
  EXPECT_EQ(m.Volume, 0.0);
  EXPECT_NEAR(m.Area, 9.0, 1e-13);
}

TEST(ClosestPoint, EqualsTheAnalyticDistanceOfATorus)
{
  const SplineModel m = samples::torus();
  Monitor monitor;
  const std::vector<Vec3> points = cloud(2000, 4.5);
  const auto d = measureDeviation(m, points, {}, monitor);
  ASSERT_TRUE(d.isOk()) << d.status().message();
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    EXPECT_NEAR(d->Distance[i], torusDistance(points[i]), 1e-9) << points[i].transpose();
    squares += d->Distance[i] * d->Distance[i];
  }
  EXPECT_NEAR(d->RMS, std::sqrt(squares / 2000.0), 1e-12);
  EXPECT_LE(d->Percentiles[0], d->Percentiles[4]);
  EXPECT_LE(d->Percentiles[4], d->Max);
}

TEST(ClosestPoint, PolesAndPointsOnTheSurface)
{
  const SplineModel m = samples::octantSphere(2.0);
  const ClosestPoint closest(m);
  for (const Vec3& p : {Vec3(0, 0, 5), Vec3(0, 0, -1), Vec3(0.1, 0.1, 1.0), Vec3(2, 0, 0)})
  {
    const ModelHit hit = closest.find(p);
    EXPECT_NEAR(closest.signedDistance(p, hit), p.norm() - 2.0, 1e-7) << p.transpose();
  }
}

TEST(ClosestPoint, NoSampleIsNearerAndSignsHoldAtSharpEdges)
{
  const SplineModel m = samples::tube(6, 2, 2);
  const ClosestPoint closest(m);
  std::vector<Vec3> surface;
  for (const SplinePatch& p : m.Patches)
  {
    for (int j = 0; j <= 16; ++j)
    {
      for (int i = 0; i <= 16; ++i)
      {
        surface.push_back(evaluatePatch(m, p, i / 16.0, j / 16.0).Point);
      }
    }
  }
  for (const Vec3& q : cloud(200, 2.0))
  {
    double best = 1e300;
    for (const Vec3& s : surface)
    {
      best = std::min(best, (s - q).norm());
    }
    EXPECT_LE(std::sqrt(closest.find(q).SquaredDistance), best + 1e-12);
  }
  // Below the lower rim: outside, although the nearest point lies on a sharp edge.
  for (int k = 0; k < 40; ++k)
  {
    const double a = 2 * samples::Pi * k / 40;
    for (const double r : {0.3, 0.9, 1.5})
    {
      const Vec3 q(r * std::cos(a), r * std::sin(a), -0.3);
      EXPECT_GT(closest.signedDistance(q, closest.find(q)), 0.0) << q.transpose();
    }
  }
  // Within the wall.
  const Vec3 inside(0.8 * 1.15, 0.0, 0.05);
  EXPECT_LT(closest.signedDistance(inside, closest.find(inside)), 0.0);
}

TEST(ClosestPoint, AModelStoredInsideOutHasTheSameSigns)
{
  SplineModel m;
  samples::addBall(m, 1.0, 1, 1, true);
  samples::addBall(m, 0.4, 1, 1, false, Shell::Inner);
  samples::connect(m);
  const std::vector<Vec3> points = {Vec3(1.5, 0, 0), Vec3(0.7, 0, 0), Vec3(0.1, 0, 0)};
  Monitor monitor;
  const auto d = measureDeviation(m, points, {}, monitor);
  ASSERT_TRUE(d.isOk());
  EXPECT_GT(d->Distance[0], 0.0);
  EXPECT_LT(d->Distance[1], 0.0);
  EXPECT_GT(d->Distance[2], 0.0);
}

TEST(ClosestPoint, ShellsCanBeChosen)
{
  const SplineModel m = samples::hollowBall(1.0, 0.5);
  const std::vector<Vec3> points(3, Vec3(0.9, 0, 0));
  Monitor monitor;
  const auto d = measureDeviation(m, points, {{0, 1, 255}}, monitor);
  ASSERT_TRUE(d.isOk());
  EXPECT_LT(std::abs(d->Distance[0]), 0.15);
  EXPECT_GT(std::abs(d->Distance[1]), 0.3);
  EXPECT_EQ(d->Distance[2], d->Distance[0]);
  EXPECT_EQ(d->Counted, 2);
  EXPECT_FALSE(measureDeviation(samples::ball(), points, {{1, 1, 1}}, monitor).isOk());
}

TEST(ClosestPoint, SameBitsForAnyNumberOfThreads)
{
  const SplineModel m = samples::tube(4, 2, 3);
  const std::vector<Vec3> points = cloud(3000, 2.0);
  Monitor monitor;
  const auto two = measureDeviation(m, points, {}, monitor);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = measureDeviation(m, points, {}, monitor);
  EXPECT_EQ(two->Distance, single->Distance);
  EXPECT_EQ(two->PatchId, single->PatchId);
}

TEST(ClosestPoint, BadInputIsRefused)
{
  Monitor monitor;
  EXPECT_FALSE(measureDeviation(samples::ball(), {}, {}, monitor).isOk());
  EXPECT_FALSE(measureDeviation(samples::ball(), {Vec3(NAN, 0, 0)}, {}, monitor).isOk());
}
