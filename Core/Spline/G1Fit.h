#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Spline/ParameterCorrection.h"
#include "Spline/RationalStage.h"
#include "Spline/SplineModel.h"

#include <string>

namespace bsr
{
/// How the patches of the model meet (paper 000, section 4.3).
enum class Continuity
{
  FullG1,       ///< the whole G1 space on the layout
  VertexG1,     ///< one unknown a mesh vertex, eq. 8
  C0Reduction,  ///< eq. 7
  C0Multipliers ///< eq. 6
};

enum class OpenEnds
{
  Automatic, ///< quads with EndRegion > 0 are removed; without that array see CoverageEnds.h
  KeepClosed
};

/// Points that PartitionToQuads has put on quads.
struct PartitionedPoints
{
  std::vector<Vec3> Points;
  std::vector<Index> QuadId; ///< -1: on no quad, ignored
  std::vector<Vec2> UV;
  std::vector<std::uint8_t> Side; ///< 0 outer, 1 inner, others ignored; empty: all outer
  std::vector<double> Weights;    ///< empty: all 1
  std::vector<Vec3> Normals;      ///< of the surface they come from, of either sign; empty: unknown
  /// 1: on the boundary of the surface, with UV on a boundary side; it will follow. Empty: none.
  std::vector<std::uint8_t> Boundary;
  /// Closed curves, polylines, that the borders of open ends follow where they run along one;
  /// empty: borders are smooth curves through their vertices.
  std::vector<std::vector<Vec3>> Rims;
};

struct G1FitOptions
{
  Continuity Smoothness = Continuity::FullG1;
  int Segments = 3;
  std::vector<double> Fairing = {0.9, 0.5, 0.1};
  CorrectionMethod Correction = CorrectionMethod::Taylor;
  OpenEnds Ends = OpenEnds::Automatic;
  double DataWeight = 0.0; ///< K, points a patch that the data count as; 0: from the noise
  /// Degrees: sides of patches along which the points have a sharper edge stay sharp (FullG1 only);
  /// the layout must run along such edges. 180: none.
  double CreaseAngle = 180.0;
  /// With DataWeight 0: the points' roughness extends over neighbors, as that of CT surfaces does;
  /// off for clean scans, where what neighbors share is shape.
  bool CorrelatedNoise = true;
  bool Robust = true;   ///< weigh debris and pits down
  bool Reassign = true; ///< points may move on to neighboring patches
  /// Patches get weights, and are refined where they miss a tolerance (paper 003, section 5.1);
  /// its Lambda is that of the last pass.
  bool Rational = false;
  RationalOptions Weights;
};

struct PatchReport
{
  Shell Side = Shell::Outer;
  std::int64_t Points = 0; ///< data points that count (robust weight > 0)
  double Rms = 0.0;        ///< of their distances, world units
  double Max = 0.0;
  double MinJacobian = 1.0; ///< smallest |Su x Sv| over its mean; negative: folded
  int SegmentsU = 3;
  int SegmentsV = 3;
  PatchGain Gain; ///< of rational patches
};

struct ShellSummary
{
  std::int64_t Points = 0;
  std::int64_t Outliers = 0; ///< points without weight
  double Rms = 0.0;
  double Max = 0.0;
  double DataWeight = 0.0;
  double RobustScale = 0.0;
  /// Of rational patches: mean over the patches of the best fitness in each generation of the
  /// evolution strategy, and the seconds that the weights took.
  std::vector<double> Convergence;
  double WeightSeconds = 0.0;
};

struct G1FitResult
{
  SplineModel Model;
  std::vector<PatchReport> Patches; ///< in the order of the model's patches
  std::vector<ShellSummary> Shells; ///< outer, inner where fitted
  double Rms = 0.0;                 ///< of all counting points, world units
  double Max = 0.0;
  double MaxNormalJump = 0.0; ///< degrees, across sides that are no creases
  int CreaseEdges = 0;        ///< sides of patches that stay sharp
  int FoldedPatches = 0;
  int OpenEndCount = 0;
  std::int64_t Unknowns = 0;     ///< of one shell's system
  double MinimumWall = 0.0;      ///< between the shells, negative where they cross; 0 without inner
  int PatchesAboveTolerance = 0; ///< of the rational patches' mean distances
  std::string Message;           ///< what the user should know, e.g. that there is no inner shell
};

/// InvalidParameter, with the range allowed, where an option is absurd.
Status checkOptions(const G1FitOptions& options);

/**
 * Fits a network of bicubic patches, one a quad, to partitioned points: the whole of paper 000,
 * section 4, for the outer and, where points of it are given, the inner shell of a hollow body,
 * joined at open ends by ruled walls. A body of one shell only keeps its ends closed (there is
 * nothing to join), and the message says so.
 */
Result<G1FitResult> fitG1(const PartitionedPoints& points, const QuadMesh& quads,
  const G1FitOptions& options, Monitor& monitor);
} // namespace bsr
