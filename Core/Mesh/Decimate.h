#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/TriangleSurface.h"

#include <limits>

namespace bsr
{
struct DecimateOptions
{
  Index Target = 20000; ///< triangles wanted, virtual ones not counted
  /// Largest error of a collapse, as root mean square distance to the planes of the input that it
  /// replaces, in world units. Collapses beyond it are made only above `Most` triangles.
  double MaximumError = std::numeric_limits<double>::infinity();
  Index Most = 60000; ///< triangles that are not exceeded for the sake of the error
};

/**
 * Quadric edge collapse (Garland and Heckbert 1997). Every collapse passes the link condition,
 * keeps creases and holes, turns no triangle by more than 70 degrees and leaves no sliver that was
 * not there. Less is removed where the topology needs it.
 *
 * Large surfaces are first cut into blocks of vertices along a space-filling curve; inside the
 * blocks edges are collapsed in parallel, then the curve is shifted; the rest is done in one queue.
 * The blocks depend on the surface alone, so the result does not depend on the number of threads.
 * `s` is compact afterwards, and in another order. Returns Cancelled when the monitor says so.
 */
Status decimate(TriangleSurface& s, const DecimateOptions& options, Monitor& monitor);
} // namespace bsr
