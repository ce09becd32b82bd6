/**
 * @class vtkBranchedContourSurface
 * @brief one smooth B-spline surface through closed contours that split and merge
 *
 * vtkBranchedContourSurface makes the disjoint B-spline surface of paper 002 from a stack of closed
 * contours: all slices have the same columns of control points; where one contour (the stem) goes
 * over into several (the branches), its columns are divided among them, and inserted slices lead
 * from one to the other. The arrangement that the paper leaves to the reader is found by itself:
 * which contours belong together, start points and numbers of columns, which part of the stem
 * belongs to which branch, place and shape of the inserted slices, and the kind of junction. Any
 * number of branches, splits and merges, and several levels are possible.
 *
 * With Tangency IN_SPACE (default) the tangent planes agree everywhere, at the crotch too, for any
 * orders. AS_PUBLISHED makes the paper's junctions, which are smooth along the parameter lines but
 * creased or cusped in space next to the crotch; the report says how much.
 *
 * Input port 0: polylines or polygons (vtkPolyData), see SliceArray and ComponentArray.
 *
 * Output port 0: a surface for the eye, with the exact model in its field data (`SplinePatches`,
 * `SplineControlPoints`, `SplineKnots`, `SplineNeighbors`, `SplineVersion`); point arrays
 * `Normals`, `UV`; cell arrays `PatchId`, `Shell` (0 outer, 1 contours that are holes). Output port
 * 1: the control net. Output port 2: a table, one row a patch: `PatchId`, `Shell`, `Points`,
 * `RMS`, `Max` (of the contours' points nearest to it, world units), `MinJacobian`, `NormalJump`
 * (degrees, largest along its sides), `Tube`, `Cap` (0 lower, 1 upper end, -1 none), `Component`.
 * Field data of ports 0 and 2: `RMS`, `Max`, `MaxNormalJump` (degrees), `JunctionNormalJump` (of
 * the patches at junctions), `FoldedPatches`, `Tubes`, `Junctions`, `OpenSides`,
 * `ResliceThere` and `ResliceBack` (50, 75, 90, 95, 99 % and largest distance of the contours from
 * the model cut by their planes, and back), `LeftOutContours` (polyline) with `LeftOutReasons`,
 * `Seconds`.
 *
 * Reference: A. D. Bhatt, A. Goel, U. Gupta, S. Awasthi, Reconstruction of Branched Surfaces:
 * Experiments with Disjoint B-spline Surface, Computer-Aided Design and Applications 2014.
 *
 * @warning Open contours are left out (and named); vtkContourSkin takes them.
 * @sa vtkContourSkin vtkSplineSample vtkSplineDeviation
 */

#ifndef vtkBranchedContourSurface_h
#define vtkBranchedContourSurface_h

#include "BSplineReconstructionFiltersModule.h"

#include <vtkPolyDataAlgorithm.h>

