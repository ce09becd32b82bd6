#include "Spline/DataBalance.h"

#include "Mesh/PointTree.h"
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

/// Correlation of the residuals of nearest neighbors: near 0 for white noise, else up to 1.
double neighborCorrelation(
  const PatchNet& net, const NetPoints& surface, const std::vector<FitPoint>& points)
{
  std::vector<FitPoint> counting;
  std::copy_if(points.begin(), points.end(), std::back_inserter(counting),
    [](const FitPoint& p) { return !p.Fixed && p.weight() > 0.0; });
  if (counting.size() < 2)
  {
    return 0.0;
  }
  const auto r = residuals(net, surface, counting);
  std::vector<Vec3> places;
  places.reserve(counting.size());
  for (const FitPoint& p : counting)
  {
    places.push_back(p.Position);
  }
  const PointTree tree(std::move(places));
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i)
  {
    product += r[i].Normal * r[tree.nearestOther(static_cast<Index>(i))].Normal;
    square += r[i].Normal * r[i].Normal;
  }
  return square > 0.0 ? std::clamp(product / square, 0.0, 1.0) : 0.0;
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
  bool correlatedNoise, Monitor& monitor, double& best)
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
  std::size_t least = 0;
  for (std::size_t i = 0; i < scores.size(); ++i)
  {
    scores[i].Error = std::sqrt(scores[i].Error / std::max(weight, 1e-300));
    least = scores[i].Error < scores[least].Error ? i : least;
  }
  best = scores[least].DataWeight;
  if (!correlatedNoise)
  {
    return scores;
  }
  auto surface = solver.solveRoughly(equations.blocks(net, lambda, best));
  if (!surface)
  {
    return surface.status();
  }
  const double correlation = neighborCorrelation(net, *surface, points);
  const double limit = scores[least].Error * (1.0 + 0.5 * correlation);
  const auto chosen = std::find_if(
    scores.begin(), scores.end(), [limit](const BalanceScore& s) { return s.Error <= limit; });
  best = chosen->DataWeight;
  return scores;
}
} // namespace bsr
