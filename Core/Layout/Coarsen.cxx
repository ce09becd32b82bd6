#include "Layout/Coarsen.h"

#include "Common/Parallel.h"
#include "Layout/AnnealCoarsener.h"
#include "Layout/Chords.h"
#include "Layout/LeastQuads.h"
#include "Layout/LocalCoarsener.h"
#include "Layout/NearestQuad.h"
#include "Layout/RelaxLayout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bsr
{
namespace
{
using coarsening::AnnealCoarsener;
using coarsening::Bounds;
using coarsening::LocalCoarsener;
constexpr int MostMended = 2500;   ///< quads
constexpr double FarOff = 1.5;     ///< of the count, above which slow steps are done with less care
constexpr double Decimation = 0.8; ///< of the quads are left by a step without much care
constexpr int Improvements = 3;    ///< of shapes, after edges were turned at random
constexpr double MostMiss = 0.1;   ///< of the count, above which everything is tried

/// The whole of it: strips and local operations in turn, under bounds that get looser.
class Coarsener
{
public:
  Coarsener(LayoutDraft& draft, const ReferenceSurface& reference, const CoarsenOptions& options,
    Monitor& monitor)
      : D(draft), Reference(reference), O(options), M(monitor)
  {
    const LayoutReport report = checkLayout(draft.Mesh);
    this->Euler = report.Euler;
    this->Loops = report.BoundaryLoops;
    this->Components = report.Components;
    this->MostEdges = std::max(8, report.MaxValence);
    std::vector<Vec3> places;
    places.reserve(reference.Samples.size());
    for (const SurfaceSample& s : reference.Samples)
    {
      places.push_back(s.Point);
    }
    this->SampleSides = this->sides(places);
    for (double side : this->SampleSides)
    {
      this->Cell2 += side * side / static_cast<double>(places.size());
    }
  }

  Status run()
  {
    const int most = static_cast<int>(std::floor(this->O.Quads * (1.0 + this->O.Tolerance)));
    const std::array<Bounds, 4> bounds = {{{0.35, 0.5, 0.8, 3.0}, {0.25, 0.8, 0.2, 5.0},
      {0.1, 1.5, -2.0, 9.0}, {0.03, 1e9, -5.0, 1e9}}};
    while (this->splitStrip())
    {
    }
    const double start = this->count();
    if (Status s = this->decimate(static_cast<int>(FarOff * most), bounds[2]); !s)
    {
      return s;
    }
    for (const Bounds& bound : bounds)
    {
      double gain = 0.2;
      for (int round = 0; round < 200 && this->count() > most; ++round)
      {
        if (this->M.cancelled())
        {
          return Status::cancelled();
        }
        this->M.progress((start - this->count()) / std::max(start - most, 1.0));
        if (this->takeStrip(gain, bound))
        {
          continue;
        }
        const int next = std::max(this->O.Quads, static_cast<int>(0.93 * this->count()));
        const int before = this->count();
        if (Status s = this->local(next, bound); !s)
        {
          return s;
        }
        if (this->crowded() && this->count() > FarOff * most &&
            before - this->count() < 0.5 * (before - next) && &bound != &bounds.back())
        {
          break; // no use to be strict so far from the count
        }
        if (this->count() > 0.99 * before)
        {
          if (gain > 5.0)
          {
            break;
          }
          gain = 10.0; // strips of any irregularity
        }
      }
    }
    return this->count() > this->O.Quads * (1.0 + MostMiss) ? this->anneal(bounds.back())
                                                            : Status::ok();
  }

private:
  /// Where single steps lead no further, edges are turned at random.
  Status anneal(const Bounds& bound)
  {
    SubMonitor quiet(this->M, 0.0, 0.0);
    const int most = static_cast<int>(std::floor(this->O.Quads * (1.0 + this->O.Tolerance)));
    AnnealCoarsener coarsener(this->D, this->Reference, this->O, bound, this->Cell2, quiet);
    if (!coarsener.annealTo(most, quiet))
    {
      return Status::cancelled();
    }
    this->D = coarsener.draft();
    for (int round = 0; round < Improvements; ++round)
    {
      if (Status s = relaxLayout(this->D, this->Reference, 10, quiet, this->mending()); !s)
      {
        return s;
      }
      AnnealCoarsener last(this->D, this->Reference, this->O, bound, this->Cell2, quiet);
      if (!last.improve(quiet))
      {
        return Status::cancelled();
      }
      this->D = last.draft();
    }
    return Status::ok();
  }

  /// Where many handles leave no room, care is lost on what is far from the count.
  Status decimate(int target, const Bounds& bound)
  {
    bool goes = this->crowded();
    const double start = this->count();
    while (goes && this->count() > target)
    {
      this->M.progress((start - this->count()) / start);
      const int before = this->count();
      const int next = std::max(target, static_cast<int>(Decimation * before));
      if (Status s = this->local(next, bound); !s)
      {
        return s;
      }
      goes = before - this->count() > 0.5 * (before - next);
    }
    return Status::ok();
  }

  /// Where many handles leave no room, most quads would be mended over and over: only near the end.
  int mending() const { return !this->crowded() || this->count() < MostMended ? 2 : 0; }

  bool crowded() const { return bsr::crowded(this->Euler, this->O.Quads); }

  int count() const { return static_cast<int>(this->D.Mesh.Quads.size()); }

  Status local(int target, const Bounds& bound)
  {
    SubMonitor quiet(this->M, 0.0, 0.0);
    Monitor& m = quiet;
    LocalCoarsener local(this->D, this->Reference, this->O, bound, this->Cell2, m);
    if (!local.collapseTo(target, bound.Cost, m) || !local.regularize(m))
    {
      return Status::cancelled();
    }
    this->D = local.draft();
    return relaxLayout(this->D, this->Reference, 5, m, this->mending());
  }

  std::vector<double> sides(const std::vector<Vec3>& places) const
  {
    std::vector<double> sides(places.size());
    parallelForUntilCancelled(0, static_cast<std::int64_t>(places.size()), 256, this->M,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t i = first; i < last; ++i)
        {
          sides[i] = this->O.Side(places[i]);
        }
      });
    return sides;
  }

  /// Splits the widest strip that the count has room for, if there are too few quads.
  bool splitStrip()
  {
    if (this->count() >= this->O.Quads * (1.0 - this->O.Tolerance))
    {
      return false;
    }
    const std::vector<Chord> chords = chordsOf(this->D, this->sides(this->D.Mesh.Points));
    const double room = this->O.Quads * (1.0 + this->O.Tolerance) - this->count();
    const Chord* best = nullptr;
    for (const Chord& c : chords)
    {
      // A quad crossed twice becomes four.
      const auto more = static_cast<double>(c.Quads.size()) * (c.Twice ? 3.0 : 1.0);
      if (more <= room && (best == nullptr || c.Width > best->Width))
      {
        best = &c;
      }
    }
    if (best == nullptr)
    {
      return false;
    }
    LayoutDraft finer = withSplitChord(this->D, *best);
    const LayoutReport report = checkLayout(finer.Mesh);
    Monitor quiet;
    if (!report.Valid || !relaxLayout(finer, this->Reference, 10, quiet, 2))
    {
      return false;
    }
    this->D = std::move(finer);
    return true;
  }

  /// Takes out the best strip that leaves no less than enough quads.
  bool takeStrip(double mostGain, const Bounds& bound)
  {
    std::vector<std::pair<double, std::size_t>> order;
    const std::vector<Chord> chords = chordsOf(this->D, this->sides(this->D.Mesh.Points));
    const double least = this->O.Quads * (1.0 - this->O.Tolerance);
    for (std::size_t i = 0; i < chords.size(); ++i)
    {
      const auto n = static_cast<double>(chords[i].Quads.size());
      const double gain = chords[i].Gain / n;
      if (this->count() - n >= least && gain <= mostGain && chords[i].Width < 1.6)
      {
        order.emplace_back(chords[i].Width + 2.0 * gain, i);
      }
    }
    std::sort(order.begin(), order.end());
    const double before = checkLayout(this->D.Mesh).MinJacobian;
    for (std::size_t i = 0; i < order.size() && i < 6 && !this->M.cancelled(); ++i)
    {
      std::vector<Index> merged;
      LayoutDraft trial = withoutChord(this->D, chords[order[i].second], &merged);
      if (this->accepts(trial, std::move(merged),
            {std::min(bound.Jacobian, before), bound.Distance, bound.Facing, bound.Cost}))
      {
        this->D = std::move(trial);
        return true;
      }
    }
    return false;
  }

  bool accepts(LayoutDraft& trial, std::vector<Index> near, const Bounds& bound)
  {
    if (trial.Mesh.Quads.empty())
    {
      return false;
    }
    LayoutReport report = checkLayout(trial.Mesh);
    if (!report.Valid || report.Euler != this->Euler || report.BoundaryLoops != this->Loops ||
        report.Components != this->Components || report.MaxValence > this->MostEdges)
    {
      return false;
    }
    for (int ring = 0; ring < 2; ++ring)
    {
      std::vector<std::uint8_t> in(trial.Mesh.Points.size(), 0);
      for (Index v : near)
      {
        in[v] = 1;
      }
      near.clear();
      for (const auto& q : trial.Mesh.Quads)
      {
        if (std::any_of(q.begin(), q.end(), [&](Index v) { return in[v] != 0; }))
        {
          near.insert(near.end(), q.begin(), q.end());
        }
      }
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
    }
    relaxPart(trial, this->Reference, near, 6);
    if (checkLayout(trial.Mesh).MinJacobian < bound.Jacobian)
    {
      return false;
    }
    const double far = this->farthest(trial.Mesh);
    return far <= bound.Distance || far <= this->farthest(this->D.Mesh);
  }

  /// Largest distance of a sample, in sides of quads wanted there; infinite once cancelled.
  double farthest(const QuadMesh& mesh)
  {
    const NearestQuad nearest(mesh);
    std::vector<double> far(this->Reference.Samples.size(), 0.0);
    const bool all =
      parallelForUntilCancelled(0, static_cast<std::int64_t>(far.size()), 64, this->M,
        [&](std::int64_t first, std::int64_t last)
        {
          for (std::int64_t i = first; i < last; ++i)
          {
            const double d2 = nearest.find(this->Reference.Samples[i].Point).SquaredDistance;
            far[i] = std::sqrt(d2) / this->SampleSides[i];
          }
        });
    return all ? std::accumulate(
                   far.begin(), far.end(), 0.0, [](double a, double b) { return std::max(a, b); })
               : std::numeric_limits<double>::infinity();
  }

  LayoutDraft& D;
  const ReferenceSurface& Reference;
  const CoarsenOptions& O;
  Monitor& M;
  std::vector<double> SampleSides;
  double Cell2 = 0.0; ///< squared side of quads, mean over the samples
  int Euler = 0;
  int Loops = 0;
  int Components = 0;
  int MostEdges = 8;
};
} // namespace

Status coarsenLayout(LayoutDraft& draft, const ReferenceSurface& reference,
  const CoarsenOptions& options, Monitor& monitor)
{
  return Coarsener(draft, reference, options, monitor).run();
}
} // namespace bsr
