#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Common/Types.h"
#include "Image/ImageView.h"

namespace bsr
{
/// Gaussian filter with a standard deviation of `sigma` voxels (smallest spacing); the border is
/// repeated. In place.
Status gaussian(Volume<float>& image, double sigma, Monitor& monitor);

/**
 * Signed distance in voxels, positive inside `object`, of points (voxel indices of the volume, from
 * Extent.Lo) to the smooth wall of a rough object: the level where half of a Gaussian neighborhood
 * is object. Narrow pits and bumps count with their share of the area, not with their depth. Only
 * voxels nonzero in `known` count (all, when `known` is null): what lies elsewhere does not bend
 * the wall. Where the wall is curved the level lies off the object's border; that is measured on
 * the smooth object itself and taken off. Good to about 2.5 sigma, larger distances are clamped.
 */
Result<std::vector<float>> smoothWallDistance(const Volume<std::uint8_t>& object,
  const Volume<std::uint8_t>* known, const std::vector<Vec3>& points, double sigma,
  Monitor& monitor);

/// Trilinear interpolation at voxel indices (from the volume's first voxel), clamped to the volume.
double interpolate(const ImageView<const float>& image, const Vec3& at);
} // namespace bsr
