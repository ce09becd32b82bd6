#include "Mesh/BuildSurface.h"
#include "Mesh/Decimate.h"
#include "Mesh/TriangleTree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

namespace
{
using namespace bsr;

/// The surface of an axis-aligned box, 12 triangles, appended to `mesh`.
void addBox(TriangleMesh& mesh, const Vec3& low, const Vec3& high)
{
  const auto base = static_cast<Index>(mesh.Points.size());
  for (int i = 0; i < 8; ++i)
  {
    mesh.Points.emplace_back(
      i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
  }
  const std::array<std::array<Index, 4>, 6> sides = {
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& s : sides)
  {
    mesh.Triangles.push_back({base + s[0], base + s[1], base + s[2]});
    mesh.Triangles.push_back({base + s[0], base + s[2], base + s[3]});
  }
}

/// Names the same place by the same point.
void weld(TriangleMesh& mesh)
{
  for (auto& t : mesh.Triangles)
  {
    for (Index& v : t)
    {
      for (Index w = 0; w < v; ++w)
      {
        if (mesh.Points[w] == mesh.Points[v])
        {
          v = w;
          break;
        }
      }
    }
  }
}

std::vector<TriangleSurface> built(
  const TriangleMesh& mesh, RepairReport& report, const BuildSurfaceOptions& options = {})
{
  Monitor monitor;
  auto s = buildSurfaces(mesh, options, report, monitor);
  EXPECT_TRUE(s) << s.status().message();
  return s ? std::move(*s) : std::vector<TriangleSurface>{};
}

/// Every half-edge has a twin that runs the other way, every vertex one fan.
void expectManifold(const TriangleSurface& s)
{
  std::vector<int> corners(s.Points.size(), 0);
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    ASSERT_GE(s.Opposite[h], 0);
    EXPECT_EQ(s.Opposite[s.Opposite[h]], h);
    EXPECT_EQ(s.start(s.Opposite[h]), s.end(h));
    EXPECT_EQ(s.end(s.Opposite[h]), s.start(h));
    ++corners[s.start(h)];
  }
  for (Index v = 0; v < s.vertices(); ++v)
  {
    EXPECT_EQ(s.valence(v), corners[v]);
  }
}

TriangleMesh bumpyTorus(int n, int m)
{
  TriangleMesh mesh;
  std::mt19937 random(7);
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < m; ++j)
    {
      const double u = 2.0 * M_PI * i / n;
      const double v = 2.0 * M_PI * j / m;
      const double noise = 2e-4 * (static_cast<double>(random()) / 4294967295.0 - 0.5);
      const double r = 1.0 + 0.1 * std::sin(5.0 * u) + noise;
      mesh.Points.emplace_back((3.0 + r * std::cos(v)) * std::cos(u),
        (3.0 + r * std::cos(v)) * std::sin(u), r * std::sin(v));
      const Index a = i * m + j;
      const Index b = i * m + (j + 1) % m;
      const Index c = (i + 1) % n * m + j;
      const Index d = (i + 1) % n * m + (j + 1) % m;
      mesh.Triangles.push_back({a, c, d});
      mesh.Triangles.push_back({a, d, b});
    }
  }
  return mesh;
}
} // namespace

TEST(MeshRepair, BoxesThatTouchAlongAnEdgeComeApart)
{
  TriangleMesh mesh;
  addBox(mesh, Vec3(0, 0, 0), Vec3(1, 1, 1));
  addBox(mesh, Vec3(1, 1, 0), Vec3(2, 2, 1));
  weld(mesh);
  RepairReport report;
  const auto s = built(mesh, report);
  ASSERT_EQ(s.size(), 2U);
  for (const TriangleSurface& one : s)
  {
    expectManifold(one);
    EXPECT_EQ(one.eulerCharacteristic(), 2);
    EXPECT_NEAR(one.area(), 6.0, 1e-12);
  }
  EXPECT_EQ(report.CutEdges, 1);
  EXPECT_EQ(report.TurnedFaces, 0);
  EXPECT_EQ(report.BoundaryLoops, 0);
  EXPECT_EQ(std::count_if(report.Faces.begin(), report.Faces.end(),
              [](std::uint8_t f) { return (f & RepairCut) != 0; }),
    4);
}

