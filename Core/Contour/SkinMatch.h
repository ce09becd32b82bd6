#pragma once

#include "Common/Types.h"

namespace bsr
{
/**
 * Assigns nodes to positions on a closed curve, in order, by dynamic programming: it minimizes the
 * squared distances to the nodes' targets plus the squares of how far the steps from node to node
 * miss the wanted ones. Positions may leave 0 to n.
 * \param curve n points, a multiple of the number of targets
 * \param steps the wanted number of positions from each node to the next
 * \param stiffness of the steps, times the square of the mean distance of nodes
 * \param start about where the first node goes
 */
std::vector<int> matchNodes(const std::vector<Vec2>& curve, const std::vector<Vec2>& targets,
  const std::vector<double>& steps, double stiffness, int start);
} // namespace bsr
