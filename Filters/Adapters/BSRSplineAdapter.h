#ifndef BSRSplineAdapter_h
#define BSRSplineAdapter_h

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Spline/SampleModel.h"
#include "Spline/SplineModel.h"

class vtkDataObject;
class vtkFieldData;
class vtkPolyData;

namespace bsr
{
/// Whether a data object carries the field array `SplinePatches`.
bool hasSplineModel(vtkDataObject* data);

/// Reads the exact model from the field arrays SplinePatches, SplineControlPoints, SplineKnots,
/// SplineNeighbors and SplineVersion, and checks it. `data` may be null or of any type.
Result<SplineModel> splineModelFrom(vtkDataObject* data);

/// Writes these arrays, replacing those that are there.
void splineModelTo(const SplineModel& model, vtkFieldData* field);

/**
 * Port 0 of every filter that makes a model: replaces `out` by polygons over all patches with the
 * point arrays Normals and UV (and MeanCurvature, GaussCurvature where asked for), the cell arrays
 * PatchId and Shell, and the model in the field data. Other field arrays of `out` are kept. On
 * failure `out` is empty.
 */
Status splineSurfaceTo(
  const SplineModel& model, const SampleOptions& options, Monitor& monitor, vtkPolyData* out);

/// Port 1: quads over the control points (point i is control point i), point array Weight, cell
/// arrays PatchId and Shell.
void controlNetTo(const SplineModel& model, vtkPolyData* out);
} // namespace bsr

#endif
