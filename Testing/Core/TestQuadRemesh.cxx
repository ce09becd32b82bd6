#include "Layout/Attraction.h"
#include "Layout/QuadRemesh.h"
#include "LayoutTesting.h"
#include "ScanMeshes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>

namespace
{
using namespace bsr;
using bsrtest::remeshed;
using bsrtest::torusMesh;
using bsrtest::tubeMesh;

/// The tube closed by two flat caps, regions 1 and 2.
TriangleMesh cappedTube(int n, int m, bool regions)
{
  TriangleMesh mesh = tubeMesh(m, n);
  mesh.Region.assign(mesh.Triangles.size(), 0);
  for (int end = 0; end < 2; ++end)
  {
    const auto middle = static_cast<Index>(mesh.Points.size());
    mesh.Points.emplace_back(0.0, 0.0, 4.0 * end - 2.0);
    for (int j = 0; j < m; ++j)
    {
      const Index a = end * n * m + j;
      const Index b = end * n * m + (j + 1) % m;
      mesh.Triangles.push_back(
        end == 0 ? std::array<Index, 3>{middle, a, b} : std::array<Index, 3>{middle, b, a});
      mesh.Region.push_back(end + 1);
    }
  }
  if (!regions)
  {
    mesh.Region.clear();
  }
  return mesh;
}

Status failure(const TriangleMesh& mesh, const QuadRemeshOptions& options = {})
{
  Monitor monitor;
  return quadRemesh(mesh, options, monitor).status();
}

void expectSound(const QuadLayout& layout, int euler, int loops)
{
  EXPECT_TRUE(layout.Report.Valid) << layout.Report.Problem;
  EXPECT_EQ(layout.Report.Euler, euler);
  EXPECT_EQ(layout.Report.BoundaryLoops, loops);
  EXPECT_EQ(layout.Report.Flipped, 0);
  EXPECT_LE(layout.Report.MaxValence, 8);
}
} // namespace

TEST(QuadRemesh, TorusKeepsItsTopologyAndCount)
{
  for (int quads : {100, 250, 500, 1000})
  {
    const QuadLayout layout = remeshed(torusMesh(160, 60), quads);
    expectSound(layout, 0, 0);
    EXPECT_NEAR(layout.Mesh.Quads.size(), quads, 0.12 * quads);
    EXPECT_LT(layout.Distance.Maximum, 0.6);
  }
}

TEST(QuadRemesh, OpenTubeKeepsItsBoundaries)
{
  expectSound(remeshed(tubeMesh(60, 80), 200), 0, 2);
}

TEST(QuadRemesh, RegionBordersBecomeClosedRowsOfEdges)
{
  const QuadLayout layout = remeshed(cappedTube(80, 60, true), 300);
  expectSound(layout, 2, 0);
  for (Index region : {1, 2})
  {
    QuadMesh cap;
    std::vector<Index> map(layout.Mesh.Points.size(), -1);
    QuadMesh body = cap;
    for (std::size_t q = 0; q < layout.Mesh.Quads.size(); ++q)
    {
      if (layout.Mesh.Region[q] == region)
      {
        auto quad = layout.Mesh.Quads[q];
        for (Index& v : quad)
        {
          if (map[v] < 0)
          {
            map[v] = static_cast<Index>(cap.Points.size());
            cap.Points.push_back(layout.Mesh.Points[v]);
          }
          v = map[v];
        }
        cap.Quads.push_back(quad);
      }
    }
    const LayoutReport report = checkLayout(cap);
    EXPECT_TRUE(report.Valid) << report.Problem;
    EXPECT_EQ(report.Euler, 1);
    EXPECT_EQ(report.BoundaryLoops, 1);
    for (const Vec3& p : cap.Points)
    {
      EXPECT_NEAR(p.z(), region == 1 ? -2.0 : 2.0, 1e-9);
    }
  }
}

