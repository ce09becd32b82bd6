#include "Common/CounterRandom.h"
#include "Contour/BranchedReport.h"
#include "Contour/RelaxFolds.h"
#include "Contour/RelaxSpace.h"
#include "ContourStacks.h"
#include "Crossings.h"
#include "Spline/ModelCheck.h"
#include "Spline/SampleModel.h"
#include "Spline/Topology.h"
#include "Spline/Volume.h"
#include "WatchMonitor.h"

#include <gtest/gtest.h>

#include <cstdlib>

using namespace bsr;
using namespace bsrtest;

namespace
{
/// Legs of radius 1.5 at the given centers for z = 0 .. 3 and a trunk for z = 4 .. 7.
std::vector<Polyline> trousers(const std::vector<Vec2>& legs, double a, double b, bool down = false)
{
  std::vector<Polyline> lines;
  for (int s = 0; s < 8; ++s)
  {
    const double z = down ? -s : s;
    if (s < 4)
    {
      for (const Vec2& c : legs)
      {
        lines.push_back(ellipseAt(Vec3(c.x(), c.y(), z), 1.5, 1.5, 50));
      }
    }
    else
    {
      lines.push_back(ellipseAt(Vec3(0.0, 0.0, z), a, b, 90));
    }
  }
  return lines;
}

std::vector<Polyline> twoLegs()
{
  return trousers({Vec2(-2.0, 0.0), Vec2(2.0, 0.0)}, 4.0, 2.2);
}

ContourStack stackOf(const std::vector<Polyline>& lines)
{
  Monitor monitor;
  auto stack = buildStack(lines, {}, monitor);
  EXPECT_TRUE(stack.isOk()) << stack.status().message();
  return stack.isOk() ? *stack : ContourStack{};
}

struct Checked
{
  BranchedSurface Surface;
  BranchedReport Report;
};

/// Makes the surface and checks what holds of each.
Checked checked(const std::vector<Polyline>& lines, const BranchedOptions& options = {})
{
  Checked c;
  Monitor monitor;
  const ContourStack stack = stackOf(lines);
  auto s = makeBranchedSurface(stack, options, monitor);
  EXPECT_TRUE(s.isOk()) << s.status().message();
  if (!s)
  {
    return c;
  }
  c.Surface = std::move(*s);
  const SplineModel& m = c.Surface.Model;
  const Status valid = checkModel(m);
  EXPECT_TRUE(valid.isOk()) << valid.message();
  for (std::size_t p = 0; p < m.Patches.size(); ++p)
  {
    for (int k = 0; k < 4; ++k)
    {
      const SideMatch match = matchSide(m, static_cast<std::int64_t>(p), k);
      EXPECT_TRUE(match.Patch < 0 || (match.Same && match.Coherent)) << p << " " << k;
    }
  }
  auto r = reportBranched(c.Surface, stack, monitor);
  EXPECT_TRUE(r.isOk()) << r.status().message();
  c.Report = std::move(*r);
  return c;
}

void expectSmooth(const Checked& c)
{
  EXPECT_EQ(c.Surface.FoldedPatches, 0);
  EXPECT_LT(c.Report.MaxNormalJump, 1e-6);
}
} // namespace

TEST(BranchedSurface, TwoLegsJoinSmoothlyInSpaceForAllOrders)
{
  for (const auto& [u, v] : {std::pair{3, 3}, {4, 4}, {3, 5}, {5, 3}, {5, 5}, {6, 3}, {8, 4}})
  {
    BranchedOptions o;
    o.OrderU = u;
    o.OrderV = v;
    const Checked c = checked(twoLegs(), o);
    SCOPED_TRACE(std::to_string(u) + " " + std::to_string(v));
    expectSmooth(c);
    EXPECT_EQ(c.Surface.Network.Junctions.size(), 1u);
    EXPECT_LT(c.Report.Input.TotalMax, 0.03);
    EXPECT_LT(c.Report.Reslice.There.Value[5], 0.04);
    EXPECT_LT(c.Report.Reslice.Back.Value[5], 0.04);
  }
}

