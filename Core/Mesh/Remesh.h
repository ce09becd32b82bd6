#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/TriangleSurface.h"
#include "Mesh/TriangleTree.h"

#include <functional>

namespace bsr
{
/// What vertices of a layout are projected onto: the surface and, for those on creases, the
/// creases.
struct ReferenceSurface
{
  TriangleTree Faces;
  TriangleTree Creases;

  ReferenceSurface() = default;
  explicit ReferenceSurface(const TriangleSurface& s);
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
