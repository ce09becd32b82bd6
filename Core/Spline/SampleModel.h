#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Spline/SplineModel.h"

namespace bsr
{
struct SampleOptions
{
  int Resolution = 4;      ///< quads a side of a polynomial piece, 1 to 256
  double Tolerance = 0.0;  ///< > 0: chordal tolerance in world units instead of Resolution
  bool Curvatures = false; ///< compute MeanCurvature and GaussCurvature too
  /// Turn closed components so that normals point out of the material (outwardFlips); otherwise
  /// each component keeps the orientation that most of its patches have.
  bool Outward = true;
};

/**
 * Polygons over a spline model. Points on the side of two matching patches are written once, so a
 * closed model gives a closed mesh. Normals there are the mean of the patches' unit normals: exact
 * where the model is smooth, halfway at a sharp edge. UV of such a point belongs to the patch of
 * lowest index.
 */
struct SampledModel
{
  std::vector<Vec3> Points;
  std::vector<Vec3> Normals;
  std::vector<Vec2> UV;
  /// Half the sum and the product of the principal curvatures; the mean curvature of a sphere
  /// with outward normals is 1 / radius. Empty unless asked for.
  std::vector<double> MeanCurvature;
  std::vector<double> GaussCurvature;
  /// Counter-clockwise seen from the normals' side; a fourth corner of -1 marks a triangle.
  std::vector<std::array<Index, 4>> Polygons;
  std::vector<Index> PatchId; ///< of each polygon
};

/**
 * Samples every polynomial piece of every patch. With a tolerance the number of quads is chosen a
 * strip of patches from bounds on the second derivatives, at most 256 a piece.
 * \pre the model is valid (checkModel); fails with InvalidParameter on a bad option.
 */
Result<SampledModel> sampleModel(
  const SplineModel& model, const SampleOptions& options, Monitor& monitor);

/// The distinct knots of a patch's domain along u (direction 0) or v (1): ends of its pieces.
std::vector<double> pieceEnds(const SplineModel& model, const SplinePatch& patch, int direction);
} // namespace bsr
