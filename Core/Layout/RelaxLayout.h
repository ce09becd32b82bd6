#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * Moves the vertices of a layout over the reference so that quads become even rectangles: each quad
 * asks for its nearest rectangle with sides drawn towards the mean side, each vertex goes
 * to the mean of what its quads ask for. Then vertices of bad quads (scaled Jacobian under
 * 0.35) are moved one by one, each to where its worst quad is best.
 */
Status relaxLayout(
  LayoutDraft& draft, const ReferenceSurface& reference, int iterations, Monitor& monitor);
} // namespace bsr
