#pragma once

#include "Common/Monitor.h"
#include "Common/Types.h"

#include <limits>

namespace bsr
{
/// The nearest point of a triangle soup.
struct NearestOnTriangle
{
  Index Triangle = -1;
  Vec3 Point = Vec3::Zero();
  double SquaredDistance = std::numeric_limits<double>::infinity();
};

/// The point of triangle (a, b, c), degenerate or not, nearest to p.
Vec3 nearestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/**
 * A bounding-volume tree for exact nearest-point queries on triangles (or on segments, given as
 * triangles that name a corner twice). Read-only once built: queries may run in parallel.
 */
class TriangleTree
{
public:
  TriangleTree() = default;
  TriangleTree(std::vector<Vec3> points, std::vector<std::array<Index, 3>> triangles);
  /// Once cancelled, what is left of the tree is not halved further: queries stay right, but slow.
  TriangleTree(
    std::vector<Vec3> points, std::vector<std::array<Index, 3>> triangles, Monitor& monitor);

  bool empty() const { return this->Triangles.empty(); }
  NearestOnTriangle nearest(const Vec3& p) const;
  /// The same among triangles whose normal makes less than 90 degrees with `direction`, so that
  /// the other side of a thin wall is not taken; where there is none within `most`, among all.
  /// \param hint a triangle that is likely to be near, or -1; it saves time, and of triangles that
  /// are equally near it may be the one that is taken.
  NearestOnTriangle nearestFacing(
    const Vec3& p, const Vec3& direction, double most, Index hint = -1) const;
  /// Unit normal of a triangle (zero for degenerate ones).
  Vec3 normal(Index triangle) const;

private:
  struct Node
  {
    Eigen::Vector3d Low;
    Eigen::Vector3d High;
    Eigen::Vector3d LowCross =
      Eigen::Vector3d::Zero(); ///< bounds of the cross products of the edges of triangles
    Eigen::Vector3d HighCross = Eigen::Vector3d::Zero();
    Index First = 0; ///< first triangle of a leaf, or the second child
    Index Count = 0; ///< triangles of a leaf, 0 for inner nodes (first child: the next node)
  };

  template <class MayHold, class Allowed>
  void search(
    const Vec3& p, NearestOnTriangle& best, const MayHold& mayHold, const Allowed& allowed) const;
  /// Improves `best` by a triangle.
  void visit(const Vec3& p, Index triangle, NearestOnTriangle& best) const;
  void boundCrosses(Node& node) const;
  Index build(std::vector<Index>& order, const std::vector<Vec3>& centers, Index first, Index last,
    Monitor& monitor);
  void grow(Node& node, Index triangle) const;

  std::vector<Vec3> Points;
  std::vector<std::array<Index, 3>> Triangles;
  std::vector<Vec3> Cross;    ///< of two edges of each triangle
  std::vector<double> Square; ///< of that; 0 for slivers
  std::vector<Index> Order;
  std::vector<Node> Nodes;
};
} // namespace bsr
