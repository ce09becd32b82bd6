#include "Layout/QuadGraph.h"

#include <algorithm>
#include <limits>
#include <map>

namespace bsr
{
namespace
{
using Pair = std::pair<Index, Index>;

Pair sorted(Index a, Index b)
{
  return {std::min(a, b), std::max(a, b)};
}

/// Edges of each pair of vertices, by one half-edge each.
std::map<Pair, std::vector<Index>> edgesOf(const QuadGraph& g)
{
  std::map<Pair, std::vector<Index>> edges;
  for (Index h = 0; h < g.halfEdges(); ++h)
  {
    if (g.alive(h) && (g.Opposite[h] < 0 || h < g.Opposite[h]))
    {
      edges[sorted(g.start(h), g.end(h))].push_back(h);
    }
  }
  return edges;
}

/// Local operations on a graph, judged by the numbers of edges at the vertices.
class Mender
{
public:
  Mender(QuadGraph& graph, std::vector<Vec3>& points, std::vector<VertexKind>& kind)
      : G(graph), Points(points), Kind(kind)
  {
  }

  bool run()
  {
    const Index most = 2 * this->G.quads() + 20;
    for (int pass = 0; pass < 200 && this->G.quads() <= most; ++pass)
    {
      this->G.removeLoose(this->vertices());
      const auto repeated = this->G.repeatedEdges();
      if (repeated.empty())
      {
        return true;
      }
      this->index();
      if (!this->rotateOne(repeated) && !this->cutOne(repeated))
      {
        return false;
      }
    }
    return false;
  }

  /// Rotates the edges that gain most, as long as any does.
  void even()
  {
    for (int pass = 0; pass < 400; ++pass)
    {
      this->index();
      Index best = -1;
      int bestTurns = 0;
      int bestGain = -3;
      for (Index h = 0; h < this->G.halfEdges(); ++h)
      {
        for (int turns = 1; turns <= 2 && this->G.alive(h) && h < this->G.Opposite[h]; ++turns)
        {
          const int gain = this->gain(h, turns);
          if (gain < bestGain)
          {
            bestGain = gain;
            best = h;
            bestTurns = turns;
          }
        }
      }
      if (best < 0)
      {
        return;
      }
      this->turn(best, bestTurns);
    }
  }

private:
  static constexpr int Never = 1000000;

  Index vertices() const { return static_cast<Index>(this->Points.size()); }
  void index()
  {
    this->Rings = this->G.rings(this->vertices());
    this->Edges = edgesOf(this->G);
  }
  void turn(Index h, int turns)
  {
    for (int i = 0; i < turns; ++i)
    {
      this->G.rotate(h);
    }
  }
  /// Change of the squared distance to the regular number of edges.
  int excess(Index v, int change) const
  {
    const QuadGraph::Ring& r = this->Rings[v];
    const int off = r.Boundary ? r.Corners - 2 : r.Corners - 4;
    return (off + change) * (off + change) - off * off;
  }
  /// What rotating h so many times changes; Never if it may not be.
  int gain(Index h, int turns) const
  {
    const QuadGraph& g = this->G;
    const Index o = g.Opposite[h];
    if (o < 0 || h / 4 == o / 4)
    {
      return Never;
    }
    const Index a = g.start(h);
    const Index b = g.end(h);
    const Index far = QuadGraph::next(QuadGraph::next(o));
    const Index c = turns == 1 ? g.start(far) : g.end(far); // beside a, then beside b
    const Index there = QuadGraph::next(QuadGraph::next(h));
    const Index d = turns == 1 ? g.start(there) : g.end(there);
    const auto least = [&](Index v) { return this->Rings[v].Boundary ? 2 : 4; };
    if (c == d || a == b || this->Rings[a].Corners < least(a) ||
        this->Rings[b].Corners < least(b) || this->Edges.count(sorted(c, d)) != 0 || c == a ||
        c == b || d == a || d == b)
    {
      return Never;
    }
    return this->excess(a, -1) + this->excess(b, -1) + this->excess(c, 1) + this->excess(d, 1);
  }

