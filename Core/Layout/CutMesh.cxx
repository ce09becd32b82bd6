#include "Layout/CutMesh.h"

#include "Mesh/TriangleTree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>
#include <unordered_map>

namespace bsr
{
namespace
{
/// One surface of all components.
TriangleSurface joined(const std::vector<TriangleSurface>& parts)
{
  TriangleSurface all;
  for (const TriangleSurface& s : parts)
  {
    const auto v = static_cast<Index>(all.Points.size());
    const auto h = static_cast<Index>(all.Vertex.size());
    const auto shifted = [](std::vector<Index>& to, const std::vector<Index>& from, Index by)
    {
      for (const Index i : from)
      {
        to.push_back(i < 0 ? i : i + by);
      }
    };
    all.Points.insert(all.Points.end(), s.Points.begin(), s.Points.end());
    all.Virtual.insert(all.Virtual.end(), s.Virtual.begin(), s.Virtual.end());
    all.Crease.insert(all.Crease.end(), s.Crease.begin(), s.Crease.end());
    all.Region.insert(all.Region.end(), s.Region.begin(), s.Region.end());
    shifted(all.Vertex, s.Vertex, v);
    shifted(all.Opposite, s.Opposite, h);
    shifted(all.Out, s.Out, h);
  }
  return all;
}

double toSegment(const Vec3& p, const Vec3& a, const Vec3& b)
{
  const double l = (b - a).squaredNorm();
  const double t = l > 0.0 ? std::clamp((p - a).dot(b - a) / l, 0.0, 1.0) : 0.0;
  return (p - a - t * (b - a)).norm();
}
/// Places of points along a closed polyline, in its order.
struct Placement
{
  std::vector<std::size_t> At;
  double Cost = std::numeric_limits<double>::infinity();
};

/// The least sum of squared distances, by dynamic programming; the nearest point of all is fixed.
Placement placeInOrder(const std::vector<Vec3>& wanted, const std::vector<Vec3>& loop)
{
  const std::size_t m = wanted.size();
  const std::size_t n = loop.size();
  Placement p;
  if (n < m)
  {
    return p;
  }
  std::size_t first = 0;
  std::size_t start = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < m; ++i)
  {
    for (std::size_t j = 0; j < n; ++j)
    {
      const double d = (wanted[i] - loop[j]).squaredNorm();
      if (d < nearest)
      {
        nearest = d;
        first = i;
        start = j;
      }
    }
  }
  const auto cost = [&](std::size_t i, std::size_t j)
  { return (wanted[(first + i) % m] - loop[(start + j) % n]).squaredNorm(); };
  // best[i][j]: the first i + 1 points placed, the last at j.
  std::vector<std::vector<double>> best(
    m, std::vector<double>(n, std::numeric_limits<double>::infinity()));
  std::vector<std::vector<std::size_t>> from(m, std::vector<std::size_t>(n, 0));
  best[0][0] = cost(0, 0);
  for (std::size_t i = 1; i < m; ++i)
  {
    std::size_t least = i - 1;
    for (std::size_t j = i; j < n; ++j)
    {
      least = best[i - 1][j - 1] < best[i - 1][least] ? j - 1 : least;
      best[i][j] = best[i - 1][least] + cost(i, j);
      from[i][j] = least;
    }
  }
  const auto end = std::min_element(best[m - 1].begin(), best[m - 1].end());
  p.Cost = *end;
  p.At.resize(m);
  auto j = static_cast<std::size_t>(end - best[m - 1].begin());
  for (std::size_t i = m; i-- > 0; j = from[i][j])
  {
    p.At[(first + i) % m] = (start + j) % n;
  }
  return p;
}
} // namespace