TEST(QuadRemesh, SeveralComponentsAllGetQuads)
{
  TriangleMesh mesh = torusMesh(100, 40);
  const auto base = static_cast<Index>(mesh.Points.size());
  const TriangleMesh other = cappedTube(40, 30, false);
  for (const Vec3& p : other.Points)
  {
    mesh.Points.emplace_back(0.3 * p + Vec3(20, 0, 0));
  }
  for (const auto& t : other.Triangles)
  {
    mesh.Triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  const QuadLayout layout = remeshed(mesh, 400);
  expectSound(layout, 2, 0);
  EXPECT_EQ(layout.Report.Components, 2);
}

TEST(QuadRemesh, MendsOrientationAndDuplicates)
{
  TriangleMesh mesh = torusMesh(60, 30);
  std::swap(mesh.Triangles[7][0], mesh.Triangles[7][1]);
  mesh.Triangles.push_back(mesh.Triangles[3]);
  mesh.Triangles.push_back({5, 5, 6});
  const QuadLayout layout = remeshed(mesh, 200);
  expectSound(layout, 0, 0);
  EXPECT_EQ(layout.Repairs.TurnedFaces, 1);
  EXPECT_EQ(layout.Repairs.DuplicateFaces, 1);
  EXPECT_EQ(layout.Repairs.DegenerateFaces, 1);
}

TEST(QuadRemesh, SizesFollowAnArray)
{
  const TriangleMesh mesh = torusMesh(160, 60);
  QuadRemeshOptions options;
  options.NumberOfQuads = 600;
  options.Sizing = QuadSizing::Array;
  for (const Vec3& p : mesh.Points)
  {
    options.SizeField.push_back(p.x() > 0.0 ? 1.0 : 2.0);
  }
  Monitor monitor;
  auto layout = quadRemesh(mesh, options, monitor);
  ASSERT_TRUE(layout) << layout.status().message();
  expectSound(*layout, 0, 0);
  int small = 0;
  for (const auto& q : layout->Mesh.Quads)
  {
    small += layout->Mesh.Points[q[0]].x() + layout->Mesh.Points[q[2]].x() > 0.0;
  }
  const auto all = static_cast<int>(layout->Mesh.Quads.size());
  EXPECT_NEAR(all, 600, 90);
  // A field without singular vertices can only shorten quads along the torus.
  EXPECT_GT(small, 1.5 * (all - small));
}

TEST(QuadRemesh, CurvatureSizingKeepsTheCount)
{
  QuadRemeshOptions options;
  options.NumberOfQuads = 400;
  options.Sizing = QuadSizing::Curvature;
  Monitor monitor;
  auto layout = quadRemesh(torusMesh(160, 60), options, monitor);
  ASSERT_TRUE(layout) << layout.status().message();
  expectSound(*layout, 0, 0);
  EXPECT_NEAR(layout->Mesh.Quads.size(), 400, 60);
}

TEST(QuadRemesh, SizeFieldMustFitTheMesh)
{
  QuadRemeshOptions options;
  options.Sizing = QuadSizing::Array;
  EXPECT_EQ(failure(torusMesh(20, 10), options).code(), StatusCode::InvalidParameter);
  options.SizeField.assign(200, 1.0);
  options.SizeField[5] = 0.0;
  EXPECT_EQ(failure(torusMesh(20, 10), options).code(), StatusCode::InvalidParameter);
}

TEST(QuadRemesh, RegionsOfAnyShapeKeepTheirBorders)
{
  // A belt around the axis of a torus, from its equator to its top: not a disc.
  TriangleMesh mesh = torusMesh(160, 60);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    mesh.Region.push_back(t < mesh.Triangles.size() / 4 ? 1 : 0);
  }
  const QuadLayout layout = remeshed(mesh, 400);
  expectSound(layout, 0, 0);
  std::map<std::pair<Index, Index>, std::vector<Index>> regionsAt;
  for (std::size_t q = 0; q < layout.Mesh.Quads.size(); ++q)
  {
    const auto& c = layout.Mesh.Quads[q];
    for (int k = 0; k < 4; ++k)
    {
      regionsAt[std::minmax(c[k], c[(k + 1) % 4])].push_back(layout.Mesh.Region[q]);
    }
  }
  int border = 0;
  for (const auto& [edge, regions] : regionsAt)
  {
    if (regions[0] != regions[1])
    {
      ++border;
      for (Index v : {edge.first, edge.second})
      {
        const Vec3& p = layout.Mesh.Points[v];
        EXPECT_LT(std::min(std::abs(p.z()), std::abs(std::hypot(p.x(), p.y()) - 3.0)), 0.02);
      }
    }
  }
  EXPECT_GE(border, 8);
}

TEST(QuadRemesh, RegionsThatTouchEachOtherAreNoCaps)
{
  // Eight discs that leave nothing else of the surface.
  TriangleMesh mesh = bsrtest::icosphere(4);
  for (const auto& t : mesh.Triangles)
  {
    const Vec3 p = mesh.Points[t[0]] + mesh.Points[t[1]] + mesh.Points[t[2]];
    mesh.Region.push_back(
      1 + (p.x() > 0.0 ? 1 : 0) + (p.y() > 0.0 ? 2 : 0) + (p.z() > 0.0 ? 4 : 0));
  }
  expectSound(remeshed(mesh, 100), 2, 0);
}

