#include "Mesh/BuildSurface.h"

#include "Common/Parallel.h"
#include "Mesh/MeshRepair.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
/// Adds a fan of virtual triangles to each boundary loop.
Index fillHoles(TriangleSurface& s)
{
  Index loops = 0;
  std::vector<std::uint8_t> done(s.Vertex.size(), 0);
  const auto nh = static_cast<Index>(s.Vertex.size());
  for (Index h = 0; h < nh; ++h)
  {
    if (s.Opposite[h] >= 0 || done[h])
    {
      continue;
    }
    ++loops;
    std::vector<Index> loop; // boundary half-edges, in the order of the hole's own orientation
    for (Index x = h; !done[x];)
    {
      done[x] = 1;
      loop.push_back(x);
      // The previous boundary half-edge: turn around the start of x.
      Index y = TriangleSurface::prev(x);
      while (s.Opposite[y] >= 0)
      {
        y = TriangleSurface::prev(s.Opposite[y]);
      }
      x = y;
    }
    if (loop.size() == 2)
    {
      s.Opposite[loop[0]] = loop[1]; // a slit of no width: closed
      s.Opposite[loop[1]] = loop[0];
      --loops;
      continue;
    }
    const Index middle = s.vertices();
    Vec3 center = Vec3::Zero();
    for (Index x : loop)
    {
      center += s.Points[s.Vertex[x]] / static_cast<double>(loop.size());
    }
    s.Points.push_back(center);
    s.Virtual.push_back(1);
    const Index base = static_cast<Index>(s.Vertex.size());
    const auto n = static_cast<Index>(loop.size());
    for (Index i = 0; i < n; ++i)
    {
      // Triangle (end, start, middle) beside the boundary half-edge start -> end.
      const Index x = loop[i];
      const Index t = base + 3 * i;
      s.Vertex.insert(s.Vertex.end(), {s.end(x), s.Vertex[x], middle});
      s.Opposite.insert(
        s.Opposite.end(), {x, base + 3 * ((i + 1) % n) + 2, base + 3 * ((i + n - 1) % n) + 1});
      s.Opposite[x] = t;
      s.Region.push_back(TriangleSurface::HoleRegion);
    }
  }
  return loops;
}

void markCreases(TriangleSurface& s, double featureAngle)
{
  const double limit = std::cos(std::min(featureAngle, 180.0) * M_PI / 180.0);
  const bool sharp = featureAngle < 180.0;
  std::vector<Vec3> normal(sharp ? s.Region.size() : 0);
  parallelFor(0, static_cast<std::int64_t>(normal.size()), 4096,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t f = first; f < last; ++f)
      {
        normal[f] = s.areaNormal(static_cast<Index>(f)).normalized();
      }
    });
  const auto nh = static_cast<Index>(s.Vertex.size());
  for (Index h = 0; h < nh; ++h)
  {
    const Index f = h / 3;
    const Index g = s.Opposite[h] / 3;
    s.Crease[h] = s.Region[f] != s.Region[g] ||
                  (sharp && !s.hole(f) && !s.hole(g) && normal[f].dot(normal[g]) < limit);
  }
}

/// Some faces of a mesh, all of one component, as a closed surface.
TriangleSurface extract(const ManifoldMesh& m, const Index* faces, std::size_t count,
  std::vector<Index>& pointMap, std::vector<Index>& faceMap)
{
  TriangleSurface s;
  for (std::size_t i = 0; i < count; ++i)
  {
    faceMap[faces[i]] = static_cast<Index>(i);
  }
  s.Vertex.reserve(3 * count);
  s.Opposite.reserve(3 * count);
  s.Region.reserve(count);
  s.Points.reserve(count / 2 + 2);
  for (std::size_t i = 0; i < count; ++i)
  {
    const Index f = faces[i];
    for (int k = 0; k < 3; ++k)
    {
      const Index v = m.Faces[f][k];
      if (pointMap[v] < 0)
      {
        pointMap[v] = s.vertices();
        s.Points.push_back(m.Points[v]);
      }
      s.Vertex.push_back(pointMap[v]);
      const Index o = m.Twin[3 * f + k];
      s.Opposite.push_back(o < 0 ? -1 : 3 * faceMap[o / 3] + o % 3);
    }
    s.Region.push_back(m.Region[f]);
  }
  s.Virtual.assign(s.Points.size(), 0);
  return s;
}

void linkVertices(TriangleSurface& s)
{
  s.Out.assign(s.Points.size(), -1);
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    s.Out[s.Vertex[h]] = h;
  }
}

/// The faces of each component, one after the other; where each begins.
void sortByComponent(
  const ManifoldMesh& m, std::vector<Index>& faces, std::vector<std::size_t>& first)
{
  first.assign(static_cast<std::size_t>(m.Components) + 1, 0);
  for (Index c : m.Component)
  {
    ++first[c + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  faces.resize(m.Faces.size());
  std::vector<std::size_t> at(first.begin(), first.end() - 1);
  for (std::size_t f = 0; f < m.Faces.size(); ++f)
  {
    faces[at[m.Component[f]]++] = static_cast<Index>(f);
  }
}

std::vector<double> componentAreas(const ManifoldMesh& m)
{
  std::vector<double> area(static_cast<std::size_t>(m.Components), 0.0);
  for (std::size_t f = 0; f < m.Faces.size(); ++f)
  {
    const auto& t = m.Faces[f];
    const Vec3& p = m.Points[t[0]];
    area[m.Component[f]] += 0.5 * (m.Points[t[1]] - p).cross(m.Points[t[2]] - p).norm();
  }
  return area;
}
} // namespace

Result<std::vector<TriangleSurface>> buildSurfaces(const TriangleMesh& mesh,
  const BuildSurfaceOptions& options, RepairReport& report, Monitor& monitor)
{
  SubMonitor repairing(monitor, 0.0, 0.7);
  auto repaired = repairMesh(mesh, report, repairing);
  if (!repaired)
  {
    return repaired.status();
  }
  const ManifoldMesh& m = *repaired;
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  const std::vector<double> area = componentAreas(m);
  const double total = std::accumulate(area.begin(), area.end(), 0.0);
  if (!(total > 0.0) || !std::isfinite(total))
  {
    return Status::invalidInput("The surface has no area; check its coordinates.");
  }
  std::vector<Index> faces;
  std::vector<std::size_t> first;
  sortByComponent(m, faces, first);
  std::vector<Index> order(area.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
  std::vector<Index> pointMap(m.Points.size(), -1);
  std::vector<Index> faceMap(m.Faces.size(), -1);
  std::vector<TriangleSurface> surfaces;
  for (Index c : order)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    if (c != order.front() && (!(area[c] > 0.0) || area[c] < options.SmallestShare * total))
    {
      ++report.Specks;
      for (std::size_t i = first[c]; i < first[c + 1]; ++i)
      {
        report.Faces[m.Source[faces[i]]] |= RepairSpeck;
      }
      continue;
    }
    surfaces.push_back(extract(m, &faces[first[c]], first[c + 1] - first[c], pointMap, faceMap));
    TriangleSurface& s = surfaces.back();
    report.BoundaryLoops += fillHoles(s);
    s.Crease.assign(s.Vertex.size(), 0);
    linkVertices(s);
    markCreases(s, options.FeatureAngle);
  }
  return surfaces;
}
} // namespace bsr
