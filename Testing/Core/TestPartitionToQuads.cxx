#include "Layout/NearestQuad.h"
#include "Layout/PartitionToQuads.h"
#include "ScanMeshes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

using namespace bsr;
using bsrtest::torusQuads;

namespace
{
/// A closed torus of m x n quads; `noise` twists them.
std::vector<Vec3> cloud(int n, double size)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> in(-size, size);
  std::vector<Vec3> p(static_cast<std::size_t>(n));
  for (Vec3& x : p)
  {
    x = Vec3(in(random), in(random), in(random));
  }
  return p;
}

Vec3 bilinear(const QuadMesh& m, Index q, double u, double v)
{
  const auto& c = m.Quads[q];
  return (1 - u) * (1 - v) * m.Points[c[0]] + u * (1 - v) * m.Points[c[1]] +
         u * v * m.Points[c[2]] + (1 - u) * v * m.Points[c[3]];
}

/// The smallest distance by dense sampling of every quad.
double sampledDistance(const QuadMesh& m, const Vec3& p)
{
  double best = 1e300;
  for (Index q = 0; q < static_cast<Index>(m.Quads.size()); ++q)
  {
    for (int j = 0; j <= 20; ++j)
    {
      for (int i = 0; i <= 20; ++i)
      {
        best = std::min(best, (bilinear(m, q, i / 20.0, j / 20.0) - p).norm());
      }
    }
  }
  return best;
}
} // namespace

TEST(PartitionToQuads, NoSampleOfAnyQuadIsNearer)
{
  for (const double noise : {0.0, 0.1, 0.6})
  {
    const QuadMesh mesh = torusQuads(12, 8, noise);
    const NearestQuad nearest(mesh);
    for (const Vec3& p : cloud(300, 5.0))
    {
      const QuadHit hit = nearest.find(p);
      ASSERT_GE(hit.Quad, 0);
      const double d = std::sqrt(hit.SquaredDistance);
      EXPECT_LE(d, sampledDistance(mesh, p) + 1e-12);
      EXPECT_NEAR((bilinear(mesh, hit.Quad, hit.UV[0], hit.UV[1]) - p).norm(), d, 1e-12);
      EXPECT_TRUE(hit.UV.minCoeff() >= 0.0 && hit.UV.maxCoeff() <= 1.0);
    }
  }
}

TEST(PartitionToQuads, PointsOnAQuadAreInverted)
{
  const QuadMesh mesh = torusQuads(12, 8, 0.1);
  const NearestQuad nearest(mesh);
  for (Index q = 0; q < static_cast<Index>(mesh.Quads.size()); ++q)
  {
    const Vec2 uv(0.05 + 0.9 * ((q * 37) % 100) / 100.0, 0.05 + 0.9 * ((q * 71) % 100) / 100.0);
    const QuadHit hit = nearest.find(bilinear(mesh, q, uv[0], uv[1]));
    EXPECT_EQ(hit.Quad, q);
    EXPECT_LT((hit.UV - uv).norm(), 1e-10);
  }
}

TEST(PartitionToQuads, HintAndThreadsDoNotChangeTheAnswer)
{
  const QuadMesh mesh = torusQuads(24, 16, 0.05);
  const std::vector<Vec3> points = cloud(20000, 4.0);
  Monitor monitor;
  const auto two = partitionToQuads(points, mesh, {}, monitor);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = partitionToQuads(points, mesh, {}, monitor);
  ASSERT_TRUE(two.isOk() && single.isOk());
  EXPECT_EQ(two->QuadId, single->QuadId);
  EXPECT_EQ(two->UV, single->UV);
  EXPECT_EQ(two->Distance, single->Distance);
  const NearestQuad nearest(mesh);
  for (std::size_t i = 0; i < 500; ++i)
  {
    const QuadHit hit = nearest.find(points[i], static_cast<Index>(i % mesh.Quads.size()));
    EXPECT_EQ(hit.Quad, two->QuadId[i]);
    EXPECT_EQ(hit.UV, two->UV[i]);
  }
}

TEST(PartitionToQuads, FacingKeepsToOneSide)
{
  // Two parallel squares, the lower one facing down: the walls of a collapsed tube.
  QuadMesh mesh;
  mesh.Points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0, 0, -1),
    Vec3(1, 0, -1), Vec3(1, 1, -1), Vec3(0, 1, -1)};
  mesh.Quads = {{0, 1, 2, 3}, {7, 6, 5, 4}};
  PartitionOptions options;
  options.Facing = {Vec3(0, 0, 1), Vec3(0, 0, 0), Vec3(0, 0, -1), Vec3(1, 0, 0)};
  Monitor monitor;
  const auto p = partitionToQuads(std::vector<Vec3>(4, Vec3(.5, .5, -.8)), mesh, options, monitor);
  ASSERT_TRUE(p.isOk());
  EXPECT_EQ(p->QuadId, (std::vector<Index>{0, 1, 1, 1}));
  EXPECT_NEAR(p->Distance[0], 0.8, 1e-15);
  EXPECT_EQ(p->EmptyQuads, 0);
  // A layout that is inside out as a whole gives the same.
  for (auto& q : mesh.Quads)
  {
    std::reverse(q.begin(), q.end());
  }
  const auto r = partitionToQuads(std::vector<Vec3>(4, Vec3(.5, .5, -.8)), mesh, options, monitor);
  EXPECT_EQ(r->QuadId, p->QuadId);
}

TEST(PartitionToQuads, DegenerateQuadsDoNoHarm)
{
  QuadMesh mesh;
  mesh.Points = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 0)};
  mesh.Quads = {{0, 1, 2, 3}, {0, 1, 4, 2}};
  const QuadHit hit = NearestQuad(mesh).find(Vec3(0.25, 1, 0));
  EXPECT_EQ(hit.Quad, 0);
  EXPECT_NEAR(hit.SquaredDistance, 1.0, 1e-12);
}

TEST(PartitionToQuads, BadInputIsRefused)
{
  Monitor monitor;
  const QuadMesh good = torusQuads(4, 4);
  const std::vector<Vec3> points = cloud(10, 1.0);
  const auto refused =
    [&](const std::vector<Vec3>& p, const QuadMesh& q, const PartitionOptions& o = {})
  {
    const auto r = partitionToQuads(p, q, o, monitor);
    return !r.isOk() && !r.status().message().empty();
  };
  EXPECT_TRUE(refused({}, good));
  EXPECT_TRUE(refused(points, QuadMesh{}));
  EXPECT_TRUE(refused({Vec3(0, NAN, 0)}, good));
  PartitionOptions options;
  options.Facing.resize(3);
  EXPECT_TRUE(refused(points, good, options));
  for (const std::array<Index, 4>& q :
    {std::array<Index, 4>{0, 1, 2, 99}, {0, 1, 2, -1}, {0, 1, 1, 2}, {0, 1, 0, 2}})
  {
    QuadMesh bad = good;
    bad.Quads[3] = q;
    EXPECT_TRUE(refused(points, bad));
  }
  QuadMesh bad = good;
  bad.Points[2][1] = INFINITY;
  EXPECT_TRUE(refused(points, bad));
}
