// Layouts brought down to where their vertices have all the edges that are allowed.
#include "Layout/AnnealCoarsener.h"
#include "Layout/ApproachLayout.h"
#include "Layout/PairTriangles.h"
#include "Layout/QuadRemesh.h"
#include "Layout/RelaxLayout.h"
#include "Mesh/BuildSurface.h"
#include "PolygonTopology.h"
#include "Tunnels.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

using namespace bsr;
using bsr::coarsening::AnnealCoarsener;

namespace
{
constexpr double LeastShape = 0.03;

/// A surface and a fine layout of it.
class Annealing
{
public:
  explicit Annealing(const TriangleMesh& mesh)
  {
    RepairReport repairs;
    Monitor monitor;
    auto surfaces = buildSurfaces(mesh, {}, repairs, monitor);
    EXPECT_TRUE(surfaces);
    this->Surface = surfaces->front();
    this->Reference = ReferenceSurface(this->Surface);
    this->Fine = pairTriangles(this->Surface);
    this->Options.Side = [](const Vec3&) { return 1.0; };
  }

  AnnealCoarsener coarsener(const LayoutDraft& draft) const
  {
    Monitor monitor;
    return {draft, this->Reference, this->Options, {LeastShape, 1e9, -5.0, 1e9}, 1.0, monitor};
  }

  /// The layout that annealing leads to.
  LayoutDraft annealed(int target) const
  {
    AnnealCoarsener coarsener = this->coarsener(this->Fine);
    Monitor monitor;
    EXPECT_TRUE(coarsener.annealTo(target, monitor));
    LayoutDraft draft = coarsener.draft();
    EXPECT_EQ(static_cast<int>(draft.Mesh.Quads.size()), coarsener.count());
    return draft;
  }

  TriangleSurface Surface;
  ReferenceSurface Reference;
  LayoutDraft Fine;
  CoarsenOptions Options;
};

void expectSound(const LayoutDraft& draft, int euler, int loops)
{
  EXPECT_EQ(bsrtest::layoutProblem(draft.Mesh), "");
  const LayoutReport report = checkLayout(draft.Mesh);
  EXPECT_TRUE(report.Valid) << report.Problem;
  EXPECT_EQ(report.Euler, euler);
  EXPECT_EQ(report.BoundaryLoops, loops);
  EXPECT_EQ(report.Components, 1);
  EXPECT_LE(report.MaxValence, 8);
  EXPECT_GE(report.MinJacobian, LeastShape);
}

class Cancelled : public Monitor
{
public:
  bool cancelled() override { return true; }
};
} // namespace

/// A layout near its limit, as it is before it is taken closer to the surface.
class Approaching : public Annealing
{
public:
  Approaching(const TriangleMesh& mesh, int quads) : Annealing(mesh)
  {
    this->Reference.Samples = surfaceSamples(this->Surface, 400 + 12 * quads);
    this->Side = std::sqrt(this->Surface.area() / quads);
    this->Options.Quads = quads;
    this->Options.Side = [side = this->Side](const Vec3&) { return side; };
    this->Before = this->annealed(quads);
    Monitor monitor;
    EXPECT_TRUE(relaxLayout(this->Before, this->Reference, 40, monitor));
  }

  LayoutDraft approached() const
  {
    LayoutDraft draft = this->Before;
    Monitor monitor;
    ApproachReport report;
    EXPECT_TRUE(approachLayout(draft, this->Reference, this->Options, monitor, &report));
    EXPECT_LT(report.After, 0.9 * report.Before);
    return draft;
  }

  /// In sides of quads.
  LayoutDistance distance(const LayoutDraft& draft) const
  {
    Monitor monitor;
    LayoutDistance d = layoutDistance(draft.Mesh, this->Surface, this->Reference, {}, monitor);
    d.Maximum /= this->Side;
    d.Mean /= this->Side;
    return d;
  }

