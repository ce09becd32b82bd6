#pragma once

#include "Spline/G1Space.h"

namespace bsr
{
/**
 * The coarse G1 space with one unknown a mesh vertex (paper 000, eq. 8): net = Basis * q.
 * Patches take position, tangents and twists from the Catmull-Clark limit of the quads, are
 * projected into `full` (made by makeG1Space on the same net), and spread the correction
 * over their interior by the thin-plate energy. Where all vertices are regular it is the uniform
 * bicubic B-spline. Columns follow the vertices of the complex that have quads, in their order.
 *
 * Borders follow the cubic B-spline of their vertices; corners (one quad) are interpolated.
 */
SplineSpace makeVertexSpace(
  const QuadComplex& complex, const PatchNet& net, const SplineSpace& full);
} // namespace bsr
