/**
 * @class vtkContourSkin
 * @brief one smooth B-spline surface over a stack of contours that split and merge
 *
 * vtkContourSkin lays a bicubic C2 tensor-product B-spline surface over every connected part of a
 * stack of contours. As in paper 004 the part is read as a pair of trousers flattened into one grid
 * of data points: the lowest contour of each leg is the core of its part of the grid, each next
 * contour the rectangular ring around it, the contours of the base the rings around all legs. So
 * one patch covers legs, crotch and base, and the legs' ends close convexly. Planes, order,
 * orientation, correspondence, branching and the arrangement are found from the polylines, for any
 * number of legs of any length, on several levels, above or below the base. Parts that are closed
 * at both ends or have legs on both sides become tubes and junctions of patches with
 * continuous tangent planes, so do parts where one patch folds or misses the tolerance. Contours
 * inside others (canals) get surfaces of their own, with normals into the canal.
 *
 * The number of control points grows where the surface misses its data, until the Tolerance is met
 * or the ControlPointLimit reached.
 *
 * Input: polylines or polygons, a few or many of them a plane, closed or open, in any order and
 * orientation; loose segments are joined. SliceArray and ComponentArray (cell arrays, one integer
 * component) override what is found: contours of equal SliceArray value are one slice; only
 * contours of equal ComponentArray value are linked (negative: automatic, -2: left out).
 *
 * Output port 0: a surface for the eye, with the exact model in its field data (`SplinePatches`,
 * `SplineControlPoints`, `SplineKnots`, `SplineNeighbors`, `SplineVersion`); point arrays
 * `Normals`, `UV`; cell arrays `PatchId`, `Shell` (0 outer, 1 canal). Output port 1: the control
 * net. Output port 2: the report, a table with one row a surface: `Component`, `Shell`, `Contours`,
 * `Closed`, `SinglePatch`, `FirstPatch`, `Patches`, `Rows`, `Columns` (of the data set),
 * `ControlPointsU`, `ControlPointsV`, `Tolerance`, `Reached`, `TotalError` (eq. 12), `AverageError`
 * (eq. 13, squared length), `AverageErrorPerControlPoint` (the number that table 2 of the paper
 * gives), `RMS`, `Max` (distances of the contours from the surface), `ResliceRMS`, `ResliceMax`
 * (the surface cut by the contours' planes against the contours), `PointSpacing` (median, of the
 * contours), `SecondDerivativeJump` (largest jump across a knot over the largest second derivative:
 * 0 is C2), `NormalJump` (degrees, between patches of tubes), `EndHeight` (of the highest end
 * of a leg beyond its last contour, in slice distances), `ConvexShare` (of the points that close a
 * leg, the worst leg), `SignChangesData`, `SignChangesModel` (of the curvature along the contours
 * and along the surface there), `FoldedPatches`. Field data of ports 0 and 2: `RMS`, `Max`,
 * `AverageError`, `ResliceRMS`, `MaxNormalJump`, `FoldedPatches`, `Seconds`, `Message`.
 *
 * Output port 3: the cleaned contours of the stack with the cell arrays `Slice`, `SlicePosition`,
 * `Closed`, `Level`, `Inside`, `Component`, `Branch`, `LinksBelow`, `LinksAbove`, `Source`,
 * `Message` (string: what could not be done with this contour) and the field arrays `ContourLinks`,
 * `LinkOverlap`, `DroppedContours`, `DroppedReasons`. Output port 4: the graph: a line for each
 * link from center to center, a vertex for each contour.
 *
 * Reference: H. S. Kim, Y. H. Kim, Y. H. Choe, S.-M. Kim, T.-S. Cho, J. H. Mun: A new modeling
 * method for objects with branching problem using non-uniform B-spline. ICCS 2004, LNCS 3039 (paper
 * 004).
 *
 * @warning At the four corners of a surface with an open base the border runs on smoothly, so the
 * parameter lines are almost parallel there.
 * @warning A leg that ends where the stack is cut is closed, too; the base is the only open end.
 * @sa vtkBranchedContourSurface vtkSplineSample vtkSplineDeviation
 */

#ifndef vtkContourSkin_h
#define vtkContourSkin_h

#include "BSplineReconstructionFiltersModule.h"

#include <vtkPolyDataAlgorithm.h>

