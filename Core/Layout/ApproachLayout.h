#pragma once

#include "Layout/Coarsen.h"

namespace bsr
{
struct ApproachReport
{
  double Before = 0.0; ///< energy
  double After = 0.0;
  int Turned = 0;  ///< edges
  int Reached = 0; ///< far places of the surface that a point went to
};

/**
 * Takes a layout whose vertices have up to 8 edges, near the least number of quads, closer to the
 * surface; the number of quads, creases and boundaries stay. Points move over the surface, one goes
 * to the farthest place that a quad stands for, and edges are turned, each with the points around
 * moved after it, where that lowers an energy: the inverse of each quad's shape, how far it looks
 * away from the surface, and the distances of samples of the surface (second and fourth power,
 * relative to the side of quads). No quad gets worse than a bound that rises from pass to pass, or
 * than the worst one around. One step after the other: the result depends on nothing else.
 */
Status approachLayout(LayoutDraft& draft, const ReferenceSurface& reference,
  const CoarsenOptions& options, Monitor& monitor, ApproachReport* report = nullptr);
} // namespace bsr
