#pragma once

#include "Common/Types.h"

#include <functional>

namespace bsr
{
/**
 * Triangulates a closed loop of points in space without new points, with the least sum of
 * triangle areas (Barequet and Sharir 1995, dynamic programming); loops of more than 120 points are
 * triangulated over every k-th of them, the pieces between likewise, so that the time stays
 * O(n). Triangles name positions in `loop` and run along it.
 * \param taken says of two positions of the loop that their points are joined by an edge already:
 *        such a chord is not used. May be empty.
 * \return empty where no triangulation without such chords exists
 */
std::vector<std::array<Index, 3>> triangulateLoop(
  const std::vector<Vec3>& loop, const std::function<bool(Index, Index)>& taken);
} // namespace bsr
