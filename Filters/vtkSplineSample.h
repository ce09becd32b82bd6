/**
 * @class   vtkSplineSample
 * @brief   Resample a spline model as polygons, finer, coarser or to a tolerance
 *
 * Spline models travel as polygons for the eye with the exact model in their field data. This
 * filter replaces the polygons: by Resolution quads a side of each polynomial piece, or, where
 * Tolerance is positive, by as many as keep the polygons within that distance of the surface.
 *
 * Input: a spline model (output of vtkBSplineG1Fit and others). Output: vtkPolyData with the point
 * arrays
 * - `Normals` (Float32, 3): exact unit normals; on shared sides the mean of the patches' normals;
 * - `UV` (Float64, 2): parameters in the patch (on shared sides in the one of lowest index);
 * - `MeanCurvature`, `GaussCurvature` (Float64, 1/unit and 1/unit^2): exact; the mean curvature of
 *   a ball of radius R is 1/R (on shared sides the mean of the patches' values);
 *
 * and the cell arrays
 * - `PatchId` (Int32): index of the patch;
 * - `Shell` (UInt8): 0 outer, 1 inner, 2 wall.
 *
 * The model itself is passed on in the field data. Points on shared sides are written once: a
 * closed model is a closed mesh. Polygons next to a collapsed side (a pole) are triangles.
 *
 * @warning The tolerance is met by at most 256 quads a side of a piece.
 *
 * @sa vtkSplineToBezier, vtkSplineDeviation
 */
#ifndef vtkSplineSample_h
#define vtkSplineSample_h

#include "BSplineReconstructionFiltersModule.h"
#include <vtkPolyDataAlgorithm.h>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkSplineSample : public vtkPolyDataAlgorithm
{
public:
  static vtkSplineSample* New();
  vtkTypeMacro(vtkSplineSample, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Quads a side of each polynomial piece, 1 to 256; default 4. Used where Tolerance is 0. */
  vtkSetMacro(Resolution, int);
  vtkGetMacro(Resolution, int);
  ///@}

  ///@{
  /** Largest distance of the polygons from the surface, in world units; 0 (default): use
   * Resolution.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /** Compute MeanCurvature and GaussCurvature; on by default. */
  vtkSetMacro(Curvatures, bool);
  vtkGetMacro(Curvatures, bool);
  vtkBooleanMacro(Curvatures, bool);
  ///@}

protected:
  vtkSplineSample() = default;
  ~vtkSplineSample() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Resolution = 4;
  double Tolerance = 0.0;
  bool Curvatures = true;

private:
  vtkSplineSample(const vtkSplineSample&) = delete;
  void operator=(const vtkSplineSample&) = delete;
};

#endif
