#pragma once

#include "Common/Types.h"

namespace bsr
{
/// Which surface of a hollow body a patch belongs to.
enum class Shell : std::uint8_t
{
  Outer = 0,
  Inner = 1,
  Wall = 2
};

/// One tensor-product patch; its control points and knots are ranges of the model's arrays.
struct SplinePatch
{
  Shell Side = Shell::Outer;
  int DegreeU = 3;
  int DegreeV = 3;
  int CountU = 0;                     ///< control points along u
  int CountV = 0;                     ///< control points along v
  std::int64_t FirstControlPoint = 0; ///< u runs fastest
  std::int64_t FirstKnotU = 0;        ///< CountU + DegreeU + 1 knots, full multiplicity at the ends
  std::int64_t FirstKnotV = 0;
};

/**
 * A network of (rational) B-spline patches: the one model that every pipeline ends in.
 * Neighbors[p][s] for the sides v=0, u=1, v=1, u=0 of patch p is 4 * patch + side, or -1.
 * Matching sides have bit-identical control points.
 */
struct SplineModel
{
  std::vector<SplinePatch> Patches;
  std::vector<Vec4> ControlPoints; ///< x, y, z, w: Cartesian point and weight
  std::vector<double> Knots;
  std::vector<std::array<std::int64_t, 4>> Neighbors;
};
} // namespace bsr