TEST(MeshRepair, FinIsCutOff)
{
  TriangleMesh mesh;
  addBox(mesh, Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.Points.emplace_back(0.5, 0.5, 2.0);
  mesh.Triangles.push_back({4, 7, 8}); // on the diagonal of the top
  RepairReport report;
  const auto s = built(mesh, report);
  ASSERT_EQ(s.size(), 2U);
  expectManifold(s[0]);
  expectManifold(s[1]);
  EXPECT_EQ(s[0].eulerCharacteristic(), 2);
  EXPECT_EQ(s[1].eulerCharacteristic(), 1);
  EXPECT_EQ(report.BoundaryLoops, 1);
}

TEST(MeshRepair, SoupOfTrianglesIsSewn)
{
  TriangleMesh box;
  addBox(box, Vec3(0, 0, 0), Vec3(1, 2, 3));
  TriangleMesh soup;
  std::mt19937 random(3);
  for (auto t : box.Triangles)
  {
    if (random() % 2 == 0)
    {
      std::swap(t[0], t[1]);
    }
    const auto base = static_cast<Index>(soup.Points.size());
    for (Index v : t)
    {
      soup.Points.push_back(box.Points[v] + 1e-9 * Vec3::Constant(random() % 3));
    }
    soup.Triangles.push_back({base, base + 1, base + 2});
  }
  soup.Points.emplace_back(std::nan(""), 0.0, 0.0); // no face uses it
  RepairReport report;
  const auto s = built(soup, report);
  ASSERT_EQ(s.size(), 1U);
  expectManifold(s[0]);
  EXPECT_EQ(s[0].eulerCharacteristic(), 2);
  EXPECT_EQ(report.MergedPoints, 28);
  EXPECT_GT(report.TurnedFaces, 0);
  EXPECT_LE(report.TurnedFaces, 6); // the greater part decides
}

TEST(MeshRepair, SpecksAreDroppedWhenAsked)
{
  TriangleMesh mesh;
  addBox(mesh, Vec3(0, 0, 0), Vec3(1, 1, 1));
  addBox(mesh, Vec3(3, 0, 0), Vec3(3.01, 0.01, 0.01));
  const auto base = static_cast<Index>(mesh.Points.size());
  for (int i = 0; i < 3; ++i)
  {
    mesh.Points.emplace_back(5.0 + i, 0, 0);
  }
  mesh.Triangles.push_back({base, base + 1, base + 2}); // without area
  RepairReport report;
  EXPECT_EQ(built(mesh, report).size(), 2U);
  EXPECT_EQ(report.Specks, 1);
  report = {};
  BuildSurfaceOptions options;
  options.SmallestShare = 1e-3;
  EXPECT_EQ(built(mesh, report, options).size(), 1U);
  EXPECT_EQ(report.Specks, 2);
  EXPECT_EQ(report.Faces[12], RepairSpeck);
  EXPECT_EQ(report.Faces[24], RepairSpeck);
  EXPECT_EQ(report.Faces[0], 0);
}

TEST(Decimate, LargeSurfaceKeepsTopologyAndPlace)
{
  const TriangleMesh mesh = bumpyTorus(500, 200);
  RepairReport report;
  auto s = built(mesh, report);
  ASSERT_EQ(s.size(), 1U);
  DecimateOptions options;
  options.Target = 10000;
  options.Most = 30000;
  options.MaximumError = 0.002;
  Monitor monitor;
  ASSERT_TRUE(decimate(s[0], options, monitor));
  expectManifold(s[0]);
  EXPECT_EQ(s[0].eulerCharacteristic(), 0);
  EXPECT_LE(s[0].aliveFaces(), 15000);
  const TriangleMesh small = s[0].toMesh();
  const TriangleTree tree(small.Points, small.Triangles);
  double worst = 0.0;
  for (std::size_t i = 0; i < mesh.Points.size(); i += 7)
  {
    worst = std::max(worst, tree.nearest(mesh.Points[i]).SquaredDistance);
  }
  EXPECT_LT(std::sqrt(worst), 3.0 * options.MaximumError);
}

/// Says yes from a question on.
struct StopAfter : Monitor
{
  explicit StopAfter(long most) : Most(most) {}
  bool cancelled() override { return ++this->Asked > this->Most; }
  long Most;
  long Asked = 0;
};

TEST(MeshRepair, AsksInProportionToItsWork)
{
  // With one thread all questions are asked where they are counted.
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  constexpr long many = 1000000;
  const auto asked = [](const TriangleMesh& mesh, long most)
  {
    RepairReport report;
    StopAfter monitor(most);
    const auto surfaces = buildSurfaces(mesh, {}, report, monitor);
    EXPECT_EQ(surfaces.status().code(), most < many ? StatusCode::Cancelled : StatusCode::Ok);
    return monitor.Asked;
  };
  const TriangleMesh mesh = bumpyTorus(500, 300);
  const long all = asked(mesh, many);
  EXPECT_GT(all, 2 * asked(bumpyTorus(250, 150), many));
  EXPECT_GT(all, 3 * 900000 / 65536); // half-edges are gone through three times
  for (long i = 0; i < 5; ++i)
  {
    const long most = i * all / 5;
    EXPECT_LE(asked(mesh, most), most + 4) << i; // no work is done after the answer
  }
}

TEST(TriangleTree, IsRightHoweverEarlyItIsCancelled)
{
  const TriangleMesh mesh = bumpyTorus(200, 100);
  const TriangleTree whole(mesh.Points, mesh.Triangles);
  StopAfter never(1000000);
  const TriangleTree asking(mesh.Points, mesh.Triangles, never);
  EXPECT_GE(never.Asked, 2 * 40000 / 4096 - 8);
  for (long most : {0, 1, 5})
  {
    StopAfter monitor(most);
    const TriangleTree tree(mesh.Points, mesh.Triangles, monitor);
    for (std::size_t i = 0; i < mesh.Points.size(); i += 997)
    {
      const Vec3 p = 1.1 * mesh.Points[i] + Vec3(0.1, 0.2, 0.3);
      EXPECT_EQ(tree.nearest(p).SquaredDistance, whole.nearest(p).SquaredDistance);
    }
  }
}

TEST(Decimate, IsDeterministicAndCanBeCancelled)
{
  RepairReport report;
  auto a = built(bumpyTorus(400, 160), report);
  auto b = a;
  auto c = a;
  DecimateOptions options;
  options.Target = 5000;
  Monitor monitor;
  ASSERT_TRUE(decimate(a[0], options, monitor));
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    ASSERT_TRUE(decimate(b[0], options, monitor));
  }
  EXPECT_EQ(a[0].Vertex, b[0].Vertex);
  EXPECT_EQ(a[0].Points, b[0].Points);
  struct Stop : Monitor
  {
    int Left = 3;
    bool cancelled() override { return --this->Left < 0; }
  } stop;
  EXPECT_EQ(decimate(c[0], options, stop).code(), StatusCode::Cancelled);
}
