#include "Layout/MorseGradient.h"

#include "Common/Parallel.h"
#include "Common/UnionFind.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Half-edges out of a vertex into its real triangles, counter-clockwise. On a boundary from one
/// boundary edge to the other; the last one has the hole on its left.
struct Fan
{
  std::vector<Index> Edges;
  bool Closed = true;
};

Fan fanOf(const TriangleSurface& s, Index v)
{
  Fan fan;
  Index first = s.Out[v];
  s.around(v,
    [&](Index h)
    {
      if (s.hole(s.Opposite[h] / 3) && !s.hole(h / 3))
      {
        first = h;
        fan.Closed = false;
      }
    });
  Index h = first;
  do
  {
    if (!s.Virtual[s.end(h)])
    {
      fan.Edges.push_back(h);
    }
    h = s.turn(h);
  } while (h != first);
  return fan;
}

/// Pairs one vertex with its way down, and the triangles and edges below it.
class LowerStar
{
public:
  LowerStar(const TriangleSurface& s, MorseGradient& g, std::vector<Index>& saddles, Index v)
      : S(s), G(g), Saddles(saddles), V(v), F(fanOf(s, v)), Count(static_cast<int>(F.Edges.size()))
  {
    for (Index h : this->F.Edges)
    {
      this->Below.push_back(g.lower(s.end(h), v));
    }
  }

  void pair()
  {
    const int below = static_cast<int>(std::count(this->Below.begin(), this->Below.end(), true));
    if (!this->F.Closed)
    {
      this->pairOnBoundary(below);
    }
    else if (below == this->Count)
    {
      this->wholeFan(this->steepest(0, this->Count - 1));
    }
    else if (below > 0)
    {
      this->arcs(-1);
    }
  }

private:
  int wrap(int i) const { return (i + this->Count) % this->Count; }
  Index edge(int i) const { return this->F.Edges[this->wrap(i)]; }
  /// Triangle between edge i and i + 1.
  Index triangle(int i) const { return this->edge(i) / 3; }
  double slope(int i) const
  {
    const Index w = this->S.end(this->edge(i));
    const double length = (this->S.Points[w] - this->S.Points[this->V]).norm();
    return (this->G.Value[this->V] - this->G.Value[w]) / std::max(length, 1e-300);
  }
  bool onBoundary(Index v) const
  {
    bool found = false;
    this->S.around(v, [&](Index h) { found = found || this->S.Virtual[this->S.end(h)]; });
    return found;
  }
  /// Paths inside keep away from boundaries where they can.
  int steepest(int first, int last) const
  {
    int best = first;
    std::pair<bool, double> bestKey(true, -1.0);
    for (int i = first; i <= last; ++i)
    {
      const bool boundary = this->onBoundary(this->S.end(this->edge(i)));
      const double slope = this->slope(i);
      if (i == first || (boundary != bestKey.first ? !boundary : slope > bestKey.second))
      {
        best = i;
        bestKey = {boundary, slope};
      }
    }
    return best;
  }
  void crossed(int triangle, int edge)
  {
    // The half-edge of the triangle on this edge: its own start, or the one that ends at V.
    const Index h = this->edge(edge);
    this->G.Up[this->triangle(triangle)] =
      this->wrap(triangle) == this->wrap(edge) ? h : this->S.Opposite[h];
  }

  /// Triangles of the arc of edges first..last ascend away from the edge `root`.
  void arc(int first, int last, int root)
  {
    for (int i = first; i < last; ++i)
    {
      this->crossed(i, i < root ? i : i + 1);
    }
  }

  /// All neighbors are lower (inside): the triangle opposite to the way down is the maximum.
  void wholeFan(int root)
  {
    this->G.Down[this->V] = this->edge(root);
    const int top = root + this->Count / 2;
    for (int i = root; i < root + this->Count; ++i)
    {
      if (i != top)
      {
        this->crossed(i, i < top ? i + 1 : i);
      }
    }
  }

  /// Every arc of lower neighbors has one edge left over: the way down, or a saddle.
  void arcs(int taken)
  {
    int start = 0; // an index whose predecessor is not below
    if (this->F.Closed)
    {
      while (this->Below[this->wrap(start - 1)])
      {
        ++start;
      }
    }
    std::vector<int> roots;
    for (int i = start; i < start + this->Count; ++i)
    {
      if (!this->Below[this->wrap(i)])
      {
        continue;
      }
      const int first = i;
      while (i + 1 < start + this->Count && this->Below[this->wrap(i + 1)])
      {
        ++i;
      }
      if (!this->F.Closed && (first == 0 || i == this->Count - 1))
      {
        this->arc(first, i, first == 0 ? first : i); // its edge lies on the boundary
        continue;
      }
      roots.push_back(this->steepest(first, i));
      this->arc(first, i, roots.back());
    }
    if (taken < 0)
    {
      const auto main = std::max_element(
        roots.begin(), roots.end(), [&](int a, int b) { return this->slope(a) < this->slope(b); });
      this->G.Down[this->V] = this->edge(*main);
      roots.erase(main);
    }
    for (int r : roots)
    {
      this->Saddles.push_back(this->edge(r));
    }
  }

