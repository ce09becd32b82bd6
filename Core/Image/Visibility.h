#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"

namespace bsr
{
/// What a voxel of the void sees of the outside, as shares in 0..255 of 255.
struct Visibility
{
  /// Share of all directions in which a ray leaves the image without meeting the object.
  Volume<std::uint8_t> Open;
  /// The same among the directions near a plane, for the plane where it is smallest: about 0 all
  /// along a tube, up to its very end, where Open is already a half.
  Volume<std::uint8_t> Ring;
};

/**
 * Casts 64 rays (spread evenly, in opposite pairs) from the voxels of `where`, stepping by the
 * distance to the object (`distance`: voxels of the smallest spacing, to voxel centers, on the same
 * extent). One voxel of each 2 x 2 x 2 cell, the deepest in the void, speaks for the cell; voxels
 * not asked for are 255.
 */
Result<Visibility> visibility(
  const Volume<float>& distance, const Volume<std::uint8_t>& where, Monitor& monitor);
} // namespace bsr
