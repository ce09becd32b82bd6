#pragma once

#include "Image/BallClosing.h"
#include "Image/ClosingRadius.h"
#include "Image/DigitalTopology.h"

#include <string>

namespace bsr
{
struct ClosingOptions
{
  bool AutoIsoValue = true; ///< halfwayThreshold of Otsu's threshold instead of IsoValue
  double IsoValue = 0.0;    ///< the object is what lies at or above it
  bool AutoRadius = true;   ///< closingRadius() instead of Radius
  double Radius = 5.0;      ///< of the ball, in voxels (multiples of the smallest spacing)
  bool LargestComponent = true;
};

struct ClosingResult
{
  /// Closed object, 0 and 1, on the image's extent, widened where the object comes within two
  /// voxels of its border (so that the surface of the closed object is closed).
  Volume<std::uint8_t> Closed;
  /// Signed distance to its surface in voxels (closedDistance), on the same extent.
  Volume<float> SignedDistance;
  double IsoValue = 0.0;
  double Radius = 0.0;
  std::int64_t Components = 0; ///< of the thresholded image, before the largest was taken
  BettiNumbers Before;         ///< of the object
  BettiNumbers After;          ///< of the closed object
  BettiNumbers Surface;        ///< of the inside of SignedDistance
  double VolumeRatio = 1.0;    ///< closed voxels / object voxels
  ClosingCurve Curve;          ///< what the automatic radius was chosen from; else empty
  bool Plateau = false;        ///< the automatic radius filled a lumen
  std::string Warning;         ///< what the user should know; empty when all is well
};

/**
 * The whole first stage of the fiber pipeline: threshold, largest component, closing by a ball,
 * signed distance. Betti numbers are for connectivity 26 of the object, 6 of the background.
 */
template <class T>
Result<ClosingResult> closing(
  const ImageView<const T>& image, const ClosingOptions& options, Monitor& monitor);
} // namespace bsr
