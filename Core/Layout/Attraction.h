#pragma once

#include "Common/Monitor.h"
#include "Mesh/Meshes.h"
#include "Mesh/Remesh.h"

namespace bsr
{
/**
 * Where samples of a surface draw the points of a layout: each sample draws the nearest place of
 * the quads that face it, its way there is shared out to the corners by their bilinear weights, and
 * a point takes the mean of what it is given, in which far samples weigh more. A layout that has
 * slipped off the tip of a limb is drawn back over it; one that lies on the surface is not moved.
 * \param quads the quad of each sample, or -1: hints that save time, and those found
 * Incomplete once cancelled.
 */
std::vector<Vec3> attraction(const QuadMesh& mesh, const std::vector<SurfaceSample>& samples,
  std::vector<Index>& quads, Monitor& monitor);

/// Weight of a sample that is so far off, relative to the side of a quad.
double attractionWeight(double relativeDistance);
} // namespace bsr
