#pragma once

#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * Quads from a coarse triangle surface, whatever its topology: triangles are paired over their
 * longest edges, then each pair is split into four quads and each triangle left over into three
 * (one step of Catmull and Clark). The answer is a valid layout by construction: no creases or
 * holes are lost and no vertex gets fewer than three quads. `s` of M triangles gives 2 M quads
 * and up to half as many more.
 */
LayoutDraft pairTriangles(const TriangleSurface& s);

/// The same without pairs: three quads in the plane of each triangle.
LayoutDraft splitTriangles(const TriangleSurface& s);
} // namespace bsr
