// Layouts of surfaces with sharp edges and regions of all kinds, and of few long triangles.
#include "Layout/QuadRemesh.h"
#include "LayoutTesting.h"
#include "Mesh/TriangleTree.h"
#include "PolygonTopology.h"
#include "WatchMonitor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace bsr;

/// A polygon, counter-clockwise, as a prism of long triangles. All of the polygon is seen from the
/// corner `fan` or, -1, from the origin.
TriangleMesh prism(const std::vector<Vec2>& polygon, double height, Index fan)
{
  TriangleMesh mesh;
  const auto n = static_cast<Index>(polygon.size());
  for (double z : {0.0, height})
  {
    for (const Vec2& p : polygon)
    {
      mesh.Points.emplace_back(p.x(), p.y(), z);
    }
  }
  const Index low = fan < 0 ? 2 * n : fan;
  const Index high = fan < 0 ? 2 * n + 1 : fan + n;
  for (double z : {0.0, height})
  {
    if (fan < 0)
    {
      mesh.Points.emplace_back(0.0, 0.0, z);
    }
  }
  for (Index i = 0; i < n; ++i)
  {
    const Index j = (i + 1) % n;
    mesh.Triangles.push_back({i, j, j + n});
    mesh.Triangles.push_back({i, j + n, i + n});
    if (i != fan && j != fan)
    {
      mesh.Triangles.push_back({high, i + n, j + n});
      mesh.Triangles.push_back({low, j, i});
    }
  }
  return mesh;
}

