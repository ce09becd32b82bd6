#include "Layout/QuadGraph.h"

#include <algorithm>

namespace bsr
{
std::map<QuadGraph::Pair, std::vector<Index>> QuadGraph::edges() const
{
  std::map<Pair, std::vector<Index>> found;
  for (Index h = 0; h < this->halfEdges(); ++h)
  {
    if (this->alive(h) && (this->Opposite[h] < 0 || h < this->Opposite[h]))
    {
      found[pairOf(this->start(h), this->end(h))].push_back(h);
    }
  }
  return found;
}

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
  for (const auto& e : this->edges())
  {
    if (e.second.size() > 1)
    {
      repeated.push_back(e.second.back());
    }
  }
  return repeated;
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
