#include "Layout/CutMesh.h"

#include "Mesh/TriangleTree.h"

#include <algorithm>
#include <limits>

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
} // namespace bsr
