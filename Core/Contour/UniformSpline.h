#pragma once

#include "Common/Types.h"

#include <Eigen/LU>

namespace bsr
{
/// A row of control points.
using ControlRow = std::vector<Vec3>;

/**
 * Periodic B-spline curves with knots at all integers (paper 002, section 2). Control point i of n
 * belongs to the parameter i + siteOffset(order), where its B-spline is largest: half-way between
 * knots for odd orders, at knots for even ones.
 */
constexpr double siteOffset(int order)
{
  return order % 2 == 1 ? 0.5 : 0.0;
}

/// Values at such a site of the control points that act there: order (odd) or order - 1 (even) of
/// them, symmetric about the own one.
std::vector<double> siteValues(int order);

/// Finds the control points whose curve passes through given points at its sites.
class PeriodicInterpolation
{
public:
  PeriodicInterpolation(int order, int count);
  ControlRow solve(const ControlRow& points) const;

private:
  Eigen::PartialPivLU<Eigen::MatrixXd> Matrix;
};

/// Control points on full-multiplicity ("clamped") knots for the piece [first, first + spans] of a
/// periodic curve: spans + order - 1 of them. The same curve, exactly.
ControlRow periodicPiece(const ControlRow& row, int order, int first, int spans);

/// Knots 0 .. spans, inner ones simple, ends of multiplicity `order`.
std::vector<double> clampedKnots(int order, int spans);

/// Parameter of each control point: mean of the order - 1 knots that it lies over (Greville).
std::vector<double> grevilleSites(const std::vector<double>& knots, int order);

/// A curve on its own knots.
struct KnotCurve
{
  std::vector<double> Knots;
  ControlRow Points;
};

/**
 * The piece [a, b] of a curve, on clamped knots; the knots between a and b are kept. Exact (polar
 * forms: L. Ramshaw, Blossoms are polar forms, CAGD 6, 1989). a < b within the domain.
 */
KnotCurve curvePiece(const KnotCurve& curve, int order, double a, double b);
} // namespace bsr
