#pragma once

#include "Mesh/Meshes.h"

namespace bsr
{
/**
 * The regularized network of a layout (Branch, Prieto and Boulanger, algorithm 1.2): to each side,
 * a polyline on a mesh, a cubic B-spline curve is fitted by least squares, with the ends kept, and
 * sampled at `samples` places of equal arc length; the samples are put back on the mesh. The ends
 * of a side are those of the polyline, bit for bit. Empty sides stay empty.
 * \param samples points a side, ends included; at least 2
 */
std::vector<std::vector<Vec3>> regularizeSides(
  const std::vector<std::vector<Vec3>>& sides, int samples, const TriangleMesh& mesh);
} // namespace bsr
