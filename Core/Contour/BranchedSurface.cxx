#include "Contour/BranchedSurface.h"

#include "Common/Parallel.h"
#include "Contour/RelaxFolds.h"
#include "Contour/SurfaceReport.h"

#include <algorithm>
#include <utility>

namespace bsr
{
namespace
{
Status checkOptions(const BranchedOptions& o)
{
  if (o.OrderU < 3 || o.OrderU > 8 || o.OrderV < 3 || o.OrderV > 5)
  {
    return Status::invalidParameter("OrderU must be 3 to 8, OrderV 3 to 5.");
  }
  if (o.PointsPerSection != 0 && (o.PointsPerSection < 8 || o.PointsPerSection > 512))
  {
    return Status::invalidParameter("PointsPerSection must be 0 (automatic) or 8 to 512.");
  }
  if (!(o.CapHeight > 0.0) || !(o.CapHeight <= 10.0))
  {
    return Status::invalidParameter("CapHeight must be above 0 and at most 10.");
  }
  if (!(o.SectionTolerance > 0.0) || !(o.JunctionPosition >= 0.0) || !(o.JunctionPosition < 1.0))
  {
    return Status::invalidParameter(
      "SectionTolerance must be positive and JunctionPosition in 0 (automatic) to 1 exclusive.");
  }
  return Status::ok();
}

constexpr std::size_t MaximumRefined = 600; ///< patches of a surface that is refined as a whole

constexpr std::size_t Relaxed = 3; ///< surfaces of one network that are relaxed

/// Shapes of the star about a crotch that are tried in turn where a patch folds.
struct Trial
{
  double StarSize;
  double BendSpans;
  bool Follow;
};
constexpr Trial Trials[] = {{1.0, 4.0, false}, {1.0, 4.0, true}, {0.6, 4.0, false},
  {0.6, 2.0, false}, {0.6, 4.0, true}, {1.0, 2.0, false}, {0.35, 2.0, false}, {0.35, 4.0, true},
  {0.35, 4.0, false}, {0.2, 1.0, false}};

/// Makes a surface again and again, choosing for each end of a tube the rows that fold least.
class Maker
{
public:
  Maker(const ContourStack& stack, const BranchedNetwork& net, const BranchedOptions& options,
    const RowOptions& rows)
      : Stack(stack),
        Net(net),
        Options(options),
        Rows(rows),
        Sections(sectionRows(stack, net, options)),
        Best(net.Junctions.size() + 2 * net.Tubes.size()),
        Fine(net.Tubes.size(), 0)
  {
    this->Choices.Junctions.assign(net.Junctions.size(), rows);
    this->Choices.Caps.assign(net.Tubes.size(), {rows, rows});
  }

  /// The first surface without a fold, after relaxation where need be and wanted; else the best
  /// one.
  Result<BranchedSurface> run(bool relaxing, Monitor& monitor)
  {
    std::vector<BranchedSurface> tried;
    for (const Trial& trial : Trials)
    {
      RowOptions rows = this->Rows;
      rows.StarSize = trial.StarSize;
      rows.BendSpans = trial.BendSpans;
      rows.Follow = trial.Follow;
      this->propose(rows, tried.empty());
      auto next = this->build(monitor);
      if (!next)
      {
        return next;
      }
      tried.push_back(std::move(*next));
      this->judge(tried.back(), rows, tried.size() == 1);
      if (tried.back().FoldedPatches == 0)
      {
        return std::move(tried.back());
      }
      monitor.progress(0.05 * static_cast<double>(tried.size()));
    }
    this->propose(this->Rows, false, false); // the best of each
    auto last = this->build(monitor);
    if (!last)
    {
      return last;
    }
    tried.push_back(std::move(*last));
    std::stable_sort(tried.begin(), tried.end(),
      [](const auto& a, const auto& b) { return a.FoldedPatches < b.FoldedPatches; });
    tried.resize(
      std::min(tried.size(), tried[0].Model.Patches.size() > MaximumRefined ? 1 : Relaxed));
    // As published the patches at a crotch are singular: nothing can be done about it.
    const bool relax = relaxing && (this->Rows.Kind == JunctionKind::Superimposed ||
                                     this->Rows.Tangency == JunctionTangency::Space);
    for (std::size_t k = 0; relax && k < tried.size() && tried[0].FoldedPatches > 0; ++k)
    {
      const double each = 0.45 / static_cast<double>(tried.size());
      const double from = 0.55 + each * static_cast<double>(k);
      SubMonitor part(monitor, from, from + each);
      BranchedSurface& s = tried[k];
      const auto left = relaxFolds(s.Model, s.Jacobians, this->Stack, part);
      if (!left)
      {
        return left.status();
      }
      s.FoldedPatches = *left;
      if (s.FoldedPatches < tried[0].FoldedPatches)
      {
        std::swap(tried[0], s);
      }
    }
    return std::move(tried[0]);
  }

private:
  struct Known
  {
    int Folded = 0;
    RowOptions Rows;
  };

  std::size_t placeOf(const PatchOrigin& o) const
  {
    const Tube& t = this->Net.Tubes[o.Tube];
    const int end = t.Junctions[o.End] >= 0 || t.Capped[o.End] ? o.End : 1 - o.End;
    return t.Junctions[end] >= 0
             ? static_cast<std::size_t>(t.Junctions[end])
             : this->Net.Junctions.size() + 2 * static_cast<std::size_t>(o.Tube) +
                 static_cast<std::size_t>(end);
  }

