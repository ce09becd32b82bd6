#include "Mesh/BuildSurface.h"
#include "Mesh/RemoveSlivers.h"
#include "ScanMeshes.h"

#include <gtest/gtest.h>

using bsr::Index;
using bsr::TriangleMesh;
using bsr::TriangleSurface;
using bsr::Vec3;

namespace
{
TriangleSurface surfaceOf(const TriangleMesh& mesh)
{
  bsr::RepairReport report;
  bsr::Monitor monitor;
  auto surfaces = bsr::buildSurfaces(mesh, {}, report, monitor);
  EXPECT_TRUE(surfaces);
  return surfaces->front();
}

/// Least twice the area over the squared longest edge.
double flattest(const TriangleMesh& mesh)
{
  double least = 1.0;
  for (const auto& t : mesh.Triangles)
  {
    const Vec3 a = mesh.Points[t[1]] - mesh.Points[t[0]];
    const Vec3 b = mesh.Points[t[2]] - mesh.Points[t[0]];
    const double longest =
      std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm(), 1e-300});
    least = std::min(least, a.cross(b).norm() / longest);
  }
  return least;
}

/// Every n-th edge is split very near its start, or at the very edge's apex side (a flat triangle).
TriangleSurface withSlivers(TriangleSurface s, int n, double at)
{
  const auto count = static_cast<Index>(s.Vertex.size());
  for (Index h = 0; h < count; h += n)
  {
    const Vec3 a = s.Points[s.start(h)];
    const Vec3 b = s.Points[s.end(h)];
    s.split(h, a + at * (b - a));
  }
  return s;
}
} // namespace

TEST(RemoveSlivers, RestoresASphereWithSplitCorners)
{
  // Edges of length 1e-12, and zero where the split falls on the corner itself.
  for (const double at : {0.0, 1e-12, 1e-3})
  {
    TriangleSurface s = withSlivers(surfaceOf(bsrtest::icosphere(3)), 7, at);
    EXPECT_LT(flattest(s.toMesh()), 2e-3);
    EXPECT_GT(bsr::removeSlivers(s), 0);
    EXPECT_GT(flattest(s.toMesh()), 0.05);
    EXPECT_EQ(s.eulerCharacteristic(), 2);
    EXPECT_NEAR(s.area(), surfaceOf(bsrtest::icosphere(3)).area(), 1e-3);
  }
}

TEST(RemoveSlivers, FlipsTrianglesWithoutShortEdges)
{
  // The middle point of an edge, moved into the edge's other triangle's base: a flat triangle.
  TriangleMesh m;
  m.Points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0.5, 0, 0)};
  m.Triangles = {{0, 4, 3}, {4, 2, 3}, {4, 1, 2}};
  m.Points.emplace_back(0.5, -1, 0);
  m.Triangles.push_back({0, 1, 4}); // without area
  m.Triangles.push_back({0, 5, 1});
  TriangleSurface s = surfaceOf(m);
  EXPECT_EQ(flattest(s.toMesh()), 0.0);
  EXPECT_EQ(bsr::removeSlivers(s), 1);
  EXPECT_GT(flattest(s.toMesh()), 0.1);
  EXPECT_EQ(s.toMesh().Triangles.size(), m.Triangles.size());
  EXPECT_NEAR(s.area(), 1.5, 1e-12);
}

TEST(RemoveSlivers, LeavesSoundMeshesAndBoundariesAlone)
{
  TriangleSurface sphere = surfaceOf(bsrtest::icosphere(2));
  const auto points = sphere.Points;
  EXPECT_EQ(bsr::removeSlivers(sphere), 0);
  EXPECT_EQ(sphere.Points, points);

  // A boundary point very near a corner: the corner of the square must not be lost.
  TriangleSurface grid = withSlivers(surfaceOf(bsrtest::gridMesh(4, 4)), 5, 1e-9);
  bsr::removeSlivers(grid);
  EXPECT_EQ(grid.eulerCharacteristic(), 1);
  EXPECT_NEAR(grid.area(), 16.0, 1e-6);
  EXPECT_GT(flattest(grid.toMesh()), 0.05);
}
