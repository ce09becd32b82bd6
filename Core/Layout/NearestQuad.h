#pragma once

#include "Common/BoxTree.h"
#include "Mesh/Meshes.h"

namespace bsr
{
/// The point of a quad mesh nearest to a query.
struct QuadHit
{
  Index Quad = -1;
  Vec2 UV = Vec2::Zero(); ///< bilinear parameters in [0, 1]: u along corners 0-1, v along 0-3
  double SquaredDistance = std::numeric_limits<double>::infinity();
};

/**
 * Finds nearest points on a quad mesh whose faces are bilinear patches (not triangles): a
 * bounding-volume tree, an oriented box a quad, and Newton's method on the patch with the exact
 * solution on its sides. Ties go to the quad of lowest index, so that an answer depends neither on
 * the order of the queries nor on the hint. Queries are const and may run in parallel.
 */
class NearestQuad
{
public:
  /// \pre the points are finite and the corners are valid indices; degenerate quads are allowed.
  explicit NearestQuad(const QuadMesh& mesh);

  /// \param hint a quad that is likely to be near; it only saves time.
  QuadHit find(const Vec3& p, Index hint = -1) const;

  /// The same among quads whose normal makes less than 90 degrees with `direction`; Quad is -1
  /// where there is none.
  QuadHit findFacing(const Vec3& p, const Vec3& direction, Index hint = -1) const;

  std::int64_t size() const { return static_cast<std::int64_t>(this->Patches.size()); }

private:
  /// P(s, t) = C + s A + t B + s t D on [-1, 1]^2, in an oriented box.
  struct Patch
  {
    Vec3 C, A, B, D;
    Eigen::Matrix3d Axes; ///< rows: along A, across it, normal
    Vec3 Low, High;       ///< the box along the axes, relative to C
    double AA, BB, AB;    ///< dot products of A and B
    double Inverse;       ///< of AA BB - AB AB; 0 for a degenerate patch
    double Convex;        ///< one stationary point where |(p - C) . D| is below
  };
  static double boxDistance(const Patch& patch, const Vec3& p);
  static QuadHit project(const Patch& patch, const Vec3& p);
  template <class Allowed>
  QuadHit search(const Vec3& p, Index hint, const Allowed& allowed) const;

  std::vector<Patch> Patches;
  BoxTree Tree;
};
} // namespace bsr
