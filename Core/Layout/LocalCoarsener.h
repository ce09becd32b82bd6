#pragma once

// The local operations of coarsenLayout; used by Coarsen.cxx alone.

#include "Common/Parallel.h"
#include "Layout/Coarsen.h"
#include "Layout/NearestQuad.h"
#include "Layout/QuadEditor.h"
#include "Layout/RelaxLayout.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <queue>

namespace bsr::coarsening
{
/// What a step must keep.
struct Bounds
{
  double Jacobian; ///< least of the quads around
  double Distance; ///< largest from samples of the surface, in sides of quads
  double Facing;   ///< least of the cosine between quad and surface, times 4
  double Cost;     ///< largest of a step
};

constexpr double GainWeight = 0.25; ///< of irregularity against the relative length of a diagonal

struct Candidate
{
  double Cost;
  Index Quad;
  int Corner;
  std::uint32_t Stamp;
  bool operator<(const Candidate& o) const
  {
    return std::tie(o.Cost, o.Quad, o.Corner) < std::tie(this->Cost, this->Quad, this->Corner);
  }
};

inline double distanceToQuad(const QuadEditor& e, Index q, const Vec3& p)
{
  const auto& c = e.Quads[q];
  const Vec3& p0 = e.Points[c[0]];
  const Vec3& p2 = e.Points[c[2]];
  return std::sqrt(std::min((nearestOnTriangle(p, p0, e.Points[c[1]], p2) - p).squaredNorm(),
    (nearestOnTriangle(p, p0, p2, e.Points[c[3]]) - p).squaredNorm()));
}

/// Collapses of diagonals and turns of edges, each with the points around moved.
class LocalCoarsener
{
public:
  LocalCoarsener(const LayoutDraft& draft, const ReferenceSurface& reference,
    const CoarsenOptions& options, const Bounds& bounds)
      : E(draft),
        Reference(reference),
        Samples(options.Samples),
        Least(bounds.Jacobian),
        Farthest(bounds.Distance),
        Facing(bounds.Facing),
        Stamp(draft.Mesh.Quads.size(), 0),
        Held(draft.Mesh.Quads.size())
  {
    for (const Vec3& p : draft.Mesh.Points)
    {
      this->Side.push_back(options.Side(p));
    }
    this->Normal.resize(draft.Mesh.Points.size());
    for (Index v = 0; v < static_cast<Index>(this->Normal.size()); ++v)
    {
      this->onSurface(v, draft.Mesh.Points[v]);
    }
    this->assign(draft.Mesh);
  }

  int count() const { return this->E.count(); }
  LayoutDraft draft() const { return this->E.draft(); }

  /// Collapses until `target` quads are left; false: cancelled.
  bool collapseTo(int target, double mostCost, Monitor& monitor)
  {
    std::priority_queue<Candidate> queue;
    this->Queue = &queue;
    for (Index q = 0; q < static_cast<Index>(this->E.Quads.size()); ++q)
    {
      this->push(q);
    }
    const double start = std::max(this->count() - target, 1);
    for (int step = 0; this->count() > target && !queue.empty(); ++step)
    {
      if (step % 64 == 0)
      {
        monitor.progress(1.0 - (this->count() - target) / start);
        if (monitor.cancelled())
        {
          return false;
        }
      }
      const Candidate c = queue.top();
      queue.pop();
      if (c.Cost > mostCost)
      {
        break;
      }
      if (this->E.alive(c.Quad) && c.Stamp == this->Stamp[c.Quad])
      {
        this->tryCollapse(c.Quad, c.Corner);
      }
    }
    this->Queue = nullptr;
    return true;
  }

  /// Turns edges where that makes valences more regular.
  void regularize()
  {
    for (int pass = 0; pass < 4; ++pass)
    {
      bool any = false;
      for (Index q = 0; q < static_cast<Index>(this->E.Quads.size()); ++q)
      {
        for (int k = 0; k < 4 && this->E.alive(q); ++k)
        {
          if (this->E.crease(q, k) || this->E.neighbor(q, k) < q)
          {
            continue;
          }
          const int way = this->E.rotateGain(q, k, 1) <= this->E.rotateGain(q, k, -1) ? 1 : -1;
          any = (this->E.rotateGain(q, k, way) < -1e-9 && this->tryRotate(q, k, way)) || any;
        }
      }
      if (!any)
      {
        break;
      }
    }
  }

private:
  double cost(Index q, int k) const
  {
    const auto& c = this->E.Quads[q];
    const Index a = c[k];
    const Index b = c[k + 2];
    const double length = (this->E.Points[a] - this->E.Points[b]).norm();
    return length / (M_SQRT1_2 * (this->Side[a] + this->Side[b])) +
           GainWeight * this->E.collapseGain(q, k);
  }

  void push(Index q)
  {
    if (this->Queue == nullptr || !this->E.alive(q))
    {
      return;
    }
    for (int k = 0; k < 2; ++k)
    {
      this->Queue->push({this->cost(q, k), q, k, this->Stamp[q]});
    }
  }

