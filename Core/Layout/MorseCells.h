#pragma once

#include "Layout/MorseCut.h"
#include "Layout/QuadGraph.h"

#include <string>

namespace bsr
{
/// The cells of a discrete gradient.
struct MorseCells
{
  PartitionedSurface Surface;
  QuadGraph Graph;              ///< a quad (at boundaries up to two) for each cell
  std::vector<Vec3> Points;     ///< of the graph's vertices: critical points, then on boundaries
  std::vector<VertexKind> Kind; ///< of the graph's vertices
  Index Cells = 0;
  Index Minima = 0;    ///< boundary ones included
  Index Maxima = 0;    ///< boundary ones included
  Index Saddles = 0;   ///< boundary ones included
  std::string Problem; ///< why there is no graph
};

/**
 * The Morse-Smale complex of a gradient: from each saddle the paths down along edges and up across
 * edges (which are split there) cut the surface; cells are grown over the triangles between. Each
 * cell has one minimum and one maximum; inside it has a saddle on either side, so it is a
 * quadrilateral whatever the genus. Where a side of a cell runs along a boundary it has none, one
 * or two saddles; vertices are put on the boundary until the cell is one or two quads.
 *
 * The graph may be degenerate (a quad that names a vertex twice, vertices of two quads, repeated
 * edges): that is mended by what comes after.
 */
MorseCells morseCells(const TriangleSurface& s, const MorseGradient& g);
} // namespace bsr
