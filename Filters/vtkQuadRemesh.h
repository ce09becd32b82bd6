/**
 * @class vtkQuadRemesh
 * @brief coarse pure-quad layout of a dense triangle surface
 *
 * vtkQuadRemesh lays some hundred quads over a closed or open triangle surface of any genus: the
 * patches of a spline model. The surface is decimated (quadric edge collapse that keeps
 * topology), a cross field that follows curvature and region borders is integrated to an
 * integer grid, and the grid's cells become the quads; where that gives no valid layout, pairs of
 * coarse triangles are split into quads instead. The layout is always an oriented 2-manifold
 * of the input's Euler characteristic and boundary loops, without doublets (vertices of two quads),
 * or there is one error.
 *
 * Unlike the decimation filters of VTK, which give triangles, the output is made of quads only.
 *
 * Method MORSE_SMALE takes the Morse-Smale complex of an eigenfunction of the Laplace-Beltrami
 * operator instead: maxima, minima and saddles are joined by paths up and down, each cell between
 * them is a quad. The eigenfunction is chosen by NumberOfQuads, or by its place in the spectrum;
 * noise is cancelled by persistence, degenerate cells are mended. Boundaries are kept; regions and
 * sharp edges are not followed.
 *
 * Region borders of the array RegionArray (of cells or points) become closed rows of quad edges
 * that follow the border; so do boundaries and edges sharper than FeatureAngle.
 *
 * Any surface is taken: polygons and strips are triangulated, faces that name a point twice or are
 * repeated are dropped, edges of three or more faces and vertices of several fans are taken apart,
 * coincident points at boundaries are merged, faces are oriented alike, and components smaller than
 * SmallestComponent are dropped. Each repair is counted in `Repairs` and shown on output port 2.
 *
 * Output port 0: quads (vtkPolyData) and
 * - cell array `ScaledJacobian` (Float64): worst corner of each quad, 1 for a rectangle;
 * - cell array RegionArray (Int32), where the input has it;
 * - point array `Valence` (Int32): edges at each vertex;
 * - field arrays `Irregular` (interior vertices of a valence other than 4), `ValenceCounts` (10
 *   components: interior vertices of valence 0, 1 ... 8, 9 and more), `EulerCharacteristic`,
 *   `BoundaryLoops`, `Components`, `MinimumQuads` (a lower bound by topology), `Hausdorff` (largest
 *   distance between surface and layout, both ways, in world units), `MeanDistance`,
 *   `MinScaledJacobian`, `MeanScaledJacobian`, `FlippedQuads`, `MeanAngleDeviation` and
 *   `MaxAngleDeviation` (degrees), `LayoutStage` (per component: 0 parametrized, 1 paired
 *   triangles, 2 Morse-Smale), `FollowedFeatures` (per component: 0 all creases, 1 sharp edges are
 *   given up, as they leave no room for NumberOfQuads, 2 region borders, too; above 0 with a
 *   warning), `StageSeconds` (Repair, Decimation, Layout, Measure), `Repairs` (MergedPoints,
 * DegenerateFaces, DuplicateFaces, TurnedFaces, SplitVertices, CutEdges, Specks), `Seconds`; method
 * MORSE_SMALE, per component: `EigenfunctionTaken` (place in the spectrum), `Eigenvalue`, `Minima`,
 * `Saddles`, `Maxima`, `MorseCells` (before mending), `CancelledPairs`, `CellSubdivisions` (1:
 * every cell was cut in 2 x 2, as there was no valid layout without).
 *
 * Output port 1: the triangle surface the layout was found on (repaired and decimated;
 * MORSE_SMALE: remeshed evenly and cut along the paths), and with MORSE_SMALE
 * - cell array `Cell` (Int32): the cell of each triangle, from 0;
 * - point array `Eigenfunction` (Float64): the function, largest absolute value 1;
 * - point array `Critical` (UInt8): 0 regular, 1 minimum, 2 saddle, 3 maximum.
 *
 * Output port 2: the triangles of the input and the cell array `Repair` (UInt8), a sum of: 1
 * dropped, names a point twice; 2 dropped, repeated; 4 turned over; 8 a corner merged with a
 * coincident point; 16 a corner got a point of its own; 32 at an edge of three or more faces; 64
 * dropped with its component; 0: untouched.
 *
 * Reference: H. Mosbach et al., paper 000, section 2; D. Bommes, H. Zimmer and L. Kobbelt,
 * Mixed-integer quadrangulation, ACM Trans. Graph. 28 (2009); J. Huang et al., QuadriFlow, Comput.
 * Graph. Forum 37 (2018); S. Dong et al., Spectral surface quadrangulation, SIGGRAPH 2006; J. W.
 * Branch et al., paper 003, section 3.
 *
 * @warning One-sided surfaces, surfaces without area and triangles of non-finite points are errors.
 * @sa vtkPartitionToQuads vtkBSplineG1Fit
 */

