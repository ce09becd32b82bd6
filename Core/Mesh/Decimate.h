#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
/**
 * Quadric edge collapse (Garland and Heckbert 1997) to about `target` triangles, virtual ones not
 * counted. Every collapse passes the link condition, keeps creases and holes, turns no triangle
 * by more than 70 degrees and leaves no sliver that was not there. Less is removed where the
 * topology needs it. `s` is compact afterwards. Returns Cancelled when the monitor says so.
 */
Status decimate(TriangleSurface& s, Index target, Monitor& monitor);
} // namespace bsr
