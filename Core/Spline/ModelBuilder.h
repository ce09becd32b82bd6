#pragma once

#include "Spline/FitPoints.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/**
 * The model of one or two shells on one layout. Patch f of the outer shell is quad f; the inner
 * shell's patches follow, u and v swapped so that their normals point into the lumen; then, where
 * the layout has a border, one ruled wall patch (degree 3 x 1) a border side, from the outer to the
 * inner border curve. Control points of shared sides are copies of one another, bit for bit.
 */
SplineModel buildModel(
  const QuadComplex& complex, const PatchNet& net, const NetPoints& outer, const NetPoints* inner);
} // namespace bsr
