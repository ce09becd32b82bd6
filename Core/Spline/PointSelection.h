#pragma once

#include "Spline/G1Fit.h"
#include "Spline/LayoutEnds.h"

namespace bsr
{
/// Array sizes, QuadId within the layout, finite UV and weights; one error that names the cure.
Status checkPoints(const PartitionedPoints& points, const QuadMesh& quads);

/// The bilinear point of a quad.
Vec3 bilinearPoint(const QuadMesh& quads, Index quad, double u, double v);

/**
 * The points of a side (0 outer, 1 inner) on the quads that remain. Points on removed caps go to
 * the nearest remaining quad where they are as near to it as the side's other points are to theirs
 * (the wall next to a rim), and are dropped otherwise (the end face).
 */
std::vector<FitPoint> selectPoints(
  const PartitionedPoints& points, const QuadMesh& quads, const CutLayout& cut, int side);

/// Samples that hold a shell's border: the points marked as Boundary where a side has some, the
/// ends' rims (see rimSamples) elsewhere, of which the inner shell knows how far they reach only.
std::vector<RimSample> borderSamples(const PartitionedPoints& points, const CutLayout& cut,
  const QuadComplex& complex, const std::vector<Vec3>& vertices, bool inner);
} // namespace bsr
