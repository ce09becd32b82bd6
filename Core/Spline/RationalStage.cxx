#include "Spline/PatchImprover.h"

#include <chrono>
#include <cmath>

namespace bsr
{
namespace
{
constexpr int Sweeps = 8; ///< of weights patch by patch and a solve for all control points
constexpr double LeastGain = 0.005; ///< of the mean distance, for another sweep
constexpr double Hold = 1e6;        ///< pull that keeps patches at a border as they are

/// The mean over patches of histories of different lengths, each kept at its last value.
std::vector<double> meanHistory(const std::vector<std::vector<double>>& histories)
{
  std::size_t length = 0;
  double count = 0.0;
  for (const auto& h : histories)
  {
    length = std::max(length, h.size());
    count += !h.empty() && std::isfinite(h.back());
  }
  std::vector<double> mean(length, 0.0);
  for (const auto& h : histories)
  {
    for (std::size_t g = 0; g < length && !h.empty() && std::isfinite(h.back()); ++g)
    {
      mean[g] += h[std::min(g, h.size() - 1)] / count;
    }
  }
  return mean;
}

/// Whether a side of the patch has no neighbor.
bool atBorder(const QuadComplex& complex, Index p)
{
  return complex.twin(4 * p) < 0 || complex.twin(4 * p + 1) < 0 || complex.twin(4 * p + 2) < 0 ||
         complex.twin(4 * p + 3) < 0;
}

void holdAround(const QuadComplex& complex, Index p, std::vector<char>& held)
{
  held[p] = 1;
  for (int k = 0; k < 4; ++k)
  {
    const Index t = complex.twin(4 * p + k);
    if (t >= 0)
    {
      held[t / 4] = 1;
    }
  }
}

double totalMean(const RationalShell& shell)
{
  double sum = 0.0;
  for (const PatchGain& g : shell.Gains)
  {
    sum += g.MeanAfter;
  }
  return sum;
}

/// All control points under the weights of the patches, so that the sides follow too: homogeneous
/// nets of the space. Held patches stay as they are.
Result<RationalShell> joined(const ShellLayout& layout, const PatchImprover& stage,
  FitSolver& solver, const RationalShell& shell, const std::vector<std::int64_t>& first,
  const std::vector<char>& held)
{
  const PatchNet& net = *layout.Net;
  PatchBlocks blocks;
  blocks.resize(net.patches(), net.perPatch());
  const FitPoint* points = shell.Points.data();
  parallelFor(0, net.patches(), 8,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (auto p = static_cast<Index>(begin); p < end; ++p)
      {
        stage.block(p, shell.Patches[p], points + first[p], points + first[p + 1],
          held[p] ? Hold : 0.0, blocks.Matrix[p], blocks.Right[p]);
      }
    });
  const auto solved = solver.solve(blocks);
  if (!solved)
  {
    return solved.status();
  }
  RationalShell trial = shell;
  parallelFor(0, net.patches(), 4,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (auto p = static_cast<Index>(begin); p < end; ++p)
      {
        auto& own = trial.Patches[p];
        for (int l = 0; l < net.perPatch(); ++l)
        {
          Vec4& c = own.ControlPoints[l];
          c.head<3>() = solved->row(net.at(p, l)).transpose() / c[3];
        }
        FitPoint* at = trial.Points.data() + first[p];
        FitPoint* stop = trial.Points.data() + first[p + 1];
        correctOnPatch(own, at, stop, CorrectionSteps);
        trial.Gains[p].MeanAfter = meanDistance(own, at, stop);
      }
    });
  return trial;
}

/// Joins the patches again; where one folds, it and its neighbors are held and it is tried again.
/// False where nearly nothing is gained.
Result<bool> joinAgain(const ShellLayout& layout, const PatchImprover& stage, FitSolver& solver,
  RationalShell& shell, const std::vector<std::int64_t>& first)
{
  const QuadComplex& complex = *layout.Complex;
  std::vector<char> held(complex.faces());
  for (Index p = 0; p < complex.faces(); ++p)
  {
    held[p] = atBorder(complex, p);
  }
  for (int attempt = 0; attempt < 4; ++attempt)
  {
    auto trial = joined(layout, stage, solver, shell, first, held);
    if (!trial)
    {
      return trial.status();
    }
    bool sound = true;
    for (Index p = 0; p < complex.faces(); ++p)
    {
      if (!stage.allowed(shell.Patches[p], trial->Patches[p]))
      {
        sound = false;
        holdAround(complex, p, held);
      }
    }
    if (sound)
    {
      const double gain = 1.0 - totalMean(*trial) / std::max(totalMean(shell), 1e-300);
      if (gain > 0.0)
      {
        shell = std::move(*trial);
      }
      return gain > LeastGain;
    }
  }
  return false;
}

/// Sweeps over the patches and joins in turn, until next to nothing is gained. `done`: sweeps.
template <class Sweep, class Join>
Status alternate(
  WeightOptimizer how, const Sweep& sweep, const Join& join, int& done, Monitor& monitor)
{
  for (int i = 0; i < Sweeps; ++i)
  {
    SubMonitor part(monitor, static_cast<double>(i) / Sweeps, (i + 1.0) / Sweeps);
    if (Status s = sweep(done++, part); !s)
    {
      return s;
    }
    if (how == WeightOptimizer::None || i + 1 == Sweeps)
    {
      break;
    }
    const auto gained = join();
    if (!gained)
    {
      return gained.status();
    }
    if (!*gained)
    {
      break;
    }
  }
  return Status::ok();
}
} // namespace

Result<RationalShell> optimizeWeights(const ShellLayout& layout, FitSolver& solver,
  const ShellFitResult& fit, const ShellFitOptions& shell, const RationalOptions& options,
  Monitor& monitor)
{
  const auto start = std::chrono::steady_clock::now();
  const PatchNet& net = *layout.Net;
  PatchImprover stage(layout, fit, shell, options);
  stage.prepare(net.segments(), net.segments());
  RationalShell out;
  out.Points = fit.Points;
  const auto first = sortByPatch(out.Points, net.patches());
  out.Patches.resize(net.patches());
  out.Gains.resize(net.patches());
  std::vector<std::vector<double>> histories(net.patches());
  for (Index p = 0; p < net.patches(); ++p)
  {
    out.Patches[p] = ownPatch(net, fit.Net, p);
  }
  // Weights are looked for about the best control points: alone, those of a poor fit lead astray.
  std::vector<WeightOptimizer> phases(1, options.Optimizer);
  if (options.Optimizer == WeightOptimizer::Deterministic)
  {
    phases.insert(phases.begin(), WeightOptimizer::ControlPoints);
  }
  int done = 0;
  for (std::size_t phase = 0; phase < phases.size(); ++phase)
  {
    const double share = 1.0 / static_cast<double>(phases.size());
    SubMonitor part(monitor, share * static_cast<double>(phase), share * (phase + 1.0));
    const auto sweep = [&](int number, Monitor& watch)
    {
      return forPatches(net.patches(), watch,
        [&](Index p)
        {
          FitPoint* points = out.Points.data();
          stage.improve(phases[phase], number, p, out.Patches[p], points + first[p],
            points + first[p + 1], out.Gains[p], histories[p]);
        });
    };
    const auto join = [&] { return joinAgain(layout, stage, solver, out, first); };
    if (Status s = alternate(phases[phase], sweep, join, done, part); !s)
    {
      return s;
    }
  }
  out.History = meanHistory(histories);
  out.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}
} // namespace bsr
