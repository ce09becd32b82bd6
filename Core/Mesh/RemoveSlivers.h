#pragma once

#include "Mesh/TriangleSurface.h"

namespace bsr
{
/**
 * Removes triangles without area, on which neither angles nor maps to the plane are defined:
 * collapses edges shorter than `share` of the mean edge around them, flips the long edge of
 * triangles flatter than `share`. Isosurfaces of whole numbers have such triangles wherever a voxel
 * has the iso value itself. Vertices move by at most such an edge; those of boundaries and creases
 * stay on them. What would change the topology or turn a triangle over is left. `s` is compact
 * afterwards. Returns the number of edges collapsed or flipped.
 */
Index removeSlivers(TriangleSurface& s, double share = 0.05);
} // namespace bsr