  /// Gives each sample its nearest quad.
  void assign(const QuadMesh& mesh)
  {
    const NearestQuad nearest(mesh);
    std::vector<Index> quad(this->Samples.size());
    parallelFor(0, static_cast<std::int64_t>(quad.size()), 64,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t i = first; i < last; ++i)
        {
          quad[i] = nearest.find(this->Samples[i]).Quad;
        }
      });
    for (std::size_t i = 0; i < quad.size(); ++i)
    {
      this->Held[quad[i]].push_back(static_cast<Index>(i));
    }
  }

  /// Gives the samples of quads that changed or went to those that are left; false if one is too
  /// far from them, and farther than it was.
  bool hold(const std::vector<Index>& before, double wasFar, const std::vector<Index>& quads)
  {
    std::vector<Index> samples;
    for (const auto* list : {&before, &quads})
    {
      for (Index q : *list)
      {
        samples.insert(samples.end(), this->Held[q].begin(), this->Held[q].end());
      }
    }
    unique(samples);
    std::vector<std::pair<Index, Index>> given;
    given.reserve(samples.size());
    for (Index i : samples)
    {
      double least = std::numeric_limits<double>::infinity();
      Index at = -1;
      for (Index q : quads)
      {
        const double d = distanceToQuad(this->E, q, this->Samples[i]);
        if (d < least)
        {
          least = d;
          at = q;
        }
      }
      const double side = this->Side[this->E.Quads[at][0]];
      if (least > std::max(this->Farthest * side, wasFar))
      {
        return false;
      }
      given.emplace_back(at, i);
    }
    for (const auto* list : {&before, &quads})
    {
      for (Index q : *list)
      {
        this->Held[q].clear();
      }
    }
    for (const auto& [q, i] : given)
    {
      this->Held[q].push_back(i);
    }
    return true;
  }

  double farthest(const std::vector<Index>& quads) const
  {
    double far = 0.0;
    for (Index q : quads)
    {
      for (Index i : this->Held[q])
      {
        far = std::max(far, distanceToQuad(this->E, q, this->Samples[i]));
      }
    }
    return far;
  }

  void addRing(std::vector<Index>& vertices, Index v) const
  {
    for (Index q : this->E.Around[v])
    {
      vertices.insert(vertices.end(), this->E.Quads[q].begin(), this->E.Quads[q].end());
    }
  }

  /// The ends of the edges at v.
  std::vector<Index> joined(Index v) const
  {
    std::vector<Index> ends;
    for (Index q : this->E.Around[v])
    {
      const int k = this->E.corner(q, v);
      ends.push_back(this->E.Quads[q][(k + 1) % 4]);
      ends.push_back(this->E.Quads[q][(k + 3) % 4]);
    }
    unique(ends);
    return ends;
  }

  static void unique(std::vector<Index>& list)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  std::vector<Index> quadsAt(const std::vector<Index>& vertices) const
  {
    std::vector<Index> quads;
    for (Index v : vertices)
    {
      quads.insert(quads.end(), this->E.Around[v].begin(), this->E.Around[v].end());
    }
    unique(quads);
    return quads;
  }

  double shape(Index q) const
  {
    const auto& c = this->E.Quads[q];
    return scaledJacobian(
      this->E.Points[c[0]], this->E.Points[c[1]], this->E.Points[c[2]], this->E.Points[c[3]]);
  }

  double worst(const std::vector<Index>& quads) const
  {
    double w = 1.0;
    for (Index q : quads)
    {
      w = std::min(w, this->shape(q));
    }
    return w;
  }

  bool tryCollapse(Index q, int k)
  {
    std::vector<Index> ring(this->E.Quads[q].begin(), this->E.Quads[q].end());
    const std::vector<Index> old = this->quadsAt(ring);
    const Index a = ring[k];
    const Index b = ring[k + 2];
    const double side = 0.5 * (this->Side[a] + this->Side[b]);
    const double before = this->worst(old);
    const double far = this->farthest(old);
    this->E.begin();
    const Index v = this->E.collapse(q, k);
    if (v < 0 || !this->settle(v, ring, old, before, far))
    {
      this->E.rollback();
      return false;
    }
    this->Side[v] = side;
    return true;
  }

  bool tryRotate(Index q, int k, int way)
  {
    const Index o = this->E.neighbor(q, k);
    std::vector<Index> ring(this->E.Quads[q].begin(), this->E.Quads[q].end());
    ring.insert(ring.end(), this->E.Quads[o].begin(), this->E.Quads[o].end());
    unique(ring);
    const std::vector<Index> old = this->quadsAt(ring);
    const double before = this->worst(old);
    const double far = this->farthest(old);
    this->E.begin();
    if (!this->E.rotate(q, k, way) || !this->settle(ring[0], ring, old, before, far))
    {
      this->E.rollback();
      return false;
    }
    return true;
  }

  /// Moves the points around a change; false if a quad stays too bad.
  bool settle(Index center, std::vector<Index> vertices, const std::vector<Index>& old,
    double before, double far)
  {
    this->addRing(vertices, center);
    unique(vertices);
    vertices.erase(std::remove_if(vertices.begin(), vertices.end(),
                     [this](Index v) { return this->E.Around[v].empty(); }),
      vertices.end());
    const std::vector<Index> quads = this->quadsAt(vertices);
    const double bound = std::min(this->Least, before);
    const std::vector<Index> inner = this->joined(center);
    for (int round = 0; round < 2; ++round)
    {
      this->relax(center);
      for (Index v : inner)
      {
        this->relax(v);
      }
    }
    double now = this->worst(quads);
    for (int round = 0; round < 2 && now < bound; ++round)
    {
      for (Index v : vertices)
      {
        if (this->worst(this->E.Around[v]) < bound)
        {
          this->search(v);
        }
      }
      now = this->worst(quads);
    }
    if (now < bound || !this->facing(quads) || !this->hold(old, far, quads))
    {
      return false;
    }
    for (Index q : quads)
    {
      ++this->Stamp[q];
      this->push(q);
    }
    return true;
  }

  /// Do the quads show the side of the surface that they lie on?
  bool facing(const std::vector<Index>& quads) const
  {
    for (Index q : quads)
    {
      const auto& c = this->E.Quads[q];
      const auto& p = this->E.Points;
      const Vec3 n = (p[c[2]] - p[c[0]]).cross(p[c[3]] - p[c[1]]);
      Vec3 mean = Vec3::Zero();
      for (Index v : c)
      {
        mean += this->Normal[v];
      }
      if (n.dot(mean) < this->Facing * n.norm())
      {
        return false;
      }
    }
    return true;
  }

  /// The place of p on the surface; notes the normal there.
  Vec3 onSurface(Index v, const Vec3& p)
  {
    const auto hit = this->Reference.Faces.nearest(p);
    this->Normal[v] = this->Reference.Faces.normal(hit.Triangle);
    return this->E.Kind[v] == VertexKind::Crease ? this->Reference.Creases.nearest(p).Point
                                                 : hit.Point;
  }

  void relax(Index v)
  {
    if (this->E.Kind[v] == VertexKind::Fixed)
    {
      return;
    }
    Vec3 sum = Vec3::Zero();
    for (Index q : this->E.Around[v])
    {
      const auto& c = this->E.Quads[q];
      const auto& p = this->E.Points;
      const std::array<Vec3, 4> corners = {p[c[0]], p[c[1]], p[c[2]], p[c[3]]};
      sum += nearestRectangle(corners, -1.0)[this->E.corner(q, v)];
    }
    const double before = this->worst(this->E.Around[v]);
    const Vec3 from = this->E.Points[v];
    const Vec3 mean = sum / static_cast<double>(this->E.Around[v].size());
    this->E.move(v, this->onSurface(v, mean));
    if (this->worst(this->E.Around[v]) < std::min(before, this->Least))
    {
      this->E.Points[v] = from;
    }
  }

  /// Looks around for the place where the worst quad of v is best.
  void search(Index v)
  {
    if (this->E.Kind[v] == VertexKind::Fixed)
    {
      return;
    }
    Vec3 normal = Vec3::Zero();
    double step = 0.0;
    for (Index q : this->E.Around[v])
    {
      const auto& c = this->E.Quads[q];
      const int k = this->E.corner(q, v);
      const Vec3 e = this->E.Points[c[(k + 1) % 4]] - this->E.Points[v];
      normal += e.cross(this->E.Points[c[(k + 3) % 4]] - this->E.Points[v]);
      step = std::max(step, 0.3 * e.norm());
    }
    if (!(normal.norm() > 0.0))
    {
      return;
    }
    this->E.move(v, this->E.Points[v]);
    const Vec3 x = normal.unitOrthogonal();
    const Vec3 y = normal.normalized().cross(x);
    const Vec3 origin = this->E.Points[v];
    const double start = this->worst(this->E.Around[v]);
    double best = start;
    for (int round = 0; round < 4; ++round)
    {
      const Vec3 from = this->E.Points[v];
      Vec3 bestPoint = from;
      for (int k = 0; k < 8; ++k)
      {
        const double angle = k * M_PI / 4.0;
        this->E.Points[v] = from + step * (std::cos(angle) * x + std::sin(angle) * y);
        const double w = this->worst(this->E.Around[v]);
        if (w > best + 1e-6)
        {
          best = w;
          bestPoint = this->E.Points[v];
        }
      }
      this->E.Points[v] = bestPoint;
      step *= bestPoint == from ? 0.5 : 1.0;
    }
    this->E.Points[v] = this->onSurface(v, this->E.Points[v]);
    if (this->worst(this->E.Around[v]) < start)
    {
      this->E.Points[v] = origin;
    }
  }

  QuadEditor E;
  const ReferenceSurface& Reference;
  const std::vector<Vec3>& Samples;
  double Least;
  double Farthest;
  double Facing;
  std::vector<double> Side; ///< wanted, per point
  std::vector<Vec3> Normal; ///< of the surface, per point
  std::vector<std::uint32_t> Stamp;
  std::vector<std::vector<Index>> Held; ///< samples nearest to each quad
  std::priority_queue<Candidate>* Queue = nullptr;
};
} // namespace bsr::coarsening
