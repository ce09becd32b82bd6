#include "Layout/FieldLayout.h"

#include "Layout/ApproachLayout.h"
#include "Layout/Coarsen.h"
#include "Layout/LeastQuads.h"
#include "Layout/PairTriangles.h"
#include "Layout/ParametrizedLayout.h"
#include "Layout/RelaxLayout.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr double PoorCost = 25.0; ///< of a layout: a finer map made coarser may do better
constexpr double WeakCost = 40.0; ///< of a layout: a still finer map may do better
constexpr double BadCost = 60.0;  ///< of a layout: paired triangles may do better
constexpr double NoLayout = std::numeric_limits<double>::infinity();
constexpr double MostMiss = 0.1; ///< of the count; beyond, other roads are taken
constexpr double MissCost = 30.0;
constexpr double Fewer = 0.9;  ///< folds of a map of twice the quads, or it is no use
constexpr int MostFine = 6000; ///< quads of a map to be made coarser

/// One component and what is wanted of it.
struct Task
{
  const TriangleSurface& Surface;
  const ReferenceSurface& Reference;
  const Sizing& Size;
  int Quads;
  int Euler;
  int Loops; ///< of the boundary
  const FieldLayoutOptions& Options;
};

/// The best layout so far.
struct Candidates
{
  LayoutDraft Draft;
  double Cost = NoLayout;
  LayoutStage Stage = LayoutStage::Parametrized;
  bool Folded = true;
  bool NoMaps = false;                             ///< it is no use to try finer maps
  int MostFolds = std::numeric_limits<int>::max(); ///< of the next finer map, or it is no use

  /// Takes what a road by maps says about finer ones.
  void note(const ParametrizedLayout& found)
  {
    this->NoMaps = found.Hopeless;
    if (found.Draft.Mesh.Quads.empty() && found.Folds > 0)
    {
      this->MostFolds = static_cast<int>(Fewer * found.Folds);
    }
  }

  /// Nothing yet, or folded quads or vertices of too many.
  bool unsound() const
  {
    if (this->Draft.Mesh.Quads.empty())
    {
      return true;
    }
    const LayoutReport report = checkLayout(this->Draft.Mesh);
    return report.Flipped > 0 || report.MaxValence > 8;
  }

  /// Keeps the draft if it is valid and better.
  void offer(const Task& task, LayoutDraft draft, LayoutStage stage, Monitor& monitor)
  {
    const LayoutReport report = checkLayout(draft.Mesh);
    if (!report.Valid || report.Euler != task.Euler || report.BoundaryLoops != task.Loops ||
        report.Components != 1)
    {
      return;
    }
    const auto got = static_cast<double>(draft.Mesh.Quads.size());
    const double cost =
      layoutCost(draft, report, task.Surface, task.Reference, task.Quads, monitor) +
      (std::abs(got - task.Quads) > MostMiss * task.Quads ? MissCost : 0.0);
    // What is not folded comes before what is, whatever else.
    const bool folded = report.Flipped > 0;
    if (folded == this->Folded ? cost < this->Cost : !folded)
    {
      this->Folded = folded;
      this->Draft = std::move(draft);
      this->Cost = cost;
      this->Stage = stage;
    }
  }
};

/// Takes a layout to the count wanted.
Status coarsenTo(const Task& task, LayoutDraft& draft, Monitor& monitor)
{
  const double cell = task.Size.cellFor(task.Quads);
  CoarsenOptions options;
  options.Quads = task.Quads;
  options.Side = [&](const Vec3& p) { return task.Size.side(p, cell); };
  SubMonitor first(monitor, 0.0, 0.8);
  if (Status s = coarsenLayout(draft, task.Reference, options, first); !s)
  {
    return s;
  }
  SubMonitor second(monitor, 0.8, 1.0);
  if (Status s = relaxLayout(draft, task.Reference, 40, second); !s)
  {
    return s;
  }
  return crowded(task.Euler, task.Quads) ? approachLayout(draft, task.Reference, options, second)
                                         : Status::ok();
}

/// By the map of a finer layout, which has room for what is narrow, made coarser.
Status coarsenedRoad(const Task& task, int fine, Candidates& best, Monitor& monitor)
{
  SubMonitor first(monitor, 0.0, 0.6);
  auto found = parametrizedLayout(task.Surface, task.Reference, task.Size,
    {fine, task.Options.Seed, true, best.MostFolds}, first);
  if (!found)
  {
    return found.status();
  }
  best.note(*found);
  if (found->Draft.Mesh.Quads.empty())
  {
    return Status::ok();
  }
  SubMonitor second(monitor, 0.6, 1.0);
  if (Status s = coarsenTo(task, found->Draft, second); !s)
  {
    return s;
  }
  best.offer(task, std::move(found->Draft), LayoutStage::Coarsened, monitor);
  return Status::ok();
}

