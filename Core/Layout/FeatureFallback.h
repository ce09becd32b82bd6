#pragma once

#include "Layout/FieldLayout.h"

namespace bsr
{
/// Which creases of a component its layout follows. Creases that leave no room for the number of
/// quads asked for are given up, sharp edges first.
enum class FollowedFeatures
{
  All = 0,     ///< sharp edges and region borders, as far as there are any
  Regions = 1, ///< sharp edges are given up
  None = 2     ///< region borders, too
};

/// Gives up creases that are too long for so many quads (of a noisy surface, nearly all edges are
/// sharp), so that they do not hinder decimation.
FollowedFeatures dropHopelessCreases(TriangleSurface& s, int quads);

/**
 * fieldLayout of a surface with creases: the first that is not folded, has no vertex of more than 8
 * edges and is within 10 % of the count, of those that follow all creases, region borders only, and
 * boundaries only (whose quads are all of region 0: takeRegions).
 * \param least the fewest quads that the topology allows
 * \param followed set where creases are given up
 */
Result<FieldLayout> layoutOfFeatures(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, const FieldLayoutOptions& options, int least, FollowedFeatures& followed,
  Monitor& monitor);

/// Gives each quad the region of the triangle of `mesh` that is nearest to its middle.
void takeRegions(QuadMesh& quads, const TriangleMesh& mesh);
} // namespace bsr
