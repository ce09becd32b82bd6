#pragma once

#include "Common/Types.h"

namespace bsr
{
/// Geometry of polygonal curves in a plane. A closed curve does not repeat its first point.
using Curve2 = std::vector<Vec2>;

/// Signed area, positive where the closed curve runs counterclockwise.
double signedArea(const Curve2& curve);
/// Centroid of the area of a closed curve (of its points where the area vanishes).
Vec2 areaCentroid(const Curve2& curve);
double curveLength(const Curve2& curve, bool closed);
/// Whether a point lies inside a closed curve (even-odd rule).
bool insideCurve(const Curve2& curve, const Vec2& p);
/// Distance of a point from a curve.
double curveDistance(const Curve2& curve, bool closed, const Vec2& p);

/// A proper crossing of two segments: the curves and the segments within them; none: Curve[0] < 0.
struct CurveCrossing
{
  std::array<Index, 2> Curve{-1, -1};
  std::array<Index, 2> Segment{-1, -1};
};
/// The first proper crossing among the segments of some curves (a sweep over x).
CurveCrossing findCrossing(
  const std::vector<const Curve2*>& curves, const std::vector<char>& closed);

/// Area common to two closed curves over the smaller one's, 0 to 1 (by 96 scan lines).
double overlapShare(const Curve2& a, const Curve2& b);
} // namespace bsr
