#include "Layout/ApproachLayout.h"

#include "Layout/LocalCoarsener.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bsr
{
namespace
{
using coarsening::Bounds;
using coarsening::distanceToQuad;
using coarsening::LocalCoarsener;

constexpr int MostEdges = 8;          ///< of a vertex
constexpr int Passes = 6;             ///< at most
constexpr double FirstBound = 0.03;   ///< of shapes, in the first pass
constexpr double LastBound = 0.2;     ///< in the last one
constexpr double Ease = 0.05;         ///< of the inverse of shapes
constexpr double Poor = 0.3;          ///< shape below which quads count more
constexpr double PoorWeight = 15.0;   ///< of how far they are below, relative, squared
constexpr double Faced = 0.2;         ///< cosine from which a quad looks the way the surface does
constexpr double AwayWeight = 10.0;   ///< of how far the cosine is below
constexpr double FarWeight = 20.0;    ///< of squared distances, and of their squares
constexpr double LeastGain = 1e-3;    ///< of the energy, relative, by a step of several moves
constexpr double LeastFall = 0.005;   ///< of the energy, relative, in a pass, or it was the last
constexpr double TurnHope = 1.5;      ///< of the energy: above it right after a turn it is given up
constexpr double ReachHope = 3.0;     ///< the same after a point went to a far place
constexpr double FarOff = 0.7;        ///< sides of quads, from which a place is one to be reached
constexpr double ReachedShare = 0.05; ///< of the quads: far places looked at in a pass

double square(double x)
{
  return x * x;
}

class Approach : public LocalCoarsener
{
public:
  Approach(const LayoutDraft& draft, const ReferenceSurface& reference,
    const CoarsenOptions& options, double cell2, Monitor& monitor)
      : LocalCoarsener(draft, reference, options, {0.0, 1e9, -5.0, 1e9}, cell2, monitor),
        Changed(draft.Mesh.Quads.size(), 1),
        Shifted(draft.Mesh.Points.size(), 0),
        Asked(draft.Mesh.Quads.size(), 0),
        Tried(8 * draft.Mesh.Quads.size(), 0)
  {
    this->E.MostEdges = MostEdges;
    for (Index q = 0; q < static_cast<Index>(draft.Mesh.Quads.size()); ++q)
    {
      this->All.push_back(q);
    }
  }

  Status run(Monitor& monitor, ApproachReport& report)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    report.Before = this->total();
    report.After = report.Before;
    double before = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < Passes && report.After < (1.0 - LeastFall) * before; ++pass)
    {
      before = report.After;
      this->Least = FirstBound + (LastBound - FirstBound) * pass / (Passes - 1.0);
      if (!this->shiftAll(monitor) || !this->reachAll(monitor, report) ||
          !this->turnAll(monitor, report) || !this->reassign(monitor))
      {
        return Status::cancelled();
      }
      monitor.progress((pass + 1.0) / Passes);
      report.After = this->total();
    }
    return Status::ok();
  }

private:
  /// What a step of several moves may have to put back.
  struct Saved
  {
    std::vector<Index> Vertices;
    std::vector<Index> Quads;
    std::vector<Index> Samples;
    std::vector<std::vector<Index>> Held;
    std::vector<double> Distance;
    std::vector<std::uint32_t> Changed;
    std::vector<Index> Triangle;
    std::vector<Vec3> Normal;
    std::uint32_t Now = 0;
    double Energy = 0.0;
    double Worst = 0.0;
  };

  /// How bad the shape of a quad is, and how far it looks away from the surface.
  double quadCost(Index quad) const
  {
    const auto& c = this->E.Quads[quad];
    const auto& p = this->E.Points;
    const Vec3 n = (p[c[2]] - p[c[0]]).cross(p[c[3]] - p[c[1]]).normalized();
    const double faced = 0.25 * n.dot(this->Normal[c[0]] + this->Normal[c[1]] + this->Normal[c[2]] +
                                      this->Normal[c[3]]);
    const double shape = std::max(this->shape(quad), 0.0);
    return 1.0 / (shape + Ease) + PoorWeight * square(std::max(0.0, 1.0 - shape / Poor)) +
           AwayWeight * std::max(0.0, Faced - faced);
  }

  double sampleCost(double distance) const
  {
    const double r = square(distance) / this->Cell2;
    return FarWeight * (r + r * r) / this->SamplesPerQuad;
  }

  /// Of the whole layout.
  double total() const
  {
    double sum = 0.0;
    for (Index q : this->All)
    {
      sum += this->quadCost(q);
    }
    for (double d : this->Distance)
    {
      sum += this->sampleCost(d);
    }
    return sum;
  }

  std::vector<Index> samplesOf(const std::vector<Index>& quads) const
  {
    std::vector<Index> samples;
    for (Index q : quads)
    {
      samples.insert(samples.end(), this->Held[q].begin(), this->Held[q].end());
    }
    return samples;
  }

  /// Of some quads, and of samples that lie nearest to these; what is above `most` is not exact.
  double energy(const std::vector<Index>& quads, const std::vector<Index>& samples,
    double most = std::numeric_limits<double>::infinity())
  {
    double sum = 0.0;
    this->Balls.clear();
    for (Index q : quads)
    {
      sum += this->quadCost(q);
      this->Balls.push_back(this->ball(q));
    }
    std::size_t near = 0; // samples of a quad follow each other
    for (std::size_t i = 0; i < samples.size() && sum <= most; ++i)
    {
      const Vec3& p = this->Samples[samples[i]].Point;
      const std::size_t first = near;
      double least = distanceToQuad(this->E, quads[first], p);
      for (std::size_t k = 0; k < quads.size(); ++k)
      {
        if (k != first &&
            (p - this->Balls[k].Center).squaredNorm() <= square(least + this->Balls[k].Radius))
        {
          const double d = distanceToQuad(this->E, quads[k], p);
          near = d < least ? k : near;
          least = std::min(least, d);
        }
      }
      sum += this->sampleCost(least);
    }
    return sum;
  }

  /// Gives each sample its nearest quad again. False: cancelled.
  bool reassign(Monitor& monitor)
  {
    std::vector<Index> quad(this->Samples.size(), -1);
    for (Index q : this->All)
    {
      for (Index i : this->Held[q])
      {
        quad[i] = q;
      }
      this->Held[q].clear();
    }
    QuadMesh mesh;
    mesh.Points = this->E.Points;
    mesh.Quads = this->E.Quads;
    const NearestQuad nearest(mesh);
    parallelForUntilCancelled(0, static_cast<std::int64_t>(quad.size()), 64, monitor,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t i = first; i < last; ++i)
        {
          const QuadHit hit = nearest.find(this->Samples[i].Point, quad[i]);
          quad[i] = hit.Quad;
          this->Distance[i] = std::sqrt(hit.SquaredDistance);
        }
      });
    if (monitor.cancelled())
    {
      return false;
    }
    for (std::size_t i = 0; i < quad.size(); ++i)
    {
      this->Held[quad[i]].push_back(static_cast<Index>(i));
    }
    return true;
  }

  void changed(const std::vector<Index>& quads)
  {
    ++this->Now;
    for (Index q : quads)
    {
      this->Changed[q] = this->Now;
    }
  }

  /// Has one of the quads changed since `last`, which is set to now?
  bool stale(const std::vector<Index>& quads, std::uint32_t& last) const
  {
    const bool any =
      std::any_of(quads.begin(), quads.end(), [&](Index q) { return this->Changed[q] > last; });
    last = this->Now;
    return any;
  }

  /// Where the quads around want v to be.
  Vec3 rectangleMean(Index v) const
  {
    Vec3 sum = Vec3::Zero();
    const auto& p = this->E.Points;
    for (Index q : this->E.Around[v])
    {
      const auto& c = this->E.Quads[q];
      sum += nearestRectangle({p[c[0]], p[c[1]], p[c[2]], p[c[3]]}, -1.0)[this->E.corner(q, v)];
    }
    return sum / static_cast<double>(this->E.Around[v].size());
  }

  /// The sample farthest from its quad, or -1.
  Index farthestOf(const std::vector<Index>& samples) const
  {
    Index far = -1;
    for (Index i : samples)
    {
      far = far < 0 || this->Distance[i] > this->Distance[far] ? i : far;
    }
    return far;
  }

  /// Puts v to the place on the surface if that lowers `energy`, which is then set to that.
  bool attempt(
    Index v, const Vec3& to, const std::vector<Index>& samples, double bound, double& energy)
  {
    const auto& quads = this->E.Around[v];
    const Vec3 from = this->E.Points[v];
    const Index triangle = this->Triangle[v];
    const Vec3 normal = this->Normal[v];
    this->E.Points[v] = this->onSurface(v, to);
    if (this->worst(quads) >= bound)
    {
      const double now = this->energy(quads, samples, energy);
      if (now < energy - 1e-9)
      {
        energy = now;
        return true;
      }
    }
    this->E.Points[v] = from;
    this->Triangle[v] = triangle;
    this->Normal[v] = normal;
    return false;
  }

  /// Looks for a better place of v.
  bool shift(Index v, int rounds)
  {
    if (this->E.Kind[v] == VertexKind::Fixed)
    {
      return false;
    }
    const std::vector<Index>& quads = this->E.Around[v];
    const std::vector<Index> samples = this->samplesOf(quads);
    const double bound = std::min(this->worst(quads), this->Least);
    double energy = this->energy(quads, samples);
    bool any = this->attempt(v, this->rectangleMean(v), samples, bound, energy);
    const Index far = this->farthestOf(samples);
    if (far >= 0)
    {
      const Vec3 way = this->Samples[far].Point - this->E.Points[v];
      for (double share : {1.0, 0.5})
      {
        any = this->attempt(v, this->E.Points[v] + share * way, samples, bound, energy) || any;
      }
    }
    double step = 0.3 * this->frame(v).Longest;
    for (int round = 0; round < rounds; ++round)
    {
      const Vec3 normal = this->frame(v).Normal;
      if (!(normal.norm() > 0.0))
      {
        break;
      }
      const Vec3 x = normal.unitOrthogonal();
      const Vec3 y = normal.normalized().cross(x);
      bool better = false;
      for (int k = round % 2; k < 8; k += 2)
      {
        const double angle = k * M_PI / 4.0;
        const Vec3 to = this->E.Points[v] + step * (std::cos(angle) * x + std::sin(angle) * y);
        better = this->attempt(v, to, samples, bound, energy) || better;
      }
      step *= better ? 1.0 : 0.5;
      any = any || better;
    }
    if (any)
    {
      this->take(this->held(quads, quads), quads, quads);
      this->changed(quads);
    }
    return any;
  }

  bool shiftAll(Monitor& monitor)
  {
    for (Index v = 0; v < static_cast<Index>(this->E.Points.size()); ++v)
    {
      if (monitor.cancelled())
      {
        return false;
      }
      if (this->stale(this->E.Around[v], this->Shifted[v]))
      {
        this->shift(v, 4);
      }
    }
    return true;
  }

  Saved save(const std::vector<Index>& vertices)
  {
    Saved s;
    s.Vertices = vertices;
    s.Quads = this->E.quadsAt(vertices);
    s.Samples = this->samplesOf(s.Quads);
    s.Now = this->Now;
    for (Index q : s.Quads)
    {
      s.Held.push_back(this->Held[q]);
      s.Changed.push_back(this->Changed[q]);
    }
    for (Index i : s.Samples)
    {
      s.Distance.push_back(this->Distance[i]);
    }
    for (Index v : vertices)
    {
      s.Triangle.push_back(this->Triangle[v]);
      s.Normal.push_back(this->Normal[v]);
    }
    s.Worst = this->worst(s.Quads);
    s.Energy = this->energy(s.Quads, s.Samples);
    return s;
  }

  void restore(const Saved& s)
  {
    this->E.rollback();
    this->Now = s.Now;
    for (std::size_t k = 0; k < s.Quads.size(); ++k)
    {
      this->Held[s.Quads[k]] = s.Held[k];
      this->Changed[s.Quads[k]] = s.Changed[k];
    }
    for (std::size_t k = 0; k < s.Samples.size(); ++k)
    {
      this->Distance[s.Samples[k]] = s.Distance[k];
    }
    for (std::size_t k = 0; k < s.Vertices.size(); ++k)
    {
      this->Triangle[s.Vertices[k]] = s.Triangle[k];
      this->Normal[s.Vertices[k]] = s.Normal[k];
    }
  }

  /// After a change within begin(): moves the points around. False, and all is as it was: that led
  /// to nothing better.
  bool settle(const Saved& s, double hope)
  {
    for (Index v : s.Vertices)
    {
      this->E.move(v, this->E.Points[v]); // to be put back
    }
    bool good = this->energy(s.Quads, s.Samples, hope * s.Energy) < hope * s.Energy;
    if (good)
    {
      const double least = this->Least;
      this->Least = std::min(this->Least, this->worst(s.Quads));
      this->take(this->held(s.Quads, s.Quads), s.Quads, s.Quads);
      for (Index v : s.Vertices)
      {
        this->shift(v, 1);
      }
      this->Least = least;
      const double most = (1.0 - LeastGain) * s.Energy;
      good = this->worst(s.Quads) >= std::min(s.Worst, this->Least) &&
             this->energy(s.Quads, s.Samples, most) < most;
    }
    if (!good)
    {
      this->restore(s);
      return false;
    }
    this->changed(s.Quads);
    return true;
  }

  bool turn(Index quad, int corner, int way)
  {
    std::vector<Index> hexagon(this->E.Quads[quad].begin(), this->E.Quads[quad].end());
    const auto& other = this->E.Quads[this->E.neighbor(quad, corner)];
    hexagon.insert(hexagon.end(), other.begin(), other.end());
    QuadEditor::sortUnique(hexagon);
    if (hexagon.size() < 6 ||
        !this->stale(this->E.quadsAt(hexagon), this->Tried[8 * quad + 2 * corner + (way > 0)]))
    {
      return false;
    }
    this->E.begin();
    const bool turns = this->E.rotate(quad, corner, way);
    this->E.rollback();
    if (!turns)
    {
      return false;
    }
    const Saved s = this->save(hexagon);
    this->E.begin();
    this->E.rotate(quad, corner, way);
    for (Index v : hexagon)
    {
      this->relax(v);
    }
    return this->settle(s, TurnHope);
  }

  bool turnAll(Monitor& monitor, ApproachReport& report)
  {
    for (Index q : this->All)
    {
      for (int k = 0; k < 4; ++k)
      {
        for (int way : {1, -1})
        {
          if (monitor.cancelled())
          {
            return false;
          }
          if (!this->E.crease(q, k) && this->E.neighbor(q, k) > q && this->turn(q, k, way))
          {
            ++report.Turned;
          }
        }
      }
    }
    return true;
  }

  /// Takes a corner of the quad to the place.
  bool reach(Index quad, const Vec3& place, Monitor& monitor)
  {
    const QuadEditor::Quad corners = this->E.Quads[quad];
    for (Index v : corners)
    {
      if (this->E.Kind[v] != VertexKind::Free || monitor.cancelled())
      {
        continue;
      }
      std::vector<Index> ring;
      this->addRing(ring, v);
      QuadEditor::sortUnique(ring);
      const Saved s = this->save(ring);
      this->E.begin();
      this->E.move(v, this->E.Points[v]);
      const auto hit = this->Reference.Faces.nearest(place);
      this->E.Points[v] = hit.Point;
      this->Triangle[v] = hit.Triangle;
      this->Normal[v] = this->Reference.Faces.normal(hit.Triangle);
      if (this->settle(s, ReachHope))
      {
        return true;
      }
    }
    return false;
  }

  /// A place of the surface that is far from the quad nearest to it.
  struct FarPlace
  {
    double Distance;
    Index Sample;
    Index Quad;
    bool operator<(const FarPlace& o) const
    {
      return std::tie(o.Distance, o.Sample) < std::tie(this->Distance, this->Sample);
    }
  };

  /// One a quad, the farthest first, and no more than some.
  std::vector<FarPlace> farPlaces() const
  {
    std::vector<FarPlace> places;
    for (Index q : this->All)
    {
      const Index far = this->farthestOf(this->Held[q]);
      if (far >= 0 && square(this->Distance[far]) > square(FarOff) * this->Cell2)
      {
        places.push_back({this->Distance[far], far, q});
      }
    }
    std::sort(places.begin(), places.end());
    const auto most = static_cast<std::size_t>(1.0 + ReachedShare * this->count());
    places.resize(std::min(places.size(), most));
    return places;
  }

  bool reachAll(Monitor& monitor, ApproachReport& report)
  {
    for (const FarPlace& place : this->farPlaces())
    {
      const QuadEditor::Quad& c = this->E.Quads[place.Quad];
      const auto& held = this->Held[place.Quad];
      const bool still = std::find(held.begin(), held.end(), place.Sample) != held.end();
      if (still && this->stale(this->E.quadsAt({c.begin(), c.end()}), this->Asked[place.Quad]))
      {
        report.Reached += this->reach(place.Quad, this->Samples[place.Sample].Point, monitor);
      }
      if (monitor.cancelled())
      {
        return false;
      }
    }
    return true;
  }

  std::vector<Index> All;
  std::vector<std::uint32_t> Changed; ///< per quad: when
  std::vector<std::uint32_t> Shifted; ///< per point: when it was tried last
  std::vector<std::uint32_t> Asked;   ///< per quad: when its farthest place was to be reached
  std::vector<std::uint32_t> Tried;   ///< per corner of quads and way to turn
  std::uint32_t Now = 1;
  std::vector<Ball> Balls; ///< of energy()
};
} // namespace

Status approachLayout(LayoutDraft& draft, const ReferenceSurface& reference,
  const CoarsenOptions& options, Monitor& monitor, ApproachReport* report)
{
  double cell2 = 0.0;
  for (const SurfaceSample& s : reference.Samples)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    cell2 += square(options.Side(s.Point)) / static_cast<double>(reference.Samples.size());
  }
  ApproachReport own;
  Approach approach(draft, reference, options, cell2, monitor);
  Status status = approach.run(monitor, report != nullptr ? *report : own);
  draft = approach.draft();
  return status;
}
} // namespace bsr
