#pragma once

#include "Common/MonitoredLoop.h"
#include "Spline/RationalStage.h"
#include "Spline/WeightProblem.h"

#include <map>

namespace bsr
{
/// Improves the patches of one shell, each on its own: what they have in common.
class PatchImprover
{
public:
  PatchImprover(const ShellLayout& layout, const ShellFitResult& fit, const ShellFitOptions& shell,
    const RationalOptions& options);

  /// Fairing matrices of such patches; not to be called by several threads at once.
  void prepare(int segmentsU, int segmentsV);

  /// Optimizes the weights (and the parameters) of a patch; unchanged where nothing is gained. The
  /// evolution strategy runs in the first sweep only and gives its history.
  void improve(WeightOptimizer how, int sweep, Index p, RationalPatch& patch, FitPoint* first,
    FitPoint* last, PatchGain& gain, std::vector<double>& history) const;

  /// Fits the interior of a patch again, with its weights; unchanged where nothing is gained.
  void refit(Index p, RationalPatch& patch, FitPoint* first, FitPoint* last, PatchGain& gain) const;

  /// Not folded, and near to where it was if it is part of an inner shell.
  bool allowed(const RationalPatch& before, const RationalPatch& after) const;

  /// Normal equations of a patch for its homogeneous control points w b under its weights.
  void block(Index p, const RationalPatch& patch, const FitPoint* first, const FitPoint* last,
    double pull, Eigen::MatrixXd& matrix, Eigen::MatrixXd& right) const;

private:
  PatchObjective objective(Index p, const RationalPatch& patch) const;
  std::vector<double> evolveWeights(
    Index p, const WeightProblem& problem, WeightProblem::State& state, PatchGain& gain) const;
  /// Corrects the parameters on a trial and takes both over where they are better; else false.
  bool tryPatch(const RationalPatch& base, const RationalPatch& trial,
    std::vector<FitPoint>& points, RationalPatch& patch, FitPoint* first, PatchGain& gain) const;

  const PatchNet& Net;
  const ShellFitOptions& Shell;
  const RationalOptions& Options;
  std::vector<std::array<double, 2>> Aspect;
  std::map<std::pair<int, int>, PatchEnergies> Energies;
  double Data = 1.0;
};

/// Steps of parameter correction between two solves.
constexpr int CorrectionSteps = 2;

/// Weighted mean of the distances of points from a patch at their parameters.
double meanDistance(const RationalPatch& patch, const FitPoint* first, const FitPoint* last);

/// body(patch) for all patches, in parallel, with looks at the monitor in between.
template <class Body>
Status forPatches(Index patches, Monitor& monitor, const Body& body)
{
  const bool done = monitoredFor(0, patches, 1, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t p = first; p < last; ++p)
      {
        body(static_cast<Index>(p));
      }
    });
  return done ? Status::ok() : Status::cancelled();
}
} // namespace bsr
