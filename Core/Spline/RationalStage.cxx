#include "Spline/RationalStage.h"

#include "Common/MonitoredLoop.h"
#include "Common/UnionFind.h"
#include "Spline/FoldCheck.h"
#include "Spline/WeightProblem.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <map>

namespace bsr
{
namespace
{
constexpr int Sweeps = 8; ///< of weights patch by patch and a solve for all control points
constexpr int Rounds = 3; ///< of weights and parameter correction in a sweep
constexpr int Steps = 2;  ///< of parameter correction a round
constexpr double LeastGain = 0.005; ///< of the mean distance, for another sweep
constexpr double Hold = 1e6;        ///< pull that keeps patches at a border as they are
constexpr int Iterations = 15;      ///< of the deterministic optimizer, each round

double meanDistance(const RationalPatch& patch, const FitPoint* first, const FitPoint* last)
{
  double sum = 0.0;
  double weight = 0.0;
  for (const FitPoint* p = first; p != last; ++p)
  {
    if (p->weight() > 0.0)
    {
      sum += p->weight() * (p->Position - patch.at(p->U, p->V).Point).norm();
      weight += p->weight();
    }
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

double largestShift(const RationalPatch& a, const RationalPatch& b)
{
  constexpr int grid = 13;
  double shift = 0.0;
  for (int i = 0; i < grid * grid; ++i)
  {
    const double u = (i % grid) / (grid - 1.0);
    const double v = (i / grid) / (grid - 1.0);
    shift = std::max(shift, (a.at(u, v).Point - b.at(u, v).Point).norm());
  }
  return shift;
}

/// Adds data * sum w phi phi^T and data * sum w phi p of the points, with phi = N / W.
void addRationalData(const RationalPatch& patch, const FitPoint* first, const FitPoint* last,
  double data, Eigen::MatrixXd& matrix, Eigen::MatrixXd& right)
{
  for (const FitPoint* p = first; p != last; ++p)
  {
    const double w = data * p->weight();
    if (!(w > 0.0))
    {
      continue;
    }
    const BasisValues u = evaluateBasis(patch.KnotsU.data(), 3, patch.countU(), p->U);
    const BasisValues v = evaluateBasis(patch.KnotsV.data(), 3, patch.countV(), p->V);
    int index[16];
    double phi[16];
    double sum = 0.0;
    for (int k = 0; k < 16; ++k)
    {
      index[k] = (v.First + k / 4) * patch.countU() + u.First + k % 4;
      phi[k] = u.Value[k % 4] * v.Value[k / 4];
      sum += phi[k] * patch.ControlPoints[index[k]][3];
    }
    for (int i = 0; i < 16; ++i)
    {
      const double f = w * phi[i] / sum;
      for (int j = 0; j < 16; ++j)
      {
        matrix(index[i], index[j]) += f * phi[j] / sum;
      }
      right.row(index[i]) += f * p->Position.transpose();
    }
  }
}

/// Everything that the patches of one shell have in common.
class Stage
{
public:
  Stage(const ShellLayout& layout, const ShellFitResult& fit, const ShellFitOptions& shell,
    const RationalOptions& options)
      : Net(*layout.Net),
        Fit(fit),
        Shell(shell),
        Options(options),
        Aspect(patchAspects(*layout.Complex, *layout.Vertices))
  {
    double sum = 0.0;
    for (const FitPoint& p : fit.Points)
    {
      sum += p.weight();
    }
    this->Data =
      (1.0 - options.Lambda) * fit.DataWeight * this->Net.patches() / std::max(sum, 1e-300);
  }

  /// Fairing matrices of such patches; not to be called by several threads at once.
  void prepare(int segmentsU, int segmentsV)
  {
    const std::pair<int, int> key(segmentsU, segmentsV);
    if (this->Energies.find(key) == this->Energies.end())
    {
      this->Energies.emplace(key, patchEnergies(segmentsU, segmentsV));
    }
  }

  /// Optimizes the weights (and the parameters) of a patch; unchanged where nothing is gained.
  void improve(int sweep, Index p, RationalPatch& patch, FitPoint* first, FitPoint* last,
    PatchGain& gain, std::vector<double>& history) const
  {
    if (sweep == 0)
    {
      correctOnPatch(patch, first, last);
      gain.MeanBefore = gain.MeanAfter = meanDistance(patch, first, last);
    }
    const RationalPatch base = patch;
    RationalPatch trial = patch;
    std::vector<FitPoint> points(first, last);
    const WeightOptimizer how = this->Options.Optimizer;
    const int rounds = sweep == 0 ? Rounds : 1;
    for (int round = 0; round < rounds && how != WeightOptimizer::None; ++round)
    {
      const WeightProblem problem(trial, points.data(), points.data() + points.size(),
        FreeControlPoints::Interior, this->objective(p, trial));
      WeightProblem::State state;
      if (problem.points() < 2 * problem.variables() ||
          !problem.solve(problem.weightsOf(trial), state))
      {
        break;
      }
      if (how == WeightOptimizer::Deterministic)
      {
        gain.Generations += problem.optimize(state, Iterations);
      }
      else if (sweep + round == 0)
      {
        history = this->evolveWeights(p, problem, state, gain);
      }
      trial = state.Patch;
      correctOnPatch(trial, points.data(), points.data() + points.size(), Steps);
      this->keepIfBetter(base, trial, points, patch, first, gain);
    }
    for (const Vec4& c : patch.ControlPoints)
    {
      gain.LeastWeight = std::min(gain.LeastWeight, c[3]);
      gain.LargestWeight = std::max(gain.LargestWeight, c[3]);
    }
  }

  /// Fits the interior of a patch again, with its weights; unchanged where nothing is gained.
  void refit(Index p, RationalPatch& patch, FitPoint* first, FitPoint* last, PatchGain& gain) const
  {
    const RationalPatch base = patch;
    RationalPatch trial = patch;
    std::vector<FitPoint> points(first, last);
    for (int round = 0; round < Rounds; ++round)
    {
      const WeightProblem problem(trial, points.data(), points.data() + points.size(),
        FreeControlPoints::Interior, this->objective(p, trial));
      WeightProblem::State state;
      if (!problem.solve(problem.weightsOf(trial), state))
      {
        break;
      }
      trial = state.Patch;
      correctOnPatch(trial, points.data(), points.data() + points.size(), Steps);
      this->keepIfBetter(base, trial, points, patch, first, gain);
    }
  }

  /// Not folded, and near to where it was if it is part of an inner shell.
  bool allowed(const RationalPatch& before, const RationalPatch& after) const
  {
    return !checkShape(after).Folded &&
           !(this->Shell.RestShape && largestShift(before, after) > 0.5 * this->Shell.LeastWall);
  }

  /// Normal equations of a patch for its homogeneous control points w b under its weights.
  void block(Index p, const RationalPatch& patch, const FitPoint* first, const FitPoint* last,
    double pull, Eigen::MatrixXd& matrix, Eigen::MatrixXd& right) const
  {
    const auto n = static_cast<Eigen::Index>(patch.ControlPoints.size());
    const PatchObjective o = this->objective(p, patch);
    Eigen::VectorXd inverse(n);
    Eigen::MatrixXd points(n, 3);
    for (Eigen::Index l = 0; l < n; ++l)
    {
      inverse[l] = 1.0 / patch.ControlPoints[l][3];
      points.row(l) = patch.ControlPoints[l].head<3>().transpose();
    }
    matrix = o.Fairing;
    right = o.FairingRight.rows() > 0 ? o.FairingRight : Eigen::MatrixXd::Zero(n, 3);
    if (pull > 0.0)
    {
      const Eigen::MatrixXd& mass = this->Energies.at({patch.SegmentsU, patch.SegmentsV}).Mass;
      matrix += pull * mass;
      right += pull * (mass * points);
    }
    matrix = inverse.asDiagonal() * matrix * inverse.asDiagonal();
    right = inverse.asDiagonal() * right;
    addRationalData(patch, first, last, this->Data, matrix, right);
  }

private:
  PatchObjective objective(Index p, const RationalPatch& patch) const
  {
    PatchObjective o;
    o.Data = this->Data;
    const auto [a, b] = this->Aspect[p];
    o.Fairing =
      this->Options.Lambda * this->Energies.at({patch.SegmentsU, patch.SegmentsV}).thinPlate(a, b);
    if (this->Shell.RestShape)
    {
      RationalPatch rest = ownPatch(this->Net, *this->Shell.RestShape, p);
      rest = refined(rest, patch.SegmentsU / rest.SegmentsU, patch.SegmentsV / rest.SegmentsV);
      Eigen::MatrixXd points(static_cast<Eigen::Index>(rest.ControlPoints.size()), 3);
      for (Eigen::Index l = 0; l < points.rows(); ++l)
      {
        points.row(l) = rest.ControlPoints[l].head<3>().transpose();
      }
      o.FairingRight = o.Fairing * points;
    }
    return o;
  }

  std::vector<double> evolveWeights(
    Index p, const WeightProblem& problem, WeightProblem::State& state, PatchGain& gain) const
  {
    EvolutionOptions o = this->Options.Evolution;
    o.Stream = static_cast<std::uint64_t>(p) + (this->Shell.RestShape ? 1ULL << 32 : 0ULL);
    o.Tolerance = this->Options.Tolerance;
    const EvolutionResult e = evolve(
      problem.variables(),
      [&](const Eigen::VectorXd& weights)
      {
        WeightProblem::State s;
        const bool feasible = weights.minCoeff() >= LeastPatchWeight &&
                              weights.maxCoeff() <= LargestPatchWeight && problem.solve(weights, s);
        return feasible ? s.Mean : std::numeric_limits<double>::infinity();
      },
      o);
    gain.Generations = static_cast<int>(e.History.size()) - 1;
    WeightProblem::State best;
    if (e.Fitness < state.Mean && problem.solve(e.Best, best))
    {
      state = std::move(best);
    }
    return e.History;
  }

  void keepIfBetter(const RationalPatch& base, const RationalPatch& trial,
    const std::vector<FitPoint>& points, RationalPatch& patch, FitPoint* first,
    PatchGain& gain) const
  {
    const double mean = meanDistance(trial, points.data(), points.data() + points.size());
    const bool shifted =
      this->Shell.RestShape && largestShift(base, trial) > 0.5 * this->Shell.LeastWall;
    if (mean < gain.MeanAfter && !shifted && !checkShape(trial).Folded)
    {
      gain.MeanAfter = mean;
      patch = trial;
      std::copy(points.begin(), points.end(), first);
    }
  }

  const PatchNet& Net;
  const ShellFitResult& Fit;
  const ShellFitOptions& Shell;
  const RationalOptions& Options;
  std::vector<std::array<double, 2>> Aspect;
  std::map<std::pair<int, int>, PatchEnergies> Energies;
  double Data = 1.0;
};

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

/// Strip of patches that an edge of the layout lies across: edges on opposite sides of a quad
/// belong to one.
std::vector<Index> stripsOf(const QuadComplex& complex)
{
  UnionFind sets(complex.edges());
  for (Index f = 0; f < complex.faces(); ++f)
  {
    for (int k = 0; k < 2; ++k)
    {
      sets.join(complex.edgeOf(4 * f + k), complex.edgeOf(4 * f + k + 2));
    }
  }
  std::vector<Index> strip(complex.edges());
  for (Index e = 0; e < complex.edges(); ++e)
  {
    strip[e] = static_cast<Index>(sets.find(e));
  }
  return strip;
}

/// Neighbors get the same bits: those of the edge's first half-edge.
void shareSides(const QuadComplex& complex, std::vector<RationalPatch>& patches)
{
  for (Index e = 0; e < complex.edges(); ++e)
  {
    const QuadEdge& edge = complex.edge(e);
    if (edge.Second < 0)
    {
      continue;
    }
    RationalPatch& from = patches[edge.First / 4];
    RationalPatch& to = patches[edge.Second / 4];
    const int n = sideCount(from, edge.First % 4);
    for (int c = 1; c < n - 1; ++c)
    {
      to.ControlPoints[sideIndex(to, edge.Second % 4, n - 1 - c)] =
        from.ControlPoints[sideIndex(from, edge.First % 4, c)];
    }
  }
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
Result<RationalShell> joined(const ShellLayout& layout, const Stage& stage, FitSolver& solver,
  const RationalShell& shell, const std::vector<std::int64_t>& first, const std::vector<char>& held)
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
        correctOnPatch(own, at, stop, Steps);
        trial.Gains[p].MeanAfter = meanDistance(own, at, stop);
      }
    });
  return trial;
}

/// Joins the patches again; where one folds, it and its neighbors are held and it is tried again.
/// False where nearly nothing is gained.
Result<bool> joinAgain(const ShellLayout& layout, const Stage& stage, FitSolver& solver,
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
} // namespace

Result<RationalShell> optimizeWeights(const ShellLayout& layout, FitSolver& solver,
  const ShellFitResult& fit, const ShellFitOptions& shell, const RationalOptions& options,
  Monitor& monitor)
{
  const auto start = std::chrono::steady_clock::now();
  const PatchNet& net = *layout.Net;
  Stage stage(layout, fit, shell, options);
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
  for (int sweep = 0; sweep < Sweeps; ++sweep)
  {
    SubMonitor part(monitor, static_cast<double>(sweep) / Sweeps, (sweep + 1.0) / Sweeps);
    const Status status = forPatches(net.patches(), part,
      [&](Index p)
      {
        FitPoint* points = out.Points.data();
        stage.improve(sweep, p, out.Patches[p], points + first[p], points + first[p + 1],
          out.Gains[p], histories[p]);
      });
    if (!status)
    {
      return status;
    }
    if (options.Optimizer == WeightOptimizer::None || sweep + 1 == Sweeps)
    {
      break;
    }
    const auto gained = joinAgain(layout, stage, solver, out, first);
    if (!gained)
    {
      return gained.status();
    }
    if (!*gained)
    {
      break;
    }
  }
  out.History = meanHistory(histories);
  out.Seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

Status refineShells(const ShellLayout& layout, std::vector<RationalShell>& shells,
  const std::vector<const ShellFitResult*>& fits, const std::vector<ShellFitOptions>& options,
  const RationalOptions& rational, Monitor& monitor)
{
  const QuadComplex& complex = *layout.Complex;
  const auto strips = stripsOf(complex);
  for (int factor = 2; factor <= rational.MaximumRefinement; factor *= 2)
  {
    std::vector<char> cut(complex.edges(), 0); // by strip
    bool any = false;
    for (const RationalShell& shell : shells)
    {
      for (Index f = 0; f < complex.faces(); ++f)
      {
        if (shell.Gains[f].MeanAfter > rational.Tolerance)
        {
          cut[strips[complex.edgeOf(4 * f)]] = 1;
          cut[strips[complex.edgeOf(4 * f + 1)]] = 1;
          any = true;
        }
      }
    }
    if (!any)
    {
      return Status::ok();
    }
    for (std::size_t s = 0; s < shells.size(); ++s)
    {
      RationalShell& shell = shells[s];
      Stage stage(layout, *fits[s], options[s], rational);
      std::vector<char> changed(complex.faces(), 0);
      for (Index f = 0; f < complex.faces(); ++f)
      {
        const int cutU = cut[strips[complex.edgeOf(4 * f)]] ? 2 : 1;
        const int cutV = cut[strips[complex.edgeOf(4 * f + 1)]] ? 2 : 1;
        changed[f] = cutU * cutV > 1;
        if (changed[f])
        {
          shell.Patches[f] = refined(shell.Patches[f], cutU, cutV);
          stage.prepare(shell.Patches[f].SegmentsU, shell.Patches[f].SegmentsV);
        }
      }
      shareSides(complex, shell.Patches);
      const auto first = sortByPatch(shell.Points, complex.faces());
      const Status status = forPatches(complex.faces(), monitor,
        [&](Index p)
        {
          FitPoint* points = shell.Points.data();
          if (changed[p])
          {
            stage.refit(
              p, shell.Patches[p], points + first[p], points + first[p + 1], shell.Gains[p]);
          }
        });
      if (!status)
      {
        return status;
      }
    }
  }
  return Status::ok();
}
} // namespace bsr