#include <string>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkContourSkin : public vtkPolyDataAlgorithm
{
public:
  static vtkContourSkin* New();
  vtkTypeMacro(vtkContourSkin, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum ParameterMethods
  {
    RELAXED = 0,
    CHORD,
    CENTRIPETAL
  };
  enum Bases
  {
    BASE_AUTOMATIC = 0,
    BASE_OPEN,
    BASE_CLOSED
  };
  enum Layouts
  {
    LAYOUT_AUTOMATIC = 0,
    SINGLE_PATCH
  };

  ///@{
  /// The surface is refined until neither the average error of eq. 13 (squared world units) nor the
  /// RMS distance (world units) exceeds this. Default 0: a thousandth of the sections' mean
  /// diameter, but at least a tenth of the contours' point spacing.
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /// Close legs convexly, by less than one slice distance (default), or flat.
  vtkSetMacro(ConvexEnds, bool);
  vtkGetMacro(ConvexEnds, bool);
  vtkBooleanMacro(ConvexEnds, bool);
  ///@}

  ///@{
  /// Most control points of one surface. Default 4000, at least 16.
  vtkSetMacro(ControlPointLimit, int);
  vtkGetMacro(ControlPointLimit, int);
  ///@}

  ///@{
  /// Numbers of control points along u and v, instead of refinement. Default 0, 0: by refinement.
  vtkSetVector2Macro(ControlPoints, int);
  vtkGetVector2Macro(ControlPoints, int);
  ///@}

  ///@{
  /// CHORD: the paper's grid of data points with chord lengths averaged across its lines;
  /// CENTRIPETAL: with square roots of chord lengths, for sharp turns. RELAXED (default) starts
  /// from CHORD, rounds the rings, and moves each point's parameters to where the surface is
  /// nearest.
  vtkSetClampMacro(Parameters, int, RELAXED, CENTRIPETAL);
  vtkGetMacro(Parameters, int);
  ///@}

  ///@{
  /// Degree in both directions. Default 3, from 2 to 9.
  vtkSetMacro(Degree, int);
  vtkGetMacro(Degree, int);
  ///@}

  ///@{
  /// Whether the base's end is closed, too. BASE_AUTOMATIC (default): where its last contour
  /// shrinks to less than half the area of its neighbor, or ends inside the stack.
  vtkSetClampMacro(Base, int, BASE_AUTOMATIC, BASE_CLOSED);
  vtkGetMacro(Base, int);
  ///@}

  ///@{
  /// LAYOUT_AUTOMATIC (default): one patch where that meets the tolerance without a fold, else
  /// tubes of patches with continuous tangent planes. SINGLE_PATCH: always one patch, where the
  /// base is open.
  vtkSetClampMacro(Layout, int, LAYOUT_AUTOMATIC, SINGLE_PATCH);
  vtkGetMacro(Layout, int);
  ///@}

  ///@{
  /// Rows of a leg's core, x of eq. 7. Default 12, from 3 to 1000.
  vtkSetMacro(CorePoints, int);
  vtkGetMacro(CorePoints, int);
  ///@}

  ///@{
  /// Weight of the thin-plate fairing of RELAXED at the scale of one span. Default 0.001.
  vtkSetMacro(Fairing, double);
  vtkGetMacro(Fairing, double);
  ///@}

  ///@{
  /// Polynomial pieces a side of a patch of the model; the surface is handed on in blocks that
  /// meet exactly. Default 0: one patch, or the largest blocks of which a 25 x 25 grid of normals
  /// shows the shape.
  vtkSetMacro(PatchSpans, int);
  vtkGetMacro(PatchSpans, int);
  ///@}

  ///@{
  /// Contours whose planes are at most this far apart are one slice. Default 0: a twentieth of the
  /// typical distance of slices.
  vtkSetMacro(PlaneTolerance, double);
  vtkGetMacro(PlaneTolerance, double);
  ///@}

  ///@{
  /// Contours of neighboring slices are linked where they share this part of the smaller one's
  /// area. Default 0.1.
  vtkSetMacro(MinimumOverlap, double);
  vtkGetMacro(MinimumOverlap, double);
  ///@}

  ///@{
  /// Contours left without a partner are linked to the nearest such one within this many mean
  /// diameters. Default 0.5; 0: never.
  vtkSetMacro(MatchDistance, double);
  vtkGetMacro(MatchDistance, double);
  ///@}

  ///@{
  /// Cell arrays that override slices and correspondence; empty (default) or "None": automatic.
  void SetSliceArray(const char* name);
  const char* GetSliceArray() const { return this->SliceArray.c_str(); }
  void SetComponentArray(const char* name);
  const char* GetComponentArray() const { return this->ComponentArray.c_str(); }
  ///@}

  ///@{
  /// Quads a side of a polynomial piece in the surface of port 0. Default 4, from 1 to 64.
  vtkSetClampMacro(Resolution, int, 1, 64);
  vtkGetMacro(Resolution, int);
  ///@}

protected:
  vtkContourSkin();
  ~vtkContourSkin() override = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkContourSkin(const vtkContourSkin&) = delete;
  void operator=(const vtkContourSkin&) = delete;

  double Tolerance = 0.0;
  bool ConvexEnds = true;
  int ControlPointLimit = 4000;
  int ControlPoints[2] = {0, 0};
  int Parameters = RELAXED;
  int Degree = 3;
  int Base = BASE_AUTOMATIC;
  int Layout = LAYOUT_AUTOMATIC;
  int CorePoints = 12;
  double Fairing = 1e-3;
  int PatchSpans = 0;
  double PlaneTolerance = 0.0;
  double MinimumOverlap = 0.1;
  double MatchDistance = 0.5;
  std::string SliceArray;
  std::string ComponentArray;
  int Resolution = 4;
};

#endif