  /// Share of the quads that look away from the surface at their corners.
  double away(const LayoutDraft& draft) const
  {
    int count = 0;
    const auto& p = draft.Mesh.Points;
    for (const auto& q : draft.Mesh.Quads)
    {
      Vec3 normal = Vec3::Zero();
      for (const Index v : q)
      {
        normal += this->Reference.Faces.normal(this->Reference.Faces.nearest(p[v]).Triangle);
      }
      count += (p[q[2]] - p[q[0]]).cross(p[q[3]] - p[q[1]]).dot(normal) < 0.0 ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(draft.Mesh.Quads.size());
  }

  LayoutDraft Before;
  double Side = 1.0;
};

TEST(AnnealCoarsener, SaturatesVertices)
{
  const Annealing annealing(bsrtest::tunnels(2));
  const int least = leastQuads(-16, 0);
  const LayoutDraft draft = annealing.annealed(least);
  expectSound(draft, -16, 0);
  EXPECT_LE(static_cast<double>(draft.Mesh.Quads.size()), 1.1 * least);
}

TEST(AnnealCoarsener, StopsAtTheCount)
{
  const Annealing annealing(bsrtest::tunnels(2));
  const LayoutDraft draft = annealing.annealed(60);
  expectSound(draft, -16, 0);
  // The last collapse may close a vertex of two quads besides.
  EXPECT_LE(draft.Mesh.Quads.size(), 60U);
  EXPECT_GE(draft.Mesh.Quads.size(), 58U);
}

TEST(AnnealCoarsener, BoundariesLoseVertices)
{
  const Annealing annealing(bsrtest::openTunnels(2));
  const LayoutDraft draft = annealing.annealed(leastQuads(-18, 2));
  expectSound(draft, -18, 2);
  // Of each loop's 64 vertices a few are left, on the boundary of the surface.
  EXPECT_LE(draft.Creases.size(), 32U);
  for (const auto& edge : draft.Creases)
  {
    for (const Index v : edge)
    {
      EXPECT_EQ(draft.Kind[v], VertexKind::Crease);
      EXPECT_LT(annealing.Reference.Creases.nearest(draft.Mesh.Points[v]).SquaredDistance, 1e-18);
    }
  }
}

TEST(AnnealCoarsener, SameEachTime)
{
  const Annealing annealing(bsrtest::openTunnels(2));
  const LayoutDraft a = annealing.annealed(40);
  const LayoutDraft b = annealing.annealed(40);
  EXPECT_EQ(a.Mesh.Quads, b.Mesh.Quads);
  EXPECT_EQ(a.Mesh.Points, b.Mesh.Points);
}

TEST(AnnealCoarsener, ImprovesShapes)
{
  const Annealing annealing(bsrtest::tunnels(2));
  const LayoutDraft before = annealing.annealed(50);
  AnnealCoarsener coarsener = annealing.coarsener(before);
  Monitor monitor;
  EXPECT_TRUE(coarsener.improve(monitor));
  const LayoutDraft after = coarsener.draft();
  expectSound(after, -16, 0);
  EXPECT_EQ(after.Mesh.Quads.size(), before.Mesh.Quads.size());
  EXPECT_GT(checkLayout(after.Mesh).MeanJacobian, checkLayout(before.Mesh).MeanJacobian + 0.05);
}

TEST(AnnealCoarsener, IsCancelled)
{
  const Annealing annealing(bsrtest::tunnels(2));
  AnnealCoarsener coarsener = annealing.coarsener(annealing.Fine);
  Cancelled monitor;
  EXPECT_FALSE(coarsener.annealTo(40, monitor));
  EXPECT_FALSE(coarsener.improve(monitor));
}

TEST(AnnealCoarsener, AsksWhileSamplesFindTheirQuads)
{
  // With one thread all questions are asked where they are counted.
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  Annealing annealing(bsrtest::tunnels(2));
  annealing.Reference.Samples = surfaceSamples(annealing.Surface, 5000);
  const auto asked = [&](long most)
  {
    struct Count : Monitor
    {
      explicit Count(long most) : Most(most) {}
      bool cancelled() override { return ++this->Asked > this->Most; }
      long Most;
      long Asked = 0;
    } monitor(most);
    AnnealCoarsener coarsener(annealing.Fine, annealing.Reference, annealing.Options,
      {LeastShape, 1e9, -5.0, 1e9}, 1.0, monitor);
    const long before = monitor.Asked;
    const int fewer = static_cast<int>(annealing.Fine.Mesh.Quads.size()) - 1;
    const bool done = coarsener.annealTo(fewer, monitor);
    EXPECT_EQ(done, monitor.Asked <= most);
    return before;
  };
  const long all = asked(1000000);
  EXPECT_GE(all, 5000 / 64);
  for (long most : {0L, all / 4, all / 2, all - 1})
  {
    EXPECT_LE(asked(most), most + 8) << most; // no work is done after the answer
  }
}

TEST(AnnealCoarsener, TipsOnlyWhereAllowed)
{
  LayoutDraft draft;
  for (int i = 0; i < 9; ++i)
  {
    draft.Mesh.Points.emplace_back(i % 3, i / 3, 0.0);
    draft.Kind.push_back(i == 4 ? VertexKind::Free : VertexKind::Crease);
  }
  draft.Mesh.Quads = {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}};
  draft.Mesh.Region.assign(4, 0);
  draft.completeCreases();
  QuadEditor editor(draft);
  editor.begin();
  EXPECT_FALSE(editor.rotate(0, 1, 1)); // 1 - 4 would leave one quad at 1
  editor.rollback();
  editor.LeastRimEdges = 2;
  editor.begin();
  ASSERT_TRUE(editor.rotate(0, 1, 1));
  EXPECT_EQ(editor.Around[1].size(), 1U);
  // The ear goes: the vertices beside the tip are one.
  const Index ear = editor.Around[1][0];
  EXPECT_GE(editor.collapse(ear, (editor.corner(ear, 1) + 1) % 2), 0);
  EXPECT_EQ(editor.count(), 3);
  const LayoutReport report = checkLayout(editor.draft().Mesh);
  EXPECT_TRUE(report.Valid) << report.Problem;
  EXPECT_EQ(report.Euler, 1);
}