TEST(BranchedSurface, KindsOfJunctions)
{
  for (const JunctionKind kind : {JunctionKind::SharedEdge, JunctionKind::Asymmetric})
  {
    BranchedOptions o;
    o.Kind = kind;
    std::vector<Polyline> lines = trousers({Vec2(-2.0, 0.3), Vec2(2.0, -0.4)}, 4.2, 2.6);
    expectSmooth(checked(lines, o));
    o.Tangency = JunctionTangency::Parameter; // the paper's: creased in space
    EXPECT_GT(checked(lines, o).Report.JunctionNormalJump, 5.0);
  }
  BranchedOptions o;
  o.Kind = JunctionKind::Superimposed;
  const Checked c = checked(twoLegs(), o);
  EXPECT_EQ(c.Surface.FoldedPatches, 0);
  EXPECT_GT(c.Report.JunctionNormalJump, 5.0);
}

TEST(BranchedSurface, ManyBranchesInBothDirections)
{
  const std::vector<std::vector<Vec2>> legs{
    {Vec2(-4, 0), Vec2(0, 0), Vec2(4, 0)}, {Vec2(2.1, 0.6), Vec2(-1.5, 1.5), Vec2(-0.5, -2.1)}};
  const Vec2 trunk[2] = {{6.0, 2.2}, {4.0, 4.0}};
  for (int k = 0; k < 2; ++k)
  {
    for (const bool down : {false, true})
    {
      SCOPED_TRACE(std::to_string(k) + (down ? " down" : " up"));
      BranchedOptions o;
      o.Caps = EndCaps::All;
      const Checked c = checked(trousers(legs[k], trunk[k].x(), trunk[k].y(), down), o);
      expectSmooth(c);
      EXPECT_EQ(c.Report.OpenSides, 0);
      const ModelMeasure measure = measureModel(c.Surface.Model);
      EXPECT_TRUE(measure.Closed);
      const double legVolume = 7.07 * static_cast<double>(legs[k].size());
      EXPECT_GT(measure.Volume, 3.0 * (legVolume + 3.14159 * trunk[k].x() * trunk[k].y()));
      EXPECT_GT(componentVolumes(c.Surface.Model)[0], 0.0);
    }
  }
}

/// Sixteen sheets meet at the crotch.
TEST(BranchedSurface, FourBranchesAroundOneCrotch)
{
  const Checked c = checked(
    trousers({Vec2(2.2, 2.2), Vec2(-2.2, 2.2), Vec2(-2.2, -2.2), Vec2(2.2, -2.2)}, 5.2, 5.2));
  expectSmooth(c);
  EXPECT_EQ(c.Surface.Network.Junctions[0].Hubs.size(), 1u);
  EXPECT_EQ(c.Surface.Network.Junctions[0].Hubs[0].Seams.size(), 4u);
}

TEST(BranchedSurface, SeveralLevels)
{
  std::vector<Polyline> lines;
  for (int s = 0; s < 3; ++s)
  {
    for (const double x : {-5.0, -2.0, 2.0, 5.0})
    {
      lines.push_back(ellipseAt(Vec3(x, 0.1 * x, s), 1.0, 1.2, 40));
    }
    for (const double x : {-3.5, 3.5})
    {
      lines.push_back(ellipseAt(Vec3(x, 0.1 * x, s + 3.0), 2.6, 1.6, 60));
    }
    lines.push_back(ellipseAt(Vec3(0.0, 0.0, s + 6.0), 6.5, 2.0, 90));
  }
  const Checked c = checked(lines);
  expectSmooth(c);
  EXPECT_EQ(c.Surface.Network.Junctions.size(), 3u);
  EXPECT_LT(c.Report.Reslice.There.Value[5], 0.1);
}

TEST(BranchedSurface, BayClosesToHole)
{
  // A thick arc with round ends that closes to a ring with a hole.
  std::vector<Polyline> lines;
  for (int s = 0; s < 3; ++s)
  {
    Polyline u;
    u.Closed = true;
    const double open = 0.5 * Tau * (0.7 + 0.06 * s); // half the angle that it covers
    const auto at = [&](double angle, double radius, double turn, int n)
    {
      for (int i = 0; i < n; ++i)
      {
        const double t = turn * (i + 0.5) / n;
        const Vec3 c(3.0 * std::cos(angle), 3.0 * std::sin(angle), s);
        u.Points.push_back(c + radius * Vec3(std::cos(angle + t), std::sin(angle + t), 0.0));
      }
    };
    for (int i = 0; i <= 40; ++i)
    {
      at(open * (i / 20.0 - 1.0), 1.0, 0.0, 1);
    }
    at(open, 1.0, 0.5 * Tau, 12);
    for (int i = 0; i <= 24; ++i)
    {
      at(open * (1.0 - i / 12.0), -1.0, 0.0, 1);
    }
    at(-open, -1.0, 0.5 * Tau, 12);
    lines.push_back(u);
    lines.push_back(ellipseAt(Vec3(0.0, 0.0, s + 3.0), 4.0, 4.0, 80));
    lines.push_back(ellipseAt(Vec3(0.0, 0.0, s + 3.0), 1.9, 1.9, 50));
  }
  const Checked c = checked(lines);
  EXPECT_EQ(c.Surface.Network.Junctions.size(), 1u);
  EXPECT_EQ(c.Surface.Network.Tubes.size(), 3u);
  expectSmooth(c);
  for (const SplinePatch& p : c.Surface.Model.Patches)
  {
    EXPECT_EQ(p.Side, Shell::Outer); // the hole is one surface with the outside
  }
}

