#pragma once

#include "Spline/SplineModel.h"

namespace bsr
{
/**
 * Gives control points of sides that Neighbors joins the same bits: those of the patch of lowest
 * number. Sides are taken in the direction in which they fit better. Returns the largest distance
 * by which a point moved (rounding only, where the model was right).
 */
double weldModel(SplineModel& model);
} // namespace bsr
