#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Common/Types.h"

namespace bsr
{
/// Points of a surface, with what their neighbors say about it.
struct OrientedPoints
{
  std::vector<Vec3> Points;
  std::vector<Vec3> Normals;   ///< unit, outward as far as there is an outside
  std::vector<double> Spacing; ///< about 1.4 times the distance of samples, world units, above zero
};

/**
 * Normals of points without triangles.
 *
 * Each normal is the least principal axis of the `neighbors` nearest points; the spacing is the
 * median over them of the distance to the sixth neighbor. Normals are made to agree along a
 * minimum spanning tree of the graph of neighbors (Hoppe et al. 1992, "Surface reconstruction from
 * unorganized points", section 3.3), after the normal is mirrored at the plane halfway between
 * both points: they agree across sharp edges and on both sides of a thin wall, too. Each connected
 * part of the graph is turned so that the normals of its outermost points look outward.
 *
 * Points that repeat are left out. Fails with InvalidInput where fewer than 8 points are left or
 * one is not finite.
 */
Result<OrientedPoints> orientPoints(
  const std::vector<Vec3>& points, int neighbors, Monitor& monitor);
} // namespace bsr
