#include "ScanMeshes.h"

#include "Common/CounterRandom.h"
#include "Common/UnionFind.h"
#include "Layout/CutMesh.h"
#include "Mesh/BuildSurface.h"

#include <gtest/gtest.h>

using namespace bsr;
using bsrtest::torusQuads;
using bsrtest::tubeQuads;

namespace
{
std::vector<double> randomCosts(const LayoutGraph& graph, std::uint64_t seed)
{
  CounterRandom random(seed, 0);
  std::vector<double> cost(static_cast<std::size_t>(graph.edges()));
  for (double& c : cost)
  {
    c = random.uniform();
  }
  return cost;
}

/// Each inner side once; a spanning tree first, loops between.
void expectSafe(const LayoutGraph& graph, const SideOrder& order, std::size_t loops)
{
  EXPECT_EQ(order.EndOfLoops - order.FirstLoop, loops);
  std::set<Index> seen(order.Edges.begin(), order.Edges.end());
  EXPECT_EQ(seen.size(), order.Edges.size());
  Index inner = 0;
  UnionFind joined(static_cast<std::int64_t>(graph.Spokes.size()));
  for (Index e = 0; e < graph.edges(); ++e)
  {
    const Index h = graph.First[e];
    const bool border = graph.Twin[h] < 0;
    inner += border ? 0 : 1;
    if (border)
    {
      joined.join(graph.from(h), graph.to(h));
    }
  }
  EXPECT_EQ(static_cast<Index>(order.Edges.size()), inner);
  for (std::size_t i = 0; i < order.FirstLoop; ++i)
  {
    const Index h = graph.First[order.Edges[i]];
    EXPECT_NE(joined.find(graph.from(h)), joined.find(graph.to(h)));
    joined.join(graph.from(h), graph.to(h));
  }
}

int failedQuads(const TriangleMesh& mesh, const QuadMesh& layout, const LayoutGraph& graph,
  const SideOrder& order)
{
  Monitor quiet;
  RepairReport repairs;
  const auto surfaces = buildSurfaces(mesh, {}, repairs, quiet);
  EXPECT_TRUE(surfaces.isOk());
  auto cut = CutMesh::build(*surfaces, layout, graph, 0.3);
  EXPECT_TRUE(cut.isOk()) << cut.status().message();
  const auto failed = cut->laySides(layout, graph, order, quiet);
  EXPECT_TRUE(failed.isOk());
  return *failed;
}
} // namespace

TEST(SideOrder, TreesLoopsAndTheRest)
{
  const auto torus = LayoutGraph::build(torusQuads(6, 4));
  const auto tube = LayoutGraph::build(tubeQuads(5, 3));
  ASSERT_TRUE(torus.isOk() && tube.isOk());
  for (std::uint64_t seed = 0; seed < 5; ++seed)
  {
    expectSafe(*torus, safeOrder(*torus, randomCosts(*torus, seed)), 2);
    expectSafe(*tube, safeOrder(*tube, randomCosts(*tube, seed)), 0);
  }
}

/// Whatever the spanning tree, every quad becomes a disc; even where corners lie far from where
/// they belong, so that straight ways run through each other.
TEST(SideOrder, SafeOrdersGiveDiscs)
{
  const TriangleMesh torusTriangles = bsrtest::torusMesh(60, 24);
  QuadMesh torus = torusQuads(6, 4);
  for (Index v : {7, 8, 15})
  {
    torus.Points[v] = torus.Points[v].cwiseProduct(Vec3(0.9, 1.1, -1.0));
  }
  const auto graph = LayoutGraph::build(torus);
  ASSERT_TRUE(graph.isOk());
  int sound = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed)
  {
    sound +=
      failedQuads(torusTriangles, torus, *graph, safeOrder(*graph, randomCosts(*graph, seed))) == 0;
  }
  EXPECT_GE(sound, 4); // loops may find no way that does not part the surface
  const QuadMesh tube = tubeQuads(5, 3);
  const auto open = LayoutGraph::build(tube);
  ASSERT_TRUE(open.isOk());
  for (std::uint64_t seed = 0; seed < 6; ++seed)
  {
    EXPECT_EQ(failedQuads(
                bsrtest::tubeMesh(40, 40), tube, *open, safeOrder(*open, randomCosts(*open, seed))),
      0);
  }
}
