#pragma once

#include "Common/Status.h"
#include "Mesh/Meshes.h"

namespace bsr
{
/**
 * Vertices, edges and quads of a layout: half-edge 4 * quad + k runs from corner k to corner k + 1.
 * Fails with InvalidInput on edges of more than two quads or of opposite orientation.
 */
struct LayoutGraph
{
  std::vector<std::array<Index, 4>> Quads;
  std::vector<Index> Twin;                ///< of each half-edge, -1 at a boundary
  std::vector<Index> Edge;                ///< of each half-edge
  std::vector<Index> First;               ///< half-edge of each edge that gives its direction
  std::vector<std::vector<Index>> Spokes; ///< edges at each vertex, counter-clockwise
  std::vector<std::uint8_t> Boundary;     ///< per vertex

  static Result<LayoutGraph> build(const QuadMesh& mesh);

  /// The vertices of each boundary loop, quads on its left.
  std::vector<std::vector<Index>> boundaries() const;
  Index from(Index h) const { return this->Quads[h / 4][h % 4]; }
  Index to(Index h) const { return this->Quads[h / 4][(h + 1) % 4]; }
  Index edges() const { return static_cast<Index>(this->First.size()); }
};
} // namespace bsr
