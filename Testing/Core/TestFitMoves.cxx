#include "Layout/FieldLayout.h"
#include "Layout/FitMoves.h"
#include "Mesh/BuildSurface.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace
{
using namespace bsr;

/// A ball with three dents and three horns around, closed.
TriangleMesh pillow()
{
  constexpr int n = 60;
  constexpr int m = 90;
  TriangleMesh mesh;
  for (int i = 1; i < n; ++i)
  {
    for (int j = 0; j < m; ++j)
    {
      const double a = M_PI * i / n;
      const double b = 2.0 * M_PI * j / m;
      const double r = 1.0 + 0.3 * std::pow(std::sin(a), 3) * std::cos(3.0 * b);
      mesh.Points.emplace_back(
        r * std::sin(a) * std::cos(b), r * std::sin(a) * std::sin(b), 1.4 * std::cos(a));
    }
  }
  const auto top = static_cast<Index>(mesh.Points.size());
  mesh.Points.emplace_back(0.0, 0.0, 1.4);
  mesh.Points.emplace_back(0.0, 0.0, -1.4);
  for (int j = 0; j < m; ++j)
  {
    const int k = (j + 1) % m;
    mesh.Triangles.push_back({top, j, k});
    mesh.Triangles.push_back({top + 1, (n - 2) * m + k, (n - 2) * m + j});
    for (int i = 0; i + 2 < n; ++i)
    {
      mesh.Triangles.push_back({i * m + j, (i + 1) * m + j, (i + 1) * m + k});
      mesh.Triangles.push_back({i * m + j, (i + 1) * m + k, i * m + k});
    }
  }
  return mesh;
}

/// A layout of the pillow before and after.
struct Moved
{
  LayoutDraft Before;
  LayoutDraft After;
  FitMovesReport Report;
  Status Outcome;
};

Moved moved(Monitor& monitor)
{
  Monitor quiet;
  RepairReport repairs;
  const auto surfaces = buildSurfaces(pillow(), {}, repairs, quiet);
  const TriangleSurface& s = surfaces->front();
  const ReferenceSurface reference(s);
  const auto sizing = Sizing::measured(s, reference, 80, QuadSizing::Uniform, {}, quiet);
  auto layout = fieldLayout(s, reference, *sizing, {80, 0, QuadSizing::Uniform, {}}, quiet);
  Moved out;
  out.Before = layout->Draft;
  out.After = layout->Draft;
  out.Outcome = moveToFit(out.After, s, reference, monitor, &out.Report);
  return out;
}
} // namespace

TEST(FitMoves, PatchesFitBetterAndTheLayoutStaysSound)
{
  Monitor monitor;
  const Moved m = moved(monitor);
  ASSERT_TRUE(m.Outcome) << m.Outcome.message();
  EXPECT_GT(m.Report.Moved, 0);
  EXPECT_LE(m.Report.After, 0.9 * m.Report.Before);
  const LayoutReport before = checkLayout(m.Before.Mesh);
  const LayoutReport after = checkLayout(m.After.Mesh);
  ASSERT_TRUE(after.Valid) << after.Problem;
  EXPECT_EQ(m.After.Mesh.Quads.size(), m.Before.Mesh.Quads.size());
  EXPECT_EQ(after.Euler, before.Euler);
  EXPECT_EQ(after.Flipped, 0);
  EXPECT_GE(after.MinJacobian, std::min(0.4, before.MinJacobian) - 1e-12);
  std::printf("residual %.5f to %.5f, %d moves, %d turns\n", m.Report.Before, m.Report.After,
    m.Report.Moved, m.Report.Turned);
}

TEST(FitMoves, ThreadsDoNotChangeABit)
{
  Monitor monitor;
  const Moved many = moved(monitor);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Moved alone = moved(monitor);
  EXPECT_EQ(many.After.Mesh.Points, alone.After.Mesh.Points);
  EXPECT_EQ(many.After.Mesh.Quads, alone.After.Mesh.Quads);
}

TEST(FitMoves, CancelLeavesASoundLayout)
{
  class Few : public Monitor
  {
  public:
    bool cancelled() override { return --this->Left < 0; }
    int Left = 30;
  };
  Few monitor;
  const Moved m = moved(monitor);
  EXPECT_TRUE(m.Outcome.code() == StatusCode::Cancelled);
  EXPECT_TRUE(checkLayout(m.After.Mesh).Valid);
}
