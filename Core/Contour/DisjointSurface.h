#pragma once

#include "Common/Status.h"
#include "Contour/UniformSpline.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/**
 * One B-spline surface S(u, v) = sum B_ij N_i(u) M_j(v) whose rows hold the control points of
 * several curves one after the other; only the ranges of u in which a curve's own control points
 * act are used, so the curves are disjoint (paper 002, equations 2.1 and 2.2).
 */
struct DisjointSurface
{
  int OrderU = 3;
  int OrderV = 3;
  bool UniformU = false; ///< open uniform knots (ends of full multiplicity) instead of periodic
  bool UniformV = false;
  std::vector<int> Counts;      ///< D: control points of each disjoint curve
  std::vector<ControlRow> Rows; ///< each of sum(Counts) control points, v upward
};

/// Checks orders (2 to 10), counts (at least the order) and rows (at least the order, equal length,
/// finite).
Status checkDisjoint(const DisjointSurface& surface);

/// Knots of a direction: 0, 1, 2 ... (periodic) or with ends of full multiplicity (open uniform).
std::vector<double> disjointKnots(int order, int count, bool uniform);

/// The range of u of each disjoint curve (section 2.1): from the knot at which its first control
/// points are complete to the one at which its last begin to fade.
std::vector<std::array<double, 2>> disjointRanges(const DisjointSurface& surface);
/// Range of v.
std::array<double, 2> disjointRangeV(const DisjointSurface& surface);

Vec3 evaluateDisjoint(const DisjointSurface& surface, double u, double v);

/**
 * The same surface, exactly, as a model: a patch for each curve and each interval of v in which the
 * surface meets itself in the same way. A side u = start or end has as neighbor the side that runs
 * along it within `tolerance` times the size (its own curve's other end first: a closed tube);
 * sides without one are torn. `Torn` of them are not at the ends of v.
 */
struct DisjointModel
{
  SplineModel Model;
  int Torn = 0;         ///< free sides along v
  double TornGap = 0.0; ///< largest distance between the two ends of a torn curve
};
Result<DisjointModel> modelOfDisjoint(const DisjointSurface& surface, double tolerance = 1e-9);
} // namespace bsr
