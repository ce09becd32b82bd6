#pragma once

#include "Contour/SkinGrid.h"

namespace bsr
{
/// A point that closes the end of a leg, and its place (column, row) in the grid.
struct CapPoint
{
  Vec3 Point;
  Vec2 Place;
  Index Ring;
  bool Bridge = false; ///< between legs
};

/**
 * Points on a convex end over each core: across the core's outline they interpolate harmonically,
 * and rise over its plane like a membrane under pressure (which meets the slope of the leg), up to
 * the height at which the two lowest contours' areas, taken as linear in height, vanish, and at
 * most `share` of the room to the next slice; with share 0 they are flat. Fills the nodes inside
 * wide cores, too.
 */
std::vector<CapPoint> closeCores(const ContourStack& stack, SkinGrid& grid, double share);
/**
 * Points between the parts that face each other inside one contour: on the segments from node to
 * node, raised half way to that contour in the middle and all the way at the ends.
 */
std::vector<CapPoint> bridgeParts(const ContourStack& stack, const SkinGrid& grid);
} // namespace bsr
