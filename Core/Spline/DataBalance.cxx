#include "Spline/DataBalance.h"

#include "Mesh/PointTree.h"
#include "Spline/ParameterCorrection.h"

#include <cmath>

namespace bsr
{
namespace
{
constexpr int Folds = 4;
/// Correlation of neighboring residuals below which noise is white, and above which it is not.
constexpr double White = 0.2;
constexpr double Correlated = 0.5;
constexpr double Slack = 1.5;       ///< of the prediction's error, by the correlation
constexpr double CreaseSlack = 0.5; ///< the same without continuous tangent planes

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

/// Root mean square over the surface of the distance of two nets along the normal.
double change(const PatchNet& net, const NetPoints& from, const NetPoints& to)
{
  constexpr int Grid = 4;
  const NetEvaluator before(net, from);
  const NetEvaluator after(net, to);
  std::vector<BasisValues> basis;
  for (int i = 0; i < Grid; ++i)
  {
    basis.push_back(after.basis((i + 0.5) / Grid));
  }
  double squares = 0.0;
  double area = 0.0;
  for (Index p = 0; p < net.patches(); ++p)
  {
    for (int k = 0; k < Grid * Grid; ++k)
    {
      const SurfacePoint a = before.at(p, basis[k % Grid], basis[k / Grid]);
      const SurfacePoint b = after.at(p, basis[k % Grid], basis[k / Grid]);
      const Vec3 normal = b.normal();
      const double size = normal.norm();
      const double d = size > 0.0 ? (b.Point - a.Point).dot(normal) / size : 0.0;
      squares += size * d * d;
      area += size;
    }
  }
  return area > 0.0 ? std::sqrt(squares / area) : 0.0;
}

/// log2 of K where changes of the surface between K and 2 K stop falling steeply, at most `most`.
Result<double> whereRoughnessBegins(const PatchNet& net, FitSolver& solver,
  const FitEquations& equations, double lambda, double most, Monitor& monitor)
{
  constexpr double Steepness = 0.25; ///< log2 of the change an octave of K
  std::vector<double> changes;       ///< log2, from octave i - 1 to i
  NetPoints last;
  double slope = 0.0;
  for (int octave = -1; octave <= most + 2.0; ++octave)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    auto surface = solver.solveRoughly(equations.blocks(net, lambda, std::exp2(octave)));
    if (!surface)
    {
      return surface.status();
    }
    if (last.rows() > 0)
    {
      changes.push_back(std::log2(std::max(change(net, last, *surface), 1e-300)));
    }
    last = std::move(*surface);
    if (changes.size() < 3)
    {
      continue;
    }
    // Over two octaves; its middle is the octave before the last, and half of a change's width.
    const double next = 0.5 * (changes.back() - changes[changes.size() - 3]);
    const double middle = octave - 1.5;
    if (next > -Steepness)
    {
      const double step = changes.size() > 3 ? (next + Steepness) / (next - slope) : 0.0;
      return std::min(middle - step, most);
    }
    slope = next;
  }
  return most;
}

/// The least K whose error is within a limit, between the scores by powers; 0 where all are.
double fewestFor(const std::vector<BalanceScore>& scores, double limit)
{
  std::size_t i = 0;
  while (scores[i].Error > limit)
  {
    ++i;
  }
  if (i == 0)
  {
    return 0.0;
  }
  const BalanceScore& a = scores[i - 1];
  const BalanceScore& b = scores[i];
  const double t = std::log(a.Error / limit) / std::log(a.Error / std::max(b.Error, 1e-300));
  return a.DataWeight * std::pow(b.DataWeight / a.DataWeight, std::clamp(t, 0.0, 1.0));
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
  bool correlatedNoise, bool creases, Monitor& monitor, double& best)
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
  if (creases)
  {
    best = std::max(fewestFor(scores, scores[least].Error * (1.0 + CreaseSlack * correlation)),
      scores.front().DataWeight);
    return scores;
  }
  const double most = std::log2(best);
  auto begin = whereRoughnessBegins(net, solver, equations, lambda, most, monitor);
  if (!begin)
  {
    return begin.status();
  }
  const double share = std::clamp((correlation - White) / (Correlated - White), 0.0, 1.0);
  const double fewest = fewestFor(scores, scores[least].Error * (1.0 + Slack * correlation));
  best = std::max(std::exp2(most + share * (*begin - most)), fewest);
  return scores;
}
} // namespace bsr
