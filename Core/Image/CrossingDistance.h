#pragma once

#include "Image/DistanceTransform.h"

namespace bsr
{
/**
 * Distance of voxel centers to the zero level of a sampled field, finer than a voxel: to the
 * nearest of the points where the field, interpolated linearly along the grid lines of all three
 * axes, changes sign (negative against not negative). This is the sub-pixel distance transform of
 * Mosbach et al., section 3, exact for those points: three separable transforms, one for the
 * crossings along each axis, of which the smallest counts.
 *
 * The points lie within about half a voxel of one another on a smooth level, so that at a distance
 * d from it the result is too large by at most about 0.2 / d voxels; closer than a voxel use the
 * field itself.
 *
 * Options as in squaredDistance (ToZeros has no meaning here); the field must be finite. Without
 * any crossing all distances are infinite. Memory: the result, with as many slices as the
 * field has at least, and an eighth of the larger of both. The result is in voxels of the field
 * (its smallest spacing), not squared, without a sign.
 */
Result<Volume<float>> crossingDistance(
  const ImageView<const float>& field, const DistanceOptions& options, Monitor& monitor);
} // namespace bsr
