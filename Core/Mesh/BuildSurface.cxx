#include "Mesh/BuildSurface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace bsr
{
namespace
{
using Triangle = std::array<Index, 3>;

Status checkInput(const TriangleMesh& mesh)
{
  if (mesh.Triangles.empty())
  {
    return Status::invalidInput("The surface has no triangles; check the filters before this one.");
  }
  for (const Vec3& p : mesh.Points)
  {
    if (!p.allFinite())
    {
      return Status::invalidInput("A point has a NaN or infinite coordinate; remove it first.");
    }
  }
  const auto n = static_cast<Index>(mesh.Points.size());
  for (const Triangle& t : mesh.Triangles)
  {
    if (*std::min_element(t.begin(), t.end()) < 0 || *std::max_element(t.begin(), t.end()) >= n)
    {
      return Status::invalidInput("A triangle names a point that does not exist.");
    }
  }
  return Status::ok();
}

/// First point at the same place, for every point.
std::vector<Index> coincident(const std::vector<Vec3>& points)
{
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  auto key = [&](Index i) { return std::tie(points[i][0], points[i][1], points[i][2]); };
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  std::vector<Index> first(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const bool same = i > 0 && points[order[i]] == points[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// Working copy of the mesh: what is repaired step by step.
struct Builder
{
  std::vector<Vec3> Points;
  std::vector<Triangle> Faces;
  std::vector<Index> Region;
  std::vector<Index> Twin; ///< opposite half-edge, -1 at boundaries; orientation may disagree
  RepairReport& Report;

  Index vertex(Index h) const { return this->Faces[h / 3][h % 3]; }
  Index end(Index h) const { return this->vertex(TriangleSurface::next(h)); }

  void dropFaces(const std::vector<std::uint8_t>& drop)
  {
    std::size_t n = 0;
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      if (!drop[f])
      {
        this->Faces[n] = this->Faces[f];
        this->Region[n++] = this->Region[f];
      }
    }
    this->Faces.resize(n);
    this->Region.resize(n);
  }

  void clean()
  {
    std::vector<std::uint8_t> drop(this->Faces.size(), 0);
    for (std::size_t f = 0; f < drop.size(); ++f)
    {
      const Triangle& t = this->Faces[f];
      drop[f] = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      this->Report.DegenerateFaces += drop[f];
    }
    this->dropFaces(drop);
  }

  void dropDuplicates()
  {
    std::vector<Triangle> sorted = this->Faces;
    std::vector<Index> order(sorted.size());
    std::iota(order.begin(), order.end(), 0);
    for (Triangle& t : sorted)
    {
      std::sort(t.begin(), t.end());
    }
    std::sort(order.begin(), order.end(),
      [&](Index a, Index b) { return sorted[a] != sorted[b] ? sorted[a] < sorted[b] : a < b; });
    std::vector<std::uint8_t> drop(sorted.size(), 0);
    for (std::size_t i = 1; i < order.size(); ++i)
    {
      if (sorted[order[i]] == sorted[order[i - 1]])
      {
        drop[order[i]] = 1;
        ++this->Report.DuplicateFaces;
      }
    }
    this->dropFaces(drop);
  }

  /// Finds twins whatever the orientation; false: an edge has more than two faces.
  bool match(bool& hasBoundary)
  {
    const auto nh = static_cast<Index>(3 * this->Faces.size());
    std::vector<Index> start(this->Points.size() + 1, 0);
    for (Index h = 0; h < nh; ++h)
    {
      ++start[std::min(this->vertex(h), this->end(h)) + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<Index> bucket(nh);
    std::vector<Index> at(start.begin(), start.end() - 1);
    for (Index h = 0; h < nh; ++h)
    {
      bucket[at[std::min(this->vertex(h), this->end(h))]++] = h;
    }
    this->Twin.assign(nh, -1);
    hasBoundary = false;
    for (std::size_t v = 0; v + 1 < start.size(); ++v)
    {
      const auto first = bucket.begin() + start[v];
      const auto last = bucket.begin() + start[v + 1];
      auto top = [&](Index h) { return std::max(this->vertex(h), this->end(h)); };
      std::sort(
        first, last, [&](Index a, Index b) { return top(a) != top(b) ? top(a) < top(b) : a < b; });
      for (auto i = first; i != last;)
      {
        auto j = std::find_if(i, last, [&](Index h) { return top(h) != top(*i); });
        if (j - i > 2)
        {
          return false;
        }
        hasBoundary = hasBoundary || j - i == 1;
        if (j - i == 2)
        {
          this->Twin[i[0]] = i[1];
          this->Twin[i[1]] = i[0];
        }
        i = j;
      }
    }
    return true;
  }

  void mergePoints()
  {
    const std::vector<Index> first = coincident(this->Points);
    for (Triangle& t : this->Faces)
    {
      for (Index& v : t)
      {
        this->Report.MergedPoints += first[v] != v;
        v = first[v];
      }
    }
    this->clean();
    this->dropDuplicates();
  }

  /// Orients the faces alike; false on a one-sided surface. Numbers the components.
  bool orient(std::vector<Index>& component, Index& components)
  {
    component.assign(this->Faces.size(), -1);
    std::vector<std::uint8_t> turned(this->Faces.size(), 0);
    std::vector<Index> queue;
    components = 0;
    for (std::size_t seed = 0; seed < this->Faces.size(); ++seed)
    {
      if (component[seed] >= 0)
      {
        continue;
      }
      component[seed] = components;
      queue.assign(1, static_cast<Index>(seed));
      while (!queue.empty())
      {
        const Index f = queue.back();
        queue.pop_back();
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          const Index o = this->Twin[h];
          if (o < 0)
          {
            continue;
          }
          const bool turn = (this->vertex(h) == this->vertex(o)) != (turned[f] != 0);
          if (component[o / 3] < 0)
          {
            component[o / 3] = components;
            turned[o / 3] = turn;
            queue.push_back(o / 3);
          }
          else if ((turned[o / 3] != 0) != turn)
          {
            return false;
          }
        }
      }
      ++components;
    }
    for (std::size_t f = 0; f < turned.size(); ++f)
    {
      if (turned[f])
      {
        ++this->Report.TurnedFaces;
        std::swap(this->Faces[f][1], this->Faces[f][2]);
      }
    }
    return true;
  }

  /// Gives each fan of faces at a vertex its own vertex.
  void splitFans()
  {
    const auto nh = static_cast<Index>(this->Twin.size());
    std::vector<std::uint8_t> seen(nh, 0);
    std::vector<std::uint8_t> used(this->Points.size(), 0);
    for (Index h = 0; h < nh; ++h)
    {
      if (seen[h])
      {
        continue;
      }
      const Index v = this->vertex(h);
      std::vector<Index> fan = this->fan(h);
      for (Index x : fan)
      {
        seen[x] = 1;
      }
      if (used[v])
      {
        const auto copy = static_cast<Index>(this->Points.size());
        this->Points.push_back(Vec3(this->Points[v]));
        used.push_back(1);
        ++this->Report.SplitVertices;
        for (Index x : fan)
        {
          this->Faces[x / 3][x % 3] = copy;
        }
      }
      used[v] = 1;
    }
  }

  /// All half-edges out of the vertex of h that are reached over edges.
  std::vector<Index> fan(Index h) const
  {
    std::vector<Index> out;
    Index x = h;
    do
    {
      out.push_back(x);
      x = this->Twin[TriangleSurface::prev(x)];
    } while (x >= 0 && x != h);
    if (x < 0)
    {
      for (x = this->Twin[h]; x >= 0; x = this->Twin[x])
      {
        x = TriangleSurface::next(x);
        out.push_back(x);
      }
    }
    return out;
  }
};

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
      s.Crease.insert(s.Crease.end(), {0, 0, 0});
      s.Region.push_back(TriangleSurface::HoleRegion);
    }
  }
  return loops;
}

void markCreases(TriangleSurface& s, double featureAngle)
{
  const double limit = std::cos(std::min(featureAngle, 180.0) * M_PI / 180.0);
  std::vector<Vec3> normal(s.Region.size());
  for (Index f = 0; f < s.faces(); ++f)
  {
    normal[f] = s.areaNormal(f).normalized();
  }
  const auto nh = static_cast<Index>(s.Vertex.size());
  for (Index h = 0; h < nh; ++h)
  {
    const Index f = h / 3;
    const Index g = s.Opposite[h] / 3;
    s.Crease[h] = s.Region[f] != s.Region[g] || (featureAngle < 180.0 && !s.hole(f) && !s.hole(g) &&
                                                  normal[f].dot(normal[g]) < limit);
  }
}

/// The component `c` of the builder's faces as a closed surface.
TriangleSurface extract(const Builder& b, const std::vector<Index>& faces,
  std::vector<Index>& pointMap, std::vector<Index>& faceMap)
{
  TriangleSurface s;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    faceMap[faces[i]] = static_cast<Index>(i);
  }
  for (Index f : faces)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index v = b.Faces[f][k];
      if (pointMap[v] < 0)
      {
        pointMap[v] = s.vertices();
        s.Points.push_back(b.Points[v]);
      }
      s.Vertex.push_back(pointMap[v]);
      const Index o = b.Twin[3 * f + k];
      s.Opposite.push_back(o < 0 ? -1 : 3 * faceMap[o / 3] + o % 3);
    }
    s.Region.push_back(b.Region[f]);
  }
  s.Crease.assign(s.Vertex.size(), 0);
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
} // namespace

