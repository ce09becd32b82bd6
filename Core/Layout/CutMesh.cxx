#include "Layout/CutMesh.h"

#include <algorithm>

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