TEST(BranchedSurface, NestedCanalIsAnInnerShell)
{
  std::vector<Polyline> lines;
  for (int s = 0; s < 6; ++s)
  {
    lines.push_back(ellipseAt(Vec3(0.0, 0.0, s), 4.0, 3.0, 80));
    if (s > 1 && s < 5)
    {
      lines.push_back(ellipseAt(Vec3(0.5, 0.0, s), 1.0, 1.2, 40));
    }
  }
  BranchedOptions o;
  o.Caps = EndCaps::All;
  const Checked c = checked(lines, o);
  expectSmooth(c);
  EXPECT_EQ(c.Report.OpenSides, 0);
  const auto volumes = componentVolumes(c.Surface.Model);
  ASSERT_EQ(volumes.size(), 2u);
  const double body = std::max(volumes[0], volumes[1]);
  const double canal = std::min(volumes[0], volumes[1]);
  EXPECT_GT(body, 180.0);
  EXPECT_LT(canal, 0.0); // its normals point into the canal
}

TEST(BranchedSurface, KnotsAndControlPolygons)
{
  for (const bool periodic : {false, true})
  {
    for (const bool interpolate : {false, true})
    {
      for (const int order : {3, 4, 5})
      {
        BranchedOptions o;
        o.OrderV = order;
        o.PeriodicKnots = periodic;
        o.Interpolate = interpolate;
        const Checked c = checked(twoLegs(), o);
        expectSmooth(c);
        double low = 100.0;
        for (const Vec4& p : c.Surface.Model.ControlPoints)
        {
          low = std::min(low, p[2]);
        }
        // Periodic knots through control polygons start between the first sections (section 7).
        EXPECT_EQ(low > 0.1, periodic && !interpolate) << order << " " << low;
        EXPECT_GT(low, -1e-9);
      }
    }
  }
}

TEST(BranchedSurface, LeftOutContoursAreNamed)
{
  std::vector<Polyline> lines = twoLegs();
  lines.push_back({{Vec3(9, 9, 1), Vec3(10, 9, 1), Vec3(11, 10, 1)}, false});
  BranchedOptions o;
  o.Caps = EndCaps::None;
  lines.push_back(ellipseAt(Vec3(20.0, 0.0, 3.0), 1.0, 1.0));
  const Checked c = checked(lines, o);
  expectSmooth(c);
  ASSERT_EQ(c.Report.LeftOut.size(), 2u);
  EXPECT_NE(c.Report.LeftOut[0].Text.find("open contour"), std::string::npos);
  EXPECT_NE(c.Report.LeftOut[1].Text.find("single contour"), std::string::npos);
}

TEST(BranchedSurface, BadOptionsAndUnlinkedContours)
{
  Monitor monitor;
  const ContourStack stack = stackOf(twoLegs());
  const auto code = [&](const BranchedOptions& o)
  { return makeBranchedSurface(stack, o, monitor).status().code(); };
  BranchedOptions o;
  o.OrderU = 2;
  EXPECT_EQ(code(o), StatusCode::InvalidParameter);
  o = {};
  o.OrderV = 9;
  EXPECT_EQ(code(o), StatusCode::InvalidParameter);
  o = {};
  o.PointsPerSection = 5;
  EXPECT_EQ(code(o), StatusCode::InvalidParameter);
  o = {};
  o.JunctionPosition = 1.5;
  EXPECT_EQ(code(o), StatusCode::InvalidParameter);
  o = {};
  o.SectionTolerance = std::nan("");
  EXPECT_EQ(code(o), StatusCode::InvalidParameter);
  std::vector<Polyline> apart;
  for (int s = 0; s < 4; ++s)
  {
    apart.push_back(ellipseAt(Vec3(20.0 * s, 0.0, s), 1.0, 1.0));
  }
  o = {};
  o.Caps = EndCaps::None;
  const auto unlinked = makeBranchedSurface(stackOf(apart), o, monitor);
  EXPECT_EQ(unlinked.status().code(), StatusCode::InvalidInput);
  EXPECT_NE(unlinked.status().message().find("linked"), std::string::npos);
}

