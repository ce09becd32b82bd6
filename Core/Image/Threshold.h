#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"

#include <cstdint>

namespace bsr
{
/// Smallest and largest value, and whether any value is NaN or infinite (those are not counted).
struct ValueRange
{
  double Min = 0.0;
  double Max = 0.0;
  std::int64_t NotFinite = 0;
};

template <class T>
ValueRange valueRange(const ImageView<const T>& image);

/**
 * Otsu's threshold: the value between two classes that maximizes the variance between them, from a
 * histogram of every integer value (up to 65536 of them) or of 4096 bins. An object is what lies at
 * or above it. Fails on an empty, a constant and a not finite image.
 */
template <class T>
Result<double> otsuThreshold(const ImageView<const T>& image, Monitor& monitor);

/**
 * The gray value of the surface between two materials, from a first threshold: halfway between the
 * gray values of the two phases, iterated. The surface of a blurred edge lies halfway, whereas
 * Otsu's threshold is pulled down by the many voxels that thin walls share with air.
 *
 * The gray value of a phase is the median of its voxels at least 3 voxels away from the other: blur
 * does not reach there, and small cavities or noise do not move a median. Where less than 2 % of a
 * phase lie so deep (thin walls) 2.5, 2, 1.5 and 1.2 are tried. Returns the start value where a
 * phase has no such voxels.
 */
template <class T>
Result<double> halfwayThreshold(const ImageView<const T>& image, double start, Monitor& monitor);

/// Mask of the voxels with value >= threshold.
template <class T>
Result<Volume<std::uint8_t>> thresholdMask(
  const ImageView<const T>& image, double threshold, Monitor& monitor);
} // namespace bsr