/// Pairs of triangles of a surface remeshed to about so many quads, four quads each.
Status pairedDraft(const Task& task, int quads, LayoutDraft& draft, Monitor& monitor)
{
  TriangleSurface fine = task.Surface;
  // Bending is seen on triangles about as fine as those of the surface; finer ones only cost time.
  const int measured = std::clamp(
    task.Surface.faces() / (crowded(task.Euler, task.Quads) ? 40 : 15), task.Quads, quads);
  auto sizing = Sizing::measured(
    task.Surface, task.Reference, measured, task.Options.Kind, task.Options.Field, monitor);
  if (!sizing)
  {
    return sizing.status();
  }
  const double cell = sizing->cellFor(quads);
  const double edge = std::sqrt(8.0 / std::sqrt(3.0));
  const auto length = [&](const Vec3& p) { return edge * sizing->side(p, cell); };
  if (Status status = remesh(fine, task.Reference, length, 8, monitor); !status)
  {
    return status;
  }
  draft = pairTriangles(fine);
  return monitor.cancelled() ? Status::cancelled() : Status::ok();
}

/// By pairs of triangles, made coarser: this works for any surface.
Status pairedRoad(const Task& task, Candidates& best, Monitor& monitor)
{
  int finer =
    std::max(3 * task.Quads, std::min(1500, 12 * task.Quads)) - 10 * std::min(0, task.Euler);
  SubMonitor first(monitor, 0.0, 0.3);
  LayoutDraft draft;
  for (int attempt = 0; attempt < 3; ++attempt, finer *= 2)
  {
    if (Status status = pairedDraft(task, finer, draft, first); !status)
    {
      return status;
    }
    if (checkLayout(draft.Mesh).Flipped == 0)
    {
      break; // what is folded at the start may stay so
    }
  }
  SubMonitor second(monitor, 0.3, 1.0);
  LayoutDraft coarse = draft;
  if (Status s = coarsenTo(task, coarse, second); !s)
  {
    return s;
  }
  best.offer(task, std::move(coarse), LayoutStage::Paired, monitor);
  if (best.unsound())
  {
    best.offer(task, std::move(draft), LayoutStage::Paired, monitor);
  }
  return Status::ok();
}

/// Takes what a road found; a road that fails leaves it to the others. False: cancelled.
bool goesOn(const Status& status)
{
  return status.code() != StatusCode::Cancelled;
}

/// By a map; a second layout is brought to the count if that misses.
Status parametrizedRoad(const Task& task, Candidates& best, Monitor& monitor)
{
  SubMonitor first(monitor, 0.0, 0.9);
  auto found = parametrizedLayout(task.Surface, task.Reference, task.Size,
    {task.Quads, task.Options.Seed, false, best.MostFolds}, first);
  if (!found)
  {
    return found.status();
  }
  best.note(*found);
  if (found->Draft.Mesh.Quads.empty())
  {
    return Status::ok();
  }
  const auto got = static_cast<double>(found->Draft.Mesh.Quads.size());
  if (std::abs(got - task.Quads) > 0.045 * task.Quads)
  {
    LayoutDraft counted = found->Draft;
    SubMonitor second(monitor, 0.9, 1.0);
    if (Status s = coarsenTo(task, counted, second); !s)
    {
      return s;
    }
    best.offer(task, std::move(counted), LayoutStage::Parametrized, monitor);
  }
  best.offer(task, std::move(found->Draft), LayoutStage::Parametrized, monitor);
  return Status::ok();
}

/// The best of the roads; the later ones are taken where the first gave nothing good.
/// False: cancelled.
bool bestLayout(const Task& task, Candidates& best, Monitor& monitor)
{
  if (!crowded(task.Euler, task.Quads))
  {
    SubMonitor first(monitor, 0.0, 0.4);
    if (!goesOn(parametrizedRoad(task, best, first)))
    {
      return false;
    }
  }
  double done = 0.4;
  for (int factor : {2, 4, 8, 16})
  {
    const int fine = factor * task.Quads;
    const double poor = factor == 2 ? PoorCost : factor == 4 ? WeakCost : NoLayout;
    if (best.Cost >= poor && !best.NoMaps && fine <= MostFine && -20 * task.Euler < fine)
    {
      SubMonitor finer(monitor, done, done + 0.1);
      if (!goesOn(coarsenedRoad(task, fine, best, finer)))
      {
        return false;
      }
      done += 0.1;
    }
  }
  if (task.Options.MapsOnly)
  {
    return true;
  }
  if (best.Cost >= BadCost)
  {
    SubMonitor last(monitor, done, 1.0);
    if (!goesOn(pairedRoad(task, best, last)))
    {
      return false;
    }
  }
  if (best.unsound())
  {
    // Three quads in the plane of each triangle: nothing can go wrong but the count.
    best.offer(task, splitTriangles(task.Surface), LayoutStage::Paired, monitor);
  }
  return true;
}

} // namespace

Result<FieldLayout> fieldLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const FieldLayoutOptions& options, Monitor& monitor)
{
  const auto loops = static_cast<int>(std::count(s.Virtual.begin(), s.Virtual.end(), 1));
  const Task task{s, reference, sizing, options.Quads, s.eulerCharacteristic(), loops, options};
  Candidates best;
  if (!bestLayout(task, best, monitor) || monitor.cancelled())
  {
    return Status::cancelled();
  }
  if (best.Draft.Mesh.Quads.empty())
  {
    return Status::failed("No valid layout was found; try another NumberOfQuads or Seed.");
  }
  return FieldLayout{std::move(best.Draft), best.Stage};
}
} // namespace bsr