Result<std::vector<TriangleSurface>> buildSurfaces(
  const TriangleMesh& mesh, double featureAngle, RepairReport& report, Monitor& monitor)
{
  if (Status s = checkInput(mesh); !s)
  {
    return s;
  }
  Builder b{mesh.Points, mesh.Triangles, mesh.Region, {}, report};
  b.Region.resize(b.Faces.size(), 0);
  b.clean();
  b.dropDuplicates();
  bool boundary = false;
  if (!b.match(boundary) || boundary)
  {
    b.mergePoints();
    if (!b.match(boundary))
    {
      return Status::invalidInput("Three or more triangles meet at an edge; take a surface whose "
                                  "edges have two (Contour of an image, or Clean to Grid and "
                                  "Feature Edges to find the places).");
    }
  }
  if (b.Faces.empty())
  {
    return Status::invalidInput("All triangles of the surface are degenerate.");
  }
  std::vector<Index> component;
  Index components = 0;
  if (!b.orient(component, components))
  {
    return Status::invalidInput("The surface is one-sided (a Moebius strip); it has no layout.");
  }
  if (report.TurnedFaces > 0)
  {
    b.match(boundary); // half-edge numbers changed
  }
  b.splitFans();
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  std::vector<std::vector<Index>> faces(components);
  for (std::size_t f = 0; f < component.size(); ++f)
  {
    faces[component[f]].push_back(static_cast<Index>(f));
  }
  std::vector<Index> pointMap(b.Points.size(), -1);
  std::vector<Index> faceMap(b.Faces.size(), -1);
  std::vector<std::pair<double, std::size_t>> order;
  std::vector<TriangleSurface> surfaces;
  for (const auto& list : faces)
  {
    surfaces.push_back(extract(b, list, pointMap, faceMap));
    TriangleSurface& s = surfaces.back();
    report.BoundaryLoops += fillHoles(s);
    linkVertices(s);
    markCreases(s, featureAngle);
    order.emplace_back(-s.area(), order.size());
  }
  std::sort(order.begin(), order.end());
  std::vector<TriangleSurface> sorted;
  sorted.reserve(order.size());
  for (const auto& o : order)
  {
    sorted.push_back(std::move(surfaces[o.second]));
  }
  return sorted;
}
} // namespace bsr
