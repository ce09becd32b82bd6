#pragma once

#include <array>
#include <vector>

namespace bsr
{
/// Highest degree of a spline that the library evaluates.
constexpr int MaximumDegree = 9;

/// The non-vanishing B-splines of a span and their first two derivatives at one parameter.
struct BasisValues
{
  int First = 0; ///< index of the first non-vanishing B-spline; Degree + 1 follow
  std::array<double, MaximumDegree + 1> Value{};
  std::array<double, MaximumDegree + 1> Derivative{};  ///< first derivatives
  std::array<double, MaximumDegree + 1> Derivative2{}; ///< second derivatives
};

/**
 * Evaluates the B-splines of `degree` on `count + degree + 1` knots at t, clamped to the domain
 * [knots[degree], knots[count]] (The NURBS Book, A2.1 to A2.3). At the right end the last
 * non-empty span is used; at an inner knot the span to its right.
 */
BasisValues evaluateBasis(const double* knots, int degree, int count, double t);

/// Knots of m equal segments with inner knots of multiplicity `inner`, ends of degree + 1, on [0,
/// 1].
std::vector<double> segmentKnots(int degree, int segments, int inner);
} // namespace bsr
