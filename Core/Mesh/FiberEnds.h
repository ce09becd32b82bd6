#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/Meshes.h"

#include <string>

namespace bsr
{
/// An open end of a hollow object's lumen, in the units of the surface.
struct EndMouth
{
  Vec3 Center;
  Vec3 Direction; ///< outwards
  double Radius = 0.0;
};

struct FiberEnds
{
  /// The surface, its triangles split along the rims; Region 0 is the body, k the k-th end.
  TriangleMesh Surface;
  /// The closed loop of vertices around each end, counter-clockwise seen from outside.
  std::vector<std::vector<Index>> Rims;
  /// Why mouths were left out; empty when none was.
  std::string Note;
};

/**
 * Cuts the end discs of a fiber out of its closed surface: for each mouth of the lumen the cap over
 * it together with the fiber's annular end face, up to the convex rim where the outer wall begins.
 *
 * Around the axis of the mouth the rim is sought in every direction as the surface's outermost
 * point under 45 degrees between axis and radius; the axis is then turned to the rim's plane and
 * the search repeated. A smooth function that is zero on the rim, positive on the end's side of
 * the 45 degree cone through it, is cut at zero: triangles are split, vertices close to the rim
 * taken as they are.
 *
 * A mouth is left out (Note says why) unless its region is one disc with one simple loop around
 * it, apart from the others.
 */
Result<FiberEnds> findFiberEnds(
  const TriangleMesh& closedSurface, const std::vector<EndMouth>& mouths, Monitor& monitor);
} // namespace bsr
