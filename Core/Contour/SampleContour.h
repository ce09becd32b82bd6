#pragma once

#include "Common/Types.h"

namespace bsr
{
/// A curve by arc length. A closed curve does not repeat its first point; its parameter wraps.
class ArcCurve
{
public:
  ArcCurve(const std::vector<Vec3>& points, bool closed);

  double length() const { return this->Arc.back(); }
  /// The point at share t of the length: 0 to 1, wrapped where closed, else clamped.
  Vec3 at(double t) const;
  /// The share of the length at which the curve is nearest to p.
  double nearest(const Vec3& p) const;
  bool closed() const { return this->IsClosed; }

private:
  std::vector<Vec3> Points; ///< a closed curve's first point repeated
  std::vector<double> Arc;  ///< length up to each point
  bool IsClosed;
};

/// n points at equal arc length from share `start`: of a closed curve n different ones, of an open
/// one from end to end.
std::vector<Vec3> sampleCurve(const ArcCurve& curve, int n, double start = 0.0);

/**
 * Contour alignment over all points (paper 004, 2.4, aligns one): the share `start` at which
 * samples of `curve` at equal arc length are closest to those of `previous` (from share
 * `previousStart`) in the sum of squares, after a shift of the one onto the other. Both closed and
 * of equal sense.
 */
double alignedStart(const ArcCurve& previous, double previousStart, const ArcCurve& curve);
} // namespace bsr
