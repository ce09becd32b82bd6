#pragma once

#include "Common/Monitor.h"
#include "Layout/SideOrder.h"
#include "Mesh/Geodesic.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
/**
 * A triangle surface that is cut along the sides of a layout: each side a path of its edges from
 * the vertex of one corner to that of the next. Paths meet at corners only. Region of a triangle:
 * its quad, -1 in holes, Unknown where no quad was found. Crease: an edge of a side or a boundary.
 */
class CutMesh
{
public:
  static constexpr Index Unknown = -2;

  TriangleSurface Surface;
  std::vector<Index> Corner;             ///< vertex of each corner of the layout
  std::vector<std::vector<Index>> Sides; ///< vertices along each edge of the layout; may be empty
  std::vector<std::vector<Index>> Faces; ///< triangles of each quad; empty where it failed

  /// \param edge longest edge of the refined surface
  /// \return InvalidInput where the boundaries of layout and surface do not correspond
  static Result<CutMesh> build(const std::vector<TriangleSurface>& surfaces, const QuadMesh& layout,
    const LayoutGraph& graph, double edge);

  /// Lays the sides of an order as paths of edges, each in its sector between its neighbors;
  /// then finds the quads' triangles. Returns the number of quads without a sound disc; Cancelled
  /// when the monitor, asked before each side, says so.
  Result<int> laySides(
    const QuadMesh& layout, const LayoutGraph& graph, const SideOrder& order, Monitor& monitor);
  /// Takes up the sides between quads without a disc, or within so many rings of quads around them.
  void takeUpAround(const LayoutGraph& graph, int rings);
  /// World units.
  double sideLength(Index edge) const;
  double totalLength() const;

  /// Replaces a side between two sound quads by a path through the union of both, from the same
  /// first corner to the last. False, with the old side in place, where the path touches other
  /// sides or does not part the quads.
  bool replaceSide(const LayoutGraph& graph, Index edge, const std::vector<EdgePoint>& path);

  /// Puts a vertex on the edge between two vertices; returns it, or -1 where there is no such edge.
  Index splitEdge(Index a, Index b, double t);
  bool isWall(Index v) const { return this->Wall[v] != 0; }
  Index findHalfEdge(Index a, Index b) const;
  /// The vertices along side k of a quad in the quad's direction.
  std::vector<Index> side(const LayoutGraph& graph, Index quad, int k) const;

private:
  void refine(double edge);
  bool placeCorners(const QuadMesh& layout, const LayoutGraph& graph);
  std::vector<std::vector<Index>> boundaries() const;
  Index nextOnBoundary(Index v) const;
  bool placeOnBoundary(const QuadMesh& layout, const std::vector<Index>& corners,
    std::vector<std::vector<Index>>& loops);
  bool followBoundary(const LayoutGraph& graph, Index edge);
  bool traceSide(const QuadMesh& layout, const LayoutGraph& graph, Index edge, double reach);
  bool parts(Index edge) const;
  void takeUp(Index edge);
  std::vector<Index> sector(const LayoutGraph& graph, Index vertex, Index edge) const;
  void fence(const std::vector<Index>& path);
  void mark(const std::vector<Index>& path, std::uint8_t crease);
  std::vector<Index> flood(Index face) const;
  std::vector<Index> insertPath(const std::vector<EdgePoint>& path, std::vector<Index>& old);
  bool isFree(const std::vector<Index>& path) const;
  bool findQuad(const LayoutGraph& graph, Index quad);

  std::vector<std::uint8_t> Wall; ///< per vertex: 1 on a side or boundary, 2 a corner
};
} // namespace bsr
