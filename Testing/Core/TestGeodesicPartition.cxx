#include "ScanMeshes.h"

#include "Layout/GeodesicPartition.h"
#include "Layout/SquareMap.h"
#include "Spline/Evaluate.h"
#include "Spline/G1Fit.h"
#include "Spline/SideNetwork.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <map>

using namespace bsr;

namespace
{
/// The n x n grid as a disc, its boundary on the square; heights by a function of the unit square.
template <class Height>
SquareDisc gridDisc(int n, const Height& height)
{
  SquareDisc disc;
  disc.Mesh = bsrtest::gridMesh(n, n);
  for (std::size_t v = 0; v < disc.Mesh.Points.size(); ++v)
  {
    Vec3& p = disc.Mesh.Points[v];
    p /= n;
    if (p.x() == 0.0 || p.y() == 0.0 || p.x() == 1.0 || p.y() == 1.0)
    {
      disc.Boundary.push_back(static_cast<Index>(v));
      disc.BoundaryUV.emplace_back(p.x(), p.y());
    }
    p.z() = height(p.x(), p.y());
  }
  return disc;
}
} // namespace

TEST(SquareMap, ReproducesTheSquare)
{
  const SquareDisc disc = gridDisc(9, [](double, double) { return 0.0; });
  const auto uv = squareMap(disc, 3);
  ASSERT_EQ(uv.size(), disc.Mesh.Points.size());
  for (std::size_t v = 0; v < uv.size(); ++v)
  {
    EXPECT_NEAR((uv[v] - disc.Mesh.Points[v].head<2>()).norm(), 0.0, 1e-9);
  }
}

TEST(SquareMap, ATowerDoesNotFoldAndSpreads)
{
  const SquareDisc disc = gridDisc(30, [](double x, double y)
    { return 2.0 * std::exp(-40.0 * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5))); });
  const auto plain = squareMap(disc, 0);
  const auto spread = squareMap(disc, 5);
  EXPECT_EQ(foldedTriangles(disc.Mesh, plain), 0);
  EXPECT_EQ(foldedTriangles(disc.Mesh, spread), 0);
  // The tower's upper half covers more of the square.
  const auto share = [&](const std::vector<Vec2>& uv)
  {
    double area = 0.0;
    for (const auto& t : disc.Mesh.Triangles)
    {
      if (disc.Mesh.Points[t[0]].z() > 1.0)
      {
        const Vec2 a = uv[t[1]] - uv[t[0]];
        const Vec2 b = uv[t[2]] - uv[t[0]];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      }
    }
    return area;
  };
  EXPECT_GT(share(spread), 1.5 * share(plain));
}

namespace
{
/// A cube's faces, `n` x `n` quads each, on the unit sphere; inside out if asked for.
QuadMesh sphereQuads(int n, bool inward = false)
{
  QuadMesh q;
  std::map<std::array<int, 3>, Index> number;
  const auto vertex = [&](const std::array<int, 3>& at)
  {
    const auto [found, fresh] = number.insert({at, static_cast<Index>(q.Points.size())});
    if (fresh)
    {
      q.Points.push_back(Vec3(at[0], at[1], at[2]).normalized());
    }
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int side : {-n, n})
    {
      for (int i = -n; i < n; i += 2)
      {
        for (int j = -n; j < n; j += 2)
        {
          const auto at = [&](int a, int b)
          {
            std::array<int, 3> x{};
            x[axis] = side;
            x[(axis + 1) % 3] = a;
            x[(axis + 2) % 3] = b;
            return vertex(x);
          };
          std::array<Index, 4> f = {at(i, j), at(i + 2, j), at(i + 2, j + 2), at(i, j + 2)};
          if ((side < 0) != inward)
          {
            std::swap(f[1], f[3]);
          }
          q.Quads.push_back(f);
        }
      }
    }
  }
  return q;
}

GeodesicPartition partitioned(const std::vector<Vec3>& points, const TriangleMesh& mesh,
  const QuadMesh& quads, const GeodesicOptions& options = {})
{
  Monitor quiet;
  auto p = partitionGeodesic(points, mesh, quads, options, quiet);
  EXPECT_TRUE(p.isOk()) << p.status().message();
  return p.isOk() ? std::move(*p) : GeodesicPartition{};
}

