#include "Mesh/MeshRepair.h"

#include "Common/Parallel.h"
#include "Common/UnionFind.h"
#include "Mesh/EdgePairing.h"
#include "Mesh/TriangleSurface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
using Triangle = std::array<Index, 3>;
constexpr double MergeDistance = 1e-7; ///< of the bounding box's diagonal
constexpr Index Open = -1;             ///< twin of a half-edge at a boundary
constexpr Index Crowded = -2;          ///< not decided yet: three or more faces
constexpr std::size_t Portion = 65536; ///< steps between two questions

class Repairer
{
public:
  Repairer(const TriangleMesh& mesh, RepairReport& report, Monitor& monitor)
      : Report(report), Asked(monitor)
  {
    this->M.Points = mesh.Points;
    this->M.Faces = mesh.Triangles;
    this->M.Region = mesh.Region;
    this->M.Region.resize(this->M.Faces.size(), 0);
    this->M.Source.resize(this->M.Faces.size());
    std::iota(this->M.Source.begin(), this->M.Source.end(), 0);
    report.Faces.assign(this->M.Faces.size(), 0);
  }

  Result<ManifoldMesh> run()
  {
    Monitor& monitor = this->Asked;
    this->dropDegenerate();
    if (monitor.cancelled() || !this->match())
    {
      return Status::cancelled();
    }
    monitor.progress(0.3);
    if (this->HasBoundary && this->mergeBoundaryPoints())
    {
      this->dropDegenerate();
      if (monitor.cancelled() || !this->match())
      {
        return Status::cancelled();
      }
    }
    if (this->M.Faces.empty())
    {
      return Status::invalidInput("All triangles of the surface are degenerate; check the filters "
                                  "before this one.");
    }
    this->pairCrowded();
    monitor.progress(0.6);
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    if (!this->orient() && !monitor.cancelled())
    {
      return Status::invalidInput("The surface is one-sided (a Moebius strip); it has no layout. "
                                  "Cut it open first.");
    }
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    this->splitFans();
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    return std::move(this->M);
  }

private:
  Index vertex(Index h) const { return this->M.Faces[h / 3][h % 3]; }
  Index end(Index h) const { return this->vertex(TriangleSurface::next(h)); }
  Index apex(Index h) const { return this->vertex(TriangleSurface::prev(h)); }
  Index halfEdges() const { return static_cast<Index>(3 * this->M.Faces.size()); }
  Index upper(Index h) const { return std::max(this->vertex(h), this->end(h)); }
  /// Asked once in a while of the steps of a loop.
  bool cancelledAt(std::size_t step) { return step % Portion == 0 && this->Asked.cancelled(); }
  void mark(Index face, FaceRepair what) { this->Report.Faces[this->M.Source[face]] |= what; }

  void dropFaces(const std::vector<std::uint8_t>& drop, FaceRepair why, Index& count)
  {
    std::size_t n = 0;
    for (std::size_t f = 0; f < this->M.Faces.size(); ++f)
    {
      if (drop[f])
      {
        this->mark(static_cast<Index>(f), why);
        ++count;
        continue;
      }
      this->M.Faces[n] = this->M.Faces[f];
      this->M.Source[n] = this->M.Source[f];
      this->M.Region[n++] = this->M.Region[f];
    }
    this->M.Faces.resize(n);
    this->M.Source.resize(n);
    this->M.Region.resize(n);
  }

  void dropDegenerate()
  {
    std::vector<std::uint8_t> drop(this->M.Faces.size(), 0);
    bool any = false;
    for (std::size_t f = 0; f < drop.size(); ++f)
    {
      const Triangle& t = this->M.Faces[f];
      drop[f] = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      any = any || drop[f];
    }
    if (any)
    {
      this->dropFaces(drop, RepairDegenerate, this->Report.DegenerateFaces);
    }
  }

  /// Finds twins whatever the orientation, and drops repeated faces. False: cancelled.
  bool match()
  {
    if (!this->bucketHalfEdges() || (this->dropDuplicates() && !this->bucketHalfEdges()))
    {
      return false;
    }
    const std::vector<Index>& twin = this->M.Twin;
    this->HasBoundary = std::find(twin.begin(), twin.end(), Open) != twin.end();
    return true;
  }

