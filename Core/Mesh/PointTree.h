#pragma once

#include "Common/Types.h"

#include <nanoflann.hpp>

namespace bsr
{
/// Nearest-point search over a set of points (a k-d tree of nanoflann).
class PointTree
{
public:
  explicit PointTree(std::vector<Vec3> points)
      : Cloud{std::move(points)}, Tree(3, Cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16))
  {
  }
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  const std::vector<Vec3>& points() const { return this->Cloud.Points; }

  /// Index of the nearest point, its squared distance; the tree must not be empty.
  std::pair<Index, double> nearest(const Vec3& p) const
  {
    std::uint32_t index = 0;
    double distance2 = 0.0;
    this->Tree.knnSearch(p.data(), 1, &index, &distance2);
    return {static_cast<Index>(index), distance2};
  }

  /// The nearest point other than point i itself; there must be two.
  Index nearestOther(Index i) const
  {
    std::uint32_t index[2] = {0, 0};
    double distance2[2] = {0.0, 0.0};
    this->Tree.knnSearch(this->Cloud.Points[i].data(), 2, index, distance2);
    return static_cast<Index>(static_cast<Index>(index[0]) == i ? index[1] : index[0]);
  }

  /// The `count` nearest points (or all there are), nearest first, with their squared distances.
  std::size_t nearest(
    const Vec3& p, std::size_t count, std::uint32_t* indices, double* distances2) const
  {
    return this->Tree.knnSearch(p.data(), count, indices, distances2);
  }

private:
  struct Points3
  {
    std::vector<Vec3> Points;
    std::size_t kdtree_get_point_count() const { return this->Points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t d) const
    {
      return this->Points[i][static_cast<Eigen::Index>(d)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const
    {
      return false;
    }
  };
  using Search =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points3>, Points3, 3>;

  Points3 Cloud;
  Search Tree;
};
} // namespace bsr
