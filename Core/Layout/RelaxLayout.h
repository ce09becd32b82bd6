#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"

namespace bsr
{
/// The rectangle that fits a quad best, corner by corner; its sides are those of the quad, drawn
/// 30 % towards `side` if that is positive.
std::array<Vec3, 4> nearestRectangle(const std::array<Vec3, 4>& p, double side);

/**
 * Moves the vertices of a layout over the reference so that quads become even rectangles: each quad
 * asks for its nearest rectangle with sides drawn towards the mean side, each vertex goes
 * to the mean of what its quads ask for. Then vertices of bad quads (scaled Jacobian under
 * 0.35) are moved one by one, each to where its worst quad is best. A layout without folded quads
 * keeps none folded (`mending` times at most): steps that would fold one are not taken.
 */
Status relaxLayout(LayoutDraft& draft, const ReferenceSurface& reference, int iterations,
  Monitor& monitor, int mending = 30);

/// The same for some points only: `iterations` steps, without guard and mending.
void relaxPart(LayoutDraft& draft, const ReferenceSurface& reference,
  const std::vector<Index>& points, int iterations);
} // namespace bsr
