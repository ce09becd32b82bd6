#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"
#include "Layout/Sizing.h"
#include "Mesh/BuildSurface.h"

namespace bsr
{
struct QuadRemeshOptions
{
  int NumberOfQuads = 500;     ///< of all components together
  double FeatureAngle = 180.0; ///< degrees; sharper edges become quad edges, 180: none
  int Seed = 0;                ///< varies what is arbitrary; the same seed gives the same layout
  QuadSizing Sizing = QuadSizing::Uniform;
  std::vector<double> SizeField; ///< QuadSizing::Array: relative side per point of the mesh, > 0
};

/// Which road gave the layout of a component.
enum class LayoutStage
{
  Parametrized = 0, ///< integer-grid map of a cross field
  Paired = 1        ///< pairs of coarse triangles, split: the fallback
};

struct QuadLayout
{
  QuadMesh Mesh;
  LayoutReport Report;
  LayoutDistance Distance;         ///< in world units, to the input
  std::vector<LayoutStage> Stages; ///< per component of the input
  RepairReport Repairs;
};

/**
 * A coarse pure-quad layout of a triangle surface.
 *
 * Each connected component gets quads in proportion to its area (as many as its topology needs at
 * least). The layout is always an oriented 2-manifold with the Euler characteristic and the
 * boundary loops of the (repaired) input, without doublets, or an error is returned. Region
 * borders and boundaries become rows of quad edges; regions are passed on.
 */
Result<QuadLayout> quadRemesh(
  const TriangleMesh& mesh, const QuadRemeshOptions& options, Monitor& monitor);
} // namespace bsr