TEST(QuadRemesh, SpecksGetSixQuads)
{
  TriangleMesh mesh;
  for (int k = 0; k < 40; ++k)
  {
    const auto base = static_cast<Index>(mesh.Points.size());
    const TriangleMesh tube = cappedTube(6, 8, false);
    for (const Vec3& p : tube.Points)
    {
      mesh.Points.emplace_back(p + Vec3(5.0 * k, 0, 0));
    }
    for (const auto& t : tube.Triangles)
    {
      mesh.Triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    }
  }
  const QuadLayout layout = remeshed(mesh, 50);
  expectSound(layout, 80, 0);
  EXPECT_EQ(layout.Mesh.Quads.size(), 240U);
}

TEST(QuadRemesh, FewQuadsAreMetToo)
{
  for (int quads : {24, 50})
  {
    const QuadLayout layout = remeshed(cappedTube(80, 60, false), quads);
    expectSound(layout, 2, 0);
    EXPECT_NEAR(layout.Mesh.Quads.size(), quads, 0.1 * quads + 0.5);
  }
}

TEST(QuadRemesh, FitRelaxationHalvesTheDistance)
{
  QuadRemeshOptions options;
  options.NumberOfQuads = 200;
  Monitor monitor;
  options.FitRelaxation = false;
  auto on = quadRemesh(torusMesh(160, 60), options, monitor);
  options.FitRelaxation = true;
  auto fitted = quadRemesh(torusMesh(160, 60), options, monitor);
  ASSERT_TRUE(on && fitted);
  expectSound(*fitted, 0, 0);
  EXPECT_EQ(fitted->Mesh.Quads, on->Mesh.Quads);
  EXPECT_LT(fitted->Distance.Mean, 0.7 * on->Distance.Mean);
  EXPECT_LT(fitted->Distance.Maximum, on->Distance.Maximum);
}

TEST(QuadRemesh, TheSurfaceDrawsPointsThatSlippedOff)
{
  QuadMesh square;
  square.Points = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  square.Quads = {{0, 1, 2, 3}};
  square.Region = {0};
  std::vector<SurfaceSample> samples;
  for (int i = 0; i < 100; ++i)
  {
    samples.push_back({Vec3(0.05 + 0.1 * (i % 10), 0.05 + 0.1 * (i / 10), 0), Vec3(0, 0, 1)});
  }
  Monitor monitor;
  std::vector<Index> quads;
  for (const Vec3& pull : attraction(square, samples, quads, monitor))
  {
    EXPECT_LT(pull.norm(), 1e-12);
  }
  // The surface goes on by half a side behind points 2 and 3, and has another side.
  for (int i = 0; i < 50; ++i)
  {
    const Vec3 p(0.05 + 0.1 * (i % 10), 1.05 + 0.1 * (i / 10), 0);
    samples.push_back({p, Vec3(0, 0, 1)});
    samples.push_back({p - Vec3(0, 3, 0.2), Vec3(0, 0, -1)});
  }
  const std::vector<Vec3> pull = attraction(square, samples, quads, monitor);
  EXPECT_LT(pull[0].norm() + pull[1].norm(), 1e-12);
  EXPECT_GT(pull[2].y(), 0.1);
  EXPECT_GT(pull[3].y(), 0.1);
}

TEST(QuadRemesh, PointsStayOnTheirSideOfAThinWall)
{
  // Sheets at z = 0 and z = 0.1, which face away from each other.
  const TriangleTree tree({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 0.1),
                            Vec3(1, 0, 0.1), Vec3(0, 1, 0.1)},
    {{0, 2, 1}, {3, 4, 5}});
  const Vec3 p(0.3, 0.3, 0.02);
  EXPECT_EQ(tree.nearest(p).Triangle, 0);
  EXPECT_EQ(tree.nearestFacing(p, Vec3(0, 0, 1), 1.0).Triangle, 1);
  EXPECT_EQ(tree.nearestFacing(p, Vec3(0, 0, -1), 1.0).Triangle, 0);
  EXPECT_EQ(tree.nearestFacing(p, Vec3(0, 0, 1), 0.05).Triangle, 0); // none so near: any
  EXPECT_EQ(tree.nearestFacing(p, Vec3(1, 0, 0), 1.0).Triangle, 0);
}

TEST(QuadRemesh, IsDeterministic)
{
  const QuadLayout a = remeshed(torusMesh(100, 40), 300);
  const QuadLayout b = remeshed(torusMesh(100, 40), 300);
  ASSERT_EQ(a.Mesh.Quads, b.Mesh.Quads);
  EXPECT_EQ(a.Mesh.Points, b.Mesh.Points);
}