  bool rotateOne(const std::vector<Index>& repeated)
  {
    Index best = -1;
    int bestTurns = 0;
    int bestGain = Never;
    for (Index h : repeated)
    {
      for (Index x : this->Edges[sorted(this->G.start(h), this->G.end(h))])
      {
        for (int turns = 1; turns <= 2; ++turns)
        {
          const int gain = this->gain(x, turns);
          if (gain < bestGain)
          {
            bestGain = gain;
            best = x;
            bestTurns = turns;
          }
        }
      }
    }
    if (best >= 0)
    {
      this->turn(best, bestTurns);
    }
    return best >= 0;
  }

  bool cutOne(const std::vector<Index>& repeated)
  {
    for (Index h : repeated)
    {
      for (Index x : this->Edges[sorted(this->G.start(h), this->G.end(h))])
      {
        Index next = this->vertices();
        for (Index side : this->G.splitChord(x, next))
        {
          // The side ends at the new vertex; the other half starts there.
          const Index a = this->G.start(side);
          const Index b = this->otherEnd(side);
          this->Points.push_back(0.5 * (this->Points[a] + this->Points[b]));
          const bool border = this->G.Opposite[side] < 0;
          this->Kind.push_back(border ? VertexKind::Crease : VertexKind::Free);
        }
        if (next > 0 && static_cast<std::size_t>(next) == this->Points.size() &&
            this->Points.size() > this->Rings.size())
        {
          return true;
        }
      }
    }
    return false;
  }

  /// End of the edge that was cut at the end of `side`.
  Index otherEnd(Index side) const
  {
    // side: a -> m in (a, m, n, d); across m -> n lies (m, b, c, n).
    const Index across = this->G.Opposite[QuadGraph::next(side)];
    return this->G.end(QuadGraph::next(across));
  }

