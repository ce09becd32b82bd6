#pragma once

#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * Removes what makes a layout invalid or poor where that takes local operations only: quads whose
 * opposite corners are one point are closed like a zip, doublets (interior vertices of two quads)
 * are removed by merging their quads. Unused points are dropped. What cannot be mended is left
 * for checkLayout to find.
 */
void cleanLayout(LayoutDraft& draft);
} // namespace bsr
