#pragma once

#include "Layout/LayoutGraph.h"

namespace bsr
{
/// In which order the sides of a layout are laid on a surface. Boundary sides lie there already.
struct SideOrder
{
  std::vector<Index> Edges;
  /// Places in Edges of the sides that close loops around handles: what is left of the surface must
  /// stay connected when they are laid.
  std::size_t FirstLoop = 0;
  std::size_t EndOfLoops = 0;
  /// Longest way off the straight line, in lengths of the side; tried one after the other.
  std::vector<double> Reach = {1.0, 3.0};
};

/// Shortest first; those of larger `urgent` before.
SideOrder shortestFirst(
  const LayoutGraph& graph, const std::vector<double>& length, const std::vector<int>& urgent);

/**
 * An order in which no side can be shut off and every quad ends up a disc, if surface and layout
 * have the same topology: first a spanning tree of the vertices (boundaries count as connected),
 * then a pair of sides for each handle, then the sides whose duals span the quads (Eppstein 2003,
 * "Dynamic generators of topologically embedded graphs": tree-cotree decomposition). A tree does
 * not part the surface; with the loops the rest is one disc, whatever way they took, as the sides
 * leave each corner in the layout's order; and in a disc every side has one class of ways. Low
 * costs come into the tree, high ones to the end.
 * \param laid per edge: 1 where the side lies already (or empty)
 */
SideOrder safeOrder(const LayoutGraph& graph, const std::vector<double>& cost,
  const std::vector<std::uint8_t>& laid = {});
} // namespace bsr