double lengthOf(const std::vector<Vec3>& line)
{
  double l = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i)
  {
    l += (line[i] - line[i - 1]).norm();
  }
  return l;
}

/// Every quad has points, all parameters lie in the square, and no triangle is folded.
void expectSound(const GeodesicPartition& p)
{
  EXPECT_EQ(p.FailedQuads, 0);
  EXPECT_EQ(p.FoldedTriangles, 0);
  EXPECT_EQ(p.Points.EmptyQuads, 0);
  for (std::size_t i = 0; i < p.Points.UV.size(); ++i)
  {
    ASSERT_GE(p.Points.QuadId[i], 0);
    ASSERT_GE(p.Points.UV[i].minCoeff(), 0.0);
    ASSERT_LE(p.Points.UV[i].maxCoeff(), 1.0);
  }
}
} // namespace

TEST(GeodesicPartition, SidesOnTheSphereAreGreatCircles)
{
  const TriangleMesh sphere = bsrtest::icosphere(4);
  for (const bool inward : {false, true})
  {
    const QuadMesh quads = sphereQuads(1, inward);
    const GeodesicPartition p = partitioned(sphere.Points, sphere, quads);
    expectSound(p);
    EXPECT_EQ(p.RoughSides, 0);
    EXPECT_LT(p.Points.Max, 1e-12);
    const double exact = std::acos(1.0 / 3.0); // between neighboring corners of a cube
    ASSERT_EQ(p.Sides.size(), 12U);
    for (const auto& side : p.Sides)
    {
      // Corners move to the nearest vertex of the mesh.
      const double l = std::acos(side.front().dot(side.back()));
      EXPECT_NEAR(lengthOf(side), l, 0.01 * l);
      EXPECT_NEAR(lengthOf(side), exact, 0.12);
    }
  }
}

TEST(GeodesicPartition, NeighborsAgreeOnTheirSides)
{
  const TriangleMesh sphere = bsrtest::icosphere(4);
  const QuadMesh quads = sphereQuads(2);
  const GeodesicPartition geometry = partitioned(sphere.Points, sphere, quads);
  // Points on a side, just left and right of it: the same parameter along it, 0 across.
  for (std::size_t s = 0; s < geometry.Sides.size(); s += 5)
  {
    const auto& side = geometry.Sides[s];
    ASSERT_GT(side.size(), 2U);
    const Vec3 middle = side[side.size() / 2];
    const Vec3 along = (side[side.size() / 2 + 1] - middle).normalized();
    const Vec3 left = middle.normalized().cross(along);
    const std::vector<Vec3> both = {middle + 1e-5 * left, middle - 1e-5 * left};
    const GeodesicPartition p = partitioned(both, sphere, quads);
    EXPECT_NE(p.Points.QuadId[0], p.Points.QuadId[1]);
    std::array<double, 2> t{};
    for (int k = 0; k < 2; ++k)
    {
      const auto& q = quads.Quads[p.Points.QuadId[k]];
      const Vec2 uv = p.Points.UV[k];
      const std::array<double, 4> across = {uv[1], 1.0 - uv[0], 1.0 - uv[1], uv[0]};
      const std::array<double, 4> at = {uv[0], uv[1], 1.0 - uv[0], 1.0 - uv[1]};
      const auto e =
        static_cast<std::size_t>(std::min_element(across.begin(), across.end()) - across.begin());
      EXPECT_LT(across[e], 1e-3);
      t[k] = q[e] == geometry.SideEnds[s][0] ? at[e] : 1.0 - at[e];
    }
    EXPECT_NEAR(t[0], t[1], 1e-3);
  }
}

