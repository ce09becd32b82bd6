#pragma once

#include "Common/Types.h"

namespace bsr
{
/// Twice the signed area of the triangle that two vectors of the plane span.
inline double planeCross(const Vec2& a, const Vec2& b)
{
  return a[0] * b[1] - a[1] * b[0];
}
} // namespace bsr
