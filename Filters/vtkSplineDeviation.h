/**
 * @class   vtkSplineDeviation
 * @brief   Exact signed distance of points from a spline model
 *
 * Measures how far each point of the input lies from a spline model: the distance to the exact
 * nearest point of the surface (not of the polygons), by a bounding-volume tree over Bezier pieces
 * and Newton's method.
 *
 * Input port 0 (`Input`): any vtkPointSet. Input port 1 (`Model`): a spline model. The output is
 * input 0 with the point arrays
 * - `Deviation` (Float64, world units): signed distance; positive on the side that the normals
 *   point to (outside a closed model), negative within;
 * - `DeviationPatch` (Int32): index of the nearest patch.
 *
 * Field data (world units): `RMS`, `Max` (of the absolute values), `Mean` (of the signed values),
 * `Percentiles` (5 components: 50, 75, 90, 95, 99 % of the absolute values), `Points` (number of
 * points that count).
 *
 * At sharp edges the mean of the adjoining patches' normals gives the sign.
 *
 * @sa vtkBSplineG1Fit, vtkSplineSample
 */
#ifndef vtkSplineDeviation_h
#define vtkSplineDeviation_h

#include "BSplineReconstructionFiltersModule.h"
#include <vtkPointSetAlgorithm.h>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkSplineDeviation : public vtkPointSetAlgorithm
{
public:
  static vtkSplineDeviation* New();
  vtkTypeMacro(vtkSplineDeviation, vtkPointSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Off by default. If on and the input has the point array `Side` (vtkEDTClassify), points of side
   * 0 are compared with the outer shell only and points of side 1 with the inner shell only; others
   * (255: neither wall) are compared with any shell and do not count in the field data.
   */
  vtkSetMacro(MatchSides, bool);
  vtkGetMacro(MatchSides, bool);
  vtkBooleanMacro(MatchSides, bool);
  ///@}

protected:
  vtkSplineDeviation();
  ~vtkSplineDeviation() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  bool MatchSides = false;

private:
  vtkSplineDeviation(const vtkSplineDeviation&) = delete;
  void operator=(const vtkSplineDeviation&) = delete;
};

#endif