#include <string>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkBranchedContourSurface : public vtkPolyDataAlgorithm
{
public:
  static vtkBranchedContourSurface* New();
  vtkTypeMacro(vtkBranchedContourSurface, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Junctions
  {
    AUTOMATIC = 0,
    SUPERIMPOSED_C0,
    SHARED_EDGE_G1,
    ASYMMETRIC
  };
  enum Tangencies
  {
    IN_SPACE = 0,
    AS_PUBLISHED
  };
  enum KnotKinds
  {
    PERIODIC = 0,
    UNIFORM
  };
  enum Caps
  {
    INSIDE_STACK = 0,
    ALL_ENDS,
    NO_ENDS
  };

  ///@{
  /// Order (degree + 1) along the contours and from slice to slice. Default 3, OrderU from 3 to 8,
  /// OrderV to 5.
  vtkSetMacro(OrderU, int);
  vtkGetMacro(OrderU, int);
  vtkSetMacro(OrderV, int);
  vtkGetMacro(OrderV, int);
  ///@}

  ///@{
  /// How branches join the stem. SUPERIMPOSED_C0: section 5.1, without a common tangent plane;
  /// SHARED_EDGE_G1: section 5.2, opening about the middle of a common edge; ASYMMETRIC: section 6,
  /// opening about any point between the branches. AUTOMATIC (default): the one of the two that
  /// suits each junction.
  vtkSetClampMacro(Junction, int, AUTOMATIC, ASYMMETRIC);
  vtkGetMacro(Junction, int);
  ///@}

  ///@{
  /// Where tangent planes agree: IN_SPACE (default) or only in the parameters, AS_PUBLISHED.
  vtkSetClampMacro(Tangency, int, IN_SPACE, AS_PUBLISHED);
  vtkGetMacro(Tangency, int);
  ///@}

  ///@{
  /// Knots from slice to slice at open ends (section 7). UNIFORM (default): the surface starts at
  /// the first slice; PERIODIC: simple knots throughout.
  vtkSetClampMacro(Knots, int, PERIODIC, UNIFORM);
  vtkGetMacro(Knots, int);
  ///@}

  ///@{
  /// The contours are data to pass through (default); off: they are control polygons.
  vtkSetMacro(Interpolate, bool);
  vtkGetMacro(Interpolate, bool);
  vtkBooleanMacro(Interpolate, bool);
  ///@}

  ///@{
  /// Which ends are closed by smooth caps: those inside the stack, where the next slice has no
  /// contour to go on with (INSIDE_STACK, default), all, or none.
  vtkSetClampMacro(EndCaps, int, INSIDE_STACK, NO_ENDS);
  vtkGetMacro(EndCaps, int);
  ///@}

  ///@{
  /// Columns of control points of a contour; 0 (default): as its shape needs. Rounded up to what
  /// the junctions allow.
  vtkSetMacro(PointsPerSection, int);
  vtkGetMacro(PointsPerSection, int);
  ///@}

  ///@{
  /// Height of the crotch between the branches' slice (0) and the stem's (1), exclusive; 0
  /// (default): from the distance of the branches and the width of the stem.
  vtkSetMacro(JunctionPosition, double);
  vtkGetMacro(JunctionPosition, double);
  ///@}

  ///@{
  /// Cell arrays that give each polyline's slice, and the component it belongs to (negative:
  /// automatic, -2: left out); empty (default) or "None": found.
  void SetSliceArray(const char* name);
  const char* GetSliceArray() const { return this->SliceArray.c_str(); }
  void SetComponentArray(const char* name);
  const char* GetComponentArray() const { return this->ComponentArray.c_str(); }
  ///@}

  ///@{
  /// How contours of neighboring slices are linked, see vtkContourStack: least common area over
  /// the smaller one (0.1), farthest gap in mean diameters of those that overlap none (0.5).
  vtkSetMacro(MinimumOverlap, double);
  vtkGetMacro(MinimumOverlap, double);
  vtkSetMacro(MatchDistance, double);
  vtkGetMacro(MatchDistance, double);
  ///@}

  ///@{
  /// Contours closer than this along the axis are one slice, world units; 0 (default): automatic.
  vtkSetMacro(PlaneTolerance, double);
  vtkGetMacro(PlaneTolerance, double);
  ///@}

  ///@{
  /// Quads a side of a polynomial piece in the surface of port 0. Default 4, from 1 to 64.
  vtkSetClampMacro(Resolution, int, 1, 64);
  vtkGetMacro(Resolution, int);
  ///@}

protected:
  vtkBranchedContourSurface();
  ~vtkBranchedContourSurface() override = default;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkBranchedContourSurface(const vtkBranchedContourSurface&) = delete;
  void operator=(const vtkBranchedContourSurface&) = delete;

  int OrderU = 3;
  int OrderV = 3;
  int Junction = AUTOMATIC;
  int Tangency = IN_SPACE;
  int Knots = UNIFORM;
  bool Interpolate = true;
  int EndCaps = INSIDE_STACK;
  int PointsPerSection = 0;
  double JunctionPosition = 0.0;
  std::string SliceArray;
  std::string ComponentArray;
  double MinimumOverlap = 0.1;
  double MatchDistance = 0.5;
  double PlaneTolerance = 0.0;
  int Resolution = 4;
};

#endif
