#pragma once

#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * Fills a loop of an even number of layout points with quads: a ring along the loop around a grid
 * (a grid alone for less than 8 points), turned so that its quads are most even. `loop` runs
 * counter-clockwise seen from outside. New quads get `region`. False if the loop is odd, too
 * short or touches itself.
 */
bool capDisc(LayoutDraft& draft, std::vector<Index> loop, Index region);
} // namespace bsr
