#include "ScanMeshes.h"

#include "Mesh/FillHoles.h"
#include "Mesh/ImplicitSurface.h"
#include "Mesh/LoopTriangulation.h"

#include <gtest/gtest.h>

#include <set>

using namespace bsr;
using bsrtest::euler;
using bsrtest::icosphere;
using bsrtest::torusMesh;
using bsrtest::without;

namespace
{
/// Points and triangles of the input come first, unchanged.
void expectUntouched(const TriangleMesh& input, const FilledMesh& out)
{
  ASSERT_GE(out.Mesh.Points.size(), input.Points.size());
  ASSERT_GE(out.Mesh.Triangles.size(), input.Triangles.size());
  EXPECT_TRUE(std::equal(input.Points.begin(), input.Points.end(), out.Mesh.Points.begin()));
  EXPECT_TRUE(
    std::equal(input.Triangles.begin(), input.Triangles.end(), out.Mesh.Triangles.begin()));
  EXPECT_EQ(out.NearPoint.size(), out.Mesh.Points.size() - input.Points.size());
}

FilledMesh filled(const TriangleMesh& mesh, double size, bool keepEnds = false)
{
  FillHolesOptions o;
  o.MaximumSize = size;
  o.KeepCutEnds = keepEnds;
  Monitor quiet;
  auto out = fillHoles(mesh, o, quiet);
  EXPECT_TRUE(out.isOk()) << out.status().message();
  return out.isOk() ? std::move(*out) : FilledMesh{};
}
} // namespace

TEST(FillHoles, CapsOfASphereAreFilledBySphere)
{
  const TriangleMesh sphere = icosphere(4);
  // Of the last one only a band is left: the surface goes on over more than it is known on.
  const std::vector<std::pair<double, double>> cases = {{0.9, 8e-3}, {0.6, 8e-3}, {0.2, 0.06}};
  for (const auto& [height, tolerance] : cases)
  {
    const double h0 = height;
    const TriangleMesh cut =
      without(sphere, [&](const Vec3& p) { return p.z() > h0 || p.z() < -h0 - 0.05; });
    const FilledMesh out = filled(cut, 1.0);
    expectUntouched(cut, out);
    EXPECT_EQ(out.filled(), 2);
    EXPECT_EQ(euler(out.Mesh), 2);
    EXPECT_TRUE(boundaryLoops(out.Mesh)->empty());
    double worst = 0.0;
    for (std::size_t i = cut.Points.size(); i < out.Mesh.Points.size(); ++i)
    {
      worst = std::max(worst, std::abs(out.Mesh.Points[i].norm() - 1.0));
    }
    EXPECT_LT(worst, tolerance) << height;
    for (const HoleReport& h : out.Holes)
    {
      EXPECT_EQ(h.State, HoleState::Filled);
    }
    // The density of the scan is kept: as many triangles as were cut out, about.
    const double added = static_cast<double>(out.Mesh.Triangles.size() - cut.Triangles.size());
    const double missing = static_cast<double>(sphere.Triangles.size() - cut.Triangles.size());
    EXPECT_GT(added, 0.6 * missing) << height;
    EXPECT_LT(added, 1.7 * missing) << height;
  }
}

TEST(FillHoles, ATorusKeepsItsHandle)
{
  const TriangleMesh torus = torusMesh(96, 48);
  const TriangleMesh cut =
    without(torus, [](const Vec3& p) { return (p - Vec3(3.7, 0, 0.7)).norm() < 0.5; });
  const FilledMesh out = filled(cut, 0.5);
  expectUntouched(cut, out);
  EXPECT_EQ(euler(out.Mesh), 0);
  double worst = 0.0;
  for (std::size_t i = cut.Points.size(); i < out.Mesh.Points.size(); ++i)
  {
    const Vec3& p = out.Mesh.Points[i];
    worst = std::max(worst, std::abs(std::hypot(std::hypot(p.x(), p.y()) - 3.0, p.z()) - 1.0));
  }
  EXPECT_LT(worst, 0.01);
}

TEST(FillHoles, LargeHolesAndCutEndsStay)
{
  const TriangleMesh sphere = icosphere(4);
  const TriangleMesh cut =
    without(sphere, [](const Vec3& p) { return p.z() > 0.95 || p.z() < -0.5; });
  const FilledMesh out = filled(cut, 0.25);
  expectUntouched(cut, out);
  ASSERT_EQ(out.Holes.size(), 2U);
  EXPECT_EQ(out.filled(), 1);
  EXPECT_EQ(boundaryLoops(out.Mesh)->size(), 1U);
  const bool firstIsSmall = out.Holes[0].Size < out.Holes[1].Size;
  EXPECT_EQ(out.Holes[firstIsSmall ? 1 : 0].State, HoleState::TooLarge);

  // A tube: both ends are planar, and the wall rises from their planes.
  const TriangleMesh tube = bsrtest::tubeMesh(48, 60);
  EXPECT_EQ(filled(tube, 1.0, true).filled(), 0);
  EXPECT_EQ(filled(tube, 1.0, true).Holes[0].State, HoleState::CutEnd);
  const FilledMesh closed = filled(tube, 1.0, false);
  EXPECT_EQ(closed.filled(), 2);
  EXPECT_EQ(euler(closed.Mesh), 2);
}