TEST(QuadRemesh, BadInputIsOneClearError)
{
  EXPECT_EQ(failure({}).code(), StatusCode::InvalidInput);
  TriangleMesh nan = torusMesh(10, 10);
  nan.Points[3].x() = std::nan("");
  EXPECT_EQ(failure(nan).code(), StatusCode::InvalidInput);
  TriangleMesh moebius;
  for (Index i = 0; i < 20; ++i)
  {
    const double u = 2.0 * M_PI * i / 20.0;
    for (double w : {-0.3, 0.3})
    {
      const double r = 1.0 + w * std::cos(0.5 * u);
      moebius.Points.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(0.5 * u));
    }
    const Index a = 2 * i;
    const Index c = i < 19 ? a + 2 : 1;
    const Index d = i < 19 ? a + 3 : 0;
    moebius.Triangles.push_back({a, c, d});
    moebius.Triangles.push_back({a, d, a + 1});
  }
  EXPECT_EQ(failure(moebius).code(), StatusCode::InvalidInput);
  TriangleMesh flat = torusMesh(10, 10);
  for (Vec3& p : flat.Points)
  {
    p = Vec3::Ones();
  }
  EXPECT_EQ(failure(flat).code(), StatusCode::InvalidInput);
  TriangleMesh far = torusMesh(10, 10);
  far.Triangles[0][0] = 1000000;
  EXPECT_EQ(failure(far).code(), StatusCode::InvalidInput);
  QuadRemeshOptions options;
  options.NumberOfQuads = 0;
  EXPECT_EQ(failure(torusMesh(10, 10), options).code(), StatusCode::InvalidParameter);
}

TEST(QuadRemesh, CanBeCancelledAnywhere)
{
  struct Stop : Monitor
  {
    explicit Stop(long left) : Left(left) {}
    bool cancelled() override { return --this->Left < 0; }
    long Left;
  };
  constexpr long many = 1000000;
  Stop never(many);
  ASSERT_TRUE(quadRemesh(torusMesh(100, 40), {}, never));
  const long calls = many - never.Left;
  EXPECT_GT(calls, 50);
  for (long i = 0; i < 10; ++i)
  {
    Stop stop(i * calls / 10);
    auto layout = quadRemesh(torusMesh(100, 40), {}, stop);
    EXPECT_EQ(layout.status().code(), StatusCode::Cancelled) << i;
  }
}

TEST(QuadRemesh, AsksForCancellationOften)
{
  // Processor time of the calling thread, which other programs do not lengthen; 0.2 s is meant, the
  // bound leaves room for slow machines.
  struct Watch : Monitor
  {
    static double now()
    {
      timespec t{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
      return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    bool cancelled() override
    {
      const double t = now();
      this->Longest = std::max(this->Longest, t - this->Last);
      this->Last = t;
      return false;
    }
    void progress(double share) override
    {
      EXPECT_GE(share, this->Share - 1e-9);
      EXPECT_LE(share, 1.0 + 1e-9);
      this->Share = share;
    }
    double Last = now();
    double Longest = 0.0;
    double Share = 0.0;
  } watch;
  QuadRemeshOptions options;
  options.NumberOfQuads = 300;
  ASSERT_TRUE(quadRemesh(torusMesh(400, 250), options, watch));
  EXPECT_LT(watch.Longest, 0.8);
  RecordProperty("LongestSilence", std::to_string(watch.Longest));
  EXPECT_GT(watch.Share, 0.9);
}

TEST(QuadRemesh, ThreadsLeaveNoTrace)
{
  const QuadLayout a = remeshed(torusMesh(400, 150), 200);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const QuadLayout b = remeshed(torusMesh(400, 150), 200);
  ASSERT_EQ(a.Mesh.Quads, b.Mesh.Quads);
  EXPECT_EQ(a.Mesh.Points, b.Mesh.Points);
}

TEST(QuadRemesh, UnitsDoNotMatter)
{
  TriangleMesh mesh = torusMesh(80, 30);
  const QuadLayout one = remeshed(mesh, 150);
  for (const double scale : {std::ldexp(1.0, -30), std::ldexp(1.0, 30)})
  {
    TriangleMesh scaled = mesh;
    for (Vec3& p : scaled.Points)
    {
      p = scale * p;
    }
    const QuadLayout other = remeshed(scaled, 150);
    expectSound(other, 0, 0);
    EXPECT_EQ(one.Mesh.Quads.size(), other.Mesh.Quads.size());
  }
  for (Vec3& p : mesh.Points)
  {
    p += Vec3(1e6, -2e6, 3e6);
  }
  expectSound(remeshed(mesh, 150), 0, 0);
}

TEST(QuadRemesh, CancelsWithoutOutput)
{
  struct Stop : Monitor
  {
    bool cancelled() override { return true; }
  } stop;
  auto layout = quadRemesh(torusMesh(100, 40), {}, stop);
  EXPECT_EQ(layout.status().code(), StatusCode::Cancelled);
}
