#include "Mesh/FillHoles.h"

#include "Common/BoxTree.h"
#include "Mesh/HolePatch.h"
#include "Mesh/ImplicitSurface.h"
#include "Mesh/LoopTriangulation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>

namespace bsr
{
namespace
{
constexpr std::size_t MostCenters = 500; ///< points on the surface that the implicit one takes
constexpr std::size_t MostNormals = 250; ///< of them with points off the surface
constexpr double Reach = 0.35;           ///< how far around a hole they lie, in its sizes
constexpr double FlatEnd = 0.02;
constexpr double SteepEnd = 60.0;

/// Neighbors, normals and edge lengths of a mesh's points.
class Surroundings
{
public:
  explicit Surroundings(const TriangleMesh& mesh) : Mesh(mesh)
  {
    const std::size_t n = mesh.Points.size();
    this->First.assign(n + 1, 0);
    for (const auto& t : mesh.Triangles)
    {
      for (const Index v : t)
      {
        this->First[v + 1] += 2;
      }
    }
    for (std::size_t v = 0; v < n; ++v)
    {
      this->First[v + 1] += this->First[v];
    }
    this->Neighbor.resize(static_cast<std::size_t>(this->First[n]));
    std::vector<std::int64_t> at(this->First.begin(), this->First.end() - 1);
    this->Normal.assign(n, Vec3::Zero());
    for (const auto& t : mesh.Triangles)
    {
      const Vec3 area =
        (mesh.Points[t[1]] - mesh.Points[t[0]]).cross(mesh.Points[t[2]] - mesh.Points[t[0]]);
      for (int k = 0; k < 3; ++k)
      {
        this->Neighbor[at[t[k]]++] = t[(k + 1) % 3];
        this->Neighbor[at[t[k]]++] = t[(k + 2) % 3];
        this->Normal[t[k]] += area;
      }
    }
  }

  template <class Visit>
  void around(Index v, const Visit& visit) const
  {
    for (std::int64_t i = this->First[v]; i < this->First[v + 1]; ++i)
    {
      visit(this->Neighbor[i]);
    }
  }

  double spacing(Index v) const
  {
    double sum = 0.0;
    double count = 0.0;
    this->around(v,
      [&](Index n)
      {
        sum += (this->Mesh.Points[n] - this->Mesh.Points[v]).norm();
        count += 1.0;
      });
    return count > 0.0 ? sum / count : 0.0;
  }

  /// The unit normal, averaged with the neighbors' against the noise of scans.
  Vec3 normal(Index v) const
  {
    Vec3 sum = this->Normal[v];
    this->around(v, [&](Index n) { sum += 0.5 * this->Normal[n]; });
    return sum.norm() > 0.0 ? Vec3(sum.normalized()) : Vec3(Vec3::Zero());
  }

  bool joined(Index a, Index b) const
  {
    bool found = false;
    this->around(a, [&](Index n) { found = found || n == b; });
    return found;
  }