TEST(GeodesicPartition, OpenTubesKeepTheirBoundaries)
{
  const TriangleMesh tube = bsrtest::tubeMesh(40, 40);
  QuadMesh quads;
  const int m = 5;
  for (int j = 0; j <= 3; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const double a = 2 * M_PI * (i + 0.2 * j) / m; // a screw
      quads.Points.emplace_back(std::cos(a), std::sin(a), -2.0 + 4.0 * j / 3);
      if (j < 3)
      {
        const Index i1 = (i + 1) % m;
        quads.Quads.push_back({j * m + i, j * m + i1, (j + 1) * m + i1, (j + 1) * m + i});
      }
    }
  }
  const GeodesicPartition p = partitioned(tube.Points, tube, quads);
  expectSound(p);
  for (std::size_t s = 0; s < p.Sides.size(); ++s)
  {
    if (p.SideQuads[s][1] < 0)
    {
      for (const Vec3& x : p.Sides[s])
      {
        EXPECT_NEAR(std::abs(x.z()), 2.0, 1e-12);
      }
    }
  }
  // A closed mesh under the same layout has no such boundaries.
  Monitor quiet;
  const auto sphere = bsrtest::icosphere(3);
  const auto wrong = partitionGeodesic(sphere.Points, sphere, quads, {}, quiet);
  EXPECT_FALSE(wrong.isOk());
  EXPECT_NE(wrong.status().message().find("boundar"), std::string::npos);
}

TEST(GeodesicPartition, TakesOtherPointsAndTheirNormals)
{
  const TriangleMesh sphere = bsrtest::icosphere(4);
  const std::vector<Vec3> points = {Vec3(0, 0, 1.2), Vec3(0, 0, 0.7), Vec3(0, 0, 0.7)};
  GeodesicOptions o;
  o.Facing = {Vec3::Zero(), Vec3(0, 0, 1), Vec3(0, 0, -1)};
  const QuadMesh quads = sphereQuads(1);
  const GeodesicPartition p = partitioned(points, sphere, quads, o);
  EXPECT_NEAR(p.Points.Distance[0], 0.2, 2e-3);
  EXPECT_EQ(p.Points.QuadId[0], p.Points.QuadId[1]);
  EXPECT_NE(p.Points.QuadId[1], p.Points.QuadId[2]);
}

TEST(GeodesicPartition, PointsOfTheMeshStayWhereTheyAreWithWrongNormals)
{
  const TriangleMesh sphere = bsrtest::icosphere(3);
  GeodesicOptions o;
  for (const Vec3& p : sphere.Points)
  {
    o.Facing.emplace_back(-p);
  }
  const GeodesicPartition p = partitioned(sphere.Points, sphere, sphereQuads(2), o);
  EXPECT_LT(p.Points.Max, 1e-6);
}

TEST(GeodesicPartition, CanBeCancelledAnywhere)
{
  struct Impatient : Monitor
  {
    explicit Impatient(int left) : Left(left) {}
    bool cancelled() override { return --this->Left < 0; }
    int Left;
  };
  const TriangleMesh sphere = bsrtest::icosphere(3);
  const QuadMesh quads = sphereQuads(2);
  Impatient patient(1 << 30);
  ASSERT_TRUE(partitionGeodesic(sphere.Points, sphere, quads, {}, patient).isOk());
  const int asked = (1 << 30) - patient.Left;
  EXPECT_GT(asked, 2 * 48); // at every side, when laid and when straightened
  for (int i = 0; i < asked; i += std::max(1, asked / 12))
  {
    Impatient monitor(i);
    const auto p = partitionGeodesic(sphere.Points, sphere, quads, {}, monitor);
    EXPECT_EQ(p.status().code(), StatusCode::Cancelled) << i;
  }
}

TEST(GeodesicPartition, DoesNotDependOnThreads)
{
  const TriangleMesh sphere = bsrtest::icosphere(3);
  const QuadMesh quads = sphereQuads(2);
  const GeodesicPartition many = partitioned(sphere.Points, sphere, quads);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const GeodesicPartition single = partitioned(sphere.Points, sphere, quads);
  EXPECT_EQ(many.Points.QuadId, single.Points.QuadId);
  EXPECT_TRUE(many.Points.UV == single.Points.UV);
}

TEST(GeodesicPartition, AHandleIsNoObstacle)
{
  const TriangleMesh torus = bsrtest::torusMesh(60, 24);
  QuadMesh quads;
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 6; ++i)
    {
      const double a = 2 * M_PI * (i + 0.3 * j) / 6;
      const double b = 2 * M_PI * (j + 0.25 * (i % 2)) / 3;
      quads.Points.emplace_back(
        (3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b));
      const Index i1 = (i + 1) % 6;
      const Index j1 = (j + 1) % 3;
      quads.Quads.push_back({j * 6 + i, j * 6 + i1, j1 * 6 + i1, j1 * 6 + i});
    }
  }
  expectSound(partitioned(torus.Points, torus, quads));
}

