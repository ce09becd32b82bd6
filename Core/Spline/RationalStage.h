#pragma once

#include "Spline/EvolutionStrategy.h"
#include "Spline/ShellFit.h"

namespace bsr
{
/// How the weights of rational patches are found.
enum class WeightOptimizer
{
  None,              ///< nothing changes
  EvolutionStrategy, ///< paper 003, section 5.1
  /// Separable least squares, Levenberg-Marquardt steps on the projected problem.
  Deterministic,
  /// All weights stay 1; control points are fitted again like those of the others. Tells what of
  /// their gain is due to weights.
  ControlPoints
};

struct RationalOptions
{
  WeightOptimizer Optimizer = WeightOptimizer::Deterministic;
  EvolutionOptions Evolution; ///< Seed counts; each patch has its own stream
  double Lambda = 0.1;        ///< share of the fairing, as in the last pass of the fit
  /// delta, world units: patches whose mean distance (paper 003, eq. 2) is above it are refined;
  /// 0: none.
  double Tolerance = 0.0;
  int MaximumRefinement = 4; ///< segments are cut into at most so many (1, 2 or 4)
};

/// What the stage did to a patch.
struct PatchGain
{
  double MeanBefore = 0.0; ///< mean distance of its points, world units
  double MeanAfter = 0.0;
  double LeastWeight = 1.0;
  double LargestWeight = 1.0;
  int Generations = 0; ///< of the evolution strategy, or iterations
};

/// One shell with patches of their own.
struct RationalShell
{
  std::vector<RationalPatch> Patches; ///< one a quad
  std::vector<FitPoint> Points;       ///< with final parameters, sorted by patch
  std::vector<PatchGain> Gains;
  /// Mean over the patches of the best fitness, start and each generation (evolution strategy).
  std::vector<double> History;
  double Seconds = 0.0; ///< of the optimization of the weights
};

/**
 * Gives each patch of a fitted shell weights of its own. Free are the control points and weights
 * that touch neither the sides nor the tangent planes there, so that patches are independent of
 * each other, and neighbors keep meeting with the same tangent planes: homogeneous nets with
 * weights of 1 near the sides stay in the G1 space (specification, section F). A patch is changed
 * only if the mean distance of its points drops and it does not fold. With a `wall` (RestShape and
 * LeastWall of the shell's options) no point moves by more than half the least wall.
 */
Result<RationalShell> optimizeWeights(const ShellLayout& layout, FitSolver& solver,
  const ShellFitResult& fit, const ShellFitOptions& shell, const RationalOptions& options,
  Monitor& monitor);

/// Refines the strips of patches (all patches met by crossing opposite sides) through patches that
/// miss the tolerance in any of the shells, and fits their interiors again; repeats up to
/// MaximumRefinement. Sides are cut by knot insertion and stay equal bit for bit.
Status refineShells(const ShellLayout& layout, std::vector<RationalShell>& shells,
  const std::vector<const ShellFitResult*>& fits, const std::vector<ShellFitOptions>& options,
  const RationalOptions& rational, Monitor& monitor);
} // namespace bsr