  void pairOnBoundary(int below)
  {
    const int last = this->Count - 1;
    const bool first = this->Below[0];
    if (!first && !this->Below[last])
    {
      this->G.Boundary[this->V] = below == 0 ? BoundaryNode::Minimum : BoundaryNode::LowerSaddle;
      if (below > 0)
      {
        this->arcs(-1);
      }
      return;
    }
    const bool both = first && this->Below[last];
    const int down = both ? (this->slope(0) >= this->slope(last) ? 0 : last) : (first ? 0 : last);
    this->G.Down[this->V] = this->edge(down);
    if (below < this->Count)
    {
      this->arcs(down);
      if (both)
      {
        this->G.Boundary[this->V] = BoundaryNode::UpperSaddle;
        this->G.UpperEdge[this->V] = down == 0 ? this->S.Opposite[this->edge(last)] : this->edge(0);
      }
      return;
    }
    this->G.Boundary[this->V] = BoundaryNode::Maximum;
    const int top = last / 2;
    for (int i = 0; i < last; ++i)
    {
      if (i != top)
      {
        this->crossed(i, i < top ? i + 1 : i);
      }
    }
  }

  const TriangleSurface& S;
  MorseGradient& G;
  std::vector<Index>& Saddles;
  Index V;
  Fan F;
  int Count;
  std::vector<char> Below;
};

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

Index MorseGradient::descend(const TriangleSurface& s, Index vertex) const
{
  while (this->Down[vertex] >= 0)
  {
    vertex = s.end(this->Down[vertex]);
  }
  return vertex;
}

Index MorseGradient::ascend(const TriangleSurface& s, Index triangle) const
{
  while (this->Up[triangle] >= 0)
  {
    triangle = s.Opposite[this->Up[triangle]] / 3;
  }
  return triangle;
}

Index MorseGradient::top(const TriangleSurface& s, Index triangle) const
{
  const auto c = s.corners(triangle);
  const Index ab = this->lower(c[0], c[1]) ? c[1] : c[0];
  return this->lower(ab, c[2]) ? c[2] : ab;
}

Index MorseGradient::minima(const TriangleSurface& s) const
{
  Index n = 0;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    n += this->Down[v] < 0 && !s.Virtual[v];
  }
  return n;
}

Index MorseGradient::maxima(const TriangleSurface& s) const
{
  Index n = 0;
  for (Index t = 0; t < s.faces(); ++t)
  {
    n += this->Up[t] < 0 && !s.hole(t);
  }
  return n;
}

MorseGradient morseGradient(const TriangleSurface& s, std::vector<double> values)
{
  MorseGradient g;
  g.Value = std::move(values);
  g.Down.assign(s.Points.size(), -1);
  g.Up.assign(s.Region.size(), -1);
  g.Boundary.assign(s.Points.size(), BoundaryNode::None);
  g.UpperEdge.assign(s.Points.size(), -1);
  for (Index v = 0; v < s.vertices(); ++v)
  {
    if (!s.Virtual[v])
    {
      LowerStar(s, g, g.Saddles, v).pair();
    }
  }
  return g;
}

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

void smoothBoundaries(const TriangleSurface& s, double persistence, std::vector<double>& values)
{
  std::vector<std::uint8_t> done(s.Points.size(), 0);
  for (Index h0 = 0; h0 < static_cast<Index>(s.Vertex.size()); ++h0)
  {
    if (s.hole(h0 / 3) || !s.hole(s.Opposite[h0] / 3) || done[s.start(h0)])
    {
      continue;
    }
    std::vector<Index> loop;
    for (Index h = h0; !done[s.start(h)];)
    {
      done[s.start(h)] = 1;
      loop.push_back(s.start(h));
      h = TriangleSurface::next(h);
      while (!s.hole(s.Opposite[h] / 3))
      {
        h = TriangleSurface::next(s.Opposite[h]);
      }
    }
    const auto n = static_cast<int>(loop.size());
    const auto value = [&](int i) -> double& { return values[loop[(i % n + n) % n]]; };
    // From the highest point on: once around, with a band of `persistence` that the value drags
    // along, then around from there again; what stays inside the band is a ripple.
    int top = 0;
    for (int i = 1; i < n; ++i)
    {
      top = value(i) > value(top) ? i : top;
    }
    int bottom = top;
    for (int i = top; i < top + n; ++i)
    {
      bottom = value(i) < value(bottom) ? i : bottom;
    }
    const double range = value(top) - value(bottom);
    if (!(range > 0.0))
    {
      continue;
    }
    const double band = std::min(persistence, 0.45 * range);
    // Hysteresis: turning points are extrema that the value leaves by more than the band.
    std::vector<int> turns(1, top);
    bool falling = true;
    int extreme = top;
    for (int i = top + 1; i <= top + n; ++i)
    {
      const double v = value(i);
      if (falling ? v <= value(extreme) : v >= value(extreme))
      {
        extreme = i;
      }
      else if (std::abs(v - value(extreme)) > band)
      {
        turns.push_back(extreme);
        falling = !falling;
        extreme = i;
      }
    }
    if (turns.back() != top + n)
    {
      turns.push_back(top + n);
    }
    // Between turning points: monotone, by running extrema from both ends, averaged.
    for (std::size_t t = 0; t + 1 < turns.size(); ++t)
    {
      const int a = turns[t];
      const int b = turns[t + 1];
      const bool down = value(a) > value(b);
      std::vector<double> ahead;
      std::vector<double> back(b - a + 1);
      for (int i = a; i <= b; ++i)
      {
        const double v = value(i);
        const double last = ahead.empty() ? v : ahead.back();
        ahead.push_back(down ? std::min(last, v) : std::max(last, v));
      }
      for (int i = b; i >= a; --i)
      {
        const double v = value(i);
        const double last = i == b ? v : back[i + 1 - a];
        back[i - a] = down ? std::max(last, v) : std::min(last, v);
      }
      for (int i = a + 1; i < b; ++i)
      {
        // A touch of the straight line, so that no two values are equal.
        const double line = value(a) + (value(b) - value(a)) * (i - a) / (b - a);
        value(i) = (1.0 - 1e-6) * 0.5 * (ahead[i - a] + back[i - a]) + 1e-6 * line;
      }
    }
  }
}
} // namespace bsr
