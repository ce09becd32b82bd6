#pragma once

#include "Spline/SplineModel.h"
#include "Spline/Topology.h"

namespace bsr
{
/**
 * The polynomial (rational) pieces of a patch as Bezier pieces. The control points lie on a grid
 * with u running fastest in which neighboring pieces share their side: piece (i, j) owns points
 * i DegreeU ... (i + 1) DegreeU by j DegreeV ... (j + 1) DegreeV.
 */
struct BezierPatch
{
  int DegreeU = 0;
  int DegreeV = 0;
  std::vector<double> EndsU; ///< parameters where pieces meet; one more than pieces
  std::vector<double> EndsV;
  std::vector<Vec4> Points; ///< Cartesian point and weight

  GridSize size() const
  {
    return {static_cast<std::int64_t>(this->EndsU.size() - 1) * this->DegreeU + 1,
      static_cast<std::int64_t>(this->EndsV.size() - 1) * this->DegreeV + 1};
  }
};

/**
 * Extracts the pieces of a patch by knot insertion (Boehm); exact up to rounding. Each polynomial
 * piece is cut into `split` equal parts along u and v.
 */
BezierPatch bezierPieces(const SplineModel& model, const SplinePatch& patch, int split = 1);
} // namespace bsr
