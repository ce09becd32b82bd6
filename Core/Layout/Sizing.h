#pragma once

#include "Mesh/Remesh.h"
#include "Mesh/TriangleSurface.h"
#include "Mesh/TriangleTree.h"

#include <functional>

namespace bsr
{
/// What decides how large quads are where.
enum class QuadSizing
{
  Uniform = 0,   ///< alike everywhere
  Curvature = 1, ///< side by the root of the radius of curvature, 0.4 to 2 times the mean
  Array = 2      ///< side in proportion to a value given at each point
};

/**
 * How large quads may be where. Whatever the kind, they are smaller where the surface is bent over
 * the length of a quad, so that thin parts keep about five quads around and do not shrink.
 * Bending is averaged over about a quad, so that single sharp edges do not count.
 */
class Sizing
{
public:
  using Field = std::function<double(const Vec3&)>;

  Sizing() = default;

  /// Measures a surface for about so many quads.
  /// \param field relative side at a place, above 0; used for QuadSizing::Array only
  static Result<Sizing> measured(TriangleSurface s, const ReferenceSurface& reference, int quads,
    QuadSizing kind, const Field& field, Monitor& monitor);

  /// Side of quads at p where quads in flat places have side `cell`.
  double side(const Vec3& p, double cell) const;
  /// The side in flat places that gives about so many quads.
  double cellFor(double quads) const;

private:
  /// \param s a surface of triangles of even size, about a fifth of `cell`. Incomplete once
  /// cancelled.
  Sizing(
    const TriangleSurface& s, double cell, QuadSizing kind, const Field& field, Monitor& monitor);
  double sideIn(Index triangle, double cell) const;
  void setFactors(
    const TriangleSurface& s, const std::vector<double>& bent, QuadSizing kind, const Field& field);

  TriangleTree Tree;
  double Cell = 1.0;
  std::vector<double> Limit;  ///< largest side, per triangle
  std::vector<double> Factor; ///< side relative to flat places, per triangle
  std::vector<double> Area;   ///< per triangle
};
} // namespace bsr