Result<CutMesh> CutMesh::build(const std::vector<TriangleSurface>& surfaces, const QuadMesh& layout,
  const LayoutGraph& graph, double edge)
{
  CutMesh m;
  m.Surface = joined(surfaces);
  m.refine(edge);
  TriangleSurface& s = m.Surface;
  for (Index f = 0; f < s.faces(); ++f)
  {
    s.Region[f] = s.hole(f) ? TriangleSurface::HoleRegion : Unknown;
  }
  m.Wall.assign(s.Points.size(), 0);
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    s.Crease[h] = s.hole(h / 3) != s.hole(s.Opposite[h] / 3);
    if (s.Crease[h] || s.hole(h / 3))
    {
      m.Wall[s.start(h)] = m.Wall[s.end(h)] = 1;
    }
  }
  m.Sides.resize(static_cast<std::size_t>(graph.edges()));
  m.Faces.resize(graph.Quads.size());
  if (!m.placeCorners(layout, graph))
  {
    return Status::invalidInput("The corners of the layout have no places of their own on the "
                                "mesh: it is too coarse, or its boundaries are not those of the "
                                "layout; use the mesh that the layout was made from.");
  }
  std::vector<Index> walls;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    if (m.Wall[v] && !s.Virtual[v] && s.Out[v] >= 0)
    {
      walls.push_back(v);
    }
  }
  m.fence(walls);
  for (Index e = 0; e < graph.edges(); ++e)
  {
    if (graph.Twin[graph.First[e]] < 0 && !m.followBoundary(graph, e))
    {
      return Status::invalidInput(
        "The boundaries of the layout do not follow those of the mesh; use the mesh that the "
        "layout was made from.");
    }
  }
  return m;
}

/// Splits edges that are the longest of both triangles (Rivara) until none is longer.
void CutMesh::refine(double edge)
{
  TriangleSurface& s = this->Surface;
  const auto squared = [&](Index h)
  { return (s.Points[s.start(h)] - s.Points[s.end(h)]).squaredNorm(); };
  for (int pass = 0; pass < 100; ++pass)
  {
    bool any = false;
    const auto count = static_cast<Index>(s.Vertex.size());
    for (Index h = 0; h < count; ++h)
    {
      const Index o = s.Opposite[h];
      if (h > o || s.Virtual[s.start(h)] || s.Virtual[s.end(h)] || squared(h) <= edge * edge)
      {
        continue;
      }
      const auto longest = [&](Index x)
      {
        return s.hole(x / 3) || (squared(TriangleSurface::next(x)) <= squared(x) &&
                                  squared(TriangleSurface::prev(x)) <= squared(x));
      };
      if (longest(h) && longest(o))
      {
        s.split(h, 0.5 * (s.Points[s.start(h)] + s.Points[s.end(h)]));
        any = true;
      }
    }
    if (!any)
    {
      break;
    }
  }
}