  /// Points within a distance along edges of some points, nearest first.
  std::vector<Index> within(const std::vector<Index>& sources, double reach) const
  {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::map<Index, double> best;
    for (const Index v : sources)
    {
      best[v] = 0.0;
      queue.push({0.0, v});
    }
    std::vector<Index> order;
    std::set<Index> done;
    while (!queue.empty())
    {
      const double d = queue.top().first;
      const Index v = queue.top().second;
      queue.pop();
      if (!done.insert(v).second)
      {
        continue;
      }
      order.push_back(v);
      this->around(v,
        [&](Index n)
        {
          const double e = d + (this->Mesh.Points[n] - this->Mesh.Points[v]).norm();
          const auto found = best.find(n);
          if (e <= reach && (found == best.end() || e < found->second))
          {
            best[n] = e;
            queue.push({e, n});
          }
        });
    }
    return order;
  }

private:
  const TriangleMesh& Mesh;
  std::vector<std::int64_t> First;
  std::vector<Index> Neighbor;
  std::vector<Vec3> Normal;
};

/// At most `count` of the items, spread evenly over their order.
std::vector<Index> thinned(const std::vector<Index>& items, std::size_t count)
{
  if (items.size() <= count)
  {
    return items;
  }
  std::vector<Index> out;
  for (std::size_t i = 0; i < count; ++i)
  {
    out.push_back(items[i * items.size() / count]);
  }
  return out;
}

/// Farthest-point sampling: keeps the first `fixed` items and adds those farthest from all kept.
std::vector<Index> spreadOut(const std::vector<Vec3>& points, const std::vector<Index>& items,
  std::size_t fixed, std::size_t count)
{
  std::vector<Index> kept(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(fixed));
  std::vector<double> distance(items.size(), std::numeric_limits<double>::infinity());
  const auto add = [&](Index v)
  {
    for (std::size_t i = 0; i < items.size(); ++i)
    {
      distance[i] = std::min(distance[i], (points[items[i]] - points[v]).squaredNorm());
    }
  };
  std::for_each(kept.begin(), kept.end(), add);
  while (kept.size() < std::min(count, items.size()))
  {
    const auto far = std::max_element(distance.begin(), distance.end());
    if (!(*far > 0.0))
    {
      break;
    }
    kept.push_back(items[static_cast<std::size_t>(far - distance.begin())]);
    add(kept.back());
  }
  return kept;
}

class HoleFiller
{
public:
  HoleFiller(const TriangleMesh& mesh, const FillHolesOptions& options)
      : Input(mesh), Options(options), Around(mesh)
  {
    this->Out.Mesh.Points = mesh.Points;
    this->Out.Mesh.Triangles = mesh.Triangles;
    Box box;
    std::for_each(mesh.Points.begin(), mesh.Points.end(), [&](const Vec3& p) { box.add(p); });
    this->Limit = options.MaximumSize * (options.Relative ? (box.Max - box.Min).norm() : 1.0);
  }

  void fill(const BoundaryLoop& loop)
  {
    HoleReport r;
    r.Size = loop.Size;
    r.Flatness = loop.Flatness;
    r.Steepness = loop.Steepness;
    r.Edges = static_cast<Index>(loop.Points.size());
    r.State = this->stateOf(loop);
    if (r.State == HoleState::Filled)
    {
      const std::size_t before = this->Out.Mesh.Triangles.size();
      r.State = this->patch(loop);
      r.Triangles = static_cast<Index>(this->Out.Mesh.Triangles.size() - before);
    }
    this->Out.Holes.push_back(r);
  }

  FilledMesh Out;

private:
  HoleState stateOf(const BoundaryLoop& loop) const
  {
    if (loop.Size > this->Limit)
    {
      return HoleState::TooLarge;
    }
    const bool end = loop.Flatness < FlatEnd && loop.Steepness > SteepEnd && loop.Points.size() > 8;
    return this->Options.KeepCutEnds && end ? HoleState::CutEnd : HoleState::Filled;
  }

  HoleState patch(const BoundaryLoop& loop)
  {
    std::vector<Vec3> points;
    std::vector<double> spacing;
    for (const Index v : loop.Points)
    {
      points.push_back(this->Input.Points[v]);
      spacing.push_back(this->Around.spacing(v));
    }
    const auto taken = [&](Index a, Index b)
    { return this->Around.joined(loop.Points[a], loop.Points[b]) || this->added(loop, a, b); };
    const auto triangles = triangulateLoop(points, taken);
    if (triangles.empty() || this->clashes(loop, triangles))
    {
      return HoleState::Failed;
    }
    HolePatch patch(points, triangles, spacing, taken);
    patch.refine();
    const auto implicit = this->implicitAround(loop);
    const bool curved = implicit && patch.project(*implicit);
    this->append(loop, patch);
    return curved ? HoleState::Filled : HoleState::FilledFlat;
  }

  std::pair<Index, Index> edge(const BoundaryLoop& loop, Index a, Index b) const
  {
    return std::minmax(loop.Points[a], loop.Points[b]);
  }
  bool added(const BoundaryLoop& loop, Index a, Index b) const
  {
    return this->NewEdges.count(this->edge(loop, a, b)) > 0;
  }