TEST(FillHoles, BoundariesThatTouchInAPointAreTwoHoles)
{
  TriangleMesh plane = bsrtest::gridMesh(8, 8);
  // Two squares that share a corner, diagonally.
  const auto gone = [](const Vec3& p)
  {
    return (p.x() > 2 && p.x() < 4 && p.y() > 2 && p.y() < 4) ||
           (p.x() > 4 && p.x() < 6 && p.y() > 4 && p.y() < 6);
  };
  const TriangleMesh cut = without(plane, gone);
  const auto loops = boundaryLoops(cut);
  ASSERT_TRUE(loops.isOk());
  ASSERT_EQ(loops->size(), 3U);
  for (const BoundaryLoop& l : *loops)
  {
    const std::set<Index> once(l.Points.begin(), l.Points.end());
    EXPECT_EQ(once.size(), l.Points.size());
  }
  const FilledMesh out = filled(cut, 0.4);
  EXPECT_EQ(out.filled(), 2);
  EXPECT_EQ(boundaryLoops(out.Mesh)->size(), 1U);
}

TEST(FillHoles, BadInputIsNamed)
{
  Monitor quiet;
  const auto message = [&](const TriangleMesh& m, double size = 0.1)
  {
    FillHolesOptions o;
    o.MaximumSize = size;
    const auto r = fillHoles(m, o, quiet);
    return r.isOk() ? std::string() : r.status().message();
  };
  EXPECT_NE(message({}).find("no triangles"), std::string::npos);
  TriangleMesh m = icosphere(1);
  EXPECT_NE(message(m, -1.0).find("MaximumHoleSize"), std::string::npos);
  EXPECT_NE(message(m, NAN).find("MaximumHoleSize"), std::string::npos);
  TriangleMesh turned = m;
  std::swap(turned.Triangles[0][0], turned.Triangles[0][1]);
  EXPECT_NE(message(turned).find("oriented"), std::string::npos);
  TriangleMesh fin = m;
  fin.Points.emplace_back(0, 0, 3);
  fin.Triangles.push_back(
    {m.Triangles[0][0], m.Triangles[0][1], static_cast<Index>(m.Points.size())});
  EXPECT_NE(message(fin).find("edge"), std::string::npos);
  TriangleMesh nan = m;
  nan.Points[0].x() = NAN;
  EXPECT_NE(message(nan).find("NaN"), std::string::npos);
  TriangleMesh outside = m;
  outside.Triangles[0][0] = 100000;
  EXPECT_NE(message(outside).find("does not exist"), std::string::npos);
}

TEST(FillHoles, AClosedMeshIsReturnedAsItIs)
{
  const TriangleMesh sphere = icosphere(2);
  const FilledMesh out = filled(sphere, 1.0);
  EXPECT_TRUE(out.Holes.empty());
  EXPECT_EQ(out.Mesh.Triangles.size(), sphere.Triangles.size());
}

TEST(ImplicitSurface, IsTheDistanceOfASphereNearIt)
{
  const TriangleMesh sphere = icosphere(2);
  const auto f = ImplicitSurface::fit(sphere.Points, sphere.Points, 0.05);
  ASSERT_TRUE(f.isOk());
  const TriangleMesh fine = icosphere(4);
  for (const Vec3& p : fine.Points)
  {
    EXPECT_NEAR(f->at(p).F, 0.0, 2e-3);
    EXPECT_NEAR(f->at(p).Gradient.dot(p), 1.0, 5e-2);
    EXPECT_NEAR(f->at(1.03 * p).F, 0.03, 3e-3);
  }
}

TEST(TriangulateLoop, HasLeastAreaAndAvoidsChords)
{
  const std::vector<Vec3> square = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  const auto chord = [](Index a, Index b) { return std::minmax(a, b) == std::minmax(0, 2); };
  const auto t = triangulateLoop(square, chord);
  ASSERT_EQ(t.size(), 2U);
  for (const auto& x : t)
  {
    EXPECT_FALSE(std::count(x.begin(), x.end(), 0) && std::count(x.begin(), x.end(), 2));
  }
  EXPECT_TRUE(triangulateLoop(square, [](Index, Index) { return true; }).empty());
  std::vector<Vec3> circle;
  for (int i = 0; i < 1000; ++i)
  {
    circle.emplace_back(std::cos(2 * M_PI * i / 1000), std::sin(2 * M_PI * i / 1000), 0.0);
  }
  double area = 0.0;
  const auto all = triangulateLoop(circle, {});
  EXPECT_EQ(all.size(), 998U);
  for (const auto& x : all)
  {
    area += 0.5 * (circle[x[1]] - circle[x[0]]).cross(circle[x[2]] - circle[x[0]]).z();
  }
  EXPECT_NEAR(area, M_PI, 1e-3);
}