#ifndef vtkQuadRemesh_h
#define vtkQuadRemesh_h

#include "BSplineReconstructionFiltersModule.h"

#include <vtkPolyDataAlgorithm.h>

#include <string>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkQuadRemesh : public vtkPolyDataAlgorithm
{
public:
  static vtkQuadRemesh* New();
  vtkTypeMacro(vtkQuadRemesh, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Methods
  {
    FIELD_ALIGNED = 0,
    MORSE_SMALE = 1
  };

  enum Sizings
  {
    UNIFORM = 0,
    SIZE_BY_CURVATURE = 1,
    SIZE_BY_ARRAY = 2
  };

  ///@{
  /// How the layout is found. Default: FIELD_ALIGNED.
  vtkSetClampMacro(Method, int, FIELD_ALIGNED, MORSE_SMALE);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /// Number of quads asked for, all components together; met within about 10 % where the
  /// topology allows. Default 500, from 6 to 200000.
  vtkSetMacro(NumberOfQuads, int);
  vtkGetMacro(NumberOfQuads, int);
  ///@}

  ///@{
  /// Edges where the normals turn by more than this many degrees become quad edges. Default 180:
  /// none.
  vtkSetMacro(FeatureAngle, double);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /// How large quads are where: alike (smaller only where the surface bends over the length of a
  /// quad), by the root of the radius of curvature, or in proportion to the point array SizeArray.
  /// Default: UNIFORM.
  vtkSetClampMacro(Sizing, int, UNIFORM, SIZE_BY_ARRAY);
  vtkGetMacro(Sizing, int);
  ///@}

  ///@{
  /// Point array of relative sides of quads, above 0, for SIZE_BY_ARRAY. Default "" (none).
  vtkSetMacro(SizeArray, std::string);
  vtkGetMacro(SizeArray, std::string);
  ///@}

  ///@{
  /// Components of less area than so many mean quads are dropped as specks (never the largest).
  /// Default 0.01; 0: only those without area.
  vtkSetMacro(SmallestComponent, double);
  vtkGetMacro(SmallestComponent, double);
  ///@}

  ///@{
  /// FIELD_ALIGNED: irregular vertices and the points around move over the surface, and edges at
  /// them are turned, where a bicubic patch in each quad then fits the surface better. Default off.
  vtkSetMacro(FitMoves, bool);
  vtkGetMacro(FitMoves, bool);
  vtkBooleanMacro(FitMoves, bool);
  ///@}

  ///@{
  /// FIELD_ALIGNED: points leave the surface by up to 0.15 of an edge where the bilinear patches
  /// then fit it better; the mean distance falls to about a half. Default on.
  vtkSetMacro(FitRelaxation, bool);
  vtkGetMacro(FitRelaxation, bool);
  vtkBooleanMacro(FitRelaxation, bool);
  ///@}

  ///@{
  /// Varies what is arbitrary; the same seed gives the same layout. Default 0.
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /// MORSE_SMALE: the place of the eigenfunction in the spectrum, from 1; NumberOfQuads then has no
  /// say. Default 0: the function that gives the best layout of about NumberOfQuads.
  vtkSetMacro(Eigenfunction, int);
  vtkGetMacro(Eigenfunction, int);
  ///@}

  ///@{
  /// MORSE_SMALE: extrema that stand out less than this share of the function's range are noise and
  /// are cancelled. Default 0.01, from 0 to below 1.
  vtkSetMacro(Persistence, double);
  vtkGetMacro(Persistence, double);
  ///@}

  ///@{
  /// Cell or point array of regions whose borders become rows of quad edges, used if the input has
  /// it. Default "EndRegion".
  vtkSetMacro(RegionArray, std::string);
  vtkGetMacro(RegionArray, std::string);
  ///@}

protected:
  vtkQuadRemesh();
  ~vtkQuadRemesh() override = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkQuadRemesh(const vtkQuadRemesh&) = delete;
  void operator=(const vtkQuadRemesh&) = delete;

  int Method = FIELD_ALIGNED;
  int NumberOfQuads = 500;
  double FeatureAngle = 180.0;
  int Sizing = UNIFORM;
  std::string SizeArray;
  double SmallestComponent = 0.01;
  bool FitMoves = false;
  bool FitRelaxation = true;
  int Seed = 0;
  int Eigenfunction = 0;
  double Persistence = 0.01;
  std::string RegionArray = "EndRegion";
};

#endif
