#pragma once

// The local operations of coarsenLayout; used by Coarsen.cxx, AnnealCoarsener and
// ApproachLayout.cxx alone.

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
constexpr double LossWeight = 20.0; ///< of squared distance, in sides of a quad
constexpr double Patience = 0.1;    ///< a step may cost so much more than the next one in the queue

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
  /// \param cell2 squared side of quads, mean over the samples
  /// \param monitor that of what follows too: once cancelled, nothing but draft() is of use
  LocalCoarsener(const LayoutDraft& draft, const ReferenceSurface& reference,
    const CoarsenOptions& options, const Bounds& bounds, double cell2, Monitor& monitor)
      : E(draft),
        Reference(reference),
        Samples(reference.Samples),
        Least(bounds.Jacobian),
        Farthest(bounds.Distance),
        Facing(bounds.Facing),
        Stamp(draft.Mesh.Quads.size(), 0),
        Held(draft.Mesh.Quads.size()),
        Side(draft.Mesh.Points.size()),
        Normal(draft.Mesh.Points.size()),
        Triangle(draft.Mesh.Points.size(), -1),
        Loss(2 * draft.Mesh.Quads.size(), 0.0),
        Cell2(cell2)
  {
    parallelForUntilCancelled(0, static_cast<std::int64_t>(this->Side.size()), 64, monitor,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t v = first; v < last; ++v)
        {
          this->Side[v] = options.Side(draft.Mesh.Points[v]);
        }
      });
    for (Index v = 0; v < static_cast<Index>(this->Normal.size()); ++v)
    {
      if (v % 256 == 0 && monitor.cancelled())
      {
        return;
      }
      this->onSurface(v, draft.Mesh.Points[v]);
    }
    this->assign(draft.Mesh, monitor);
    this->SamplesPerQuad = std::max(1.0, static_cast<double>(this->Samples.size()) / options.Quads);
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
        const double next = queue.empty() ? mostCost : std::min(mostCost, queue.top().Cost);
        this->tryCollapse(c, next + Patience);
      }
    }
    this->Queue = nullptr;
    return true;
  }

  /// Turns edges where that makes valences more regular; false: cancelled.
  bool regularize(Monitor& monitor)
  {
    for (int pass = 0; pass < 4; ++pass)
    {
      bool any = false;
      for (Index q = 0; q < static_cast<Index>(this->E.Quads.size()); ++q)
      {
        if (q % 64 == 0 && monitor.cancelled())
        {
          return false;
        }
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
    return true;
  }

protected:
  double cost(Index q, int k) const
  {
    const auto& c = this->E.Quads[q];
    const Index a = c[k];
    const Index b = c[k + 2];
    const double length = (this->E.Points[a] - this->E.Points[b]).norm();
    return length / (M_SQRT1_2 * (this->Side[a] + this->Side[b])) +
           GainWeight * this->E.collapseGain(q, k) + this->Loss[2 * q + k];
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
  void assign(const QuadMesh& mesh, Monitor& monitor)
  {
    const NearestQuad nearest(mesh);
    std::vector<Index> quad(this->Samples.size());
    this->Distance.resize(this->Samples.size());
    const bool all =
      parallelForUntilCancelled(0, static_cast<std::int64_t>(quad.size()), 64, monitor,
        [&](std::int64_t first, std::int64_t last)
        {
          for (std::int64_t i = first; i < last; ++i)
          {
            const QuadHit hit = nearest.find(this->Samples[i].Point);
            quad[i] = hit.Quad;
            this->Distance[i] = std::sqrt(hit.SquaredDistance);
          }
        });
    for (std::size_t i = 0; i < quad.size() && all; ++i)
    {
      this->Held[quad[i]].push_back(static_cast<Index>(i));
    }
  }

  /// Where the samples of quads that changed or went are now.
  struct Holding
  {
    std::vector<Index> Samples;
    std::vector<Index> Quads;
    std::vector<double> Distance;
    double Far = 0.0;    ///< largest distance, relative to the side of quads
    double Change = 0.0; ///< of the sum of squared distances, relative to squared sides
  };

  /// Around a quad, a little larger than it need be.
  struct Ball
  {
    Vec3 Center;
    double Radius;
  };
  Ball ball(Index q) const
  {
    const auto& c = this->E.Quads[q];
    const auto& p = this->E.Points;
    const Vec3 center = 0.25 * (p[c[0]] + p[c[1]] + p[c[2]] + p[c[3]]);
    double radius = 0.0;
    for (Index v : c)
    {
      radius = std::max(radius, (p[v] - center).norm());
    }
    return {center, 1.000001 * radius};
  }

  Holding held(const std::vector<Index>& before, const std::vector<Index>& quads) const
  {
    Holding h;
    for (const auto* list : {&before, &quads})
    {
      for (Index q : *list)
      {
        h.Samples.insert(h.Samples.end(), this->Held[q].begin(), this->Held[q].end());
      }
    }
    QuadEditor::sortUnique(h.Samples);
    std::vector<Ball> balls;
    balls.reserve(quads.size());
    for (Index q : quads)
    {
      balls.push_back(this->ball(q));
    }
    for (Index i : h.Samples)
    {
      const Vec3& p = this->Samples[i].Point;
      double least = std::numeric_limits<double>::infinity();
      Index at = -1;
      for (std::size_t k = 0; k < quads.size(); ++k)
      {
        const double reach = least + balls[k].Radius;
        const double d = (p - balls[k].Center).squaredNorm() > reach * reach
                           ? least
                           : distanceToQuad(this->E, quads[k], p);
        if (d < least)
        {
          least = d;
          at = quads[k];
        }
      }
      h.Quads.push_back(at);
      h.Distance.push_back(least);
      const double side = this->Side[this->E.Quads[at][0]];
      h.Far = std::max(h.Far, least / side);
      h.Change += (least * least - this->Distance[i] * this->Distance[i]) / this->Cell2;
    }
    return h;
  }

  void take(const Holding& h, const std::vector<Index>& before, const std::vector<Index>& quads)
  {
    for (const auto* list : {&before, &quads})
    {
      for (Index q : *list)
      {
        this->Held[q].clear();
      }
    }
    for (std::size_t i = 0; i < h.Samples.size(); ++i)
    {
      this->Held[h.Quads[i]].push_back(h.Samples[i]);
      this->Distance[h.Samples[i]] = h.Distance[i];
    }
  }

  /// Largest distance of samples, relative to the side of quads.
  double farthest(const std::vector<Index>& quads) const
  {
    double far = 0.0;
    for (Index q : quads)
    {
      const double side = this->Side[this->E.Quads[q][0]];
      for (Index i : this->Held[q])
      {
        far = std::max(far, this->Distance[i] / side);
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
    QuadEditor::sortUnique(ends);
    return ends;
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

  /// Does the step, or puts it back into the queue if it costs more than `most`.
  void tryCollapse(const Candidate& c, double most)
  {
    std::vector<Index> ring(this->E.Quads[c.Quad].begin(), this->E.Quads[c.Quad].end());
    const std::vector<Index> old = this->E.quadsAt(ring);
    const Index a = ring[c.Corner];
    const Index b = ring[c.Corner + 2];
    const double side = 0.5 * (this->Side[a] + this->Side[b]);
    double& loss = this->Loss[2 * c.Quad + c.Corner];
    const double cheap = c.Cost - loss;
    const double before = this->worst(old);
    const double far = this->farthest(old);
    this->E.begin();
    const Index v = this->E.collapse(c.Quad, c.Corner);
    double change = most - cheap;
    if (v >= 0 && this->settle(v, ring, old, before, far, change))
    {
      this->Side[v] = side;
      return;
    }
    this->E.rollback();
    if (v >= 0 && change > most - cheap)
    {
      loss = change;
      this->Queue->push({cheap + change, c.Quad, c.Corner, c.Stamp});
    }
  }

  bool tryRotate(Index q, int k, int way)
  {
    const Index o = this->E.neighbor(q, k);
    std::vector<Index> ring(this->E.Quads[q].begin(), this->E.Quads[q].end());
    ring.insert(ring.end(), this->E.Quads[o].begin(), this->E.Quads[o].end());
    QuadEditor::sortUnique(ring);
    const std::vector<Index> old = this->E.quadsAt(ring);
    const double before = this->worst(old);
    const double far = this->farthest(old);
    this->E.begin();
    double change = -GainWeight * this->E.rotateGain(q, k, way);
    if (!this->E.rotate(q, k, way) || !this->settle(ring[0], ring, old, before, far, change))
    {
      this->E.rollback();
      return false;
    }
    return true;
  }

  /// Moves the points around a change; false if a quad stays too bad, or if what the surface is
  /// left by costs more than `loss`, which is then set to that.
  bool settle(Index center, std::vector<Index> vertices, const std::vector<Index>& old,
    double before, double far, double& loss)
  {
    this->addRing(vertices, center);
    QuadEditor::sortUnique(vertices);
    vertices.erase(std::remove_if(vertices.begin(), vertices.end(),
                     [this](Index v) { return this->E.Around[v].empty(); }),
      vertices.end());
    const std::vector<Index> quads = this->E.quadsAt(vertices);
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
    if (now < bound || !this->facing(quads))
    {
      return false;
    }
    const Holding holding = this->held(old, quads);
    if (holding.Far > std::max(this->Farthest, far))
    {
      return false;
    }
    const double change = LossWeight * holding.Change / this->SamplesPerQuad;
    if (change > loss)
    {
      loss = change;
      return false;
    }
    this->take(holding, old, quads);
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

  PointFrame frame(Index v) const
  {
    PointFrame frame;
    for (Index q : this->E.Around[v])
    {
      const auto& c = this->E.Quads[q];
      const int k = this->E.corner(q, v);
      const Vec3 e = this->E.Points[c[(k + 1) % 4]] - this->E.Points[v];
      frame.Normal += e.cross(this->E.Points[c[(k + 3) % 4]] - this->E.Points[v]);
      frame.Longest = std::max(frame.Longest, e.norm());
    }
    return frame;
  }

  /// The place of p on the surface; notes the normal there.
  Vec3 onSurface(Index v, const Vec3& p)
  {
    const PointFrame frame = this->frame(v);
    const auto hit =
      this->Reference.Faces.nearestFacing(p, frame.Normal, frame.Longest, this->Triangle[v]);
    this->Triangle[v] = hit.Triangle;
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
    const PointFrame frame = this->frame(v);
    if (!(frame.Normal.norm() > 0.0))
    {
      return;
    }
    double step = 0.3 * frame.Longest;
    this->E.move(v, this->E.Points[v]);
    const Vec3 x = frame.Normal.unitOrthogonal();
    const Vec3 y = frame.Normal.normalized().cross(x);
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
  const std::vector<SurfaceSample>& Samples;
  double Least;
  double Farthest;
  double Facing;
  std::vector<std::uint32_t> Stamp;
  std::vector<std::vector<Index>> Held; ///< samples nearest to each quad
  std::vector<double> Side;             ///< wanted, per point
  std::vector<Vec3> Normal;             ///< of the surface, per point
  std::vector<Index> Triangle;          ///< of the surface, per point: where it was last
  std::vector<double> Distance;         ///< of each sample
  std::vector<double> Loss;             ///< last known, of the two collapses of each quad
  double Cell2;                         ///< squared side of quads, mean over the samples
  double SamplesPerQuad = 1.0;          ///< of the count wanted
  std::priority_queue<Candidate>* Queue = nullptr;
};
} // namespace bsr::coarsening