/// The boundary loops as vertices, surface on their left.
std::vector<std::vector<Index>> CutMesh::boundaries() const
{
  const TriangleSurface& s = this->Surface;
  std::vector<std::vector<Index>> loops;
  std::vector<std::uint8_t> done(s.Points.size(), 0);
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    const Index start = s.start(h);
    if (s.hole(h / 3) || !s.hole(s.Opposite[h] / 3) || done[start])
    {
      continue;
    }
    std::vector<Index> loop;
    for (Index v = start; v >= 0 && !done[v]; v = this->nextOnBoundary(v))
    {
      done[v] = 1;
      loop.push_back(v);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

Index CutMesh::nextOnBoundary(Index v) const
{
  const TriangleSurface& s = this->Surface;
  Index next = -1;
  s.around(
    v, [&](Index h) { next = !s.hole(h / 3) && s.hole(s.Opposite[h] / 3) ? s.end(h) : next; });
  return next;
}

/// Gives the corners of a boundary of the layout places in their order on one of the mesh.
bool CutMesh::placeOnBoundary(
  const QuadMesh& layout, const std::vector<Index>& corners, std::vector<std::vector<Index>>& loops)
{
  const TriangleSurface& s = this->Surface;
  std::vector<Index>* best = nullptr;
  Placement placed;
  for (auto& loop : loops)
  {
    std::vector<Vec3> places;
    places.reserve(loop.size());
    for (const Index v : loop)
    {
      places.push_back(s.Points[v]);
    }
    std::vector<Vec3> wanted;
    wanted.reserve(corners.size());
    for (const Index c : corners)
    {
      wanted.push_back(layout.Points[c]);
    }
    Placement p = placeInOrder(wanted, places);
    if (p.Cost < placed.Cost)
    {
      placed = std::move(p);
      best = &loop;
    }
  }
  if (!best)
  {
    return false;
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    this->Corner[corners[i]] = (*best)[placed.At[i]];
    this->Wall[this->Corner[corners[i]]] = 2;
  }
  best->clear();
  return true;
}

/// Corners inside at the nearest vertex that is free, those of boundaries in order along them.
bool CutMesh::placeCorners(const QuadMesh& layout, const LayoutGraph& graph)
{
  const TriangleSurface& s = this->Surface;
  this->Corner.assign(layout.Points.size(), -1);
  auto loops = this->boundaries();
  for (const auto& corners : graph.boundaries())
  {
    if (!this->placeOnBoundary(layout, corners, loops))
    {
      return false;
    }
  }
  std::vector<std::array<Index, 3>> faces;
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (!s.hole(f))
    {
      faces.push_back(s.corners(f));
    }
  }
  const TriangleTree tree(s.Points, faces);
  for (std::size_t c = 0; c < layout.Points.size(); ++c)
  {
    if (graph.Spokes[c].empty() || graph.Boundary[c])
    {
      continue;
    }
    const Vec3& p = layout.Points[c];
    Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    const auto offer = [&](Index v)
    {
      const double d = (s.Points[v] - p).squaredNorm();
      if (!s.Virtual[v] && this->Wall[v] == 0 && d < least)
      {
        least = d;
        best = v;
      }
    };
    const auto& near = faces[tree.nearest(p).Triangle];
    std::for_each(near.begin(), near.end(), offer);
    for (int k = 0; k < 3 && best < 0; ++k)
    {
      s.around(near[k], [&](Index h) { offer(s.end(h)); });
    }
    if (best < 0)
    {
      return false;
    }
    this->Corner[c] = best;
    this->Wall[best] = 2;
  }
  return true;
}

Index CutMesh::findHalfEdge(Index a, Index b) const
{
  Index found = -1;
  this->Surface.around(a, [&](Index h) { found = this->Surface.end(h) == b ? h : found; });
  return found;
}

Index CutMesh::splitEdge(Index a, Index b, double t)
{
  const Index h = this->findHalfEdge(a, b);
  if (h < 0 || this->Surface.Crease[h])
  {
    return -1;
  }
  const Vec3 p = (1.0 - t) * this->Surface.Points[a] + t * this->Surface.Points[b];
  const Index f = this->Surface.faces();
  const Index v = this->Surface.split(h, p);
  this->Wall.push_back(0);
  for (const Index face : {f, f + 1})
  {
    const Index quad = this->Surface.Region[face];
    if (quad >= 0)
    {
      this->Faces[quad].push_back(face);
    }
  }
  return v;
}

/// Splits what joins vertices of a path with other walls: beside each path there is a way left.
void CutMesh::fence(const std::vector<Index>& path)
{
  const TriangleSurface& s = this->Surface;
  for (const Index v : path)
  {
    std::vector<Index> ends;
    s.around(v,
      [&](Index h)
      {
        if (!s.Crease[h] && !s.hole(h / 3) && this->Wall[s.end(h)])
        {
          ends.push_back(s.end(h));
        }
      });
    for (const Index e : ends)
    {
      this->splitEdge(v, e, 0.5);
    }
  }
}

void CutMesh::mark(const std::vector<Index>& path, std::uint8_t crease)
{
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    const Index h = this->findHalfEdge(path[i - 1], path[i]);
    this->Surface.Crease[h] = this->Surface.Crease[this->Surface.Opposite[h]] = crease;
    if (i + 1 < path.size())
    {
      this->Wall[path[i]] = crease;
    }
  }
}

/// The side along the mesh's boundary; it must reach its end before another corner.
bool CutMesh::followBoundary(const LayoutGraph& graph, Index edge)
{
  const TriangleSurface& s = this->Surface;
  const Index h0 = graph.First[edge];
  const Index end = this->Corner[graph.to(h0)];
  std::vector<Index> path{this->Corner[graph.from(h0)]};
  do
  {
    const Index next = this->nextOnBoundary(path.back());
    if (next < 0 || (this->Wall[next] == 2 && next != end) || path.size() > s.Points.size())
    {
      return false;
    }
    path.push_back(next);
  } while (path.back() != end);
  this->Sides[edge] = std::move(path);
  return true;
}

/// The neighbors of a corner's vertex over which a side may leave it: those between the sides
/// before and after it in the layout's order.
std::vector<Index> CutMesh::sector(const LayoutGraph& graph, Index vertex, Index edge) const
{
  const TriangleSurface& s = this->Surface;
  const auto& spokes = graph.Spokes[vertex];
  const Index at = this->Corner[vertex];
  const auto n = spokes.size();
  const auto own =
    static_cast<std::size_t>(std::find(spokes.begin(), spokes.end(), edge) - spokes.begin());
  const auto firstOf = [&](Index e)
  {
    const auto& path = this->Sides[e];
    return path.front() == at ? path[1] : path[path.size() - 2];
  };
  Index before = -1;
  Index after = -1;
  for (std::size_t k = 1; k < n; ++k)
  {
    const Index b = spokes[(own + n - k) % n];
    const Index a = spokes[(own + k) % n];
    before = before < 0 && !this->Sides[b].empty() ? firstOf(b) : before;
    after = after < 0 && !this->Sides[a].empty() ? firstOf(a) : after;
  }
  std::vector<Index> ring; // counter-clockwise, from `before` on
  s.around(at, [&](Index h) { ring.push_back(s.end(h)); });
  if (before < 0)
  {
    return ring;
  }
  std::rotate(ring.begin(), std::find(ring.begin(), ring.end(), before), ring.end());
  ring.erase(ring.begin());
  ring.erase(std::find(ring.begin(), ring.end(), after), ring.end());
  return ring;
}

