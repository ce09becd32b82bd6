/**
 * @class   vtkScanToNURBS
 * @brief   a triangulated scan, or its points, in; a network of NURBS patches out
 *
 * The whole pipeline of Branch, Prieto and Boulanger, "Automatic Extraction of a Quadrilateral
 * Network of NURBS Patches from Range Data Using Evolutionary Strategies", in one filter, with the
 * settings that a person is likely to change. It runs, in this order: for data without triangles
 * vtkSurfaceFromPoints; then vtkFillHolesRBF, vtkQuadRemesh, vtkPartitionToQuads (Geodesic) and
 * vtkBSplineG1Fit. Whoever needs a setting that is not here builds the chain from these filters.
 *
 * Connected parts of less than 0.5 % of the scan's area are left out as specks (`DroppedParts`);
 * of several larger ones each becomes a closed or open shell of its own.
 *
 * Input: a vtkPolyData of triangles; if it has none, its points are taken, and the surface of the
 * largest component of the reconstruction is what the layout is made on, while the model is fitted
 * to the points themselves. Output ports:
 * - 0 model: the spline model (see vtkBSplineG1Fit, port 0);
 * - 1 control net (vtkBSplineG1Fit, port 1);
 * - 2 report: a row a patch (vtkBSplineG1Fit, port 2); its field data also carries `StageNames` and
 *   `StageSeconds`, `FilledHoles`, `LeftHoles`, `HoleSize`, `HoleState`, `Irregular`,
 *   `EulerCharacteristic`, `FailedQuads`, `RoughSides`, `RelativeRMS` and `RelativeMax` (of the
 * bounding box's diagonal);
 * - 3 closed mesh with the cell array `Filled`;
 * - 4 quad layout;
 * - 5 points with `QuadId`, `UV`, `QuadDistance`;
 * - 6 regularized network of sides.
 *
 * When a stage fails, its message is reported as this filter's error with the stage's name in
 * front, and every output is empty; so it is when the filter is cancelled (AbortExecute).
 *
 * @sa vtkFillHolesRBF vtkQuadRemesh vtkPartitionToQuads vtkBSplineG1Fit
 */
#ifndef vtkScanToNURBS_h
#define vtkScanToNURBS_h

#include "BSplineReconstructionFiltersModule.h"
#include "vtkAlgorithm.h"

class vtkPolyData;

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkScanToNURBS : public vtkAlgorithm
{
public:
  static vtkScanToNURBS* New();
  vtkTypeMacro(vtkScanToNURBS, vtkAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The output ports.
  enum Port
  {
    MODEL = 0,
    CONTROL_NET = 1,
    REPORT = 2,
    CLOSED_MESH = 3,
    LAYOUT = 4,
    POINTS = 5,
    NETWORK = 6
  };

  ///@{
  /// How the layout is found, as in vtkQuadRemesh: 0 Field Aligned (default), 1 Morse-Smale.
  vtkSetClampMacro(Method, int, 0, 1);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /// Number of quads of the layout, about the number of patches. Default 300.
  vtkSetMacro(NumberOfQuads, int);
  vtkGetMacro(NumberOfQuads, int);
  ///@}

  ///@{
  /// Where regions of the layout are no discs on the scan or patches fold, lay out again with half
  /// as many quads more, up to three times (`MoreQuadsRounds` in the report). Default on; off: the
  /// best effort with the number asked for.
  vtkSetMacro(MoreQuads, bool);
  vtkGetMacro(MoreQuads, bool);
  vtkBooleanMacro(MoreQuads, bool);
  ///@}

  ///@{
  /// Holes of a larger diameter stay open; a share of the bounding box's diagonal. Default 0.25.
  /// Planar cut ends of tubes stay open whatever their size (see vtkFillHolesRBF).
  vtkSetMacro(MaximumHoleSize, double);
  vtkGetMacro(MaximumHoleSize, double);
  ///@}

  ///@{
  /// Optimize weights (NURBS) after the fit, as in vtkBSplineG1Fit: 0 none (default), 1 evolution
  /// strategy, 2 deterministic, 3 control points alone (weights 1).
  vtkSetClampMacro(Optimizer, int, 0, 3);
  vtkGetMacro(Optimizer, int);
  ///@}

  ///@{
  /// Largest mean distance of a patch, as a share of the bounding box's diagonal: patches above it
  /// are refined (segments), none with 0 (default). Works with weights on or off.
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Polynomial pieces a side of a patch, 3 (default) to 16.
  vtkSetClampMacro(SegmentsPerSide, int, 3, 16);
  vtkGetMacro(SegmentsPerSide, int);
  ///@}

  ///@{
  /// How large quads are where, as in vtkQuadRemesh: 0 Uniform, 1 Curvature (default).
  vtkSetClampMacro(Sizing, int, 0, 1);
  vtkGetMacro(Sizing, int);
  ///@}

  ///@{
  /// Edges where the normals turn by more than this become sides of quads and stay
  /// sharp in the model; 180 (default): none.
  vtkSetMacro(FeatureAngle, double);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /// How points get their parameters, as in vtkPartitionToQuads: 0 Nearest Quad, 1 Geodesic
  /// (default).
  vtkSetClampMacro(Partition, int, 0, 1);
  vtkGetMacro(Partition, int);
  ///@}

  ///@{
  /// Weigh outliers down, for scans with debris. Default off: every point counts.
  vtkSetMacro(RobustWeights, bool);
  vtkGetMacro(RobustWeights, bool);
  vtkBooleanMacro(RobustWeights, bool);
  ///@}

  ///@{
  /// Data without triangles: voxels along the longest side of the box in which their surface is
  /// reconstructed; 0 (default): from the points' spacing.
  vtkSetClampMacro(ReconstructionDimension, int, 0, 1000);
  vtkGetMacro(ReconstructionDimension, int);
  ///@}

  ///@{
  /// Quads a side of a polynomial piece in the model's picture. Default 4.
  vtkSetClampMacro(Resolution, int, 1, 64);
  vtkGetMacro(Resolution, int);
  ///@}

  vtkTypeBool ProcessRequest(
    vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

protected:
  vtkScanToNURBS();
  ~vtkScanToNURBS() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*);

  int Method = 0;
  int NumberOfQuads = 300;
  bool MoreQuads = true;
  double MaximumHoleSize = 0.25;
  int Optimizer = 0;
  double Tolerance = 0.0;
  int SegmentsPerSide = 3;
  int Sizing = 1;
  double FeatureAngle = 180.0;
  int Partition = 1;
  bool RobustWeights = false;
  int ReconstructionDimension = 0;
  int Resolution = 4;

private:
  struct Stages;

  vtkScanToNURBS(const vtkScanToNURBS&) = delete;
  void operator=(const vtkScanToNURBS&) = delete;
};

#endif
