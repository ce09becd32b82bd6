#include "Spline/DataBalance.h"

#include "Spline/ParameterCorrection.h"

#include <cmath>

namespace bsr
{
namespace
{
constexpr int Folds = 4;

int foldOf(const FitPoint& p)
{
  // Quarter of the patch; shifted from patch to patch so that a fold's regions are spread out.
  const unsigned quarter = (p.U < 0.5 ? 0u : 1u) + (p.V < 0.5 ? 0u : 2u);
  return static_cast<int>(
    (quarter + 2654435761u * static_cast<unsigned>(p.Patch) / 65536u) % Folds);
}

struct Fold
{
  FitEquations Equations;
  std::vector<FitPoint> LeftOut;
};

Fold makeFold(
  const PatchNet& net, const FitEquations& all, const std::vector<FitPoint>& points, int k)
{
  Fold fold;
  std::vector<FitPoint> kept;
  for (const FitPoint& p : points)
  {
    (p.Fixed || foldOf(p) != k ? kept : fold.LeftOut).push_back(p);
  }
  const auto first = sortByPatch(kept, net.patches());
  fold.Equations = all;
  fold.Equations.Data = dataBlocks(net, kept, first);
  fold.Equations.TotalWeight = 0.0;
  for (const FitPoint& p : kept)
  {
    fold.Equations.TotalWeight += p.Fixed ? 0.0 : p.weight();
  }
  return fold;
}
} // namespace

Result<std::vector<BalanceScore>> scanDataWeight(const PatchNet& net, FitSolver& solver,
  const FitEquations& equations, const std::vector<FitPoint>& points, double lambda,
  Monitor& monitor, double& best)
{
  std::vector<BalanceScore> scores;
  for (const double k : {10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 1e5})
  {
    scores.push_back({k, 0.0});
  }
  double weight = 0.0;
  for (int f = 0; f < Folds; ++f)
  {
    const Fold fold = makeFold(net, equations, points, f);
    for (BalanceScore& s : scores)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      auto surface = solver.solveRoughly(fold.Equations.blocks(net, lambda, s.DataWeight));
      if (!surface)
      {
        return surface.status();
      }
      const auto r = residuals(net, *surface, fold.LeftOut);
      for (std::size_t i = 0; i < r.size(); ++i)
      {
        s.Error += fold.LeftOut[i].weight() * r[i].Normal * r[i].Normal;
      }
    }
    for (const FitPoint& p : fold.LeftOut)
    {
      weight += p.weight();
    }
  }
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < scores.size(); ++i)
  {
    scores[i].Error = std::sqrt(scores[i].Error / std::max(weight, 1e-300));
    chosen = scores[i].Error < scores[chosen].Error ? i : chosen;
  }
  best = scores[chosen].DataWeight;
  return scores;
}
} // namespace bsr
