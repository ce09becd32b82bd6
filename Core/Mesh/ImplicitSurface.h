#pragma once

#include "Common/Status.h"
#include "Common/Types.h"

namespace bsr
{
/**
 * A function of space whose zero set passes through given points with given normals (Carr et al.
 * 2001, "Reconstruction and representation of 3D objects with radial basis functions"): biharmonic
 * splines |x - c| around the points and around points moved off the surface along the normals,
 * plus a quadratic polynomial. Close to the surface it is about the signed distance, positive
 * outside. Of all functions that interpolate the data it is the one of least third-order energy,
 * which is why it closes gaps smoothly.
 */
class ImplicitSurface
{
public:
  /**
   * Fits; the dense system takes O((points + 2 normals)^3).
   * \param points  on the surface; \pre finite, none twice
   * \param normals unit outward, one a point; zero: no off-surface points there
   * \param offset  distance of the off-surface points, world units
   */
  static Result<ImplicitSurface> fit(
    const std::vector<Vec3>& points, const std::vector<Vec3>& normals, double offset);

  struct Value
  {
    double F = 0.0;
    Vec3 Gradient = Vec3::Zero();
  };
  /// World units; read-only, may run in parallel.
  Value at(const Vec3& p) const;

private:
  Vec3 Center = Vec3::Zero();
  double Scale = 1.0;
  Eigen::Matrix<double, 3, Eigen::Dynamic> Centers; ///< scaled
  Eigen::VectorXd Coefficients;                     ///< one a center, then 10 of the polynomial
};
} // namespace bsr