/// The junctions of 5.1, 5.2 and 6 made in space, with uniform and periodic knots (figure 10), and
/// two stages (section 8, figure 11): closed, without self-intersection.
TEST(BranchedSurface, JunctionsInSpaceDoNotIntersect)
{
  std::vector<Polyline> stages; // a stem above; one of its branches parts again
  for (int s = 0; s < 3; ++s)
  {
    stages.push_back(ellipseAt(Vec3(-4.0, 0.0, s), 1.0, 1.2, 30));
    stages.push_back(ellipseAt(Vec3(-1.2, 0.3, s), 1.0, 1.2, 30));
    stages.push_back(ellipseAt(Vec3(3.0, -0.2, s), 1.4, 1.4, 30));
    stages.push_back(ellipseAt(Vec3(-2.5, 0.1, s + 3.0), 2.4, 1.6, 40));
    stages.push_back(ellipseAt(Vec3(2.6, -0.1, s + 3.0), 1.5, 1.5, 30));
    stages.push_back(ellipseAt(Vec3(-0.5, 0.0, s + 6.0), 4.6, 2.2, 50));
  }
  for (const JunctionKind kind :
    {JunctionKind::Superimposed, JunctionKind::SharedEdge, JunctionKind::Asymmetric})
  {
    for (const bool several : {false, true})
    {
      SCOPED_TRACE(std::to_string(static_cast<int>(kind)) + (several ? " two stages" : ""));
      BranchedOptions o;
      o.Kind = kind;
      o.Caps = EndCaps::All;
      o.Interpolate = !several; // control polygons, as in the paper
      const Checked c = checked(several ? stages : twoLegs(), o);
      EXPECT_EQ(c.Surface.Network.Junctions.size(), several ? 2u : 1u);
      EXPECT_EQ(c.Report.OpenSides, 0);
      EXPECT_EQ(c.Surface.FoldedPatches, 0);
      EXPECT_EQ(crossings(c.Surface.Model, 2), 0);
      if (kind != JunctionKind::Superimposed)
      {
        EXPECT_LT(c.Report.JunctionNormalJump, 0.01);
      }
    }
  }
}

/// Any displacement of the space that relaxes folds keeps shared sides and tangent planes.
TEST(BranchedSurface, RelaxSpaceKeepsContacts)
{
  for (const int order : {3, 4})
  {
    BranchedOptions o;
    o.OrderU = order;
    o.OrderV = order;
    o.Caps = EndCaps::All;
    const std::vector<Vec2> legs{Vec2(2.1, 0.6), Vec2(-1.5, 1.5), Vec2(-0.5, -2.1)};
    SplineModel m = checked(trousers(legs, 4.0, 4.0), o).Surface.Model;
    std::vector<std::int64_t> region = growRegion(m, {3}, 3);
    ASSERT_LT(region.size(), m.Patches.size());
    const RelaxSpace space = makeRelaxSpace(m, region);
    ASSERT_GT(space.Variables, 10);
    CounterRandom random(order, 3);
    std::vector<Vec3> x;
    for (int k = 0; k < space.Variables; ++k)
    {
      x.emplace_back(0.01 * Vec3(random.normal(), random.normal(), random.normal()));
    }
    double moved = 0.0;
    for (std::size_t k = 0; k < m.ControlPoints.size(); ++k)
    {
      Vec3 d = Vec3::Zero();
      for (const LinearForm::Term& t : space.Points[k].terms())
      {
        d += t.second * x[t.first];
      }
      m.ControlPoints[k].head<3>() += d;
      moved = std::max(moved, d.norm());
    }
    EXPECT_GT(moved, 0.01);
    EXPECT_TRUE(checkModel(m).isOk());
    for (const SideJumps& jumps : normalJumps(m))
    {
      for (const double j : jumps)
      {
        EXPECT_LT(j, 1e-6);
      }
    }
  }
}

