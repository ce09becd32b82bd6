#pragma once

#include "Layout/LayoutDraft.h"

namespace bsr
{
/// Closed, of genus 0, without creases: may be laid out as a box.
bool isSphere(const TriangleSurface& s);

/// Six quads around the middle of a sphere along its principal axes, whatever its shape: the
/// layout of specks. They are planar and square at the corners, so never folded.
LayoutDraft boxLayout(const TriangleSurface& s);

/// One boundary loop, no handles, no creases inside: may be laid out as one quad.
bool isDisc(const TriangleSurface& s);

/// One quad between four places of the boundary of a disc; no quad where that would be of no use.
LayoutDraft singleQuad(const TriangleSurface& s);
} // namespace bsr
