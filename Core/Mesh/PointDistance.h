#pragma once

#include "Mesh/OrientedPoints.h"

#include <memory>

namespace bsr
{
class PointTree;

/**
 * Signed distance to a surface that is known by points with normals, positive outside: the mean of
 * the distances to the tangent planes of the nearest points, with weights that fall off with the
 * points' own spacing. Fine places keep their detail and coarse ones do not tear, which one
 * radius for all points cannot give.
 */
class PointDistance
{
public:
  explicit PointDistance(const OrientedPoints& points);
  ~PointDistance();
  PointDistance(PointDistance&&) noexcept;
  PointDistance& operator=(PointDistance&&) noexcept;

  /// Read-only, may run in parallel.
  double at(const Vec3& p) const;
  /// Least of the distances to near points, each in units of the point's own spacing: beside dense
  /// points, too, coarse ones reach as far as they do elsewhere.
  double remoteness(const Vec3& p) const;
  /**
   * How far a place of the surface lies outside what the points cover: how much the points around
   * it (of the nearest point's spacing, on its side of the wall) lie to one side of it. About 0
   * among them, 1 half a sample beyond a straight rim, and growing.
   */
  double overhang(const Vec3& p) const;

private:
  const OrientedPoints* Surface;
  std::unique_ptr<PointTree> Tree;
};

/// Values on a grid, x fastest.
struct DistanceGrid
{
  Vec3 Origin = Vec3::Zero();
  double Voxel = 0.0; ///< side of a voxel, world units
  std::array<int, 3> Size = {0, 0, 0};
  std::vector<float> Values; ///< far from the points: Unknown
  float Unknown = 0.0F;      ///< above every known distance
};

/**
 * Samples the distance around the points, up to `band` spacings away.
 * \param voxel side of a voxel, world units
 * Fails with InvalidParameter where the grid would have more than 4e8 voxels.
 */
Result<DistanceGrid> sampleDistance(const OrientedPoints& points, const PointDistance& distance,
  double voxel, double band, Monitor& monitor);
} // namespace bsr
