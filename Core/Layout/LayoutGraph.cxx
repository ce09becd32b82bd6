#include "Layout/LayoutGraph.h"

#include <map>

namespace bsr
{
namespace
{
Index nextOf(Index h)
{
  return h % 4 == 3 ? h - 3 : h + 1;
}
Index prevOf(Index h)
{
  return h % 4 == 0 ? h + 3 : h - 1;
}
} // namespace

Result<LayoutGraph> LayoutGraph::build(const QuadMesh& mesh)
{
  LayoutGraph g;
  g.Quads = mesh.Quads;
  const auto nh = static_cast<Index>(4 * g.Quads.size());
  std::map<std::pair<Index, Index>, Index> at;
  for (Index h = 0; h < nh; ++h)
  {
    if (!at.insert({{g.from(h), g.to(h)}, h}).second)
    {
      return Status::invalidInput("An edge of the layout has more than two quads, or neighbors of "
                                  "opposite orientation; use a layout as QuadRemesh makes.");
    }
  }
  g.Twin.assign(nh, -1);
  g.Edge.assign(nh, -1);
  g.Boundary.assign(mesh.Points.size(), 0);
  for (Index h = 0; h < nh; ++h)
  {
    const auto found = at.find({g.to(h), g.from(h)});
    g.Twin[h] = found == at.end() ? -1 : found->second;
    if (g.Twin[h] < 0)
    {
      g.Boundary[g.from(h)] = g.Boundary[g.to(h)] = 1;
    }
    if (g.Twin[h] < 0 || h < g.Twin[h])
    {
      g.Edge[h] = g.edges();
      g.First.push_back(h);
    }
    else
    {
      g.Edge[h] = g.Edge[g.Twin[h]];
    }
  }
  g.Spokes.resize(mesh.Points.size());
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(nh), 0);
  for (Index h = 0; h < nh; ++h)
  {
    if (seen[h])
    {
      continue;
    }
    Index first = h; // back clockwise to a boundary, or round
    for (Index x = g.Twin[first]; x >= 0; x = g.Twin[first])
    {
      first = nextOf(x);
      if (first == h)
      {
        break;
      }
    }
    auto& spokes = g.Spokes[g.from(h)];
    if (!spokes.empty())
    {
      return Status::invalidInput("Quads of the layout touch in a vertex only; use a layout as "
                                  "QuadRemesh makes.");
    }
    Index x = first;
    do
    {
      seen[x] = 1;
      spokes.push_back(g.Edge[x]);
      const Index back = prevOf(x);
      if (g.Twin[back] < 0)
      {
        spokes.push_back(g.Edge[back]);
      }
      x = g.Twin[back];
    } while (x >= 0 && x != first);
  }
  return g;
}

std::vector<std::vector<Index>> LayoutGraph::boundaries() const
{
  std::vector<std::vector<Index>> loops;
  std::map<Index, Index> next;
  for (Index h = 0; h < static_cast<Index>(this->Twin.size()); ++h)
  {
    if (this->Twin[h] < 0)
    {
      next[this->from(h)] = this->to(h);
    }
  }
  while (!next.empty())
  {
    std::vector<Index> loop;
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back()))
    {
      loop.push_back(at->second);
      next.erase(at);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}
} // namespace bsr
