/**
 * @class   vtkPartitionToQuads
 * @brief   Give each point its quad of a layout and its parameters on it
 *
 * The step between a quad layout and the fit of one B-spline patch a quad (Mosbach et al.,
 * section 4.2; Branch, Prieto and Boulanger, section 4), by one of two methods.
 *
 * Nearest Quad: every point of the input gets the quad of the layout that is nearest to it and the
 * parameters (u, v) of the nearest point, by inversion of the bilinear patch that the quad's four
 * corners span. The search is exact: the quads are bilinear patches, not pairs of triangles.
 *
 * Geodesic: the sides of the quads become geodesics of a mesh (fast marching), the mesh is cut
 * along them, each region is mapped to the unit square without fold-over (mean value coordinates,
 * then less stretch), and a point gets the quad and parameters of the nearest point of the mesh.
 * Large curved quads get right parameters that way. Quads without a sound region are counted in
 * `FailedQuads`; their points take the nearest quad.
 *
 * Input port 0 (`Input`): any vtkPointSet; only its points are used. Input port 1 (`Quads`): a
 * vtkPolyData of quads only, as vtkQuadRemesh makes. Input port 2 (`Surface`, optional): the
 * triangles that the layout was made from, for Geodesic; without it those of the input. Without any
 * triangle, Geodesic warns and takes the nearest quad.
 *
 * Output port 1 (`Network`, empty with Nearest Quad): the regularized network, a polyline of
 * SamplesPerSide points for each side: a cubic B-spline fitted to the geodesic, sampled evenly and
 * put back on the mesh. Cell arrays `Side`, `Corners` (points of the layout), `SideQuads` (left and
 * right quad, -1: none), all Int32.
 *
 * The output is the input with these point arrays added:
 * - `QuadId` (Int32): index of the quad among the polygons of the layout;
 * - `UV` (Float64, 2 components): parameters in [0, 1]; u runs from corner 0 to corner 1, v from
 *   corner 0 to corner 3;
 * - `QuadDistance` (Float64): distance to the quad (Geodesic: to the mesh), in world units.
 *
 * With Geodesic on an open mesh also `Boundary` (UInt8): 1 for points of the mesh's boundary, which
 * lie on boundary sides of the layout; vtkBSplineG1Fit lets the model's boundary follow them.
 *
 * Field data: `QuadDistanceRMS`, `QuadDistanceMax` (world units), `EmptyQuads` (quads without
 * points); with Geodesic also `FailedQuads`, `RoughSides` (sides left as paths of mesh edges),
 * `FoldedTriangles` (0: the maps are one to one) and `SideRatio` (worst ratio of the longest to the
 * shortest side of a quad).
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

class vtkPolyData;

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkPartitionToQuads : public vtkPointSetAlgorithm
{
public:
  static vtkPartitionToQuads* New();
  vtkTypeMacro(vtkPartitionToQuads, vtkPointSetAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Methods
  {
    NEAREST_QUAD = 0,
    GEODESIC = 1
  };

  ///@{
  /**
   * How points are given to quads. NEAREST_QUAD (default): by Euclidean distance. GEODESIC: by a
   * map of the mesh.
   */
  vtkSetClampMacro(Method, int, NEAREST_QUAD, GEODESIC);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /// Points of the network a side, ends included (lambda of Branch et al.). Default 17, at least 2.
  vtkSetClampMacro(SamplesPerSide, int, 2, 10000);
  vtkGetMacro(SamplesPerSide, int);
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
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Method = NEAREST_QUAD;
  int SamplesPerSide = 17;
  bool MatchNormals = true;

private:
  /// The triangles for geodesics, or null.
  static vtkPolyData* MeshOf(vtkPointSet* input, vtkInformationVector** inputs);

  vtkPartitionToQuads(const vtkPartitionToQuads&) = delete;
  void operator=(const vtkPartitionToQuads&) = delete;
};

#endif
