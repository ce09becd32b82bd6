#include "Layout/SideOrder.h"

#include "Common/UnionFind.h"

#include <algorithm>
#include <limits>

namespace bsr
{
namespace
{
/// The inner sides, sorted by `before`.
template <class Before>
std::vector<Index> innerSides(const LayoutGraph& graph, const Before& before)
{
  std::vector<Index> sides;
  for (Index e = 0; e < graph.edges(); ++e)
  {
    if (graph.Twin[graph.First[e]] >= 0)
    {
      sides.push_back(e);
    }
  }
  std::stable_sort(sides.begin(), sides.end(), before);
  return sides;
}
} // namespace

SideOrder shortestFirst(
  const LayoutGraph& graph, const std::vector<double>& length, const std::vector<int>& urgent)
{
  SideOrder order;
  order.Edges = innerSides(graph, [&](Index a, Index b)
    { return urgent[a] != urgent[b] ? urgent[a] > urgent[b] : length[a] < length[b]; });
  return order;
}

SideOrder safeOrder(
  const LayoutGraph& graph, const std::vector<double>& cost, const std::vector<std::uint8_t>& laid)
{
  const auto lies = [&](Index e)
  { return graph.Twin[graph.First[e]] < 0 || (!laid.empty() && laid[e]); };
  std::vector<Index> sides = innerSides(graph, [&](Index a, Index b) { return cost[a] < cost[b]; });
  sides.erase(std::remove_if(sides.begin(), sides.end(), lies), sides.end());
  UnionFind vertices(static_cast<std::int64_t>(graph.Spokes.size()));
  for (Index e = 0; e < graph.edges(); ++e)
  {
    const Index h = graph.First[e];
    if (lies(e))
    {
      vertices.join(graph.from(h), graph.to(h));
    }
  }
  SideOrder order;
  std::vector<char> inTree(static_cast<std::size_t>(graph.edges()), 0);
  for (const Index e : sides)
  {
    const Index h = graph.First[e];
    if (vertices.find(graph.from(h)) != vertices.find(graph.to(h)))
    {
      vertices.join(graph.from(h), graph.to(h));
      inTree[e] = 1;
      order.Edges.push_back(e);
    }
  }
  UnionFind quads(static_cast<std::int64_t>(graph.Quads.size()));
  std::vector<Index> last;
  std::vector<Index> loops;
  std::for_each(sides.rbegin(), sides.rend(),
    [&](Index e)
    {
      if (inTree[e])
      {
        return;
      }
      const Index h = graph.First[e];
      const bool joins = quads.find(h / 4) != quads.find(graph.Twin[h] / 4);
      if (joins)
      {
        quads.join(h / 4, graph.Twin[h] / 4);
      }
      (joins ? last : loops).push_back(e);
    });
  order.FirstLoop = order.Edges.size();
  order.Edges.insert(order.Edges.end(), loops.rbegin(), loops.rend());
  order.EndOfLoops = order.Edges.size();
  order.Edges.insert(order.Edges.end(), last.rbegin(), last.rend());
  order.Reach = {1.0, 3.0, std::numeric_limits<double>::infinity()};
  return order;
}
} // namespace bsr
