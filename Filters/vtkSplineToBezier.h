/**
 * @class   vtkSplineToBezier
 * @brief   Turn a spline model into exact Bezier cells
 *
 * Each polynomial piece of each patch becomes one cell of type VTK_BEZIER_QUADRILATERAL, equal to
 * the model up to rounding, for isogeometric analysis and for exchange with programs that read
 * VTK's Bezier cells.
 *
 * Input: a spline model. Output: vtkUnstructuredGrid with
 * - point data `RationalWeights` (Float64, set as the active rational weights): weights of the
 *   control points (all 1 for a polynomial model);
 * - cell data `HigherOrderDegrees` (Float64, 3, set as the active degrees): degree along u and v,
 * 0;
 * - cell data `PatchId` (Int32), `Shell` (UInt8: 0 outer, 1 inner, 2 wall);
 * - cell data `Domain` (Float64, 4): u from, u to, v from, v to of the piece in its patch;
 * - the model in the field data.
 *
 * The points are control points, shared by neighboring pieces and matching patches.
 *
 * @warning Rendering 20 000 such cells takes seconds a frame, and ParaView's Clip and Slice flatten
 * them; use the polygons of the model itself for the eye.
 *
 * @sa vtkSplineSample
 */
#ifndef vtkSplineToBezier_h
#define vtkSplineToBezier_h

#include "BSplineReconstructionFiltersModule.h"
#include <vtkUnstructuredGridAlgorithm.h>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkSplineToBezier : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkSplineToBezier* New();
  vtkTypeMacro(vtkSplineToBezier, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkSplineToBezier() = default;
  ~vtkSplineToBezier() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSplineToBezier(const vtkSplineToBezier&) = delete;
  void operator=(const vtkSplineToBezier&) = delete;
};

#endif
