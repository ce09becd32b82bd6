#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"
#include "Layout/Sizing.h"

namespace bsr
{
/**
 * A layout of one component by an integer-grid map of a cross field. Where all regions other than 0
 * are discs, the map covers region 0 and ends along their borders, which are then capped; else it
 * covers all regions and follows their borders. Several
 * fields are tried; the best valid layout is relaxed and returned. No quads: none was found, and
 * another road must be taken (that is not an error).
 */
Result<LayoutDraft> parametrizedLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, int quads, int seed, Monitor& monitor);

/// Small is good: angles, count, irregular vertices, bad quads, distance to the surface.
double layoutCost(const LayoutDraft& draft, const LayoutReport& report, const TriangleSurface& s,
  const ReferenceSurface& reference, int wanted);
} // namespace bsr
