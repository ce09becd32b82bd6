#pragma once

#include "Layout/GridMap.h"
#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * The quads of an integer-grid map, found by whole numbers only: every vertex is rounded to its
 * nearest grid point (transitions are whole, so all charts agree), triangles longer than a cell
 * are split first and triangles that rounding turned over are flipped away. What is left are
 * triangles without area and halves of cells; vertices at the same grid point joined by
 * edges become one, halves across a diagonal become a quad (as in QuadriFlow, Huang et al. 2018).
 *
 * The answer may be invalid (checkLayout tells) where the map folds. No quads: not extractable.
 * `borderHalfEdges` receives the points of each border loop in order, with the domain on the left.
 */
LayoutDraft extractQuads(GridMap map, std::vector<std::vector<Index>>& borders,
  std::vector<Index>& borderRegions, Monitor& monitor);
} // namespace bsr
