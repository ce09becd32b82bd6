#pragma once

#include "Mesh/TriangleSurface.h"

namespace bsr
{
/**
 * Renumbers a compact surface so that vertices follow a space-filling (Morton) curve over a grid
 * of cubes, virtual ones last, and triangles follow their vertices: neighbors in space
 * become neighbors in memory. `shift` (0..1) moves the grid by that share of its size. Returns the
 * old index of each new vertex.
 */
std::vector<Index> sortAlongCurve(TriangleSurface& s, double shift);
} // namespace bsr