/// A side over free vertices, within its length of the straight line between its corners, or three
/// times as far.
bool CutMesh::traceSide(const QuadMesh& layout, const LayoutGraph& graph, Index edge, bool near)
{
  const TriangleSurface& s = this->Surface;
  const Index h0 = graph.First[edge];
  const Index a = this->Corner[graph.from(h0)];
  const Index b = this->Corner[graph.to(h0)];
  const Vec3& pa = layout.Points[graph.from(h0)];
  const Vec3& pb = layout.Points[graph.to(h0)];
  const double length = std::max((pb - pa).norm(), 1e-300);
  const auto cost = [&](Index x, Index y)
  {
    const Vec3 middle = 0.5 * (s.Points[x] + s.Points[y]);
    const double off = toSegment(middle, pa, pb) / length;
    return (s.Points[x] - s.Points[y]).norm() * (1.0 + 8.0 * off * off);
  };
  const auto starts = this->sector(graph, graph.from(h0), edge);
  const auto ends = this->sector(graph, graph.to(h0), edge);
  const std::set<Index> arrival(ends.begin(), ends.end());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::unordered_map<Index, std::pair<double, Index>> best; // distance, predecessor
  const auto offer = [&](Index v, double d, Index from)
  {
    const auto found = best.find(v);
    if (found == best.end() || d < found->second.first)
    {
      best[v] = {d, from};
      queue.push({d, v});
    }
  };
  for (const Index v : starts)
  {
    if (!this->Wall[v])
    {
      offer(v, cost(a, v), a);
    }
  }
  while (!queue.empty())
  {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > best[v].first)
    {
      continue;
    }
    if (v == b)
    {
      break;
    }
    if (toSegment(s.Points[v], pa, pb) > (near ? 1.0 : 3.0) * length)
    {
      continue;
    }
    const double distance = d;
    const Index from = v;
    s.around(v,
      [&](Index h)
      {
        const Index n = s.end(h);
        if (!this->Wall[n] || (n == b && arrival.count(from) > 0))
        {
          offer(n, distance + cost(from, n), from);
        }
      });
  }
  if (best.find(b) == best.end())
  {
    return false;
  }
  std::vector<Index> path{b};
  while (path.back() != a)
  {
    path.push_back(best[path.back()].second);
  }
  std::reverse(path.begin(), path.end());
  this->mark(path, 1);
  this->fence(path);
  this->Sides[edge] = std::move(path);
  return true;
}

std::vector<Index> CutMesh::side(const LayoutGraph& graph, Index quad, int k) const
{
  const Index h = 4 * quad + k;
  std::vector<Index> path = this->Sides[graph.Edge[h]];
  if (graph.First[graph.Edge[h]] != h)
  {
    std::reverse(path.begin(), path.end());
  }
  return path;
}

/// The triangles that are reached from one without crossing a side.
std::vector<Index> CutMesh::flood(Index face) const
{
  const TriangleSurface& s = this->Surface;
  std::vector<Index> faces{face};
  std::set<Index> seen{face};
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h)
    {
      const Index o = s.Opposite[h] / 3;
      if (!s.Crease[h] && seen.insert(o).second)
      {
        faces.push_back(o);
      }
    }
  }
  return faces;
}

