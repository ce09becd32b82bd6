#pragma once

namespace bsr
{
/**
 * A lower bound of the quads of a component: no layout that checkLayout takes and whose vertices
 * have at most 8 edges has fewer. It counts vertices inside (n) and on boundaries (b, at least
 * three a loop; their edges are as many), of which n + b / 2 - euler quads come, and asks for
 *
 * - 4 n + 5 b >= -4 euler: the edges at vertices are 8 at most,
 * - two ends of their own for each edge (Hartsfield and Ringel 1989),
 * - two quads of their own for each edge inside.
 *
 * A ball needs 6. Near the bound nearly all vertices have 8 edges; with many handles and short
 * boundaries it is not reached, for it takes boundaries to be as long as helps.
 */
int leastQuads(int euler, int boundaryLoops);

/// Whether handles leave no room on so many quads: maps fold there, and shapes are poor.
inline bool crowded(int euler, int quads)
{
  return -6 * euler >= quads;
}
} // namespace bsr
