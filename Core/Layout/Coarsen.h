#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"

#include <functional>

namespace bsr
{
struct CoarsenOptions
{
  int Quads = 500;                         ///< wanted
  double Tolerance = 0.04;                 ///< of the count, relative
  std::function<double(const Vec3&)> Side; ///< wanted side of a quad at a place
};

/**
 * Takes a valid layout to a given number of quads by operations that keep it valid (Daniels et al.
 * 2008, Tarini et al. 2010): whole strips are taken out or split, quads are collapsed along a
 * diagonal, edges are turned, always that of the least irregularity and size first. Points move
 * over the reference with every step, and no step may make the worst quad around it worse than a
 * bound that is loosened only when nothing else goes: what was not folded is not folded after.
 * Where that leads no further, edges are turned at random until collapses are possible again.
 * Stops early where topology, creases or shape allow no step: then there are more quads than asked.
 */
Status coarsenLayout(LayoutDraft& draft, const ReferenceSurface& reference,
  const CoarsenOptions& options, Monitor& monitor);
} // namespace bsr
