#pragma once

#include "Common/Types.h"
#include "Image/ImageView.h"

namespace bsr
{
/**
 * Where the voxels of an image lie in the world: voxel (i, j, k), counted as in an ImageView, is at
 * Origin + Direction * (i sx, j sy, k sz).
 */
struct ImageFrame
{
  Vec3 Origin = Vec3::Zero(); ///< world position of the view's first voxel
  Eigen::Matrix3d Direction = Eigen::Matrix3d::Identity();
};

/**
 * The value of a volume at a point of the world, interpolated linearly along the three axes; used
 * on SignedDistance it is the distance of any point to the closed surface in voxels, negative
 * inside. Points outside of the volume get the value of the nearest point of its border.
 * `gradient`, where given, receives the gradient of the interpolant in world units.
 */
double sampleVolume(const ImageView<const float>& volume, const ImageFrame& frame,
  const Vec3& point, Vec3* gradient = nullptr);
} // namespace bsr