TriangleMesh angle()
{
  return prism({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, 2.0, 3);
}

TriangleMesh plate()
{
  return prism({{0, 0}, {200, 0}, {200, 200}, {0, 200}}, 1.0, 0);
}

QuadRemeshOptions sharp(int quads)
{
  QuadRemeshOptions options;
  options.NumberOfQuads = quads;
  options.FeatureAngle = 35.0;
  return options;
}

QuadLayout sound(const TriangleMesh& mesh, const QuadRemeshOptions& options)
{
  Monitor monitor;
  auto layout = quadRemesh(mesh, options, monitor);
  EXPECT_TRUE(layout) << layout.status().message();
  if (!layout)
  {
    return {};
  }
  EXPECT_EQ(bsrtest::layoutProblem(layout->Mesh), "");
  EXPECT_EQ(bsrtest::flippedQuads(layout->Mesh), 0);
  EXPECT_LE(layout->Report.MaxValence, 8);
  EXPECT_NEAR(layout->Mesh.Quads.size(), options.NumberOfQuads, 0.1 * options.NumberOfQuads);
  return *layout;
}

template <class Name>
TriangleMesh ballOf(const Name& name)
{
  TriangleMesh mesh;
  constexpr int n = 24;
  const auto at = [](int i, int j)
  { return static_cast<Index>(1 + (i - 1) * 2 * n + j % (2 * n)); };
  mesh.Points.emplace_back(0, 0, 1);
  for (int i = 1; i < n; ++i)
  {
    for (int j = 0; j < 2 * n; ++j)
    {
      const double t = M_PI * i / n;
      const double p = M_PI * j / n;
      mesh.Points.emplace_back(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
    }
  }
  mesh.Points.emplace_back(0, 0, -1);
  const auto last = static_cast<Index>(mesh.Points.size()) - 1;
  for (int j = 0; j < 2 * n; ++j)
  {
    mesh.Triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.Triangles.push_back({last, at(n - 1, j + 1), at(n - 1, j)});
    for (int i = 1; i + 1 < n; ++i)
    {
      mesh.Triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.Triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto& c = mesh.Triangles[t];
    mesh.Region.push_back(
      name((mesh.Points[c[0]] + mesh.Points[c[1]] + mesh.Points[c[2]]) / 3.0, t));
  }
  return mesh;
}

Index octant(const Vec3& p)
{
  return (p.x() > 0) + 2 * (p.y() > 0) + 4 * (p.z() > 0);
}
} // namespace

TEST(LayoutFeatures, FewTrianglesWithSharpEdges)
{
  const QuadLayout layout = sound(angle(), sharp(100));
  ASSERT_EQ(layout.Followed.size(), 1U);
  EXPECT_EQ(layout.Followed[0], FollowedFeatures::All);
  EXPECT_LT(layout.Distance.Maximum, 1e-3);
  bsrtest::WatchMonitor watch; // progress grows
  EXPECT_TRUE(quadRemesh(angle(), sharp(100), watch));
}

TEST(LayoutFeatures, SharpEdgesThatLeaveNoRoomAreGivenUp)
{
  std::vector<Vec2> teeth;
  for (int i = 0; i < 240; ++i)
  {
    const double r = i % 2 == 0 ? 10.0 : 8.0;
    teeth.emplace_back(r * std::cos(M_PI * i / 120), r * std::sin(M_PI * i / 120));
  }
  const QuadLayout layout = sound(prism(teeth, 2.0, -1), sharp(100));
  ASSERT_EQ(layout.Followed.size(), 1U);
  EXPECT_EQ(layout.Followed[0], FollowedFeatures::Regions);
}

TEST(LayoutFeatures, SharpEdgesOfAThinPlate)
{
  sound(plate(), sharp(100));
}

TEST(LayoutFeatures, ThinPlatesOfTwelveTriangles)
{
  for (int quads : {60, 100, 150})
  {
    QuadRemeshOptions options;
    options.NumberOfQuads = quads;
    const QuadLayout layout = sound(plate(), options);
    const double side = 200.0 * std::sqrt(2.0 / static_cast<double>(layout.Mesh.Quads.size()));
    EXPECT_LT(layout.Distance.Maximum, 1.2 * side) << quads << " quads";
    EXPECT_LT(layout.Distance.Mean, 0.1 * side) << quads << " quads";
  }
}

TEST(LayoutFeatures, NeedlesOfAFan)
{
  std::vector<Vec2> circle;
  for (int i = 0; i < 400; ++i)
  {
    circle.emplace_back(std::cos(M_PI * i / 200), std::sin(M_PI * i / 200));
  }
  sound(prism(circle, 10.0, 0), sharp(100));
}

TEST(LayoutFeatures, RegionsThatShareCornersKeepTheirBorders)
{
  QuadRemeshOptions options;
  options.NumberOfQuads = 100;
  const QuadLayout layout =
    sound(ballOf([](const Vec3& p, std::size_t) { return octant(p) - 3; }), options);
  EXPECT_EQ(layout.Followed[0], FollowedFeatures::All);
  ASSERT_EQ(layout.Mesh.Region.size(), layout.Mesh.Quads.size());
  for (std::size_t q = 0; q < layout.Mesh.Quads.size(); ++q)
  {
    Vec3 middle = Vec3::Zero();
    for (Index v : layout.Mesh.Quads[q])
    {
      middle += layout.Mesh.Points[v];
    }
    EXPECT_EQ(layout.Mesh.Region[q], octant(middle) - 3); // negative ones, too
  }
}

TEST(LayoutFeatures, RegionsOfSingleTrianglesAreNotFollowed)
{
  QuadRemeshOptions options;
  options.NumberOfQuads = 100;
  const QuadLayout layout = sound(ballOf([](const Vec3& p, std::size_t t)
                                    { return static_cast<Index>(t % 3 + 3 * (p.z() > 0)); }),
    options);
  EXPECT_EQ(layout.Followed[0], FollowedFeatures::None);
  for (std::size_t q = 0; q < layout.Mesh.Quads.size(); ++q)
  {
    const double z = layout.Mesh.Points[layout.Mesh.Quads[q][0]].z();
    if (std::abs(z) > 0.5)
    {
      EXPECT_EQ(layout.Mesh.Region[q] >= 3, z > 0.0);
    }
  }
}

TEST(LayoutFeatures, MeanDistanceIsOfTheAreaNotOfThePoints)
{
  const QuadLayout layout = bsrtest::remeshed(angle(), 300);
  std::vector<Vec3> points;
  std::vector<std::array<Index, 3>> triangles;
  for (const auto& q : layout.Mesh.Quads)
  {
    triangles.push_back({q[0], q[1], q[2]});
    triangles.push_back({q[0], q[2], q[3]});
  }
  const TriangleTree tree(layout.Mesh.Points, triangles);
  const TriangleMesh mesh = angle();
  double sum = 0.0;
  double area = 0.0;
  constexpr int n = 30;
  for (const auto& t : mesh.Triangles)
  {
    const Vec3& a = mesh.Points[t[0]];
    const Vec3 b = mesh.Points[t[1]] - a;
    const Vec3 c = mesh.Points[t[2]] - a;
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; i + j < n; ++j)
      {
        const Vec3 p = a + (i + 0.33) / n * b + (j + 0.33) / n * c;
        sum += b.cross(c).norm() * std::sqrt(tree.nearest(p).SquaredDistance);
        area += b.cross(c).norm();
      }
    }
  }
  EXPECT_NEAR(layout.Distance.Mean, sum / area, 0.3 * sum / area);
}
