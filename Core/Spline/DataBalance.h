#pragma once

#include "Spline/FitEquations.h"

namespace bsr
{
/// One candidate of the scan for K.
struct BalanceScore
{
  double DataWeight = 0.0;
  double Error = 0.0; ///< root mean square of the left-out points' distances along the normal
};

/**
 * Finds K by block-wise cross-validation: the points of whole regions (quarters of patches) are
 * left out in turn and predicted from the rest, for each K of a logarithmic grid. Regions, because
 * the roughness of CT surfaces is correlated over several voxels: single left-out points would be
 * predicted by neighbors with the same error, and the noise be followed.
 * What is correlated over more than a region still looks like shape. So where the residuals of
 * neighbors are correlated, a second criterion bounds K from above: the change of the surface from
 * K to 2 K. It falls steeply while shape is gained (as K^-1/2) and hardly once roughness is
 * followed, whatever its strength and range; K is where it falls by less than a quarter of an
 * octave an octave. That place is the same length on the surface for any number of patches. (A
 * continuous relative of the quasi-optimality criterion of Tikhonov and Glasko, which looks for the
 * least change.) Where patches are joined without tangent planes (`creases`), edges that fairing
 * does not reach drown that: there K is the least whose prediction is at most half as much worse
 * than the best. Not so without `correlatedNoise`: then what is correlated is the shape that the
 * patches miss. Returns the scores, increasing in K; `best` is set to the K chosen.
 */
Result<std::vector<BalanceScore>> scanDataWeight(const PatchNet& net, FitSolver& solver,
  const FitEquations& equations, const std::vector<FitPoint>& points, double lambda,
  bool correlatedNoise, bool creases, Monitor& monitor, double& best);
} // namespace bsr
