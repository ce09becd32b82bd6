#include "Spline/PatchImprover.h"

#include "Spline/FoldCheck.h"

#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr int Rounds = 3;      ///< of weights and parameter correction in a sweep
constexpr int Iterations = 15; ///< of the deterministic optimizer, each round

double largestShift(const RationalPatch& a, const RationalPatch& b)
{
  constexpr int grid = 13;
  double shift = 0.0;
  for (int i = 0; i < grid * grid; ++i)
  {
    const double u = (i % grid) / (grid - 1.0);
    const int row = i / grid;
    const double v = row / (grid - 1.0);
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
} // namespace

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

PatchImprover::PatchImprover(const ShellLayout& layout, const ShellFitResult& fit,
  const ShellFitOptions& shell, const RationalOptions& options)
    : Net(*layout.Net),
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

void PatchImprover::prepare(int segmentsU, int segmentsV)
{
  const std::pair<int, int> key(segmentsU, segmentsV);
  if (this->Energies.find(key) == this->Energies.end())
  {
    this->Energies.emplace(key, patchEnergies(segmentsU, segmentsV));
  }
}

void PatchImprover::improve(WeightOptimizer how, int sweep, Index p, RationalPatch& patch,
  FitPoint* first, FitPoint* last, PatchGain& gain, std::vector<double>& history) const
{
  if (sweep == 0)
  {
    correctOnPatch(patch, first, last);
    gain.MeanBefore = gain.MeanAfter = meanDistance(patch, first, last);
  }
  const RationalPatch base = patch;
  RationalPatch trial = patch;
  std::vector<FitPoint> points(first, last);
  const int rounds = sweep == 0 ? Rounds : 1;
  for (int round = 0; round < rounds && how != WeightOptimizer::None; ++round)
  {
    const WeightProblem problem(trial, points.data(), points.data() + points.size(),
      FreeControlPoints::Interior, this->objective(p, trial));
    const Eigen::VectorXd start = problem.weightsOf(trial);
    WeightProblem::State state;
    if (problem.points() < 2 * problem.variables() || !problem.solve(start, state))
    {
      break;
    }
    if (how == WeightOptimizer::Deterministic)
    {
      gain.Generations += problem.optimize(state, Iterations);
    }
    else if (how == WeightOptimizer::EvolutionStrategy && sweep + round == 0)
    {
      history = this->evolveWeights(p, problem, state, gain);
    }
    const std::vector<FitPoint> before = points;
    const Eigen::VectorXd found = problem.weightsOf(state.Patch);
    bool kept = this->tryPatch(base, state.Patch, points, patch, first, gain);
    trial = state.Patch;
    // Weights that fold a patch, or fit it worse at the true feet, are taken back by halves.
    for (double share = 0.5; !kept && how == WeightOptimizer::Deterministic && share > 0.1;
         share *= 0.5)
    {
      const Eigen::VectorXd weights =
        (start.array().pow(1.0 - share) * found.array().pow(share)).matrix();
      std::vector<FitPoint> moved = before;
      if (problem.solve(weights, state))
      {
        kept = this->tryPatch(base, state.Patch, moved, patch, first, gain);
      }
      if (kept)
      {
        trial = state.Patch;
        points = std::move(moved);
      }
    }
  }
  for (const Vec4& c : patch.ControlPoints)
  {
    gain.LeastWeight = std::min(gain.LeastWeight, c[3]);
    gain.LargestWeight = std::max(gain.LargestWeight, c[3]);
  }
}

void PatchImprover::refit(
  Index p, RationalPatch& patch, FitPoint* first, FitPoint* last, PatchGain& gain) const
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
    this->tryPatch(base, trial, points, patch, first, gain);
  }
}

bool PatchImprover::allowed(const RationalPatch& before, const RationalPatch& after) const
{
  return !checkShape(after).Folded &&
         !(this->Shell.RestShape && largestShift(before, after) > 0.5 * this->Shell.LeastWall);
}

void PatchImprover::block(Index p, const RationalPatch& patch, const FitPoint* first,
  const FitPoint* last, double pull, Eigen::MatrixXd& matrix, Eigen::MatrixXd& right) const
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

PatchObjective PatchImprover::objective(Index p, const RationalPatch& patch) const
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

std::vector<double> PatchImprover::evolveWeights(
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

bool PatchImprover::tryPatch(const RationalPatch& base, const RationalPatch& trial,
  std::vector<FitPoint>& points, RationalPatch& patch, FitPoint* first, PatchGain& gain) const
{
  correctOnPatch(trial, points.data(), points.data() + points.size(), CorrectionSteps);
  const double mean = meanDistance(trial, points.data(), points.data() + points.size());
  if (!(mean < gain.MeanAfter) || !this->allowed(base, trial))
  {
    return false;
  }
  gain.MeanAfter = mean;
  patch = trial;
  std::copy(points.begin(), points.end(), first);
  return true;
}
} // namespace bsr
