#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/Meshes.h"

#include <cstdint>
#include <string>
#include <vector>

namespace bsr
{
/// An open end of a hollow object's lumen, in the units of the surface.
struct EndMouth
{
  Vec3 Center;
  Vec3 Direction; ///< outwards
  double Radius = 0.0;
};

/// A fiber's raw surface; no triangles: not known.
struct FiberWall
{
  TriangleMesh Surface;
  /// Of each vertex: 0 outer wall, 1 inner wall, others neither.
  std::vector<std::uint8_t> Side;
};

struct FiberEnds
{
  /// The surface, its triangles split along the rims and moved there; Region 0 is the body, k the
  /// k-th end.
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
 * the search repeated. A smooth closed curve is fitted along it, in which webs of the surface over
 * debris count little. Where `wall`, the fiber's raw surface, is given, places far from its walls
 * are such webs and are no rim, and the curve is moved to where the raw outer wall ends
 * (rimOnWall()). A function that is zero on that curve, positive on the end's side of the 45 degree
 * cone through it, is cut at zero: triangles are split, vertices close to the curve taken as they
 * are. The surface within half a mouth's radius is then moved to the curve, by at most a fifth of
 * that radius: the rims are smooth, however rough the wall.
 *
 * A mouth is left out (Note says why) unless its region is one disc with one simple loop around
 * it, apart from the others.
 */
Result<FiberEnds> findFiberEnds(const TriangleMesh& closedSurface,
  const std::vector<EndMouth>& mouths, const FiberWall& wall, Monitor& monitor);
} // namespace bsr
