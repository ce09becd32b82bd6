#include "Layout/QuadGraph.h"

#include <gtest/gtest.h>

namespace
{
using namespace bsr;

/// A closed grid of n x m quads on a torus.
struct Grid
{
  QuadGraph Graph;
  std::vector<Vec3> Points;
  std::vector<VertexKind> Kind;
};

Grid torusGrid(int n, int m)
{
  Grid g;
  const auto at = [&](int i, int j) { return ((i + n) % n) * m + (j + m) % m; };
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < m; ++j)
    {
      g.Points.emplace_back(i, j, i * j);
      g.Kind.push_back(VertexKind::Free);
      g.Graph.add({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < m; ++j)
    {
      g.Graph.link(4 * at(i, j) + 1, 4 * at(i + 1, j) + 3);
      g.Graph.link(4 * at(i, j) + 2, 4 * at(i, j + 1));
    }
  }
  return g;
}

void expectLinked(const QuadGraph& g)
{
  for (Index h = 0; h < g.halfEdges(); ++h)
  {
    if (g.alive(h) && g.Opposite[h] >= 0)
    {
      const Index o = g.Opposite[h];
      EXPECT_EQ(g.Opposite[o], h);
      EXPECT_EQ(g.start(o), g.end(h));
      EXPECT_EQ(g.end(o), g.start(h));
    }
  }
}

LayoutReport checked(const Grid& g)
{
  return checkLayout(draftOf(g.Graph, g.Points, g.Kind).Mesh);
}
} // namespace

TEST(QuadGraph, RotationsKeepTheTopology)
{
  Grid g = torusGrid(5, 6);
  for (Index h : {0, 17, 50, 81})
  {
    g.Graph.rotate(h);
    expectLinked(g.Graph);
    const LayoutReport report = checked(g);
    EXPECT_EQ(report.Euler, 0);
  }
  Grid same = torusGrid(5, 6);
  for (int i = 0; i < 3; ++i)
  {
    same.Graph.rotate(8); // three times: the same edge, run through the other way
  }
  expectLinked(same.Graph);
  EXPECT_TRUE(checked(same).Valid);
  EXPECT_EQ(checked(same).Irregular, 0);
}

TEST(QuadGraph, ChordsAreCutAllAround)
{
  Grid g = torusGrid(5, 6);
  Index next = 30;
  const auto sides = g.Graph.splitChord(0, next);
  EXPECT_EQ(next - 30, static_cast<Index>(sides.size()));
  for (Index side : sides)
  {
    g.Points.push_back(g.Points[g.Graph.start(side)] + Vec3(0.5, 0.1, 0.2));
    g.Kind.push_back(VertexKind::Free);
  }
  expectLinked(g.Graph);
  EXPECT_EQ(g.Graph.quads(), 30 + static_cast<Index>(sides.size()));
  EXPECT_TRUE(checked(g).Valid) << checked(g).Problem;
  EXPECT_EQ(checked(g).Irregular, 0);
}

TEST(QuadGraph, NarrowRingsAreMended)
{
  // Two quads around: every edge across is there twice.
  for (int n : {2, 3})
  {
    Grid g = torusGrid(n, 2);
    EXPECT_FALSE(g.Graph.repeatedEdges().empty());
    Monitor monitor;
    if (!mendGraph(g.Graph, g.Points, g.Kind, monitor))
    {
      subdivideGraph(g.Graph, g.Points, g.Kind);
    }
    expectLinked(g.Graph);
    EXPECT_TRUE(checked(g).Valid) << checked(g).Problem;
    EXPECT_EQ(checked(g).Euler, 0);
  }
}

TEST(QuadGraph, SubdivisionMakesFourOfEach)
{
  Grid g = torusGrid(3, 4);
  subdivideGraph(g.Graph, g.Points, g.Kind);
  expectLinked(g.Graph);
  EXPECT_EQ(g.Graph.quads(), 48);
  EXPECT_TRUE(checked(g).Valid);
  EXPECT_EQ(checked(g).Irregular, 0);
}

TEST(QuadGraph, LooseQuadsAreClosed)
{
  // A quad folded on a spike, put between two quads of a grid.
  Grid g = torusGrid(4, 5);
  const Index h = 0;
  const Index o = g.Graph.Opposite[h];
  const Index a = g.Graph.start(h);
  const Index b = g.Graph.end(h);
  g.Points.emplace_back(0, 0, 9);
  g.Kind.push_back(VertexKind::Free);
  const Index q = g.Graph.add({20, a, b, a}); // spike, a, b, a: two edges from a to b
  g.Graph.link(q, q + 3);
  g.Graph.link(q + 1, o);
  g.Graph.link(q + 2, h);
  EXPECT_FALSE(checked(g).Valid);
  EXPECT_EQ(g.Graph.removeLoose(21), 1);
  EXPECT_EQ(g.Graph.quads(), 20);
  EXPECT_TRUE(checked(g).Valid) << checked(g).Problem;
  // A vertex in the middle of a quad, joined to two corners.
  const Index x = 4 * 7;
  const std::array<Index, 4> c = {
    g.Graph.start(x), g.Graph.start(x + 1), g.Graph.start(x + 2), g.Graph.start(x + 3)};
  const Index tb = g.Graph.Opposite[x + 1];
  const Index tc = g.Graph.Opposite[x + 2];
  // (0, 1, v, 3) and (v, 1, 2, 3)
  g.Graph.Vertex[x + 2] = 20;
  const Index y = g.Graph.add({20, c[1], c[2], c[3]});
  g.Graph.link(x + 1, y);
  g.Graph.link(x + 2, y + 3);
  g.Graph.link(y + 1, tb);
  g.Graph.link(y + 2, tc);
  expectLinked(g.Graph);
  EXPECT_FALSE(checked(g).Valid);
  EXPECT_EQ(g.Graph.removeLoose(21), 1);
  expectLinked(g.Graph);
  EXPECT_TRUE(checked(g).Valid) << checked(g).Problem;
  EXPECT_EQ(g.Graph.quads(), 20);
}
