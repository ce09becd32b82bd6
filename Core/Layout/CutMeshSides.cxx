// Sides of the layout as paths on the cut mesh: tracing, laying and replacing them.
#include "Layout/CutMesh.h"

#include <algorithm>
#include <queue>
#include <set>
#include <unordered_map>
#include <unordered_set>

namespace bsr
{
namespace
{
constexpr Index MostGrowth = 6; ///< of the triangles while sides are laid: they run in spirals

double toSegment(const Vec3& p, const Vec3& a, const Vec3& b)
{
  const double l = (b - a).squaredNorm();
  const double t = l > 0.0 ? std::clamp((p - a).dot(b - a) / l, 0.0, 1.0) : 0.0;
  return (p - a - t * (b - a)).norm();
}
} // namespace

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

/// A side over free vertices, not further from the straight line between its corners than `reach`
/// times its length.
bool CutMesh::traceSide(const QuadMesh& layout, const LayoutGraph& graph, Index edge, double reach)
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
    if (toSegment(s.Points[v], pa, pb) > reach * length)
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
  std::unordered_set<Index> seen{face};
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
  std::unordered_set<Index> border;
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
  std::vector<Index> faces{first / 3};
  std::unordered_set<Index> seen{first / 3};
  std::unordered_set<Index> vertices;
  std::size_t creases = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    if (s.Region[faces[i]] != Unknown)
    {
      return false; // a hole, or another quad's
    }
    for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h)
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
      else if (seen.insert(s.Opposite[h] / 3).second)
      {
        faces.push_back(s.Opposite[h] / 3);
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

/// Whether a side cuts what is left of the surface in two.
bool CutMesh::parts(Index edge) const
{
  const auto& path = this->Sides[edge];
  const Index left = this->findHalfEdge(path[0], path[1]);
  const auto faces = this->flood(left / 3);
  return std::find(faces.begin(), faces.end(), this->Surface.Opposite[left] / 3) == faces.end();
}

void CutMesh::takeUp(Index edge)
{
  this->mark(this->Sides[edge], 0);
  this->Sides[edge].clear();
}

void CutMesh::takeUpAround(const LayoutGraph& graph, int rings)
{
  std::vector<std::uint8_t> bad(graph.Quads.size());
  for (std::size_t q = 0; q < bad.size(); ++q)
  {
    bad[q] = this->Faces[q].empty();
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    std::vector<std::uint8_t> corner(graph.Spokes.size(), 0);
    for (std::size_t q = 0; q < bad.size(); ++q)
    {
      for (int k = 0; bad[q] && k < 4; ++k)
      {
        corner[graph.Quads[q][k]] = 1;
      }
    }
    for (std::size_t q = 0; q < bad.size(); ++q)
    {
      const auto& c = graph.Quads[q];
      bad[q] |= corner[c[0]] | corner[c[1]] | corner[c[2]] | corner[c[3]];
    }
  }
  for (std::size_t q = 0; q < bad.size(); ++q)
  {
    for (std::size_t i = 0; bad[q] && i < this->Faces[q].size(); ++i)
    {
      this->Surface.Region[this->Faces[q][i]] = Unknown;
    }
    if (bad[q])
    {
      this->Faces[q].clear();
    }
  }
  for (Index e = 0; e < graph.edges(); ++e)
  {
    const Index h = graph.First[e];
    const Index t = graph.Twin[h];
    if (t >= 0 && bad[h / 4] && bad[t / 4] && !this->Sides[e].empty())
    {
      this->takeUp(e);
    }
  }
}

Result<int> CutMesh::laySides(
  const QuadMesh& layout, const LayoutGraph& graph, const SideOrder& order, Monitor& monitor)
{
  std::vector<Index> sides = order.Edges;
  std::size_t tries = order.EndOfLoops - order.FirstLoop; // of a side later, after the other loops
  tries *= tries;
  const Index most = MostGrowth * this->Surface.faces();
  for (std::size_t i = 0; i < sides.size() && this->Surface.faces() < most; ++i)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    const Index e = sides[i];
    const bool laid = std::any_of(order.Reach.begin(), order.Reach.end(),
      [&](double reach) { return this->traceSide(layout, graph, e, reach); });
    if (laid && i >= order.FirstLoop && i < order.EndOfLoops && this->parts(e) && tries > 0)
    {
      this->takeUp(e);
      const auto at = sides.begin() + static_cast<std::ptrdiff_t>(i);
      std::rotate(at, at + 1, sides.begin() + static_cast<std::ptrdiff_t>(order.EndOfLoops));
      --i;
      --tries;
    }
  }
  int failed = 0;
  for (Index q = 0; q < static_cast<Index>(graph.Quads.size()); ++q)
  {
    failed += !this->Faces[q].empty() || this->findQuad(graph, q) ? 0 : 1;
  }
  return failed;
}

double CutMesh::sideLength(Index edge) const
{
  const auto& side = this->Sides[edge];
  double length = 0.0;
  for (std::size_t i = 1; i < side.size(); ++i)
  {
    length += (this->Surface.Points[side[i]] - this->Surface.Points[side[i - 1]]).norm();
  }
  return length;
}

double CutMesh::totalLength() const
{
  double length = 0.0;
  for (Index e = 0; e < static_cast<Index>(this->Sides.size()); ++e)
  {
    length += this->sideLength(e);
  }
  return length;
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
