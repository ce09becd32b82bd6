#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/TriangleSurface.h"
#include "Mesh/TriangleTree.h"

#include <functional>

namespace bsr
{
/// A point of a surface and the unit normal there.
struct SurfaceSample
{
  Vec3 Point;
  Vec3 Normal;
};

/// About `count` samples, evenly spread over the area.
std::vector<SurfaceSample> surfaceSamples(const TriangleSurface& s, int count);

/// What vertices of a layout are projected onto: the surface and, for those on creases, the
/// creases.
struct ReferenceSurface
{
  TriangleTree Faces;
  TriangleTree Creases;
  std::vector<SurfaceSample> Samples; ///< from which layouts must not move away; may be empty

  ReferenceSurface() = default;
  explicit ReferenceSurface(const TriangleSurface& s);
  ReferenceSurface(const TriangleSurface& s, Monitor& monitor); ///< see TriangleTree
};

/// The edge length wanted at a place.
using EdgeLength = std::function<double(const Vec3&)>;

/**
 * Isotropic remeshing (Botsch and Kobbelt 2004): splits long edges, collapses short ones, flips
 * towards valence 6 and relaxes tangentially, each vertex on `reference`. Topology, creases
 * and holes stay. `s` is compact afterwards; when cancelled it is left half done.
 */
Status remesh(TriangleSurface& s, const ReferenceSurface& reference, const EdgeLength& edgeLength,
  int iterations, Monitor& monitor);
} // namespace bsr
