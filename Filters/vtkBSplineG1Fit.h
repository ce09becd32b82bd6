/**
 * @class vtkBSplineG1Fit
 * @brief smooth B-spline patches, one a quad of a layout, through partitioned points
 *
 * vtkBSplineG1Fit fits a network of bicubic B-spline patches to points that vtkPartitionToQuads has
 * put on the quads of a layout. Data and thin-plate fairing are balanced by a schedule of
 * Fairing values between which the points' parameters are corrected and outliers lose their weight.
 * Neighboring patches meet with continuous tangent planes (FULL_G1, VERTEX_G1), or only without
 * gaps (C0_REDUCTION, C0_MULTIPLIERS). Lengths are normalized: the settings mean the same at any
 * scale.
 *
 * Points of the inner wall (`Side` 1) get a second shell on the same layout. Where the layout has
 * an open end (cell array `EndRegion` > 0 on the quads of its cap, as vtkQuadRemesh carries it),
 * the caps are removed and the shells' borders joined by ruled patches; without inner points there
 * is an outer shell only, and the field `Message` says so.
 *
 * Input port 0: points with the point arrays
 * - `QuadId` (Int32): quad of the layout, -1 to ignore the point;
 * - `UV` (two components): its place on the quad, in the unit square;
 * - `Side` (UInt8, optional): 0 outer wall, 1 inner wall, others are ignored;
 * - `Boundary` (UInt8, optional): 1 for points on a boundary side of an open layout, which the
 *   model's boundary follows (vtkPartitionToQuads, Geodesic);
 * - WeightArray (optional): weights >= 0.
 * Input port 1 (Quads): the layout, quads only, oriented outward, of valence 3 and more inside.
 * Input port 2 (Rims, optional): closed polylines that the borders of open ends follow where the
 * layout's vertices lie on one (vtkFiberEnds, port 1); other lines are ignored. Without it borders
 * are smooth curves through the layout's vertices, which cut the corners of a rim with few quads
 * around.
 *
 * Output port 0: a surface for the eye, with the exact model in its field data (`SplinePatches`,
 * `SplineControlPoints`, `SplineKnots`, `SplineNeighbors`, `SplineVersion`); point arrays
 * `Normals`, `UV`; cell arrays `PatchId`, `Shell` (0 outer, 1 inner, 2 wall). Output port 1: the
 * control net. Output port 2: a table, one row a patch: `PatchId`, `Shell`, `Points`, `RMS`, `Max`
 * (world units, of the points that count), `MinJacobian` (smallest |Su x Sv| over its mean,
 * negative where folded). Field data of ports 0 and 2: `RMS`, `Max`, `MaxNormalJump` (degrees,
 * inside a shell), `FoldedPatches`, `Unknowns`, `OpenEnds`, `MinimumWall`, `Seconds`, and one value
 * a shell of `Shells`, `DataWeight` (K), `RobustScale`, `Outliers`; `Message`. With Rational the
 * report has the columns `MeanBefore`, `Mean` (mean distance of the patch's points without and with
 * weights), `LeastWeight`, `LargestWeight`, `Generations`, `SegmentsU`, `SegmentsV`, and field data
 * `Convergence` (best fitness after each generation, mean over the patches), `WeightSeconds`,
 * `PatchesAboveTolerance`.
 *
 * Reference: H. Mosbach et al., paper 000, section 4.
 *
 * @warning The shells share one layout: points of the inner wall must have been put on quads of the
 * outer one.
 * @sa vtkPartitionToQuads vtkQuadRemesh vtkSplineSample vtkSplineDeviation
 */

#ifndef vtkBSplineG1Fit_h
#define vtkBSplineG1Fit_h

#include "BSplineReconstructionFiltersModule.h"

#include <vtkPolyDataAlgorithm.h>

