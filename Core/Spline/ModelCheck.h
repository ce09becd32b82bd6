#pragma once

#include "Common/Status.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/**
 * Checks that a model may be evaluated: at least one patch, degrees 1 to MaximumDegree, array
 * ranges, finite control points, positive weights, non-decreasing knots with full multiplicity at
 * the ends, neighbors that name each other. The message names the patch and what is wrong with it.
 */
Status checkModel(const SplineModel& model);
} // namespace bsr
