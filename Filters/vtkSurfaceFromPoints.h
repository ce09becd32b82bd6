/**
 * @class   vtkSurfaceFromPoints
 * @brief   triangles through the points of a scan that has none
 *
 * The first step for point clouds: normals from the nearest points, made to agree along a minimum
 * spanning tree (Hoppe et al. 1992), a signed distance to the points' tangent planes, weighted by
 * their own spacing, and its zero set (vtkExtractSurface), cut off where no point is near. In
 * contrast to vtkSignedDistance, which weighs all points within one radius alike, fine places keep
 * their detail and thin walls their two sides, while coarse places do not tear; where the scan has
 * no points, the surface has a hole or a boundary (see vtkFillHolesRBF).
 *
 * Output 0: the largest connected surface, triangles that face outward. Output 1: the distinct
 * points with the point arrays `Normals` (unit, outward) and `Spacing` (world units, about 1.4
 * times the distance of samples).
 *
 * @warning Samples must lie closer than about half the least thickness of the body.
 *
 * @sa vtkScanToNURBS vtkFillHolesRBF vtkQuadRemesh
 */
#ifndef vtkSurfaceFromPoints_h
#define vtkSurfaceFromPoints_h

#include "BSplineReconstructionFiltersModule.h"
#include <vtkPolyDataAlgorithm.h>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkSurfaceFromPoints : public vtkPolyDataAlgorithm
{
public:
  static vtkSurfaceFromPoints* New();
  vtkTypeMacro(vtkSurfaceFromPoints, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum OutputPorts
  {
    SURFACE = 0,
    POINTS = 1
  };

  ///@{
  /// Neighbors of a point that its normal is estimated from, 4 to 200 (default 16); more for noise.
  vtkSetMacro(NeighborCount, int);
  vtkGetMacro(NeighborCount, int);
  ///@}

  ///@{
  /// Voxels along the longest side of the points' box; 0 (default): half the spacing of the finer
  /// quarter of the points a voxel, at most 400.
  vtkSetClampMacro(Dimension, int, 0, 1000);
  vtkGetMacro(Dimension, int);
  ///@}

  ///@{
  /// Largest distance of the surface to the nearest point, in spacings (default 1.2). A greater
  /// value closes larger gaps, and lets open boundaries stand out farther.
  vtkSetMacro(Reach, double);
  vtkGetMacro(Reach, double);
  ///@}

protected:
  vtkSurfaceFromPoints();
  ~vtkSurfaceFromPoints() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int NeighborCount = 16;
  int Dimension = 0;
  double Reach = 1.2;

private:
  vtkSurfaceFromPoints(const vtkSurfaceFromPoints&) = delete;
  void operator=(const vtkSurfaceFromPoints&) = delete;
};

#endif
