#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/FeatureFallback.h"
#include "Layout/LeastQuads.h"
#include "Layout/MorseLayout.h"
#include "Mesh/BuildSurface.h"

namespace bsr
{
/// How a layout is found.
enum class LayoutMethod
{
  FieldAligned = 0, ///< integer-grid map of a cross field, or paired triangles
  MorseSmale = 1    ///< Morse-Smale complex of a Laplacian eigenfunction
};

struct QuadRemeshOptions
{
  LayoutMethod Method = LayoutMethod::FieldAligned;
  int NumberOfQuads = 500;     ///< of all components together
  double FeatureAngle = 180.0; ///< degrees; sharper edges become quad edges, 180: none
  int Seed = 0;                ///< varies what is arbitrary; the same seed gives the same layout
  QuadSizing Sizing = QuadSizing::Uniform;
  std::vector<double> SizeField; ///< QuadSizing::Array: relative side per point of the mesh, > 0
  /// Components of less area than so many mean quads are dropped as specks; 0: none is.
  double SmallestComponent = 0.01;
  bool FitMoves = false;     ///< irregular vertices and edges move where patches then fit better
  bool FitRelaxation = true; ///< points leave the surface where patches then fit it better
  int Eigenfunction = 0;     ///< Morse-Smale: place in the spectrum, from 1; 0: automatic
  double Persistence = 0.01; ///< Morse-Smale: noise, as a share of the function's range
};

/// Seconds of wall time, by stage, all components together.
struct LayoutSeconds
{
  double Repair = 0.0;
  double Decimation = 0.0;
  double Layout = 0.0;  ///< sizing, field, map, extraction, relaxation
  double Measure = 0.0; ///< checks and distances
};

struct QuadLayout
{
  QuadMesh Mesh;
  LayoutReport Report;
  LayoutDistance Distance;                ///< in world units, to the input
  std::vector<LayoutStage> Stages;        ///< per component of the input
  std::vector<FollowedFeatures> Followed; ///< per component
  RepairReport Repairs;
  LayoutSeconds Seconds;
  int MinimumQuads = 0;           ///< leastQuads of all components together
  std::vector<MorseReport> Morse; ///< per component, method MorseSmale only
  /// The surface the layout was found on. Method MorseSmale: cut along the paths of the complex;
  /// FieldAligned: repaired and decimated, without cells and function.
  PartitionedSurface Surface;
};

/// InvalidParameter, with the range allowed, where an option is absurd.
Status checkOptions(const QuadRemeshOptions& options);

/**
 * A coarse pure-quad layout of a triangle surface.
 *
 * Each connected component gets quads in proportion to its area (as many as its topology needs at
 * least). The layout is always an oriented 2-manifold with the Euler characteristic and the
 * boundary loops of the (repaired) input, without doublets, or an error is returned. Region
 * borders and boundaries become rows of quad edges; regions are passed on. The method MorseSmale
 * follows boundaries, but neither regions nor sharp edges.
 */
Result<QuadLayout> quadRemesh(
  const TriangleMesh& mesh, const QuadRemeshOptions& options, Monitor& monitor);
} // namespace bsr
