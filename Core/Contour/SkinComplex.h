#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Contour/SkinMeasure.h"
#include "Spline/G1Fit.h"

namespace bsr
{
struct SkinComplexOptions
{
  double Tolerance = 0.0;    ///< RMS distance, world units; above 0
  double PointSpacing = 0.0; ///< of samples along the contours, above 0
  double CapShare = 0.75;    ///< see closeCores
  int CorePoints = 12;
  int PatchLimit = 1200;
};

struct SkinComplexFit
{
  G1FitResult Fit;
  std::vector<LegEnd> Ends; ///< of its legs, below and above
};

/**
 * A surface over a part of the stack that may end on both sides: a cube of six faces, its
 * bottom and its top the data sets of the legs below and above (arrangeGrid), its four sides the
 * trunk between them, cut into quads, with bicubic patches of continuous tangent planes on them
 * (fitG1). The corners of bottom and top are vertices of three faces, so nothing degenerates there.
 * Normals point outward.
 */
Result<SkinComplexFit> fitComplex(const ContourStack& stack, const SkinPiece& piece,
  const SkinComplexOptions& options, Monitor& monitor);
} // namespace bsr
