#include "Layout/QuadRemesh.h"
#include "MorseShapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using namespace bsr;

Result<QuadLayout> morse(const TriangleMesh& mesh, int quads, int eigenfunction = 0)
{
  QuadRemeshOptions options;
  options.Method = LayoutMethod::MorseSmale;
  options.NumberOfQuads = quads;
  options.Eigenfunction = eigenfunction;
  Monitor monitor;
  return quadRemesh(mesh, options, monitor);
}

void expectSound(const Result<QuadLayout>& layout, int euler, int loops)
{
  ASSERT_TRUE(layout) << layout.status().message();
  EXPECT_TRUE(layout->Report.Valid) << layout->Report.Problem;
  EXPECT_EQ(layout->Report.Euler, euler);
  EXPECT_EQ(layout->Report.BoundaryLoops, loops);
  EXPECT_EQ(layout->Report.Flipped, 0);
}

/// Every triangle is in a cell, critical points are marked and counted right.
void expectPartition(const QuadLayout& layout, int euler)
{
  const PartitionedSurface& s = layout.Surface;
  ASSERT_EQ(s.Cell.size(), s.Mesh.Triangles.size());
  ASSERT_EQ(s.Critical.size(), s.Mesh.Points.size());
  ASSERT_EQ(s.Eigenfunction.size(), s.Mesh.Points.size());
  const auto count = [&](CriticalPoint c)
  { return static_cast<int>(std::count(s.Critical.begin(), s.Critical.end(), c)); };
  EXPECT_EQ(
    count(CriticalPoint::Minimum) - count(CriticalPoint::Saddle) + count(CriticalPoint::Maximum),
    euler);
  const MorseReport& r = layout.Morse.front();
  EXPECT_EQ(count(CriticalPoint::Minimum), r.Minima);
  EXPECT_EQ(count(CriticalPoint::Saddle), r.Saddles);
  EXPECT_EQ(count(CriticalPoint::Maximum), r.Maxima);
  EXPECT_EQ(r.Cells, 2 * r.Saddles);
  EXPECT_EQ(*std::max_element(s.Cell.begin(), s.Cell.end()) + 1, r.Cells);
}
} // namespace

TEST(MorseLayout, ClosedShapesOfAnyGenus)
{
  const std::vector<std::pair<bsrtest::AnalyticSurface, int>> shapes = {
    {bsrtest::ellipsoid({1, 1, 1}, 4), 60}, {bsrtest::ellipsoid({3, 2, 1}, 4), 160},
    {bsrtest::torus(80, 40), 40}, {bsrtest::doubleTorus(12), 100}};
  for (const auto& [shape, quads] : shapes)
  {
    const auto layout = morse(shape.Mesh, quads);
    expectSound(layout, shape.Euler, 0);
    EXPECT_NEAR(layout->Mesh.Quads.size(), quads, 0.15 * quads);
    expectPartition(*layout, shape.Euler);
  }
}

TEST(MorseLayout, OpenTubeKeepsItsBoundaries)
{
  for (int quads : {30, 90})
  {
    const auto layout = morse(bsrtest::tube(30, 40).Mesh, quads);
    expectSound(layout, 0, 2);
    EXPECT_NEAR(layout->Mesh.Quads.size(), quads, 0.2 * quads);
  }
}

TEST(MorseLayout, SmallHoles)
{
  // Three triangles are taken out of a sphere, far from each other.
  bsrtest::AnalyticSurface s = bsrtest::ellipsoid({1, 1, 1}, 5);
  for (std::size_t t : {6000U, 3500U, 100U})
  {
    s.Mesh.Triangles.erase(s.Mesh.Triangles.begin() + static_cast<std::ptrdiff_t>(t));
  }
  expectSound(morse(s.Mesh, 80), -1, 3);
}

TEST(MorseLayout, EigenfunctionOfChoice)
{
  const auto mesh = bsrtest::ellipsoid({1.3, 1.1, 0.9}, 5).Mesh;
  int last = 0;
  for (int k : {20, 60, 150})
  {
    const auto layout = morse(mesh, 100, k);
    expectSound(layout, 2, 0);
    EXPECT_EQ(layout->Morse.front().Eigenfunction, k);
    EXPECT_GT(layout->Morse.front().Cells, last);
    last = layout->Morse.front().Cells;
  }
}

TEST(MorseLayout, FunctionThatGivesNoQuadsIsOneError)
{
  // The first function of a long ellipsoid has one maximum, one minimum and nothing between.
  const auto layout = morse(bsrtest::ellipsoid({4, 1, 1.1}, 4).Mesh, 100, 1);
  ASSERT_FALSE(layout);
  EXPECT_EQ(layout.status().code(), StatusCode::Failed);
  EXPECT_NE(layout.status().message().find("Field Aligned"), std::string::npos);
}

TEST(MorseLayout, SeveralComponents)
{
  bsrtest::AnalyticSurface s = bsrtest::torus(60, 30);
  const auto base = static_cast<Index>(s.Mesh.Points.size());
  const auto other = bsrtest::ellipsoid({2, 2, 2}, 4);
  for (const Vec3& p : other.Mesh.Points)
  {
    s.Mesh.Points.emplace_back(p + Vec3(20, 0, 0));
  }
  for (const auto& t : other.Mesh.Triangles)
  {
    s.Mesh.Triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  const auto layout = morse(s.Mesh, 200);
  expectSound(layout, 2, 0);
  EXPECT_EQ(layout->Report.Components, 2);
  ASSERT_EQ(layout->Morse.size(), 2U);
  EXPECT_EQ(*std::max_element(layout->Surface.Cell.begin(), layout->Surface.Cell.end()) + 1,
    layout->Morse[0].Cells + layout->Morse[1].Cells);
}

TEST(MorseLayout, IsDeterministic)
{
  const auto a = morse(bsrtest::torus(60, 30).Mesh, 90);
  const auto b = morse(bsrtest::torus(60, 30).Mesh, 90);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->Mesh.Quads, b->Mesh.Quads);
  EXPECT_EQ(a->Mesh.Points, b->Mesh.Points);
  EXPECT_EQ(a->Surface.Cell, b->Surface.Cell);
}

TEST(MorseLayout, BadParametersAndCancel)
{
  const auto mesh = bsrtest::torus(60, 30).Mesh;
  EXPECT_EQ(morse(mesh, 90, -1).status().code(), StatusCode::InvalidParameter);
  EXPECT_EQ(morse(mesh, 90, 1000000).status().code(), StatusCode::InvalidParameter);
  QuadRemeshOptions options;
  options.Method = LayoutMethod::MorseSmale;
  Monitor monitor;
  for (double bad : {-0.1, 1.0, std::nan("")})
  {
    options.Persistence = bad;
    EXPECT_EQ(quadRemesh(mesh, options, monitor).status().code(), StatusCode::InvalidParameter);
  }
  struct Stop : Monitor
  {
    bool cancelled() override { return true; }
  } stop;
  options.Persistence = 0.01;
  EXPECT_EQ(quadRemesh(mesh, options, stop).status().code(), StatusCode::Cancelled);
}
