#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Spline/FitPoints.h"
#include "Spline/ThinPlate.h"

#include <memory>

namespace bsr
{
/// Normal equations of the patches over their own control points, before any continuity.
struct PatchBlocks
{
  std::vector<Eigen::MatrixXd> Matrix; ///< symmetric, n^2 x n^2 a patch
  std::vector<Eigen::MatrixXd> Right;  ///< n^2 x 3 a patch

  void resize(Index patches, int perPatch);
};

/// N^T W N and N^T W p of every patch (paper 000, eq. 4); points sorted by patch.
PatchBlocks dataBlocks(
  const PatchNet& net, const std::vector<FitPoint>& points, const std::vector<std::int64_t>& first);

/**
 * Solves the normal equations of all patches under the continuity of a space.
 * The sparse pattern and its fill-reducing order are found once, with the first system.
 */
class FitSolver
{
public:
  virtual ~FitSolver() = default;
  /// The net that solves sum of the blocks = right-hand sides; fails on a singular system.
  virtual Result<NetPoints> solve(const PatchBlocks& blocks) = 0;
  /// The same to a relative residual of 1e-5 by conjugate gradients from the last solution; for
  /// scans.
  virtual Result<NetPoints> solveRoughly(const PatchBlocks& blocks) = 0;
  virtual Index unknowns() const = 0;
};

/// net = Basis * x: one positive definite system (eq. 7 and 8), sparse Cholesky, three right sides.
std::unique_ptr<FitSolver> makeReducedSolver(const PatchNet& net, const SplineSpace& space);

/// C0 by Lagrange multipliers over all control points of all patches (eq. 6).
std::unique_ptr<FitSolver> makeMultiplierSolver(const PatchNet& net);
} // namespace bsr