/// Random bodies of nine kinds; BSR_STACKS sets how many (200 were looked at).
TEST(BranchedSurface, RandomStacks)
{
  const char* wanted = std::getenv("BSR_STACKS");
  const int count = wanted ? std::atoi(wanted) : 27;
  std::vector<double> there;
  std::vector<double> back;
  int folded = 0;
  for (int seed = 0; seed < count; ++seed)
  {
    const RandomStack random = randomStack(seed);
    Monitor monitor;
    const auto stack = buildStack(random.Lines, {}, monitor);
    ASSERT_TRUE(stack.isOk()) << random.Name << ": " << stack.status().message();
    const auto s = makeBranchedSurface(*stack, {}, monitor);
    ASSERT_TRUE(s.isOk()) << random.Name << ": " << s.status().message();
    EXPECT_TRUE(checkModel(s->Model).isOk()) << random.Name;
    const auto r = reportBranched(*s, *stack, monitor);
    ASSERT_TRUE(r.isOk()) << random.Name;
    EXPECT_LT(r->MaxNormalJump, 1e-6) << random.Name;
    if (s->FoldedPatches > 0)
    {
      ++folded;
      std::printf("%s: folded %d of %d, jump %.3g\n", random.Name.c_str(), s->FoldedPatches,
        static_cast<int>(s->Model.Patches.size()), r->MaxNormalJump);
    }
    there.push_back(r->Reslice.There.Value[5]);
    back.push_back(r->Reslice.Back.Value[5]);
  }
  const Percentiles t = percentilesOf(there);
  const Percentiles b = percentilesOf(back);
  std::printf(
    "with folded patches: %d of %d; largest re-slicing error a stack, 50 %% %.3g %.3g, 95 %% "
    "%.3g %.3g, max %.3g %.3g\n",
    folded, count, t.Value[0], b.Value[0], t.Value[3], b.Value[3], t.Value[5], b.Value[5]);
  EXPECT_EQ(folded, 0);
  EXPECT_LT(t.Value[3], 0.5);
}

TEST(BranchedSurface, TellsProgressAndCanBeCancelledAnywhere)
{
  for (const int seed : {4, 7})
  {
    const auto lines = randomStack(seed).Lines;
    expectWatchable(
      [&](Monitor& monitor)
      {
        SubMonitor first(monitor, 0.0, 0.1);
        SubMonitor second(monitor, 0.1, 0.8);
        SubMonitor third(monitor, 0.8, 1.0);
        const auto stack = buildStack(lines, {}, first);
        if (!stack)
        {
          return stack.status();
        }
        const auto surface = makeBranchedSurface(*stack, {}, second);
        return surface ? reportBranched(*surface, *stack, third).status() : surface.status();
      });
  }
}

/// A bay much longer than the contour below it opens in one slice distance: the columns go there.
TEST(BranchedSurface, BaysGetTheirColumns)
{
  std::vector<Polyline> lines;
  for (int s = 0; s < 10; ++s)
  {
    if (s < 5)
    {
      lines.push_back(ellipseAt(Vec3(0.0, 0.0, s), 10.0, 10.0, 300));
      continue;
    }
    // an island beside the bay makes it a junction
    lines.push_back(ellipseAt(Vec3(0.0, -8.5, s), 0.8, 0.8, 30));
    Polyline l;
    for (int i = 0; i <= 500; ++i)
    {
      const double t = Tau * (i % 500) / 500.0;
      const double wide = std::pow(std::max(0.0, -std::sin(t)), 20.0); // 1 at the bottom
      const double r = 10.0 - 9.0 * wide;
      l.Points.emplace_back(r * std::cos(t), r * std::sin(t), s);
    }
    lines.push_back(std::move(l));
  }
  Monitor monitor;
  const ContourStack stack = stackOf(lines);
  const auto net = makeNetwork(stack, {}, monitor);
  ASSERT_TRUE(net.isOk()) << net.status().message();
  ASSERT_EQ(net->Junctions.size(), 1u);
  int bays = 0;
  for (const Tube& t : net->Tubes)
  {
    const std::vector<double>& shares = t.Shares.front();
    double widest = 0.0;
    for (std::size_t u = 0; u < shares.size(); ++u)
    {
      const double next = u + 1 < shares.size() ? shares[u + 1] : shares[0] + 1.0;
      EXPECT_GT(next, shares[u]);
      widest = std::max(widest, next - shares[u]);
    }
    bays += stack.Contours[t.Contours[0]].Length > 70.0 ? 1 : 0;
    EXPECT_LT(widest * t.Columns, 2.5);
  }
  EXPECT_EQ(bays, 1);
}