TEST(ApproachLayout, TakesLayoutsCloserAtTheSameCount)
{
  double awayBefore = 0.0;
  double awayAfter = 0.0;
  for (const bool open : {false, true})
  {
    const Approaching a(open ? bsrtest::openTunnels(2) : bsrtest::tunnels(2), open ? 36 : 44);
    const LayoutDraft after = a.approached();
    expectSound(after, open ? -18 : -16, open ? 2 : 0);
    EXPECT_EQ(after.Mesh.Quads.size(), a.Before.Mesh.Quads.size());
    EXPECT_LT(a.distance(after).Maximum, 0.75 * a.distance(a.Before).Maximum);
    EXPECT_LT(a.distance(after).Maximum, 0.8);
    EXPECT_LT(a.distance(after).Mean, 0.75 * a.distance(a.Before).Mean);
    EXPECT_LT(a.distance(after).Mean, 0.2);
    awayBefore += 0.5 * a.away(a.Before);
    awayAfter += 0.5 * a.away(after);
  }
  EXPECT_LT(awayAfter, 0.9 * awayBefore);
  EXPECT_LT(awayAfter, 0.4);
}

TEST(ApproachLayout, SameEachTime)
{
  const Approaching a(bsrtest::openTunnels(2), 36);
  const LayoutDraft one = a.approached();
  const LayoutDraft other = a.approached();
  EXPECT_EQ(one.Mesh.Quads, other.Mesh.Quads);
  EXPECT_EQ(one.Mesh.Points, other.Mesh.Points);
}

TEST(ApproachLayout, IsCancelled)
{
  const Approaching a(bsrtest::tunnels(2), 44);
  LayoutDraft draft = a.Before;
  Cancelled monitor;
  EXPECT_EQ(approachLayout(draft, a.Reference, a.Options, monitor).code(), StatusCode::Cancelled);
}
