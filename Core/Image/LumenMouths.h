#pragma once

#include "Image/Lumen.h"
#include "Image/MaskOperations.h"

namespace bsr
{
/// Voxels of the outside that touch the lumen: neither of them in `solid`.
Mask mouthFaces(const Mask& lumen, const Mask& solid);

/**
 * The open ends of a lumen among the parts of its border with the outside (`faces`: mouthFaces).
 *
 * A part is an end when it is at least 0.6 as wide as the lumen (`radius`, in voxels), at least
 * half as wide as the widest end, and the lumen lies behind it: the middle of the lumen near it
 * (within three of its radii) is at least 1.15 times as far away as the lumen spreads across the
 * line to there, which is within 60 degrees of the part's axis. That factor is 1.3 to 2 for the end
 * of a tube, straight or slanted, and 0.4 to 1.1 for a hole in its side, however large.
 */
Result<std::vector<LumenMouth>> findMouths(
  const Mask& lumen, const Mask& solid, const Mask& faces, double radius, Monitor& monitor);
} // namespace bsr