  /// Whether a chord joins two points that are joined already.
  bool clashes(const BoundaryLoop& loop, const std::vector<std::array<Index, 3>>& triangles) const
  {
    const auto n = static_cast<Index>(loop.Points.size());
    for (const auto& t : triangles)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Index a = t[k];
        const Index b = t[(k + 1) % 3];
        const bool side = (a + 1) % n == b || (b + 1) % n == a;
        if (!side &&
            (this->Around.joined(loop.Points[a], loop.Points[b]) || this->added(loop, a, b)))
        {
          return true;
        }
      }
    }
    return false;
  }

  Result<ImplicitSurface> implicitAround(const BoundaryLoop& loop) const
  {
    double spacing = 0.0;
    for (const Index v : loop.Points)
    {
      spacing += this->Around.spacing(v) / static_cast<double>(loop.Points.size());
    }
    const double reach = std::max(4.0 * spacing, Reach * loop.Size);
    const auto rim = thinned(loop.Points, MostCenters / 2);
    std::vector<Index> items = rim;
    const std::set<Index> onLoop(loop.Points.begin(), loop.Points.end());
    for (const Index v : this->Around.within(loop.Points, reach))
    {
      if (onLoop.count(v) == 0)
      {
        items.push_back(v);
      }
    }
    const auto chosen = spreadOut(this->Input.Points, items, rim.size(), MostCenters);
    std::vector<Vec3> points;
    points.reserve(chosen.size());
    std::vector<Vec3> normals(chosen.size(), Vec3::Zero());
    for (const Index v : chosen)
    {
      points.push_back(this->Input.Points[v]);
    }
    const std::size_t step = std::max<std::size_t>(1, chosen.size() / MostNormals);
    for (std::size_t i = 0; i < chosen.size(); i += step)
    {
      normals[i] = this->Around.normal(chosen[i]);
    }
    return ImplicitSurface::fit(points, normals, spacing);
  }

  void append(const BoundaryLoop& loop, const HolePatch& patch)
  {
    const auto n = static_cast<Index>(loop.Points.size());
    const auto base = static_cast<Index>(this->Out.Mesh.Points.size());
    for (const Vec3& p : patch.innerPoints())
    {
      this->Out.Mesh.Points.push_back(p);
      const auto near = std::min_element(loop.Points.begin(), loop.Points.end(),
        [&](Index a, Index b) {
          return (this->Input.Points[a] - p).squaredNorm() <
                 (this->Input.Points[b] - p).squaredNorm();
        });
      this->Out.NearPoint.push_back(*near);
    }
    for (auto t : patch.triangles())
    {
      for (Index& v : t)
      {
        v = v < n ? loop.Points[v] : base + v - n;
      }
      this->Out.Mesh.Triangles.push_back(t);
      for (int k = 0; k < 3; ++k)
      {
        this->NewEdges.insert(std::minmax(t[k], t[(k + 1) % 3]));
      }
    }
  }

  const TriangleMesh& Input;
  const FillHolesOptions& Options;
  Surroundings Around;
  double Limit = 0.0;
  std::set<std::pair<Index, Index>> NewEdges;
};
} // namespace

Index FilledMesh::filled() const
{
  return static_cast<Index>(std::count_if(this->Holes.begin(), this->Holes.end(),
    [](const HoleReport& h) { return h.State <= HoleState::FilledFlat; }));
}

Result<FilledMesh> fillHoles(
  const TriangleMesh& mesh, const FillHolesOptions& options, Monitor& monitor)
{
  if (!(options.MaximumSize >= 0.0) || !std::isfinite(options.MaximumSize))
  {
    return Status::invalidParameter("MaximumHoleSize must be 0 or a positive number.");
  }
  const auto loops = boundaryLoops(mesh);
  if (!loops)
  {
    return loops.status();
  }
  HoleFiller filler(mesh, options);
  for (std::size_t i = 0; i < loops->size(); ++i)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    monitor.progress(static_cast<double>(i) / static_cast<double>(loops->size()));
    filler.fill((*loops)[i]);
  }
  monitor.progress(1.0);
  return std::move(filler.Out);
}
} // namespace bsr
