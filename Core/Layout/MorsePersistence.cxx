#include "Layout/MorseGradient.h"

#include "Common/UnionFind.h"

#include <algorithm>
#include <tuple>

namespace bsr
{
namespace
{
/// The root of each vertex (each triangle), following the pointers once.
template <class Next>
std::vector<Index> rootsOf(Index count, const Next& next)
{
  std::vector<Index> root(count, -1);
  std::vector<Index> path;
  for (Index i = 0; i < count; ++i)
  {
    Index x = i;
    while (root[x] < 0)
    {
      path.push_back(x);
      const Index y = next(x);
      if (y < 0)
      {
        root[x] = x;
        break;
      }
      x = y;
    }
    for (Index p : path)
    {
      root[p] = root[x];
    }
    path.clear();
  }
  return root;
}

Index below(const TriangleSurface& s, const MorseGradient& g, Index v)
{
  return g.Down[v] < 0 ? -1 : s.end(g.Down[v]);
}

Index above(const TriangleSurface& s, const MorseGradient& g, Index t)
{
  return g.Up[t] < 0 ? -1 : s.Opposite[g.Up[t]] / 3;
}

/// Kruskal's sweep: `order` lists saddles, `ends` the two roots of each; `older(a, b)` says which
/// root survives.
template <class Ends, class Older, class Add>
void sweep(const std::vector<Index>& order, std::int64_t count, const Ends& ends,
  const Older& older, const Add& add)
{
  UnionFind sets(count);
  std::vector<Index> eldest(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < eldest.size(); ++i)
  {
    eldest[i] = static_cast<Index>(i);
  }
  for (Index k : order)
  {
    const auto [x, y] = ends(k);
    const auto a = sets.find(x);
    const auto b = sets.find(y);
    if (a == b)
    {
      continue;
    }
    const bool first = older(eldest[a], eldest[b]);
    const Index survivor = first ? eldest[a] : eldest[b];
    add(k, first ? eldest[b] : eldest[a]);
    sets.join(a, b);
    eldest[sets.find(a)] = survivor;
  }
}

/// Turns the path from `first` to its root around, so that `first` leads over `edge` instead.
bool turnDown(const TriangleSurface& s, Index first, Index edge, MorseGradient& g)
{
  std::vector<Index> path; // half-edges down
  for (Index v = first; g.Down[v] >= 0; v = s.end(g.Down[v]))
  {
    path.push_back(g.Down[v]);
  }
  const Index root = path.empty() ? first : s.end(path.back());
  const auto onBoundary = [&](Index v)
  {
    bool found = false;
    s.around(v, [&](Index h) { found = found || s.Virtual[s.end(h)]; });
    return found;
  };
  if (onBoundary(root) ||
      std::any_of(path.begin(), path.end(), [&](Index h) { return onBoundary(s.start(h)); }))
  {
    return false; // boundaries stay lines of the flow
  }
  for (Index h : path)
  {
    g.Down[s.end(h)] = s.Opposite[h];
  }
  g.Down[first] = edge;
  return true;
}

bool turnUp(const TriangleSurface& s, Index first, Index edge, MorseGradient& g)
{
  std::vector<Index> path;
  Index root = first;
  for (; g.Up[root] >= 0; root = s.Opposite[g.Up[root]] / 3)
  {
    path.push_back(g.Up[root]);
  }
  if (g.Boundary[g.top(s, root)] == BoundaryNode::Maximum)
  {
    return false;
  }
  for (Index h : path)
  {
    g.Up[s.Opposite[h] / 3] = s.Opposite[h];
  }
  g.Up[first] = edge;
  return true;
}

bool cancelLower(const TriangleSurface& s, Index saddle, MorseGradient& g)
{
  const Index a = s.start(saddle);
  const Index b = s.end(saddle);
  const Index ra = g.descend(s, a);
  const Index rb = g.descend(s, b);
  if (ra == rb)
  {
    return false;
  }
  const bool first = g.lower(rb, ra); // the higher minimum goes
  return first ? turnDown(s, a, saddle, g) || turnDown(s, b, s.Opposite[saddle], g)
               : turnDown(s, b, s.Opposite[saddle], g) || turnDown(s, a, saddle, g);
}

bool cancelUpper(const TriangleSurface& s, Index saddle, MorseGradient& g)
{
  const Index o = s.Opposite[saddle];
  const Index ra = g.ascend(s, saddle / 3);
  const Index rb = g.ascend(s, o / 3);
  if (ra == rb)
  {
    return false;
  }
  const bool first = g.lower(g.top(s, ra), g.top(s, rb));
  return first ? turnUp(s, saddle / 3, saddle, g) || turnUp(s, o / 3, o, g)
               : turnUp(s, o / 3, o, g) || turnUp(s, saddle / 3, saddle, g);
}
} // namespace

std::vector<PersistencePair> persistencePairs(const TriangleSurface& s, const MorseGradient& g)
{
  const auto low = rootsOf(s.vertices(), [&](Index v) { return below(s, g, v); });
  const auto high = rootsOf(s.faces(), [&](Index t) { return above(s, g, t); });
  std::vector<Index> order(g.Saddles.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = static_cast<Index>(i);
  }
  const auto at = [&](Index k) { return s.start(g.Saddles[k]); };
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b) { return at(a) != at(b) ? g.lower(at(a), at(b)) : a < b; });
  std::vector<PersistencePair> pairs;
  const auto isLower = [&](Index v) { return g.Boundary[v] != BoundaryNode::None; };
  sweep(
    order, s.vertices(),
    [&](Index k)
    {
      const Index h = g.Saddles[k];
      return std::make_pair(low[s.start(h)], low[s.end(h)]);
    },
    [&](Index a, Index b) { return isLower(a) != isLower(b) ? isLower(a) : g.lower(a, b); },
    [&](Index k, Index loser)
    {
      if (!isLower(loser))
      {
        pairs.push_back({g.Value[at(k)] - g.Value[loser], k, false});
      }
    });
  std::reverse(order.begin(), order.end());
  const auto isUpper = [&](Index t) { return g.Boundary[g.top(s, t)] == BoundaryNode::Maximum; };
  sweep(
    order, s.faces(),
    [&](Index k)
    {
      const Index h = g.Saddles[k];
      return std::make_pair(high[h / 3], high[s.Opposite[h] / 3]);
    },
    [&](Index a, Index b)
    { return isUpper(a) != isUpper(b) ? isUpper(a) : g.lower(g.top(s, b), g.top(s, a)); },
    [&](Index k, Index loser)
    {
      if (!isUpper(loser))
      {
        pairs.push_back({g.Value[g.top(s, loser)] - g.Value[at(k)], k, true});
      }
    });
  std::sort(pairs.begin(), pairs.end(),
    [](const PersistencePair& a, const PersistencePair& b)
    {
      return std::tie(a.Persistence, a.Upper, a.Saddle) <
             std::tie(b.Persistence, b.Upper, b.Saddle);
    });
  return pairs;
}

void cancelPairs(const TriangleSurface& s, const std::vector<PersistencePair>& pairs,
  std::size_t count, MorseGradient& g)
{
  std::vector<std::uint8_t> gone(g.Saddles.size(), 0);
  for (std::size_t i = 0; i < std::min(count, pairs.size()); ++i)
  {
    const Index saddle = g.Saddles[pairs[i].Saddle];
    gone[pairs[i].Saddle] = pairs[i].Upper ? cancelUpper(s, saddle, g) : cancelLower(s, saddle, g);
  }
  std::size_t n = 0;
  for (std::size_t i = 0; i < g.Saddles.size(); ++i)
  {
    if (!gone[i])
    {
      g.Saddles[n++] = g.Saddles[i];
    }
  }
  g.Saddles.resize(n);
}

} // namespace bsr
