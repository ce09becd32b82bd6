#pragma once

#include "Spline/FitPoints.h"
#include "Spline/VertexFrames.h"

namespace bsr
{
/**
 * The edges of a layout along which the points have a sharp edge: the normals of the points close
 * to either side (planes fitted to a tenth of the patch, up to three tenths where there are few
 * points, in four places along the edge) differ by more than `angle` degrees in most places.
 * Points sorted by patch; angle of 180 or more: none.
 */
Creases findCreases(const QuadComplex& complex, const std::vector<Vec3>& vertices,
  const std::vector<FitPoint>& points, double angle);
} // namespace bsr
