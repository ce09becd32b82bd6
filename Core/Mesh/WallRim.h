#pragma once

#include "Mesh/FiberEnds.h"
#include "Mesh/FiberRim.h"

#include <vector>

namespace bsr
{
/// Samples of a raw surface: the middles of its triangles with unit normals and areas.
struct WallSamples
{
  std::vector<Vec3> Points;
  std::vector<Vec3> Normals;
  std::vector<double> Areas;
  std::vector<std::uint8_t> Side; ///< as of FiberWall, of most corners
  double Edge = 0.0;              ///< mean length of an edge
};

/// A rim on the wall, and how clearly the wall ends there: 0 (not known) to 1, the mean over the
/// directions of what is covered just below less what is covered just above.
struct WallRim
{
  FiberRim Rim;
  double Clear = 0.0;
};

/// Empty where the surface has no triangles or the sides are not as many as its vertices.
WallSamples sampleWall(const FiberWall& wall);

/**
 * Moves a rim found on the closed surface onto the fiber's raw outer wall. The closed surface lies
 * on the bumps of a rough wall, fills what is concave and spans notches of the end by a slope that
 * leaves the wall; the raw surface does not.
 *
 * In turns, six times: a ruled wall (radius and slope against the axis for each direction, both
 * smooth around) is fitted to the outer wall's points within 0.3 radii behind the rim, by least
 * squares that count outliers little; and in every direction the height is sought where that wall
 * ends: covered below and bare above, by the area of the raw surface that lies along it. These
 * heights are joined with the least jumps (dynamic programming) and smoothed, each counting as
 * clearly as the wall ends there, so that gaps and tears are passed straight.
 *
 * The rim is returned as it was where the raw wall is missing in more than half of the directions
 * or its end in more than two thirds, or where the result leaves it by more than 0.35 radii.
 */
WallRim rimOnWall(const WallSamples& wall, const MouthFrame& frame, const FiberRim& start);
} // namespace bsr
