// Numbers of quads: shares of components, and layouts at the limit of their topology.
#include "Layout/ComponentShares.h"
#include "Layout/QuadRemesh.h"
#include "LayoutTesting.h"
#include "ScanMeshes.h"
#include "Tunnels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using namespace bsr;
using bsrtest::openTunnels;
using bsrtest::remeshed;
using bsrtest::tunnels;

namespace
{
/// A wavy disc of 2 n n triangles around `middle`.
void addDisc(TriangleMesh& mesh, int n, const Vec3& middle, double size)
{
  const auto first = static_cast<Index>(mesh.Points.size());
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; j <= n; ++j)
    {
      const double x = 2.0 * i / n - 1.0;
      const double y = 2.0 * j / n - 1.0;
      mesh.Points.push_back(middle + size * Vec3(x, 1.4 * y, 0.1 * std::sin(3.0 * x + y)));
    }
  }
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const Index a = first + i * (n + 1) + j;
      mesh.Triangles.push_back({a, a + n + 1, a + n + 2});
      mesh.Triangles.push_back({a, a + n + 2, a + 1});
    }
  }
}
} // namespace

TEST(LayoutCounts, SharesGoByAreaAndTopology)
{
  EXPECT_EQ(componentShares({{1.0, 56}}, 50), std::vector<int>{56});
  EXPECT_EQ(componentShares({{3.0, 6}, {1.0, 6}}, 400), (std::vector<int>{300, 100}));
  // Each enough to show its shape, as long as that leaves room.
  EXPECT_EQ(componentShares({{99.0, 6}, {1.0, 6}}, 200), (std::vector<int>{176, 24}));
  EXPECT_EQ(componentShares({{1.0, 36}, {0.1, 3}, {0.01, 1}, {0.001, 6}}, 20),
    (std::vector<int>{36, 3, 1, 6}));
  // Many specks that need little get little, so that the count is met.
  std::vector<ComponentSize> many(51, {0.1, 1});
  many.front() = {5.0, 6};
  const std::vector<int> shares = componentShares(many, 100);
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0), 100, 5);
  EXPECT_EQ(shares[1], 1);
}

TEST(LayoutCounts, LeastQuadsOfHandlesAndLoops)
{
  EXPECT_EQ(leastQuads(2, 0), 6);
  EXPECT_EQ(leastQuads(1, 1), 1);
  EXPECT_EQ(leastQuads(0, 2), 3);
  EXPECT_EQ(leastQuads(-100, 0), 200);
  EXPECT_EQ(leastQuads(-28, 0), 56);
  EXPECT_EQ(leastQuads(-24, 8), 36);   // 24 vertices on the loops are more than handles need
  EXPECT_EQ(leastQuads(-29, 9), 43);   // 28, for it must be an even number
  EXPECT_EQ(leastQuads(-420, 2), 588); // 168 on each loop
}

TEST(LayoutCounts, LeastQuadsAreReachedOnSmallSurfaces)
{
  // Five vertices on a torus, each joined to all others; then without one of the quads.
  QuadMesh mesh;
  for (Index i = 0; i < 5; ++i)
  {
    mesh.Points.emplace_back(std::cos(i), std::sin(i), 0.1 * i);
    mesh.Quads.push_back({i, (i + 1) % 5, (i + 3) % 5, (i + 2) % 5});
  }
  const LayoutReport torus = checkLayout(mesh);
  EXPECT_TRUE(torus.Valid) << torus.Problem;
  EXPECT_EQ(torus.Euler, 0);
  EXPECT_EQ(leastQuads(0, 0), 5);
  mesh.Quads.pop_back();
  const LayoutReport open = checkLayout(mesh);
  EXPECT_TRUE(open.Valid) << open.Problem;
  EXPECT_EQ(open.Euler, -1);
  EXPECT_EQ(open.BoundaryLoops, 1);
  EXPECT_EQ(leastQuads(-1, 1), 4);
}

TEST(LayoutCounts, ManySpecksDoNotCostTheCount)
{
  TriangleMesh mesh;
  addDisc(mesh, 30, Vec3::Zero(), 4.0);
  for (int i = 0; i < 20; ++i)
  {
    addDisc(mesh, 6, Vec3(10.0 + 3.0 * i, 0.0, 0.0), 0.5);
  }
  const QuadLayout layout = remeshed(mesh, 50);
  EXPECT_NEAR(static_cast<double>(layout.Mesh.Quads.size()), 50.0, 5.0);
  EXPECT_EQ(layout.MinimumQuads, 21);
  EXPECT_TRUE(layout.Report.Valid) << layout.Report.Problem;
  EXPECT_EQ(layout.Report.Flipped, 0);
  EXPECT_EQ(layout.Report.Components, 21);
  EXPECT_EQ(layout.Report.BoundaryLoops, 21);
  // The single quads look to the side that the specks look to.
  for (const auto& q : layout.Mesh.Quads)
  {
    const auto& p = layout.Mesh.Points;
    EXPECT_GT((p[q[2]] - p[q[0]]).cross(p[q[3]] - p[q[1]])[2], 0.0);
  }
}

TEST(LayoutCounts, OnlySpecksThatOthersMakeUpForAreBoxes)
{
  const TriangleMesh small = bsrtest::icosphere(3);
  TriangleMesh ball = small;
  EXPECT_NEAR(static_cast<double>(remeshed(ball, 11).Mesh.Quads.size()), 11.0, 1.1);
  const auto first = static_cast<Index>(ball.Points.size());
  for (const Vec3& p : small.Points)
  {
    ball.Points.emplace_back(0.4 * p + Vec3(3.0, 0.0, 0.0));
  }
  for (const auto& t : small.Triangles)
  {
    ball.Triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const QuadLayout layout = remeshed(ball, 60);
  EXPECT_NEAR(static_cast<double>(layout.Mesh.Quads.size()), 60.0, 6.0);
  EXPECT_EQ(layout.Stages[1], LayoutStage::Box);
}

TEST(LayoutCounts, HandlesOnFewQuads)
{
  const QuadLayout layout = remeshed(tunnels(2), 10);
  EXPECT_EQ(layout.Report.Euler, -16);
  EXPECT_EQ(layout.MinimumQuads, leastQuads(-16, 0));
  EXPECT_TRUE(layout.Report.Valid) << layout.Report.Problem;
  EXPECT_EQ(layout.Report.Flipped, 0);
  EXPECT_LE(layout.Report.MaxValence, 8);
  EXPECT_LE(static_cast<double>(layout.Mesh.Quads.size()), 1.1 * layout.MinimumQuads);
}

TEST(LayoutCounts, HandlesAndOpeningsOnFewQuads)
{
  const QuadLayout layout = remeshed(openTunnels(2), 10);
  EXPECT_EQ(layout.Report.Euler, -18);
  EXPECT_EQ(layout.Report.BoundaryLoops, 2);
  EXPECT_TRUE(layout.Report.Valid) << layout.Report.Problem;
  EXPECT_EQ(layout.Report.Flipped, 0);
  EXPECT_LE(layout.Report.MaxValence, 8);
  EXPECT_LE(static_cast<double>(layout.Mesh.Quads.size()), 1.2 * layout.MinimumQuads);
  EXPECT_GE(static_cast<int>(layout.Mesh.Quads.size()), layout.MinimumQuads);
}