  QuadGraph& G;
  std::vector<Vec3>& Points;
  std::vector<VertexKind>& Kind;
  std::vector<QuadGraph::Ring> Rings;
  std::map<Pair, std::vector<Index>> Edges;
};
} // namespace

Index QuadGraph::quads() const
{
  Index n = 0;
  for (Index h = 0; h < this->halfEdges(); h += 4)
  {
    n += this->alive(h);
  }
  return n;
}

Index QuadGraph::add(const std::array<Index, 4>& corners)
{
  this->Vertex.insert(this->Vertex.end(), corners.begin(), corners.end());
  this->Opposite.insert(this->Opposite.end(), 4, -1);
  return this->halfEdges() - 4;
}

void QuadGraph::link(Index a, Index b)
{
  if (a >= 0)
  {
    this->Opposite[a] = b;
  }
  if (b >= 0)
  {
    this->Opposite[b] = a;
  }
}

std::vector<QuadGraph::Ring> QuadGraph::rings(Index vertices) const
{
  std::vector<Ring> rings(vertices);
  for (Index h = 0; h < this->halfEdges(); ++h)
  {
    if (this->alive(h))
    {
      ++rings[this->start(h)].Corners;
      if (this->Opposite[h] < 0)
      {
        rings[this->start(h)].Boundary = rings[this->end(h)].Boundary = true;
      }
    }
  }
  return rings;
}

int QuadGraph::removeLoose(Index vertices)
{
  int removed = 0;
  const auto remove = [&](Index h)
  {
    for (Index k = 4 * (h / 4); k < 4 * (h / 4) + 4; ++k)
    {
      this->Vertex[k] = this->Opposite[k] = -1;
    }
    ++removed;
  };
  bool any = true;
  while (any)
  {
    any = false;
    const auto rings = this->rings(vertices);
    for (Index h = 0; h < this->halfEdges() && !any; ++h)
    {
      if (!this->alive(h) || rings[this->start(h)].Boundary)
      {
        continue;
      }
      const int corners = rings[this->start(h)].Corners;
      if (corners == 1 && this->Opposite[h] == prev(h))
      {
        // (v, s, w, s): the sides at v are one edge; those at w become one.
        const Index x = this->Opposite[next(h)];
        const Index y = this->Opposite[next(next(h))];
        if (x == next(next(h)))
        {
          continue; // nothing else is there
        }
        remove(h);
        this->link(x, y);
        any = true;
      }
      else if (corners == 2 && this->Opposite[h] / 4 != h / 4)
      {
        // p = (v, a, c, b), q = (v, b, d, a): p becomes (d, a, c, b).
        const Index o = this->Opposite[h]; // a -> v in q
        const Index hq = next(o);          // v -> b in q
        const Index bd = next(hq);
        const Index da = next(bd);
        const Index qb = this->Opposite[bd];
        const Index qa = this->Opposite[da];
        const auto own = [&](Index t) { return t >= 0 && t / 4 == h / 4; };
        if (own(qb) || own(qa) || qb == da)
        {
          continue; // the two quads are the whole surface
        }
        const Index d = this->start(da);
        remove(o);
        this->Vertex[h] = d; // d -> a
        this->link(h, qa);
        this->link(prev(h), qb); // b -> d
        any = true;
      }
    }
  }
  return removed;
}

void QuadGraph::rotate(Index h)
{
  const Index o = this->Opposite[h];
  const std::array<Index, 6> from = {
    next(h), next(next(h)), prev(h), next(o), next(next(o)), prev(o)};
  // (a, b, c, d) and (b, a, e, f) become (e, c, d, a) and (c, e, f, b).
  const std::array<Index, 6> to = {
    prev(o), next(h), next(next(h)), prev(h), next(o), next(next(o))};
  std::array<Index, 6> vertex{};
  std::array<Index, 6> twin{};
  for (int k = 0; k < 6; ++k)
  {
    vertex[k] = this->Vertex[from[k]];
    const auto at = std::find(from.begin(), from.end(), this->Opposite[from[k]]);
    twin[k] = at == from.end() ? this->Opposite[from[k]] : to[at - from.begin()];
  }
  for (int k = 0; k < 6; ++k)
  {
    this->Vertex[to[k]] = vertex[k];
    this->link(to[k], twin[k]);
  }
  this->Vertex[h] = vertex[4]; // e -> c
  this->Vertex[o] = vertex[1]; // c -> e
}

std::vector<Index> QuadGraph::splitChord(Index h, Index& vertices)
{
  // Back to where the chord starts, if it does; then all sides by which it enters a quad.
  Index first = h;
  for (Index n = 0; n < this->halfEdges(); ++n)
  {
    const Index o = this->Opposite[first];
    if (o < 0)
    {
      break;
    }
    first = next(next(o));
    if (first == h)
    {
      break;
    }
  }
  std::vector<Index> enter;
  std::vector<std::uint8_t> seen(this->Vertex.size() / 4, 0);
  bool closed = false;
  for (Index x = first; x >= 0 && !closed;)
  {
    if (seen[x / 4])
    {
      return {};
    }
    seen[x / 4] = 1;
    enter.push_back(x);
    x = this->Opposite[next(next(x))];
    closed = x == first;
  }
  if (closed && enter.size() < 2)
  {
    return {};
  }
  const auto n = static_cast<Index>(enter.size());
  const Index base = vertices;
  vertices += n + (closed ? 0 : 1);
  std::vector<Index> sides;
  std::vector<Index> other(n); // m -> b of the new quads
  for (Index i = 0; i < n; ++i)
  {
    const Index x = enter[i]; // a -> b of (a, b, c, d)
    const Index b = this->end(x);
    const Index c = this->start(next(next(x)));
    const Index m = base + i;
    const Index out = base + (closed ? (i + 1) % n : i + 1);
    const Index bc = this->Opposite[next(x)];
    this->Vertex[next(x)] = m;
    this->Vertex[next(next(x))] = out;
    other[i] = this->add({m, b, c, out});
    this->link(other[i] + 1, bc == next(x) ? -1 : bc);
    this->link(next(x), other[i] + 3);
    sides.push_back(x);
  }
  for (Index i = 0; i < n; ++i)
  {
    if (i > 0 || closed)
    {
      const Index before = (i + n - 1) % n;
      this->link(enter[i], next(next(enter[before])));
      this->link(other[i], other[before] + 2);
    }
  }
  if (!closed)
  {
    sides.push_back(other[n - 1] + 2); // c -> n on the boundary
  }
  return sides;
}

std::vector<Index> QuadGraph::repeatedEdges() const
{
  std::vector<Index> repeated;
  for (const auto& e : edgesOf(*this))
  {
    if (e.second.size() > 1)
    {
      repeated.push_back(e.second.back());
    }
  }
  return repeated;
}

bool mendGraph(QuadGraph& graph, std::vector<Vec3>& points, std::vector<VertexKind>& kind)
{
  Mender mender(graph, points, kind);
  if (!mender.run())
  {
    return false;
  }
  mender.even();
  return true;
}

void subdivideGraph(QuadGraph& graph, std::vector<Vec3>& points, std::vector<VertexKind>& kind)
{
  std::vector<Index> middle(graph.Vertex.size(), -1);
  const auto add = [&](const Vec3& p, VertexKind k)
  {
    points.push_back(p);
    kind.push_back(k);
    return static_cast<Index>(points.size()) - 1;
  };
  for (Index h = 0; h < graph.halfEdges(); ++h)
  {
    const Index o = graph.Opposite[h];
    if (graph.alive(h) && (o < 0 || h < o))
    {
      middle[h] = add(0.5 * (points[graph.start(h)] + points[graph.end(h)]),
        o < 0 ? VertexKind::Crease : VertexKind::Free);
      if (o >= 0)
      {
        middle[o] = middle[h];
      }
    }
  }
  QuadGraph fine;
  std::vector<Index> at(graph.Vertex.size(), -1); // quad at each corner
  for (Index q = 0; q < graph.halfEdges(); q += 4)
  {
    if (!graph.alive(q))
    {
      continue;
    }
    Vec3 center = Vec3::Zero();
    for (Index k = 0; k < 4; ++k)
    {
      center += 0.25 * points[graph.start(q + k)];
    }
    const Index c = add(center, VertexKind::Free);
    for (Index h = q; h < q + 4; ++h)
    {
      at[h] = fine.add({graph.start(h), middle[h], c, middle[QuadGraph::prev(h)]});
    }
    for (Index h = q; h < q + 4; ++h)
    {
      fine.link(at[h] + 1, at[QuadGraph::next(h)] + 2);
    }
  }
  for (Index h = 0; h < graph.halfEdges(); ++h)
  {
    const Index o = graph.alive(h) ? graph.Opposite[h] : -1;
    if (o >= 0)
    {
      fine.link(at[h], at[QuadGraph::next(o)] + 3);
    }
  }
  graph = std::move(fine);
}

LayoutDraft draftOf(
  const QuadGraph& graph, const std::vector<Vec3>& points, const std::vector<VertexKind>& kind)
{
  LayoutDraft draft;
  std::vector<Index> number(points.size(), -1);
  for (Index q = 0; q < graph.halfEdges(); q += 4)
  {
    if (!graph.alive(q))
    {
      continue;
    }
    std::array<Index, 4> quad{};
    for (Index k = 0; k < 4; ++k)
    {
      const Index v = graph.start(q + k);
      if (number[v] < 0)
      {
        number[v] = static_cast<Index>(draft.Mesh.Points.size());
        draft.Mesh.Points.push_back(points[v]);
        draft.Kind.push_back(kind[v]);
      }
      quad[k] = number[v];
    }
    draft.Mesh.Quads.push_back(quad);
    draft.Mesh.Region.push_back(0);
  }
  return draft;
}
} // namespace bsr
