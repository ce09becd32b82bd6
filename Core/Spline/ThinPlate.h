#pragma once

#include "Spline/QuadComplex.h"

#include <Eigen/Core>

namespace bsr
{
/**
 * Exact Gram matrices of a bicubic patch with m segments a side on the unit square (n * n control
 * points, number j * n + i), by Gauss quadrature segment by segment:
 * thin plate = Uu + 2 Uv + Vv (paper 000, section 4.2), and the mass matrix of the values.
 */
struct PatchEnergies
{
  Eigen::MatrixXd Uu;   ///< integral of N_uu^T N_uu
  Eigen::MatrixXd Uv;   ///< integral of N_uv^T N_uv
  Eigen::MatrixXd Vv;   ///< integral of N_vv^T N_vv
  Eigen::MatrixXd Mass; ///< integral of N^T N

  Eigen::MatrixXd thinPlate() const { return this->Uu + 2.0 * this->Uv + this->Vv; }
  /**
   * The thin plate of a patch whose sides measure a (along u) and b (along v) times the unit
   * length, integrated over its own area: b/a^3 Uu + 2/(a b) Uv + a/b^3 Vv; equals thinPlate() at a
   * = b = 1.
   */
  Eigen::MatrixXd thinPlate(double a, double b) const
  {
    return b / (a * a * a) * this->Uu + 2.0 / (a * b) * this->Uv + a / (b * b * b) * this->Vv;
  }
};

PatchEnergies patchEnergies(int segments);
/// The same with different numbers of segments along u and v.
PatchEnergies patchEnergies(int segmentsU, int segmentsV);

/// Side lengths of the patches along u and v in units of the mean patch size, limited to 1/3 .. 3.
std::vector<std::array<double, 2>> patchAspects(
  const QuadComplex& complex, const std::vector<Vec3>& vertices);
} // namespace bsr