  /// Half-edges by the lower of their ends, then by the other end; twins where an edge has two.
  /// False: cancelled.
  bool bucketHalfEdges()
  {
    const Index nh = this->halfEdges();
    this->First.assign(this->M.Points.size() + 1, 0);
    for (Index h = 0; h < nh; ++h)
    {
      ++this->First[std::min(this->vertex(h), this->end(h)) + 1];
    }
    std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
    this->Bucket.resize(nh);
    std::vector<Index> at(this->First.begin(), this->First.end() - 1);
    for (Index h = 0; h < nh; ++h)
    {
      if (this->cancelledAt(h))
      {
        return false;
      }
      this->Bucket[at[std::min(this->vertex(h), this->end(h))]++] = h;
    }
    this->M.Twin.assign(nh, Open);
    this->Special.assign(this->M.Points.size(), 0);
    return parallelForUntilCancelled(0, static_cast<std::int64_t>(this->M.Points.size()), 4096,
      this->Asked,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t v = first; v < last; ++v)
        {
          this->matchAt(static_cast<Index>(v));
        }
      });
  }

  template <class Visit>
  void groupsAt(Index v, const Visit& visit)
  {
    const auto last = this->Bucket.begin() + this->First[v + 1];
    for (auto i = this->Bucket.begin() + this->First[v]; i != last;)
    {
      const Index top = this->upper(*i);
      auto j = i + 1;
      while (j != last && this->upper(*j) == top)
      {
        ++j;
      }
      visit(i, j);
      i = j;
    }
  }

  void matchAt(Index v)
  {
    std::sort(this->Bucket.begin() + this->First[v], this->Bucket.begin() + this->First[v + 1],
      [&](Index a, Index b)
      {
        const Index ua = this->upper(a);
        const Index ub = this->upper(b);
        return ua != ub ? ua < ub : a < b;
      });
    this->groupsAt(v,
      [&](auto i, auto j)
      {
        if (j - i == 2)
        {
          this->M.Twin[i[0]] = i[1];
          this->M.Twin[i[1]] = i[0];
          this->Special[v] |= this->apex(i[0]) == this->apex(i[1]);
        }
        for (auto k = i; j - i > 2 && k != j; ++k)
        {
          this->M.Twin[*k] = Crowded;
          this->Special[v] = 1;
        }
      });
  }

  bool dropDuplicates()
  {
    std::vector<std::uint8_t> drop(this->M.Faces.size(), 0);
    bool any = false;
    for (std::size_t v = 0; v < this->Special.size(); ++v)
    {
      if (!this->Special[v])
      {
        continue;
      }
      this->groupsAt(static_cast<Index>(v),
        [&](auto i, auto j)
        {
          std::vector<std::pair<Index, Index>> byApex;
          for (auto k = i; k != j; ++k)
          {
            byApex.emplace_back(this->apex(*k), *k / 3);
          }
          std::sort(byApex.begin(), byApex.end());
          for (std::size_t k = 1; k < byApex.size(); ++k)
          {
            if (byApex[k].first == byApex[k - 1].first)
            {
              drop[byApex[k].second] = 1;
              any = true;
            }
          }
        });
    }
    if (any)
    {
      this->dropFaces(drop, RepairDuplicate, this->Report.DuplicateFaces);
    }
    return any;
  }

  /// Merges coincident points at boundaries; false if there were none, or if cancelled.
  bool mergeBoundaryPoints()
  {
    std::vector<std::uint8_t> border(this->M.Points.size(), 0);
    Eigen::AlignedBox3d box;
    for (Index h = 0; h < this->halfEdges(); ++h)
    {
      if (this->cancelledAt(h))
      {
        return false;
      }
      box.extend(this->M.Points[this->vertex(h)]);
      if (this->M.Twin[h] == Open)
      {
        border[this->vertex(h)] = border[this->end(h)] = 1;
      }
    }
    // Along a direction that no usual mesh is aligned with, only few points are near.
    const Vec3 along = Vec3(0.5774, 0.6313, 0.5179).normalized();
    std::vector<std::pair<double, Index>> order;
    for (std::size_t v = 0; v < border.size(); ++v)
    {
      if (border[v])
      {
        order.emplace_back(along.dot(this->M.Points[v]), static_cast<Index>(v));
      }
    }
    std::sort(order.begin(), order.end());
    const double near = MergeDistance * box.diagonal().norm();
    UnionFind sets(static_cast<std::int64_t>(this->M.Points.size()));
    bool any = false;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      if (i % 1024 == 0 && this->Asked.cancelled())
      {
        return false;
      }
      for (std::size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= near; ++j)
      {
        const Vec3& p = this->M.Points[order[i].second];
        if ((p - this->M.Points[order[j].second]).squaredNorm() <= near * near)
        {
          sets.join(order[i].second, order[j].second);
          any = true;
        }
      }
    }
    for (Index f = 0; any && f < this->halfEdges() / 3; ++f)
    {
      for (Index& v : this->M.Faces[f])
      {
        const auto to = static_cast<Index>(sets.find(v));
        if (to != v)
        {
          this->mark(f, RepairMerged);
          ++this->Report.MergedPoints;
          v = to;
        }
      }
    }
    return any;
  }

  void pairCrowded()
  {
    this->Paired.assign(this->M.Twin.size(), 0);
    for (std::size_t v = 0; v < this->Special.size(); ++v)
    {
      if (this->Special[v])
      {
        this->groupsAt(static_cast<Index>(v),
          [&](auto i, auto j)
          {
            if (j - i > 2)
            {
              this->pairGroup(i, j);
            }
          });
      }
    }
  }

  template <class Iterator>
  void pairGroup(Iterator i, Iterator j)
  {
    ++this->Report.CutEdges;
    const Index low = std::min(this->vertex(*i), this->end(*i));
    std::vector<EdgeFace> faces;
    for (auto k = i; k != j; ++k)
    {
      this->mark(*k / 3, RepairCut);
      this->M.Twin[*k] = Open;
      faces.push_back(
        {*k, this->vertex(*k) == low, this->loose(*k), this->M.Points[this->apex(*k)]});
    }
    for (const auto& p : pairAtEdge(this->M.Points[low], this->M.Points[this->upper(*i)], faces))
    {
      this->M.Twin[p[0]] = p[1];
      this->M.Twin[p[1]] = p[0];
      this->Paired[p[0]] = this->Paired[p[1]] = 1;
    }
  }

  /// Is another edge of the face at a boundary?
  bool loose(Index h) const
  {
    return this->M.Twin[TriangleSurface::next(h)] == Open ||
           this->M.Twin[TriangleSurface::prev(h)] == Open;
  }

  /// Orients faces alike and numbers components; false on a one-sided surface. Edges that were
  /// paired by choice are crossed last and opened where that makes a surface one-sided. False once
  /// cancelled, too.
  bool orient()
  {
    this->M.Component.assign(this->M.Faces.size(), -1);
    std::vector<std::uint8_t> turned(this->M.Faces.size(), 0);
    for (std::size_t seed = 0; seed < this->M.Faces.size(); ++seed)
    {
      if (this->M.Component[seed] < 0 && !this->flood(static_cast<Index>(seed), turned))
      {
        return false;
      }
    }
    for (std::size_t f = 0; f < turned.size(); ++f)
    {
      if (this->cancelledAt(f))
      {
        return false;
      }
      if (turned[f])
      {
        ++this->Report.TurnedFaces;
        this->mark(static_cast<Index>(f), RepairTurned);
        this->turnFace(static_cast<Index>(f));
      }
    }
    return true;
  }

  bool flood(Index seed, std::vector<std::uint8_t>& turned)
  {
    const Index component = this->M.Components++;
    this->M.Component[seed] = component;
    std::vector<Index> queue(1, seed);
    std::vector<Index> later; // half-edges of chosen pairs
    std::vector<Index> all;
    double area[2] = {0.0, 0.0};
    while (!queue.empty())
    {
      const Index f = queue.back();
      queue.pop_back();
      if (this->cancelledAt(all.size()))
      {
        return false;
      }
      all.push_back(f);
      area[turned[f]] += this->areaOf(f);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (this->M.Twin[h] >= 0 && this->Paired[h])
        {
          later.push_back(h);
        }
        else if (this->M.Twin[h] >= 0 && !this->cross(h, component, turned, queue))
        {
          return false;
        }
      }
      while (queue.empty() && !later.empty())
      {
        const Index h = later.back();
        later.pop_back();
        if (!this->cross(h, component, turned, queue))
        {
          this->M.Twin[this->M.Twin[h]] = Open;
          this->M.Twin[h] = Open;
        }
      }
    }
    if (area[1] > area[0])
    {
      for (Index f : all)
      {
        turned[f] = !turned[f];
      }
    }
    return true;
  }

  /// Takes the face beyond h into the component; false if it is there, oriented the other way.
  bool cross(Index h, Index component, std::vector<std::uint8_t>& turned, std::vector<Index>& queue)
  {
    const Index o = this->M.Twin[h];
    if (o < 0)
    {
      return true;
    }
    const bool turn = (this->vertex(h) == this->vertex(o)) != (turned[h / 3] != 0);
    if (this->M.Component[o / 3] < 0)
    {
      this->M.Component[o / 3] = component;
      turned[o / 3] = turn;
      queue.push_back(o / 3);
      return true;
    }
    return (turned[o / 3] != 0) == turn;
  }

  double areaOf(Index f) const
  {
    const Triangle& t = this->M.Faces[f];
    const Vec3& p = this->M.Points[t[0]];
    return (this->M.Points[t[1]] - p).cross(this->M.Points[t[2]] - p).norm();
  }

  /// Exchanges corners 1 and 2, with them half-edges 0 (0-1) and 2 (2-0).
  void turnFace(Index f)
  {
    std::swap(this->M.Faces[f][1], this->M.Faces[f][2]);
    std::swap(this->M.Twin[3 * f], this->M.Twin[3 * f + 2]);
    for (Index h : {3 * f, 3 * f + 2})
    {
      const Index o = this->M.Twin[h];
      if (o >= 0)
      {
        this->M.Twin[o] = h;
      }
    }
  }

  /// Gives each fan of faces at a vertex its own vertex; stops once cancelled.
  void splitFans()
  {
    std::vector<std::uint8_t> seen(this->M.Twin.size(), 0);
    std::vector<std::uint8_t> used(this->M.Points.size(), 0);
    for (Index h = 0; h < this->halfEdges(); ++h)
    {
      if (this->cancelledAt(h))
      {
        return;
      }
      if (seen[h])
      {
        continue;
      }
      const Index v = this->vertex(h);
      Index to = v;
      if (used[v])
      {
        to = static_cast<Index>(this->M.Points.size());
        this->M.Points.push_back(Vec3(this->M.Points[v]));
        used.push_back(1);
        ++this->Report.SplitVertices;
      }
      used[v] = 1;
      this->overFan(h,
        [&](Index x)
        {
          seen[x] = 1;
          if (to != v)
          {
            this->M.Faces[x / 3][x % 3] = to;
            this->mark(x / 3, RepairSplit);
          }
        });
    }
  }

  /// All half-edges out of the vertex of h that are reached over edges.
  template <class Visit>
  void overFan(Index h, const Visit& visit)
  {
    Index x = h;
    do
    {
      const Index next = this->M.Twin[TriangleSurface::prev(x)];
      visit(x);
      x = next;
    } while (x >= 0 && x != h);
    for (x = x < 0 ? this->M.Twin[h] : -1; x >= 0;)
    {
      const Index at = TriangleSurface::next(x);
      const Index next = this->M.Twin[at];
      visit(at);
      x = next;
    }
  }

  ManifoldMesh M;
  RepairReport& Report;
  Monitor& Asked;
  std::vector<Index> First; ///< per vertex: its part of Bucket
  std::vector<Index> Bucket;
  std::vector<std::uint8_t> Special; ///< per vertex: an edge there has repeated or many faces
  std::vector<std::uint8_t> Paired;  ///< per half-edge: joined by choice
  bool HasBoundary = false;
};

Status checkInput(const TriangleMesh& mesh)
{
  if (mesh.Triangles.empty())
  {
    return Status::invalidInput("The surface has no triangles; check the filters before this one.");
  }
  const auto n = static_cast<Index>(mesh.Points.size());
  for (const Triangle& t : mesh.Triangles)
  {
    for (Index v : t)
    {
      if (v < 0 || v >= n)
      {
        return Status::invalidInput("A triangle names a point that does not exist.");
      }
      if (!mesh.Points[v].allFinite())
      {
        return Status::invalidInput("Point " + std::to_string(v) +
                                    " of a triangle has a NaN or infinite coordinate; remove it "
                                    "first (Threshold, Clean).");
      }
    }
  }
  return Status::ok();
}
} // namespace

Result<ManifoldMesh> repairMesh(const TriangleMesh& mesh, RepairReport& report, Monitor& monitor)
{
  if (Status s = checkInput(mesh); !s)
  {
    return s;
  }
  return Repairer(mesh, report, monitor).run();
}
} // namespace bsr
