#include "Layout/GeodesicPartition.h"

#include "Common/BoxTree.h"
#include "Common/Parallel.h"
#include "Layout/LaySides.h"
#include "Layout/MappedTriangles.h"
#include "Layout/SquareMap.h"
#include "Mesh/BoundaryLoops.h"
#include "Mesh/BuildSurface.h"
#include "Mesh/RemoveSlivers.h"
#include "Mesh/TriangleTree.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace bsr
{
namespace
{
constexpr double EdgeShare = 0.14; ///< longest edge of the refined mesh, of a quad's mean side
constexpr double Margin = 0.04;    ///< paths keep this share of an edge away from its ends
constexpr double OnMesh = 1e-6;    ///< of the diagonal: such points lie on the mesh
constexpr double Shore = 0.15;     ///< of a side's length: nearer to other sides it is slow

double meanSide(const QuadMesh& quads)
{
  double sum = 0.0;
  for (const auto& q : quads.Quads)
  {
    for (int k = 0; k < 4; ++k)
    {
      sum += (quads.Points[q[k]] - quads.Points[q[(k + 1) % 4]]).norm();
    }
  }
  return sum / (4.0 * static_cast<double>(quads.Quads.size()));
}

/// Diagonal of the points' bounding box.
double diagonalOf(const std::vector<Vec3>& points)
{
  Box box;
  std::for_each(points.begin(), points.end(), [&](const Vec3& p) { box.add(p); });
  return (box.Max - box.Min).norm();
}

/// Whether the quads' normals run against those of the mesh beneath them, by majority.
bool opposed(const TriangleMesh& mesh, const QuadMesh& quads)
{
  const TriangleTree tree(mesh.Points, mesh.Triangles);
  int votes = 0;
  for (const auto& q : quads.Quads)
  {
    const Vec3 center =
      0.25 * (quads.Points[q[0]] + quads.Points[q[1]] + quads.Points[q[2]] + quads.Points[q[3]]);
    const Vec3 normal =
      (quads.Points[q[2]] - quads.Points[q[0]]).cross(quads.Points[q[3]] - quads.Points[q[1]]);
    votes += normal.dot(tree.normal(tree.nearest(center).Triangle)) < 0.0 ? 1 : -1;
  }
  return votes > 0;
}

/// Some triangles of the cut mesh as a mesh of their own.
struct LocalMesh
{
  TriangleMesh Mesh;
  std::vector<Index> Global; ///< vertex of the cut mesh
  std::unordered_map<Index, Index> Local;

  void add(const TriangleSurface& s, const std::vector<Index>& faces)
  {
    for (const Index f : faces)
    {
      std::array<Index, 3> t{};
      const auto corners = s.corners(f);
      for (int k = 0; k < 3; ++k)
      {
        const auto [at, fresh] =
          this->Local.insert({corners[k], static_cast<Index>(this->Global.size())});
        if (fresh)
        {
          this->Global.push_back(corners[k]);
          this->Mesh.Points.push_back(s.Points[corners[k]]);
        }
        t[k] = at->second;
      }
      this->Mesh.Triangles.push_back(t);
    }
  }
};

/// A path in global vertices, points near free vertices moved onto them, loops cut out.
std::vector<EdgePoint> snapped(const std::vector<EdgePoint>& path, const LocalMesh& local,
  const std::vector<std::uint8_t>& shore)
{
  std::vector<EdgePoint> out;
  for (std::size_t i = 0; i < path.size(); ++i)
  {
    EdgePoint p = path[i];
    if (!p.isVertex())
    {
      const Index near = p.T < 0.5 ? p.A : p.B;
      if (std::min(p.T, 1.0 - p.T) < 0.06 && !shore[near])
      {
        p = {near, near, 0.0};
      }
    }
    p.A = local.Global[p.A];
    p.B = local.Global[p.B];
    const auto same = std::find_if(out.begin(), out.end(),
      [&](const EdgePoint& q)
      {
        return p.isVertex() ? q.isVertex() && q.A == p.A
                            : !q.isVertex() && std::minmax(q.A, q.B) == std::minmax(p.A, p.B);
      });
    out.erase(same, out.end());
    out.push_back(p);
  }
  return out;
}

/// The geodesic of a side in the union of its quads; empty where it touches other sides.
std::vector<EdgePoint> geodesicSide(const CutMesh& cut, const LayoutGraph& graph, Index edge)
{
  const Index h = graph.First[edge];
  LocalMesh local;
  local.add(cut.Surface, cut.Faces[h / 4]);
  local.add(cut.Surface, cut.Faces[graph.Twin[h] / 4]);
  const auto twin = halfEdgeTwins(local.Mesh);
  if (!twin)
  {
    return {};
  }
  std::vector<std::uint8_t> shore(local.Global.size(), 0);
  for (std::size_t x = 0; x < twin->size(); ++x)
  {
    if ((*twin)[x] < 0)
    {
      const auto& t = local.Mesh.Triangles[x / 3];
      shore[t[x % 3]] = shore[t[(x + 1) % 3]] = 1;
    }
  }
  const FastMarching march(local.Mesh, *twin);
  const Index a = local.Local[cut.Sides[edge].front()];
  const Index b = local.Local[cut.Sides[edge].back()];
  std::vector<Index> rim;
  for (std::size_t v = 0; v < shore.size(); ++v)
  {
    if (shore[v])
    {
      rim.push_back(static_cast<Index>(v));
    }
  }
  const double width = Shore * (local.Mesh.Points[a] - local.Mesh.Points[b]).norm();
  std::vector<double> slow = march.distances(rim);
  for (double& x : slow)
  {
    const double near = std::max(0.0, 1.0 - x / width);
    x = 1.0 + 5.0 * near * near;
  }
  auto path = march.descend(march.distances({b}, slow, -1), a);
  if (path.empty())
  {
    return {};
  }
  march.straighten(path, 8, Margin);
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
  {
    if (path[i].isVertex() && shore[path[i].A])
    {
      return {};
    }
  }
  return snapped(path, local, shore);
}

/// The sides' places on the square of a quad.
SquareDisc discOf(const CutMesh& cut, const LayoutGraph& graph, Index quad, const LocalMesh& local)
{
  static const std::array<Vec2, 4> corner = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  SquareDisc disc;
  disc.Mesh = local.Mesh;
  for (int k = 0; k < 4; ++k)
  {
    const Index edge = graph.Edge[4 * quad + k];
    const auto& path = cut.Sides[edge];
    // Arc length in the side's own direction, so that both neighbors see the same numbers.
    std::vector<double> at(1, 0.0);
    for (std::size_t i = 1; i < path.size(); ++i)
    {
      at.push_back(
        at.back() + (cut.Surface.Points[path[i]] - cut.Surface.Points[path[i - 1]]).norm());
    }
    const bool along = graph.First[edge] == 4 * quad + k;
    const Vec2& from = corner[along ? k : (k + 1) % 4];
    const Vec2& to = corner[along ? (k + 1) % 4 : k];
    for (std::size_t i = 0; i < path.size(); ++i)
    {
      const bool last = along ? i + 1 == path.size() : i == 0;
      if (!last)
      {
        disc.Boundary.push_back(local.Local.at(path[i]));
        disc.BoundaryUV.emplace_back(from + (at[i] / at.back()) * (to - from));
      }
    }
  }
  return disc;
}

class Partitioner
{
public:
  Partitioner(const std::vector<Vec3>& points, const TriangleMesh& mesh, const QuadMesh& quads,
    const GeodesicOptions& options, Monitor& monitor)
      : Points(points), Input(mesh), Quads(quads), Options(options), Watch(monitor)
  {
  }

  Result<GeodesicPartition> run()
  {
    // The nearest quads serve where no region is found, and the checks are the same.
    PartitionOptions simple;
    simple.Facing = this->Options.Facing;
    SubMonitor first(this->Watch, 0.0, 0.1);
    auto nearest = partitionToQuads(this->Points, this->Quads, simple, first);
    if (!nearest)
    {
      return nearest.status();
    }
    this->Out.Points = std::move(*nearest);
    auto graph = LayoutGraph::build(this->Quads);
    if (!graph)
    {
      return graph.status();
    }
    this->Graph = std::move(*graph);
    for (const auto& step : {&Partitioner::cut, &Partitioner::straighten, &Partitioner::mapRegions})
    {
      if (Status s = (this->*step)(); !s)
      {
        return s;
      }
    }
    this->locate();
    this->markBoundary();
    this->describe();
    this->Watch.progress(1.0);
    return std::move(this->Out);
  }

private:
  /// The mesh's components without slivers, on the side that the layout looks to.
  Result<std::vector<TriangleSurface>> surfaces()
  {
    TriangleMesh mesh = this->Input;
    mesh.Region.clear();
    RepairReport repairs;
    auto surfaces = buildSurfaces(mesh, {}, repairs, this->Watch);
    if (surfaces && opposed(surfaces->front().toMesh(), this->Quads))
    {
      for (auto& t : mesh.Triangles)
      {
        std::swap(t[1], t[2]);
      }
      surfaces = buildSurfaces(mesh, {}, repairs, this->Watch);
    }
    if (surfaces)
    {
      std::for_each(
        surfaces->begin(), surfaces->end(), [](TriangleSurface& s) { removeSlivers(s); });
    }
    return surfaces;
  }

  Status cut()
  {
    auto surfaces = this->surfaces();
    if (!surfaces)
    {
      return surfaces.status();
    }
    const auto base =
      CutMesh::build(*surfaces, this->Quads, this->Graph, EdgeShare * meanSide(this->Quads));
    if (!base)
    {
      return base.status();
    }
    SubMonitor laying(this->Watch, 0.1, 0.3);
    auto laid = laySides(*base, this->Quads, this->Graph, laying);
    if (!laid)
    {
      return laid.status();
    }
    this->Cut = std::move(laid->Mesh);
    return Status::ok();
  }

  Status straighten()
  {
    if (!this->Options.Straighten)
    {
      return Status::ok();
    }
    for (Index e = 0; e < this->Graph.edges(); ++e)
    {
      if (this->Watch.cancelled())
      {
        return Status::cancelled();
      }
      const Index h = this->Graph.First[e];
      const Index t = this->Graph.Twin[h];
      if (t < 0 || t / 4 == h / 4 || this->Cut.Faces[h / 4].empty() ||
          this->Cut.Faces[t / 4].empty())
      {
        this->Out.RoughSides += t >= 0 ? 1 : 0;
        continue;
      }
      const auto path = geodesicSide(this->Cut, this->Graph, e);
      if (path.empty() || !this->Cut.replaceSide(this->Graph, e, path))
      {
        ++this->Out.RoughSides;
      }
      this->Watch.progress(0.3 + 0.3 * (e + 1) / this->Graph.edges());
    }
    return Status::ok();
  }

  Status mapRegions()
  {
    const auto n = static_cast<Index>(this->Quads.Quads.size());
    std::vector<LocalMesh> local(this->Quads.Quads.size());
    std::vector<std::vector<Vec2>> uv(local.size());
    std::vector<int> folded(local.size(), 0);
    constexpr Index Batch = 32;
    for (Index begin = 0; begin < n; begin += Batch)
    {
      if (this->Watch.cancelled())
      {
        return Status::cancelled();
      }
      parallelFor(begin, std::min(n, begin + Batch), 1,
        [&](std::int64_t first, std::int64_t last)
        {
          for (auto q = static_cast<Index>(first); q < last; ++q)
          {
            if (!this->Cut.Faces[q].empty())
            {
              local[q].add(this->Cut.Surface, this->Cut.Faces[q]);
              const SquareDisc disc = discOf(this->Cut, this->Graph, q, local[q]);
              uv[q] = squareMap(disc, this->Options.StretchRounds);
              folded[q] = uv[q].empty() ? 0 : foldedTriangles(disc.Mesh, uv[q]);
            }
          }
        });
      this->Watch.progress(0.6 + 0.3 * std::min(n, begin + Batch) / n);
    }
    this->Out.Failed.assign(local.size(), 0);
    this->Out.FailedQuads = 0;
    for (Index q = 0; q < n; ++q)
    {
      if (uv[q].empty())
      {
        this->Out.Failed[q] = 1;
        ++this->Out.FailedQuads;
        for (const Index f : this->Cut.Faces[q])
        {
          this->Map.addUnmapped(this->Cut.Surface, f);
        }
        continue;
      }
      this->Out.FoldedTriangles += folded[q];
      this->Map.add(local[q].Mesh, uv[q], q);
    }
    for (Index f = 0; f < this->Cut.Surface.faces(); ++f)
    {
      if (this->Cut.Surface.Region[f] == CutMesh::Unknown)
      {
        this->Map.addUnmapped(this->Cut.Surface, f);
      }
    }
    this->Map.build();
    return Status::ok();
  }

  void locate()
  {
    Partition& p = this->Out.Points;
    const auto n = static_cast<std::int64_t>(this->Points.size());
    const double on = OnMesh * diagonalOf(this->Input.Points);
    parallelFor(0, n, 1000,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          const Vec3 facing =
            this->Options.Facing.empty() ? Vec3(Vec3::Zero()) : this->Options.Facing[i];
          const QuadHit hit = this->Map.find(this->Points[i], facing, on);
          p.Distance[i] = std::sqrt(hit.SquaredDistance);
          if (hit.Quad >= 0)
          {
            p.QuadId[i] = hit.Quad;
            p.UV[i] = hit.UV;
          }
        }
      });
    std::vector<char> used(this->Quads.Quads.size(), 0);
    double sum = 0.0;
    p.Max = 0.0;
    for (std::size_t i = 0; i < p.QuadId.size(); ++i)
    {
      used[p.QuadId[i]] = 1;
      sum += p.Distance[i] * p.Distance[i];
      p.Max = std::max(p.Max, p.Distance[i]);
    }
    p.EmptyQuads = std::count(used.begin(), used.end(), 0);
    p.RMS = std::sqrt(sum / static_cast<double>(n));
  }

  /// Points of the mesh's boundary are put exactly on their sides.
  void markBoundary()
  {
    Partition& p = this->Out.Points;
    const double near = 1e-9 * diagonalOf(this->Input.Points);
    std::vector<std::uint8_t> boundary(p.QuadId.size(), 0);
    bool any = false;
    for (std::size_t i = 0; i < p.QuadId.size(); ++i)
    {
      Vec2& uv = p.UV[i];
      for (int k = 0; k < 4 && p.Distance[i] <= near; ++k)
      {
        double& across = uv[k % 2 == 0 ? 1 : 0];
        const double border = k == 1 || k == 2 ? 1.0 : 0.0;
        if (this->Graph.Twin[4 * p.QuadId[i] + k] < 0 && std::abs(across - border) < 1e-9 &&
            !this->Out.Failed[p.QuadId[i]])
        {
          across = border;
          boundary[i] = 1;
          any = true;
        }
      }
    }
    p.Boundary = any ? std::move(boundary) : std::vector<std::uint8_t>();
  }

  void describe()
  {
    std::vector<double> length(static_cast<std::size_t>(this->Graph.edges()), 0.0);
    const auto far = detours(this->Cut, this->Quads, this->Graph);
    this->Out.Detours = static_cast<int>(std::count(far.begin(), far.end(), 1));
    for (Index e = 0; e < this->Graph.edges(); ++e)
    {
      const Index h = this->Graph.First[e];
      const Index t = this->Graph.Twin[h];
      std::vector<Vec3> side;
      for (const Index v : this->Cut.Sides[e])
      {
        side.push_back(this->Cut.Surface.Points[v]);
        length[e] += side.size() > 1 ? (side.back() - side[side.size() - 2]).norm() : 0.0;
      }
      this->Out.Sides.push_back(std::move(side));
      this->Out.SideEnds.push_back({this->Graph.from(h), this->Graph.to(h)});
      this->Out.SideQuads.push_back({h / 4, t < 0 ? -1 : t / 4});
    }
    for (std::size_t q = 0; q < this->Quads.Quads.size(); ++q)
    {
      std::array<double, 4> l{};
      for (std::size_t k = 0; k < 4; ++k)
      {
        l[k] = length[this->Graph.Edge[4 * q + k]];
      }
      const auto [least, most] = std::minmax_element(l.begin(), l.end());
      if (*least > 0.0)
      {
        this->Out.Stretch = std::max(this->Out.Stretch, *most / *least);
      }
    }
  }

  const std::vector<Vec3>& Points;
  const TriangleMesh& Input;
  const QuadMesh& Quads;
  const GeodesicOptions& Options;
  Monitor& Watch;
  LayoutGraph Graph;
  CutMesh Cut;
  MappedTriangles Map;
  GeodesicPartition Out;
};
} // namespace

Result<GeodesicPartition> partitionGeodesic(const std::vector<Vec3>& points,
  const TriangleMesh& mesh, const QuadMesh& quads, const GeodesicOptions& options, Monitor& monitor)
{
  return Partitioner(points, mesh, quads, options, monitor).run();
}
} // namespace bsr