#include <string>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkBSplineG1Fit : public vtkPolyDataAlgorithm
{
public:
  static vtkBSplineG1Fit* New();
  vtkTypeMacro(vtkBSplineG1Fit, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Continuities
  {
    FULL_G1 = 0,
    VERTEX_G1,
    C0_REDUCTION,
    C0_MULTIPLIERS
  };
  enum Corrections
  {
    TAYLOR = 0,
    NEWTON
  };
  enum Ends
  {
    AUTOMATIC = 0,
    KEEP_CLOSED
  };
  enum Optimizers
  {
    NO_WEIGHTS = 0,
    EVOLUTION_STRATEGY,
    DETERMINISTIC,
    CONTROL_POINTS
  };

  ///@{
  /// How patches meet. FULL_G1 (default) uses all nets with continuous tangent planes, VERTEX_G1
  /// one unknown a layout vertex (equation 8), C0_REDUCTION and C0_MULTIPLIERS only close gaps
  /// (equations 7 and 6).
  vtkSetClampMacro(Continuity, int, FULL_G1, C0_MULTIPLIERS);
  vtkGetMacro(Continuity, int);
  ///@}

  ///@{
  /// Polynomial segments a side of a patch: 2 n + 2 control points. Default 3, from 3 to 16.
  vtkSetMacro(SegmentsPerSide, int);
  vtkGetMacro(SegmentsPerSide, int);
  ///@}

  ///@{
  /// Share of the fairing in each pass, between 0 and 1 exclusive. Default 0.9, 0.5, 0.1.
  vtkSetVector3Macro(Fairing, double);
  vtkGetVector3Macro(Fairing, double);
  ///@}

  ///@{
  /// How the points' parameters are corrected between passes. Default TAYLOR, as good as NEWTON.
  vtkSetClampMacro(ParameterCorrection, int, TAYLOR, NEWTON);
  vtkGetMacro(ParameterCorrection, int);
  ///@}

  ///@{
  /// AUTOMATIC (default) opens the ends that `EndRegion` marks or, without that array, those that
  /// the outer points do not cover; KEEP_CLOSED fits all quads.
  vtkSetClampMacro(OpenEnds, int, AUTOMATIC, KEEP_CLOSED);
  vtkGetMacro(OpenEnds, int);
  ///@}

  ///@{
  /// Number of points a patch that the data count as against the fairing, whatever their real
  /// number; 30 to 300 for CT surfaces, 10 000 and more for clean points. Default 0: from the
  /// noise.
  vtkSetMacro(DataWeight, double);
  vtkGetMacro(DataWeight, double);
  ///@}

  ///@{
  /// Degrees: sides of patches along which the points have a sharper edge stay sharp (FULL_G1
  /// only); the layout must run along such edges (FeatureAngle of vtkQuadRemesh). Default 180:
  /// none.
  vtkSetMacro(CreaseAngle, double);
  vtkGetMacro(CreaseAngle, double);
  ///@}

  ///@{
  /// With DataWeight 0: the points' roughness extends over neighbors, as that of CT surfaces does;
  /// switch it off for clean scans, which are then followed more closely. Default on.
  vtkSetMacro(CorrelatedNoise, bool);
  vtkGetMacro(CorrelatedNoise, bool);
  vtkBooleanMacro(CorrelatedNoise, bool);
  ///@}

  ///@{
  /// Weigh outliers (debris, pits) down. Default on.
  vtkSetMacro(RobustWeights, bool);
  vtkGetMacro(RobustWeights, bool);
  vtkBooleanMacro(RobustWeights, bool);
  ///@}

  ///@{
  /// Let points move on to neighboring patches. Default on; off as in the paper.
  vtkSetMacro(MovePoints, bool);
  vtkGetMacro(MovePoints, bool);
  vtkBooleanMacro(MovePoints, bool);
  ///@}

  ///@{
  /// Point array of weights; empty (default) or "None": all 1.
  void SetWeightArray(const char* name);
  const char* GetWeightArray() const { return this->WeightArray.c_str(); }
  ///@}

  ///@{
  /// Give the patches weights (NURBS) after the fit, and refine them where Tolerance is missed.
  /// Default off.
  vtkSetMacro(Rational, bool);
  vtkGetMacro(Rational, bool);
  vtkBooleanMacro(Rational, bool);
  ///@}

  ///@{
  /// How weights are found: NO_WEIGHTS (all 1), EVOLUTION_STRATEGY (paper 003, section 5.1) or
  /// DETERMINISTIC (separable least squares, default); CONTROL_POINTS: weights stay 1, the control
  /// points are fitted again as with the others.
  vtkSetClampMacro(Optimizer, int, NO_WEIGHTS, CONTROL_POINTS);
  vtkGetMacro(Optimizer, int);
  ///@}

  ///@{
  /// Evolution strategy: parents (gamma, default 10, at least 2), descendants a generation (mu,
  /// default 50), generations at most (default 100). Seed (default 0) makes runs reproducible.
  vtkSetClampMacro(Parents, int, 2, 1000);
  vtkGetMacro(Parents, int);
  vtkSetClampMacro(Offspring, int, 1, 10000);
  vtkGetMacro(Offspring, int);
  vtkSetClampMacro(Generations, int, 0, 100000);
  vtkGetMacro(Generations, int);
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /// With Rational: largest mean distance of a patch's points, in world units (delta of paper 003,
  /// equation 2). Patches above it are refined: the segments of their strips are cut in two or
  /// four. Default 0: none.
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Quads a side of a polynomial piece in the surface of port 0. Default 4, from 1 to 64.
  vtkSetClampMacro(Resolution, int, 1, 64);
  vtkGetMacro(Resolution, int);
  ///@}

protected:
  vtkBSplineG1Fit();
  ~vtkBSplineG1Fit() override = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkBSplineG1Fit(const vtkBSplineG1Fit&) = delete;
  void operator=(const vtkBSplineG1Fit&) = delete;

  int Continuity = FULL_G1;
  int SegmentsPerSide = 3;
  double Fairing[3] = {0.9, 0.5, 0.1};
  int ParameterCorrection = TAYLOR;
  int OpenEnds = AUTOMATIC;
  double DataWeight = 0.0;
  double CreaseAngle = 180.0;
  bool CorrelatedNoise = true;
  bool RobustWeights = true;
  bool MovePoints = true;
  std::string WeightArray;
  bool Rational = false;
  int Optimizer = DETERMINISTIC;
  int Parents = 10;
  int Offspring = 50;
  int Generations = 100;
  int Seed = 0;
  double Tolerance = 0.0;
  int Resolution = 4;
};

#endif
