#pragma once

#include "Mesh/TriangleSurface.h"
#include "Mesh/TriangleTree.h"

namespace bsr
{
/**
 * How large quads may be where: everywhere alike, but smaller where the surface is bent over the
 * length of a quad, so that thin parts keep about five quads around and do not shrink.
 * Bending is averaged over about a quad, so that single sharp edges do not count.
 */
class Sizing
{
public:
  Sizing() = default;
  /// \param s a surface of triangles of even size, about a fifth of `cell`.
  Sizing(const TriangleSurface& s, double cell);

  /// Largest side of a quad at p.
  double limit(const Vec3& p) const;
  /// Side of quads at p where quads in flat places have side `cell`.
  double side(const Vec3& p, double cell) const;
  /// The side in flat places that gives about so many quads.
  double cellFor(double quads) const;

private:
  static double bounded(double limit, double cell);

  TriangleTree Tree;
  std::vector<double> Limit; ///< per triangle
  std::vector<double> Area;  ///< per triangle
};
} // namespace bsr
