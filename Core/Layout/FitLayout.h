#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * Moves the points of a layout off the surface, along its normals, so that the bilinear patches of
 * the quads fit the surface best: a sparse least-squares problem over samples of all triangles,
 * with samples that are far off weighing more, solved a few times as samples change quads. Patches
 * then cut through the surface instead of spanning chords inside it: the mean distance falls to
 * about a half. Between the solves points slide towards even rectangles. Points on creases and
 * boundaries stay. No quad that was sound is folded.
 */
Status fitLayout(LayoutDraft& draft, const TriangleSurface& s, Monitor& monitor);
} // namespace bsr
