#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"

#include <cstdint>

namespace bsr
{
/**
 * A field whose zero level is the surface of a gray-value object: negative in the object's voxels,
 * positive elsewhere, the linear interpolation of neighbors crossing zero where the gray value
 * crosses `iso`. It covers the object's mask (Extent in voxels of the image) widened by one voxel;
 * beyond the image the gray values are mirrored, so that the surface closes half a voxel outside
 * the last voxel.
 */
template <class T>
Volume<float> objectField(
  const ImageView<const T>& image, double iso, const Volume<std::uint8_t>& object);

/**
 * Signed distance to the surface of a closed object, in voxels (multiples of the smallest spacing),
 * negative inside, on `extent` (indices of the image, which may go beyond it).
 *
 * `field` has its zero level on the surface of the object before closing (objectField). The closing
 * is that of closeByBall with real-valued distances: D = the points within `radius` of the object;
 * S = radius - (distance to the border of D) inside D, radius + distance outside. In the closed
 * object -S is exactly the depth below its surface; outside S never exceeds the distance to it
 * within D and is the distance to the object beyond. Both distances are taken to sub-voxel points,
 * so that the zero level is smooth where the ball closed it and follows the gray values elsewhere.
 * A radius below 1 closes nothing: S is then the signed distance to the object itself.
 */
Result<Volume<float>> closedDistance(
  Volume<float> field, double radius, const Box& extent, Monitor& monitor);

/**
 * Makes a signed distance agree with the closed voxels in its components: parts of its inside that
 * hold no closed voxel (stray bubbles) become outside, and pockets of its outside without any voxel
 * that is not closed become inside. Returns the number of parts changed. Both cover the same
 * extent.
 */
Result<std::int64_t> removeStrayParts(
  Volume<float>& distance, const Volume<std::uint8_t>& closed, Monitor& monitor);
} // namespace bsr
