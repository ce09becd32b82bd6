#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"

#include <cstdint>
#include <limits>

namespace bsr
{
/// What distanceTransform measures, and where.
struct DistanceOptions
{
  /// Distance to the zeros of the mask instead of to its nonzero voxels.
  bool ToZeros = false;
  /// Only distances up to this many voxels matter: others come out as anything larger (much
  /// faster).
  double Bound = std::numeric_limits<double>::infinity();
  /// The voxels wanted, as indices of the mask; may be smaller than the mask or reach beyond it.
  /// Empty: the mask's own extent. Outside the mask there are no sites.
  Box Extent;
  /// Only every Step-th voxel of Extent along each axis (the cost falls with it).
  std::int64_t Step = 1;
};

/**
 * Exact squared Euclidean distance of every voxel's center to the nearest site (nonzero voxel) of a
 * mask, in voxels (multiples of the smallest spacing), anisotropic spacing included.
 *
 * Three passes of lower envelopes of parabolas (Meijster et al. 2000; Felzenszwalb & Huttenlocher
 * 2012): linear time, independent of the distances, the work cropped to the sites' bounding box
 * until a pass widens it to the extent wanted. Memory: the result (4 bytes a voxel wanted) and a
 * few lines a thread. With equal spacings squared distances are integers and exact while below
 * 2^24; otherwise each carries at most three roundings of single precision. Without any site all
 * are infinite. Bit-identical for any number of threads.
 *
 * The result has ceil(Extent / Step) samples along each axis; its Spacing is the mask's times Step
 * and Extent.Lo counts in voxels of the mask.
 */
Result<Volume<float>> squaredDistance(
  const ImageView<const std::uint8_t>& mask, const DistanceOptions& options, Monitor& monitor);

/// The bounding box of the voxels whose being nonzero equals `nonzero`; empty when there are none.
Box boundingBox(const ImageView<const std::uint8_t>& mask, bool nonzero = true);
} // namespace bsr
