#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"
#include "Mesh/Meshes.h"

namespace bsr
{
/**
 * Voxels whose centers lie inside a triangle surface. Points are in voxel indices (x, y, z) of the
 * image, `extent` in the same indices.
 *
 * Every row of voxels is cut with the surface; between entering and leaving it the voxels are 1.
 * Which side is inside follows from the rows that the surface cuts completely, so that the
 * orientation may be either; a surface that is open at the border of its bounding box (an
 * isosurface cut by the border of the volume) is closed there. Fails on an empty surface.
 */
Result<Volume<std::uint8_t>> voxelizeSurface(
  const TriangleMesh& surface, const Box& extent, const Double3& spacing, Monitor& monitor);
} // namespace bsr
