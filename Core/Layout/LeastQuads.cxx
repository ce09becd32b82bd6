#include "Layout/LeastQuads.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace bsr
{
namespace
{
/// May there be a layout of so many vertices inside and on boundaries?
bool mayBe(std::int64_t inside, std::int64_t border, std::int64_t euler)
{
  const std::int64_t vertices = inside + border;
  const std::int64_t quads = inside + border / 2 - euler;
  const std::int64_t edges = 2 * quads + border / 2;
  return quads > 0 && 4 * inside + 5 * border >= -4 * euler &&
         2 * edges <= vertices * (vertices - 1) && 2 * (edges - border) <= quads * (quads - 1);
}
} // namespace

int leastQuads(int euler, int boundaryLoops)
{
  if (boundaryLoops == 0 && euler > 0)
  {
    return 6;
  }
  std::int64_t best = std::numeric_limits<std::int64_t>::max();
  // The number of edges of all boundaries is even, as that of the sides of all quads is.
  std::int64_t border = 3 * boundaryLoops + boundaryLoops % 2;
  do
  {
    std::int64_t inside = std::max<std::int64_t>(0, -euler - 5 * border / 4);
    while (!mayBe(inside, border, euler))
    {
      ++inside;
    }
    best = std::min(best, inside + border / 2 - euler);
    border += 2;
  } while (boundaryLoops > 0 && border / 2 - euler < best);
  return static_cast<int>(best);
}
} // namespace bsr