/// Takes the triangles left of a quad's sides, if they are a disc with these sides around it.
bool CutMesh::findQuad(const LayoutGraph& graph, Index quad)
{
  TriangleSurface& s = this->Surface;
  std::set<Index> border;
  Index first = -1;
  for (int k = 0; k < 4; ++k)
  {
    const auto path = this->side(graph, quad, k);
    if (path.empty())
    {
      return false;
    }
    for (std::size_t i = 1; i < path.size(); ++i)
    {
      first = this->findHalfEdge(path[i - 1], path[i]);
      border.insert(first);
    }
  }
  std::vector<Index> faces = this->flood(first / 3);
  std::set<Index> vertices;
  std::size_t creases = 0;
  for (const Index f : faces)
  {
    if (s.Region[f] != Unknown)
    {
      return false; // a hole, or another quad's
    }
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      vertices.insert(s.start(h));
      if (s.Crease[h])
      {
        ++creases;
        if (border.count(h) == 0)
        {
          return false;
        }
      }
    }
  }
  // V - E + F of a disc: E = (3 F + border) / 2.
  const auto f = static_cast<std::int64_t>(faces.size());
  const auto euler = static_cast<std::int64_t>(vertices.size()) -
                     (3 * f + static_cast<std::int64_t>(creases)) / 2 + f;
  if (creases != border.size() || euler != 1)
  {
    return false;
  }
  for (const Index face : faces)
  {
    s.Region[face] = quad;
  }
  this->Faces[quad] = std::move(faces);
  return true;
}

Result<int> CutMesh::laySides(const QuadMesh& layout, const LayoutGraph& graph,
  const std::vector<int>& urgent, Monitor& monitor)
{
  std::vector<Index> order;
  for (Index e = 0; e < graph.edges(); ++e)
  {
    if (this->Sides[e].empty())
    {
      order.push_back(e);
    }
  }
  const auto length = [&](Index e)
  {
    const Index h = graph.First[e];
    return (layout.Points[graph.from(h)] - layout.Points[graph.to(h)]).norm();
  };
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      const auto key = [&](Index e) { return std::make_pair(-urgent[e], length(e)); };
      return key(a) != key(b) ? key(a) < key(b) : a < b;
    });
  for (const Index e : order)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    if (!this->traceSide(layout, graph, e, true))
    {
      this->traceSide(layout, graph, e, false);
    }
  }
  int failed = 0;
  for (Index q = 0; q < static_cast<Index>(graph.Quads.size()); ++q)
  {
    failed += this->findQuad(graph, q) ? 0 : 1;
  }
  return failed;
}

/// Splits the edges that a path crosses; `old` gains the vertices that fall on its edges.
std::vector<Index> CutMesh::insertPath(const std::vector<EdgePoint>& path, std::vector<Index>& old)
{
  std::vector<Index> out;
  for (const EdgePoint& p : path)
  {
    Index v = p.A;
    if (!p.isVertex())
    {
      v = this->splitEdge(p.A, p.B, p.T);
      const auto on = std::adjacent_find(old.begin(), old.end(),
        [&](Index a, Index b) { return std::minmax(a, b) == std::minmax(p.A, p.B); });
      if (v >= 0 && on != old.end())
      {
        old.insert(on + 1, v);
      }
    }
    out.push_back(v);
  }
  return out;
}

bool CutMesh::isFree(const std::vector<Index>& path) const
{
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    const bool last = i + 1 == path.size();
    if (path[i] < 0 || (!last && this->Wall[path[i]]) ||
        this->findHalfEdge(path[i - 1], path[i]) < 0)
    {
      return false;
    }
  }
  return path.size() > 1;
}

bool CutMesh::replaceSide(
  const LayoutGraph& graph, Index edge, const std::vector<EdgePoint>& crossings)
{
  TriangleSurface& s = this->Surface;
  const Index h = graph.First[edge];
  const Index f = h / 4;
  const Index g = graph.Twin[h] / 4;
  std::vector<Index> old = this->Sides[edge];
  this->mark(old, 0);
  const std::vector<Index> path = this->insertPath(crossings, old);
  const std::size_t whole = this->Faces[f].size() + this->Faces[g].size();
  const auto set = [&](const std::vector<Index>& p)
  {
    this->mark(p, 1);
    this->Sides[edge] = p;
    const Index left = this->findHalfEdge(p[0], p[1]);
    this->Faces[f] = this->flood(left / 3);
    this->Faces[g] = this->flood(s.Opposite[left] / 3);
    return this->Faces[f].size() + this->Faces[g].size() == whole;
  };
  const bool free = this->isFree(path);
  const bool done = free && set(path);
  if (!done)
  {
    if (free)
    {
      this->mark(path, 0);
    }
    set(old);
  }
  for (const Index q : {f, g})
  {
    for (const Index face : this->Faces[q])
    {
      s.Region[face] = q;
    }
  }
  this->fence(this->Sides[edge]);
  return done;
}
} // namespace bsr
