#pragma once

#include <vector>

namespace bsr
{
/// What a component brings to the shares.
struct ComponentSize
{
  double Area;
  int Least; ///< quads that its topology needs at least
};

/**
 * How many quads each component gets of `quads` for all together: by area, but each enough to show
 * its shape (6 to 24 where there is room), and never less than its topology needs. Where that alone
 * is more than `quads`, each gets just that.
 */
std::vector<int> componentShares(const std::vector<ComponentSize>& components, int quads);
} // namespace bsr