  /// The new rows where there are folds (everywhere at first), else the best known ones.
  void propose(const RowOptions& rows, bool first, bool fresh = true)
  {
    const auto pick = [&](std::size_t place)
    { return fresh && (first || this->Best[place].Folded > 0) ? rows : this->Best[place].Rows; };
    for (std::size_t j = 0; j < this->Net.Junctions.size(); ++j)
    {
      this->Choices.Junctions[j] = pick(j);
    }
    for (std::size_t t = 0; t < this->Net.Tubes.size(); ++t)
    {
      for (std::size_t e = 0; e < 2; ++e)
      {
        this->Choices.Caps[t][e] = pick(this->Net.Junctions.size() + 2 * t + e);
      }
    }
  }

  void judge(const BranchedSurface& s, const RowOptions& rows, bool first)
  {
    std::vector<int> folded(this->Best.size(), 0);
    for (std::size_t p = 0; p < s.Jacobians.size(); ++p)
    {
      folded[this->placeOf(s.Origins[p])] += s.Jacobians[p] < 0.0 ? 1 : 0;
      if (s.Jacobians[p] < 0.0 && s.Origins[p].Cap < 0)
      {
        this->Fine[s.Origins[p].Tube] = 1;
      }
    }
    for (std::size_t k = 0; k < folded.size(); ++k)
    {
      if (first || folded[k] < this->Best[k].Folded)
      {
        this->Best[k] = {folded[k], rows};
      }
    }
  }

  Result<BranchedSurface> build(Monitor& monitor) const
  {
    const InsertedRows inserted =
      insertRows(this->Stack, this->Net, this->Sections, this->Choices, this->Options.CapHeight);
    std::vector<TubeSurface> tubes(this->Net.Tubes.size());
    const bool made =
      parallelForUntilCancelled(0, static_cast<std::int64_t>(tubes.size()), 1, monitor,
        [&](std::int64_t begin, std::int64_t end)
        {
          for (std::int64_t t = begin; t < end; ++t)
          {
            tubes[t] = makeTube(this->Net, static_cast<Index>(t), this->Sections[t], inserted,
              this->Options, this->Rows, this->Fine[t] != 0);
          }
        });
    if (!made)
    {
      return Status::cancelled();
    }
    BranchedSurface s = assemblePatches(this->Stack, this->Net, tubes, inserted, this->Options);
    s.Jacobians.assign(s.Model.Patches.size(), 0.0);
    const bool measured =
      parallelForUntilCancelled(0, static_cast<std::int64_t>(s.Jacobians.size()), 32, monitor,
        [&](std::int64_t begin, std::int64_t end)
        {
          for (std::int64_t p = begin; p < end; ++p)
          {
            s.Jacobians[p] = patchJacobian(s.Model, p);
          }
        });
    if (!measured)
    {
      return Status::cancelled();
    }
    s.FoldedPatches = static_cast<int>(
      std::count_if(s.Jacobians.begin(), s.Jacobians.end(), [](double j) { return j < 0.0; }));
    return s;
  }

  const ContourStack& Stack;
  const BranchedNetwork& Net;
  const BranchedOptions& Options;
  const RowOptions Rows;
  const std::vector<std::vector<ControlRow>> Sections;
  std::vector<Known> Best; ///< of each junction, then of the two ends of each tube
  RowChoices Choices;
  std::vector<char> Fine; ///< whether a tube has short patches along v
};
} // namespace

Result<BranchedSurface> makeBranchedSurface(
  const ContourStack& stack, const BranchedOptions& options, Monitor& monitor)
{
  if (Status s = checkOptions(options); !s)
  {
    return s;
  }
  NetworkOptions no;
  no.Order = options.OrderU;
  no.PointsPerSection = options.PointsPerSection;
  no.SectionTolerance = options.SectionTolerance;
  no.Caps = options.Caps;
  no.ClosedEnds = options.ClosedEnds;
  no.Components = options.Components;
  RowOptions rows;
  rows.OrderU = options.OrderU;
  rows.OrderV = options.OrderV;
  rows.Kind = options.Kind;
  rows.Tangency = options.Tangency;
  rows.Position = options.JunctionPosition;
  // other and more columns where a patch folds; first without relaxation, which takes long
  struct Columns
  {
    double Refinement;
    bool Follow;
    int Folded;
  };
  std::vector<Columns> columns{
    {1.0, true, 0}, {1.0, false, 0}, {1.5, true, 0}, {1.5, false, 0}, {2.2, false, 0}};
  BranchedSurface best;
  double done = 0.0;
  for (const bool relaxing : {false, true})
  {
    const double share = (relaxing ? 0.7 : 0.3) / static_cast<double>(columns.size());
    for (Columns& c : columns)
    {
      no.Refinement = c.Refinement;
      no.FollowMatch = c.Follow;
      SubMonitor part(monitor, done, done + share);
      done += share;
      SubMonitor first(part, 0.0, 0.2);
      const auto net = makeNetwork(stack, no, first);
      if (!net)
      {
        return net.status();
      }
      SubMonitor rest(part, 0.2, 1.0);
      auto s = Maker(stack, *net, options, rows).run(relaxing, rest);
      if (!s)
      {
        return s;
      }
      c.Folded = s->FoldedPatches;
      if (best.Model.Patches.empty() || s->FoldedPatches < best.FoldedPatches)
      {
        best = std::move(*s);
      }
      if (best.FoldedPatches == 0)
      {
        monitor.progress(1.0);
        return best;
      }
      if (best.Model.Patches.size() > MaximumRefined)
      {
        columns.resize(1);
        break;
      }
    }
    std::stable_sort(columns.begin(), columns.end(),
      [](const Columns& a, const Columns& b) { return a.Folded < b.Folded; });
  }
  return best;
}
} // namespace bsr
