#include "ScanMeshes.h"

#include "Mesh/BoundaryLoops.h"
#include "Mesh/Geodesic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

using namespace bsr;

namespace
{
/// Largest relative error of distance and of path length from vertex `from`, beyond distance 0.3.
std::pair<double, double> errors(const TriangleMesh& mesh, Index from,
  const std::function<double(const Vec3&, const Vec3&)>& exact)
{
  const auto twin = halfEdgeTwins(mesh);
  const FastMarching march(mesh, *twin);
  const auto d = march.distances({from});
  double worst = 0.0;
  double worstPath = 0.0;
  for (std::size_t v = 0; v < mesh.Points.size(); v += 7)
  {
    const double e = exact(mesh.Points[from], mesh.Points[v]);
    if (e > 0.3)
    {
      worst = std::max(worst, std::abs(d[v] - e) / e);
      auto path = march.descend(d, static_cast<Index>(v));
      if (path.empty())
      {
        ADD_FAILURE() << "no path from " << v;
        continue;
      }
      EXPECT_EQ(path.back().A, from);
      march.straighten(path, 50, 0.0);
      worstPath = std::max(worstPath, std::abs(pathLength(path, mesh.Points) - e) / e);
    }
  }
  return {worst, worstPath};
}

double onSphere(const Vec3& a, const Vec3& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double onTube(const Vec3& a, const Vec3& b)
{
  double angle = std::abs(std::atan2(a.y(), a.x()) - std::atan2(b.y(), b.x()));
  angle = std::min(angle, 2 * M_PI - angle);
  return std::hypot(angle, a.z() - b.z());
}
} // namespace

TEST(Geodesic, ConvergesOnTheSphere)
{
  double last = 1.0;
  for (const int level : {3, 4, 5})
  {
    const auto [distance, path] = errors(bsrtest::icosphere(level), 0, onSphere);
    EXPECT_LT(distance, 0.65 * last) << level;
    EXPECT_LT(path, 1.5 * distance + 1e-4) << level;
    last = distance;
  }
  EXPECT_LT(last, 7e-3);
}

TEST(Geodesic, IsExactOnACylinderUpToItsFacets)
{
  for (const int m : {24, 48, 96})
  {
    const TriangleMesh tube = bsrtest::tubeMesh(m, m / 2);
    const auto [distance, path] = errors(tube, (m / 4) * m + 3, onTube);
    // The facets of a polygon of m sides are shorter than the arc by this.
    const double facets = 1.0 - std::sin(M_PI / m) / (M_PI / m);
    EXPECT_LT(distance, facets + 2e-3) << m;
    EXPECT_LT(path, facets + 2e-3) << m;
  }
}

TEST(Geodesic, UnfoldsObtuseTriangles)
{
  // A plane of needles: sheared by 2.
  TriangleMesh plane = bsrtest::gridMesh(40, 40);
  for (Vec3& p : plane.Points)
  {
    p = Vec3(p.x() + 2.0 * p.y(), p.y(), 0.0) / 40.0;
  }
  const auto [distance, path] =
    errors(plane, 20 * 41 + 20, [](const Vec3& a, const Vec3& b) { return (a - b).norm(); });
  EXPECT_LT(distance, 0.02);
  EXPECT_LT(path, 0.05);
}

TEST(Geodesic, RunsRoundWhatIsSlow)
{
  const TriangleMesh plane = bsrtest::gridMesh(40, 40);
  const auto twin = halfEdgeTwins(plane);
  const FastMarching march(plane, *twin);
  std::vector<double> slow(plane.Points.size(), 1.0);
  for (std::size_t v = 0; v < slow.size(); ++v)
  {
    slow[v] = (plane.Points[v] - Vec3(20, 20, 0)).norm() < 8.0 ? 10.0 : 1.0;
  }
  const Index left = 20 * 41;
  const auto d = march.distances({left}, slow);
  const auto path = march.descend(d, left + 40);
  ASSERT_GT(path.size(), 2U);
  for (const EdgePoint& p : path)
  {
    EXPECT_GT((p.at(plane.Points) - Vec3(20, 20, 0)).norm(), 6.9);
  }
  // What it costs: around the disc at radius 8.
  const double exact = 2.0 * (std::sqrt(400.0 - 64.0) + 8.0 * std::asin(8.0 / 20.0));
  EXPECT_NEAR(d[left + 40], exact, 0.05 * exact);
}

TEST(Geodesic, LeavesWhatItDoesNotReach)
{
  TriangleMesh two = bsrtest::icosphere(1);
  const auto n = static_cast<Index>(two.Points.size());
  const TriangleMesh other = two;
  for (const Vec3& p : other.Points)
  {
    two.Points.push_back(p + Vec3(5, 0, 0));
  }
  for (const auto& t : other.Triangles)
  {
    two.Triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  const auto twin = halfEdgeTwins(two);
  const FastMarching march(two, *twin);
  const auto d = march.distances({0});
  EXPECT_FALSE(std::isfinite(d[n]));
  EXPECT_TRUE(march.descend(d, n).empty());
  EXPECT_TRUE(std::isfinite(d[n - 1]));
}
