#pragma once

#include "Common/Monitor.h"
#include "Spline/FitSystem.h"
#include "Spline/ParameterCorrection.h"

namespace bsr
{
/// A place on a border side where the surface shall be: fixed parameters, a target in space.
struct RimSample
{
  Index HalfEdge = -1;
  double T = 0.0; ///< along the half-edge
  Vec3 Target = Vec3::Zero();
  /// If not zero: only the component along this unit direction counts.
  Vec3 Direction = Vec3::Zero();
  double Weight = 1.0;
};

struct ShellFitOptions
{
  std::vector<double> Fairing = {0.9, 0.5, 0.1}; ///< lambda of each pass, in [0, 1)
  CorrectionMethod Correction = CorrectionMethod::Taylor;
  double DataWeight = 0.0;     ///< K: reference points a patch; 0: found by cross-validation
  bool CorrelatedNoise = true; ///< the points' roughness extends over neighbors (CT surfaces)
  bool Creases = false;        ///< the patches' tangent planes are not continuous
  bool Robust = true;          ///< weigh outliers down (Tukey)
  bool Reassign = true;        ///< points may move on to neighboring patches
  int ExtraPasses = 2;         ///< repetitions of the last pass
  int MostPasses = 0;       ///< accelerated repetitions of it after that, while they gain something
  double LeastGain = 0.005; ///< of the root mean square distance, of a pass that gains something
  /// Where given, fairing acts on the difference to this net: a shell whose shape this one shares.
  const NetPoints* RestShape = nullptr;
  /// With a RestShape: it is the outer shell, and this one keeps at least this distance inside it.
  double LeastWall = 0.0;
  double TypicalWall = 0.0; ///< its thickness where nothing is known of this shell
};

struct ShellFitResult
{
  NetPoints Net;
  std::vector<FitPoint> Points; ///< with final parameters and weights, sorted by patch
  double DataWeight = 0.0;      ///< K used
  double Balance = 0.0;         ///< K before folds made it smaller
  double RobustScale = 0.0;     ///< sigma of the residuals, world units
  int Folded = 0;               ///< patches still folded at the end
  int FoldedWalls = 0;          ///< ruled walls to the outer shell still folded at the end
  int Repaired = 0;             ///< patches that needed the cure
};

/// Everything about the layout that both shells share.
struct ShellLayout
{
  const QuadComplex* Complex = nullptr;
  const PatchNet* Net = nullptr;
  const std::vector<Vec3>* Vertices = nullptr;
};

/**
 * Fits one shell: for each lambda solve, correct parameters, weigh outliers down; finds the balance
 * K; then repairs what is folded, crosses the outer shell or makes a wall fold, in steps of
 * growing force: local fairing, a pull to a smooth fit, a pull to a safe shape (the layout, or the
 * outer shell moved inward) with data dropped, a blend of the whole shell with the safe shape.
 */
Result<ShellFitResult> fitShell(const ShellLayout& layout, FitSolver& solver,
  std::vector<FitPoint> points, const std::vector<RimSample>& rim, const ShellFitOptions& options,
  Monitor& monitor);
} // namespace bsr
