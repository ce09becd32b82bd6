/**
 * @class   vtkPartitionToQuads
 * @brief   Give each point the nearest quad of a layout and its parameters on it
 *
 * The step between a quad layout and the fit of one B-spline patch a quad (Mosbach et al.,
 * section 4.2). Every point of the input gets the quad of the layout that is nearest to it and the
 * parameters (u, v) of the nearest point, by inversion of the bilinear patch that the quad's four
 * corners span. The search is exact: the quads are bilinear patches, not pairs of triangles.
 *
 * Input port 0 (`Input`): any vtkPointSet; only its points are used. Input port 1 (`Quads`): a
 * vtkPolyData of quads only, as vtkQuadRemesh makes.
 *
 * The output is the input with these point arrays added:
 * - `QuadId` (Int32): index of the quad among the polygons of the layout;
 * - `UV` (Float64, 2 components): parameters in [0, 1]; u runs from corner 0 to corner 1, v from
 *   corner 0 to corner 3;
 * - `QuadDistance` (Float64): distance to the quad, in world units, never negative.
 *
 * Field data: `QuadDistanceRMS`, `QuadDistanceMax` (world units), `EmptyQuads` (quads without
 * points).
 *
 * The result is the same for any number of threads, bit for bit.
 *
 * @warning The nearest quad of a point on the inner wall of a thin or collapsed tube may lie on the
 * far side of the lumen. Where the input has normals, as isosurfaces do, MatchNormals forbids that.
 *
 * @sa vtkQuadRemesh, vtkBSplineG1Fit
 */
#ifndef vtkPartitionToQuads_h
#define vtkPartitionToQuads_h

#include "BSplineReconstructionFiltersModule.h"
#include <vtkPointSetAlgorithm.h>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkPartitionToQuads : public vtkPointSetAlgorithm
{
public:
  static vtkPartitionToQuads* New();
  vtkTypeMacro(vtkPartitionToQuads, vtkPointSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Methods
  {
    NEAREST_QUAD = 0
  };

  ///@{
  /** How points are given to quads. NEAREST_QUAD (default): by Euclidean distance. */
  vtkSetClampMacro(Method, int, NEAREST_QUAD, NEAREST_QUAD);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /**
   * On by default. A point with a normal (active point normals) is given only quads that
   * face the way it does: less than 90 degrees between the normals. Points whose array `Side` is 1
   * (inner wall, see vtkEDTClassify) are given quads that face the opposite way, since the layout's
   * normals point out of the closed object. A point that no quad suits, or an input without
   * normals, takes the nearest one. If off, always the nearest.
   */
  vtkSetMacro(MatchNormals, bool);
  vtkGetMacro(MatchNormals, bool);
  vtkBooleanMacro(MatchNormals, bool);
  ///@}

protected:
  vtkPartitionToQuads();
  ~vtkPartitionToQuads() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Method = NEAREST_QUAD;
  bool MatchNormals = true;

private:
  vtkPartitionToQuads(const vtkPartitionToQuads&) = delete;
  void operator=(const vtkPartitionToQuads&) = delete;
};

#endif
