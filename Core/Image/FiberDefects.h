#pragma once

#include "Common/Types.h"

#include <vector>

namespace bsr
{
class FiberShape;
struct FiberPhantomOptions;

/**
 * A piece of air or of material with a simple shape: an ellipsoid, or a rod (a straight piece of
 * constant thickness with round or flat ends; with no length a ball).
 */
struct FiberDefect
{
  enum class Shape
  {
    Rod,
    FlatRod,
    Ellipsoid
  };
  Shape Kind = Shape::Rod;
  bool Solid = false;                   ///< adds material of gray value `Value`, else removes it
  double Value = 1.0;                   ///< 0 air .. 1 wall; debris may be denser
  Vec3 Begin{0, 0, 0}, Finish{0, 0, 0}; ///< ends of the rod; Begin is an ellipsoid's center
  double Radius = 1.0;                  ///< of the rod
  Eigen::Matrix3d Axes = Eigen::Matrix3d::Identity(); ///< columns: unit axes of the ellipsoid
  Vec3 HalfAxes{1, 1, 1};                             ///< of the ellipsoid

  /// Signed distance, negative inside; of ellipsoids to first order.
  double distance(const Vec3& p) const;
  /// No point of the shape is farther than this from its `middle`.
  double reach() const;
  Vec3 middle() const;
};

/// Draws the holes, slits, pits, tunnels, cavities and debris of a fiber; what removes comes first.
std::vector<FiberDefect> makeFiberDefects(
  const FiberPhantomOptions& options, const FiberShape& shape);
} // namespace bsr
