#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"

#include <cstdint>

namespace bsr
{
/**
 * Morphological closing of the nonzero voxels of a mask by the ball {d <= radius}, radius in voxels
 * (multiples of the smallest spacing, any real number >= 0), d between voxel centers with the
 * image's spacing. Equals dilation and then erosion by that ball on an unbounded grid, voxel by
 * voxel: nothing is clipped at the border of the image. Time does not depend on the radius but for
 * the halo: one exact distance transform of the object's bounding box widened by the radius, one
 * back.
 *
 * The closed object never leaves the bounding box of the object (closing by a symmetric ball keeps
 * within half spaces), so the result covers just that box: Extent of the volume. Its values are 0
 * and 1. Distances are compared with a relative tolerance of 1e-6 (radius sqrt(2) reaches the
 * diagonal neighbor). Memory: 6 bytes a voxel of the widened box.
 */
Result<Volume<std::uint8_t>> closeByBall(
  const ImageView<const std::uint8_t>& mask, double radius, Monitor& monitor);

/// The comparison value for squared distances in voxels: d^2 <= squaredLimit(r) means d <= r.
inline float squaredLimit(double radius)
{
  return static_cast<float>(radius * radius * (1.0 + 1e-6));
}
} // namespace bsr