TEST(SideNetwork, IsEvenSmoothAndOnTheMesh)
{
  const TriangleMesh sphere = bsrtest::icosphere(4);
  std::vector<Vec3> jagged;
  for (int i = 0; i <= 30; ++i)
  {
    const double a = 1.2 * i / 30;
    const double off = i == 0 || i == 30 ? 0.0 : 0.02 * (i % 2 ? 1 : -1);
    jagged.push_back(Vec3(std::cos(a), std::sin(a), off).normalized());
  }
  const auto network = regularizeSides({jagged, {}}, 9, sphere);
  ASSERT_EQ(network.size(), 2U);
  EXPECT_TRUE(network[1].empty());
  const auto& side = network[0];
  ASSERT_EQ(side.size(), 9U);
  EXPECT_EQ(side.front(), jagged.front());
  EXPECT_EQ(side.back(), jagged.back());
  for (std::size_t i = 1; i < side.size(); ++i)
  {
    EXPECT_NEAR((side[i] - side[i - 1]).norm(), 1.2 / 8, 0.01);
    EXPECT_LT(std::abs(side[i].z()), 0.01);
    EXPECT_NEAR(side[i].norm(), 1.0, 3e-3);
  }
}

TEST(GeodesicPartition, TheModelFollowsAnOpenBoundary)
{
  // A tube with a wavy rim.
  TriangleMesh tube = bsrtest::tubeMesh(48, 48);
  for (Vec3& p : tube.Points)
  {
    p.z() *= 1.0 + 0.15 * std::cos(2.0 * std::atan2(p.y(), p.x()));
  }
  QuadMesh quads;
  const int m = 6;
  for (int j = 0; j <= 4; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const double a = 2 * M_PI * i / m;
      quads.Points.emplace_back(
        std::cos(a), std::sin(a), (j - 2.0) * (1.0 + 0.15 * std::cos(2.0 * a)));
      if (j < 4)
      {
        const Index i1 = (i + 1) % m;
        quads.Quads.push_back({j * m + i, j * m + i1, (j + 1) * m + i1, (j + 1) * m + i});
      }
    }
  }
  const GeodesicPartition p = partitioned(tube.Points, tube, quads);
  ASSERT_FALSE(p.Points.Boundary.empty());
  EXPECT_EQ(std::count(p.Points.Boundary.begin(), p.Points.Boundary.end(), 1), 2 * 48);
  PartitionedPoints points;
  points.Points = tube.Points;
  points.QuadId = p.Points.QuadId;
  points.UV = p.Points.UV;
  points.Boundary = p.Points.Boundary;
  G1FitOptions options;
  options.DataWeight = 1e4;
  options.Robust = false;
  Monitor quiet;
  const auto fit = fitG1(points, quads, options, quiet);
  ASSERT_TRUE(fit.isOk()) << fit.status().message();
  EXPECT_EQ(fit->FoldedPatches, 0);
  EXPECT_LT(fit->Rms, 3e-3);
  // The border curves of the model lie on the rims.
  double worst = 0.0;
  for (std::size_t patch = 0; patch < quads.Quads.size(); ++patch)
  {
    for (int k = 0; k < 4; ++k)
    {
      if (fit->Model.Neighbors[patch][k] >= 0)
      {
        continue;
      }
      for (int s = 0; s <= 10; ++s)
      {
        const double t = s / 10.0;
        const std::array<Vec2, 4> at = {Vec2(t, 0), Vec2(1, t), Vec2(t, 1), Vec2(0, t)};
        const Vec3 x =
          evaluatePatch(fit->Model, fit->Model.Patches[patch], at[k][0], at[k][1]).Point;
        const double rim = 2.0 * (1.0 + 0.15 * std::cos(2.0 * std::atan2(x.y(), x.x())));
        worst = std::max(worst, std::abs(std::abs(x.z()) - rim));
      }
    }
  }
  EXPECT_LT(worst, 0.01);
}
