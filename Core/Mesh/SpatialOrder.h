#pragma once

#include "Common/Monitor.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
/**
 * Renumbers a compact surface so that vertices follow a space-filling (Morton) curve over a grid
 * of cubes, virtual ones last, and triangles follow their vertices: neighbors in space
 * become neighbors in memory. `shift` (0..1) moves the grid by that share of its size. Returns the
 * old index of each new vertex, or nothing if cancelled: the surface is as it was then.
 */
std::vector<Index> sortAlongCurve(TriangleSurface& s, double shift, Monitor& monitor);
} // namespace bsr
