#pragma once

#include "Contour/BranchedSurface.h"
#include "Contour/SkinMeasure.h"
#include "Contour/SkinTree.h"
#include "Contour/SurfaceReport.h"

namespace bsr
{
struct SkinNetworkOptions
{
  double Tolerance = 0.0;    ///< RMS distance of the contours, world units; above 0
  double PointSpacing = 0.0; ///< of the contours, above 0
  bool ConvexEnds = true;
};

/// A component of the stack as tubes and junctions.
struct SkinNetwork
{
  BranchedSurface Surface;
  std::vector<Index> Contours; ///< that it goes through
  InputError Input;            ///< of these
  std::vector<LegEnd> Ends;    ///< that are closed
  bool Closed = true;          ///< no border
  double MaxNormalJump = 0.0;  ///< degrees, between patches
};

/**
 * Where one tensor-product patch will not do (closed at both ends, legs on both sides, handles,
 * bays that open or close between two slices): tubes of patches through the contours and junctions
 * with continuous tangent planes between them (makeBranchedSurface), with more columns until the
 * tolerance is met. Ends are closed except at the bases of the component's open pieces.
 * \param components of the stack, sorted
 */
Result<SkinNetwork> fitNetwork(const ContourStack& stack, const std::vector<SkinPiece>& pieces,
  const std::vector<Index>& components, const SkinNetworkOptions& options, Monitor& monitor);
} // namespace bsr
