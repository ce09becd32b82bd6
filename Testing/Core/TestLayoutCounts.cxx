// Numbers of quads: shares of components, and layouts at the limit of their topology.
#include "Layout/ComponentShares.h"
#include "Layout/QuadRemesh.h"
#include "LayoutTesting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

using namespace bsr;
using bsrtest::remeshed;

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

/// A surface of genus 9: a block of 3 x 3 tunnels, of n cells a tunnel and a wall.
TriangleMesh tunnels(int n)
{
  const int size = 7 * n;
  const auto solid = [&](int i, int j, int k)
  {
    return i >= 0 && j >= 0 && k >= 0 && i < size && j < size && k < n &&
           ((i / n) % 2 == 0 || (j / n) % 2 == 0);
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, Index> number;
  const auto point = [&](const std::array<int, 3>& p)
  {
    const auto added = number.try_emplace(p, static_cast<Index>(mesh.Points.size()));
    if (added.second)
    {
      mesh.Points.emplace_back(p[0], p[1], p[2]);
    }
    return added.first->second;
  };
  for (int i = 0; i < size; ++i)
  {
    for (int j = 0; j < size; ++j)
    {
      for (int k = 0; k < n; ++k)
      {
        for (int axis = 0; axis < 3 && solid(i, j, k); ++axis)
        {
          for (int side = 0; side < 2; ++side)
          {
            std::array<int, 3> there = {i, j, k};
            there[axis] += 2 * side - 1;
            if (solid(there[0], there[1], there[2]))
            {
              continue;
            }
            std::array<int, 3> a = {i, j, k};
            a[axis] += side;
            std::array<int, 3> b = a;
            std::array<int, 3> c = a;
            ++b[(axis + (side ? 1 : 2)) % 3];
            ++c[(axis + (side ? 2 : 1)) % 3];
            std::array<int, 3> d = b;
            ++d[(axis + (side ? 2 : 1)) % 3];
            mesh.Triangles.push_back({point(a), point(b), point(d)});
            mesh.Triangles.push_back({point(a), point(d), point(c)});
          }
        }
      }
    }
  }
  return mesh;
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

TEST(LayoutCounts, HandlesOnFewQuads)
{
  const QuadLayout layout = remeshed(tunnels(2), 40);
  EXPECT_EQ(layout.Report.Euler, -16);
  EXPECT_EQ(layout.MinimumQuads, leastQuads(-16, 0));
  EXPECT_TRUE(layout.Report.Valid) << layout.Report.Problem;
  EXPECT_EQ(layout.Report.Flipped, 0);
  EXPECT_LE(layout.Report.MaxValence, 8);
  EXPECT_LE(layout.Mesh.Quads.size(), 48U);
}
