#pragma once

#include "Common/Types.h"

namespace bsr
{
/// A point of a surface with its partial derivatives in the patch's parameters.
struct SurfacePoint
{
  Vec3 Point = Vec3::Zero();
  Vec3 Du = Vec3::Zero();
  Vec3 Dv = Vec3::Zero();
  Vec3 Duu = Vec3::Zero();
  Vec3 Duv = Vec3::Zero();
  Vec3 Dvv = Vec3::Zero();

  /// Du x Dv, not normalized; zero where the patch is singular.
  Vec3 normal() const { return this->Du.cross(this->Dv); }
};

/// Columns: the homogeneous point (w x, w y, w z, w), its derivatives by u, v, uu, uv and vv.
using HomogeneousPoint = Eigen::Matrix<double, 4, 6>;

/// The quotient rule: from homogeneous coordinates to space.
inline SurfacePoint projected(const HomogeneousPoint& h)
{
  const auto w = h.row(3);
  SurfacePoint s;
  s.Point = h.col(0).head<3>() / w[0];
  s.Du = (h.col(1).head<3>() - w[1] * s.Point) / w[0];
  s.Dv = (h.col(2).head<3>() - w[2] * s.Point) / w[0];
  s.Duu = (h.col(3).head<3>() - 2 * w[1] * s.Du - w[3] * s.Point) / w[0];
  s.Duv = (h.col(4).head<3>() - w[1] * s.Dv - w[2] * s.Du - w[4] * s.Point) / w[0];
  s.Dvv = (h.col(5).head<3>() - 2 * w[2] * s.Dv - w[5] * s.Point) / w[0];
  return s;
}
} // namespace bsr
