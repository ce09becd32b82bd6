#pragma once

#include "Layout/LayoutDraft.h"

namespace bsr
{
/// Closed, of genus 0, without creases: may be laid out as a box.
bool isSphere(const TriangleSurface& s);

/// Six quads around the middle of a sphere along its principal axes, whatever its shape: the
/// layout of specks. They are planar and square at the corners, so never folded.
LayoutDraft boxLayout(const TriangleSurface& s);
} // namespace bsr
