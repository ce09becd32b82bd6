/**
 * @class   vtkFiberReconstruction
 * @brief   a CT volume in, a hollow fiber as a B-spline solid out
 *
 * The whole pipeline of Mosbach, Schladitz, Hamann and Hagen, "Topologically Robust B-spline
 * Reconstruction of Fibers from 3D Images", in one filter. It runs, in this order and with the
 * settings that a person is likely to change:
 * vtkClosing, vtkFlyingEdges3D (closed surface and raw surface), vtkEDTClassify, vtkFiberEnds,
 * vtkQuadRemesh, vtkPartitionToQuads and vtkBSplineG1Fit. Whoever needs a setting that is not here
 * builds the chain from these filters.
 *
 * Input: a vtkImageData with a point array (SetInputArrayToProcess(0, ...); default: the active
 * scalars). Output ports:
 * - 0 model: the spline model (see vtkBSplineG1Fit, port 0);
 * - 1 control net (vtkBSplineG1Fit, port 1);
 * - 2 report: a row a patch (vtkBSplineG1Fit, port 2); its field data also carries `StageNames` and
 *   `StageSeconds`, `IsoValue`, `ClosingRadius`, `BettiNumbers`, `OpenEnds`, `EndsNote` (openings
 * that were left out, and why);
 * - 3 closed surface with the cell array `EndRegion`;
 * - 4 quad layout;
 * - 5 raw surface with the point arrays `Depth`, `Side`, `QuadId`, `UV`, `QuadDistance`.
 *
 * When a stage fails, its message is reported as this filter's error with the stage's name in
 * front, and every output is empty; so it is when the filter is cancelled (AbortExecute).
 *
 * @warning Only the largest object of the volume is reconstructed.
 * @sa vtkClosing vtkEDTClassify vtkFiberEnds vtkQuadRemesh vtkPartitionToQuads vtkBSplineG1Fit
 */
#ifndef vtkFiberReconstruction_h
#define vtkFiberReconstruction_h

#include "BSplineReconstructionFiltersModule.h"
#include "vtkAlgorithm.h"

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkFiberReconstruction : public vtkAlgorithm
{
public:
  static vtkFiberReconstruction* New();
  vtkTypeMacro(vtkFiberReconstruction, vtkAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The output ports.
  enum Port
  {
    MODEL = 0,
    CONTROL_NET = 1,
    REPORT = 2,
    CLOSED_SURFACE = 3,
    LAYOUT = 4,
    RAW_SURFACE = 5
  };

  /// Which surfaces of the wall are fitted.
  enum SideChoice
  {
    BOTH = 0,
    OUTER_ONLY = 1,
    INNER_ONLY = 2
  };

  ///@{
  /**
   * Gray value of the object's surface. With AutoIsoValue (default 1) it is found as in
   * vtkClosing and IsoValue is ignored.
   */
  vtkSetMacro(IsoValue, double);
  vtkGetMacro(IsoValue, double);
  vtkSetMacro(AutoIsoValue, bool);
  vtkGetMacro(AutoIsoValue, bool);
  vtkBooleanMacro(AutoIsoValue, bool);
  ///@}

  ///@{
  /**
   * Radius of the closing's ball in voxels (default 16). With AutoRadius (default 1) it is found
   * from the volume: the start of the plateau where the lumen is filled.
   */
  vtkSetMacro(Radius, double);
  vtkGetMacro(Radius, double);
  vtkSetMacro(AutoRadius, bool);
  vtkGetMacro(AutoRadius, bool);
  vtkBooleanMacro(AutoRadius, bool);
  ///@}

  ///@{
  /// Number of quads of the closed layout, so about the number of patches a shell. Default 300.
  vtkSetMacro(NumberOfQuads, int);
  vtkGetMacro(NumberOfQuads, int);
  ///@}

  ///@{
  /**
   * BOTH (default), OUTER_ONLY or INNER_ONLY. One side alone becomes a closed body without walls,
   * whose patches are of shell 0.
   */
  vtkSetClampMacro(Sides, int, BOTH, INNER_ONLY);
  vtkGetMacro(Sides, int);
  ///@}

  ///@{
  /// 0: open ends are found and kept open (default); 1: the shells are kept closed.
  vtkSetClampMacro(OpenEnds, int, 0, 1);
  vtkGetMacro(OpenEnds, int);
  ///@}

  ///@{
  /// Continuity of the shells, as in vtkBSplineG1Fit. Default: Full G1.
  vtkSetClampMacro(Continuity, int, 0, 3);
  vtkGetMacro(Continuity, int);
  ///@}

  ///@{
  /// Polynomial segments along a patch's side. Default 3.
  vtkSetMacro(SegmentsPerSide, int);
  vtkGetMacro(SegmentsPerSide, int);
  ///@}

  ///@{
  /// Samples a side of a polynomial piece in the model's polygons. Default 4.
  vtkSetClampMacro(Resolution, int, 1, 64);
  vtkGetMacro(Resolution, int);
  ///@}

protected:
  vtkFiberReconstruction();
  ~vtkFiberReconstruction() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output);

  double IsoValue = 0.0;
  bool AutoIsoValue = true;
  double Radius = 16.0;
  bool AutoRadius = true;
  int NumberOfQuads = 300;
  int Sides = BOTH;
  int OpenEnds = 0;
  int Continuity = 0;
  int SegmentsPerSide = 3;
  int Resolution = 4;

private:
  struct Stages;

  vtkFiberReconstruction(const vtkFiberReconstruction&) = delete;
  void operator=(const vtkFiberReconstruction&) = delete;
};

#endif
