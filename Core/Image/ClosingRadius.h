#pragma once

#include "Image/BallClosing.h"
#include "Image/DigitalTopology.h"

#include <vector>

namespace bsr
{
/// Volume of the closing as a function of the radius of the ball.
struct ClosingCurve
{
  std::vector<double> Radius; ///< voxels, increasing
  std::vector<double> Volume; ///< relative to the object's
};

/**
 * Samples the curve at radii in a geometric progression up to half the object's smallest width (the
 * mask covers just the object). One distance transform of the object serves all dilations, at every
 * n-th voxel where the object is large; the erosions work on those samples with real-valued
 * distances, the coarser the larger the ball.
 */
Result<ClosingCurve> closingCurve(const Volume<std::uint8_t>& object, Monitor& monitor);

/// What closingRadius found.
struct RadiusChoice
{
  double Radius = 0.0;
  bool Plateau = false; ///< the volume has a rise with a plateau behind it: a lumen was filled
  double Rise = 0.0;    ///< steepest d ln(volume) / d ln(radius)
  BettiNumbers Betti;   ///< of the object closed with Radius
  ClosingCurve Curve;
  Volume<std::uint8_t> Closed; ///< the object closed with Radius (closeByBall)
};

/**
 * The radius at which the lumen of a hollow object is just filled.
 *
 * The closing's volume rises steeply while the ball grows to the width of the lumen, and creeps
 * from then on. The radius is where the last steep part of the rise ends, plus a margin of 8 %; it
 * is enlarged by up to a third while the closed object is not yet a ball (1, 0, 0). Topology alone
 * would stop too early, at a lumen that is merely blocked in its middle. Every voxel more would
 * fill outer concavities, but also flatten the cap over an open end, which bows inward by R -
 * sqrt(R^2 - r^2) for a lumen of radius r: at the margin chosen here by about 0.7 r where the lumen
 * is widest. What needs the fiber's true end must find its rim.
 *
 * An object without such a rise (solid, branching, a network) gets the smallest radius that makes
 * it a ball without doubling its volume, or else the one that leaves the fewest tunnels and
 * cavities.
 */
Result<RadiusChoice> closingRadius(const Volume<std::uint8_t>& object, Monitor& monitor);
} // namespace bsr
