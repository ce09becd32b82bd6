#pragma once

#include "Spline/Basis.h"
#include "Spline/SurfacePoint.h"

#include "Common/Types.h"

namespace bsr
{
/**
 * A rational bicubic patch on its own: SegmentsU and SegmentsV segments along u and v on [0, 1]
 * with double inner knots, 2 m + 2 control points a direction, u fastest.
 */
struct RationalPatch
{
  int SegmentsU = 3;
  int SegmentsV = 3;
  std::vector<double> KnotsU;
  std::vector<double> KnotsV;
  std::vector<Vec4> ControlPoints; ///< x, y, z, w: Cartesian point, weight

  RationalPatch() = default;
  RationalPatch(int segmentsU, int segmentsV);

  bool empty() const { return this->ControlPoints.empty(); }
  int countU() const { return 2 * this->SegmentsU + 2; }
  int countV() const { return 2 * this->SegmentsV + 2; }
  SurfacePoint at(double u, double v) const;
};

/// Control points along a side of a patch (k as of a half-edge, counter-clockwise: v=0, u=1, v=1,
/// u=0).
inline int sideCount(const RationalPatch& p, int k)
{
  return k % 2 == 0 ? p.countU() : p.countV();
}

/// Number of control point c along side k, counter-clockwise.
inline int sideIndex(const RationalPatch& p, int k, int c)
{
  const int n = p.countU();
  const int m = p.countV();
  switch (k)
  {
  case 0:
    return c;
  case 1:
    return c * n + n - 1;
  case 2:
    return (m - 1) * n + n - 1 - c;
  default:
    return (m - 1 - c) * n;
  }
}

/// The same surface with each segment cut into so many (knot insertion; the shape does not change).
RationalPatch refined(const RationalPatch& patch, int factorU, int factorV);
} // namespace bsr
