#pragma once

#include "Spline/FitPoints.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/**
 * The model of one or two shells on one layout. Patch f of the outer shell is quad f; the inner
 * shell's patches follow, u and v swapped so that their normals point into the lumen; then, where
 * the layout has a border, one ruled wall patch (degree 3 x 1) a border side, from the outer to the
 * inner border curve. One patch a quad and shell (inner: null where there is none); shared sides
 * must have the same control points, bit for bit, and have them in the model.
 */
SplineModel buildModel(const QuadComplex& complex, const std::vector<RationalPatch>& outer,
  const std::vector<RationalPatch>* inner);

/// The patches of a net, with weights of 1.
std::vector<RationalPatch> ownPatches(const PatchNet& net, const NetPoints& points);
} // namespace bsr
