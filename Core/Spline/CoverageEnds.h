#pragma once

#include "Spline/G1Fit.h"

namespace bsr
{
/**
 * Open ends of a hollow body on a closed layout that does not mark them: groups of quads that the
 * outer wall's points do not cover.
 *
 * A quad is uncovered where it has less than 0.45 of the median density of outer points. A group of
 * such quads is widened by the neighbors that face its way (within 45 degrees, or 37 to 60 where
 * that gives no sound end: the annular end face). It is an end where at least 35 % of that is
 * uncovered, the surface around turns away by more than 65 degrees on average (a hole in the wall
 * lies in a wall that goes on), it is no more than 30 % of the layout, and removing it, a disc,
 * leaves a sound surface. The two with the largest uncovered area are taken: a tube has two ends.
 *
 * Returns the layout with Region (0 body, 1 and 2 the ends; empty where there are none) and with
 * the rims' vertices moved along the fiber, by half a side at most, to where the wall's points end:
 * whole quads do not end there. Orientation: outward.
 */
QuadMesh markOpenEnds(const PartitionedPoints& points, const QuadMesh& quads);
} // namespace bsr
