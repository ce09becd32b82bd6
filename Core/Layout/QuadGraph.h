#pragma once

#include "Layout/LayoutDraft.h"

#include <map>

namespace bsr
{
/**
 * A complex of quads by half-edges, where two vertices may share several edges and a quad may name
 * a vertex twice: what a quad layout is before it is mended. Half-edge h = 4 q + k starts at
 * Vertex[h]; Opposite[h] is -1 at boundaries. Removed quads have Vertex = -1.
 */
class QuadGraph
{
public:
  std::vector<Index> Vertex;
  std::vector<Index> Opposite;

  static Index next(Index h) { return h % 4 == 3 ? h - 3 : h + 1; }
  static Index prev(Index h) { return h % 4 == 0 ? h + 3 : h - 1; }
  Index start(Index h) const { return this->Vertex[h]; }
  Index end(Index h) const { return this->Vertex[next(h)]; }
  Index halfEdges() const { return static_cast<Index>(this->Vertex.size()); }
  bool alive(Index h) const { return this->Vertex[h] >= 0; }
  Index quads() const;

  /// Adds a quad; its sides are joined to others by link().
  Index add(const std::array<Index, 4>& corners);
  void link(Index a, Index b);
  /// Quad corners around each vertex, and whether it lies on a boundary.
  struct Ring
  {
    int Corners = 0;
    bool Boundary = false;
  };
  std::vector<Ring> rings(Index vertices) const;

  /// Closes every quad whose one corner has no other quad (the two sides there are one edge), and
  /// every interior vertex of two quads by joining these. Returns the number of quads removed.
  int removeLoose(Index vertices);
  /// Replaces the edge by the next pair of opposite corners of the hexagon around it,
  /// counter-clockwise.
  void rotate(Index h);
  /// Cuts all quads along the chord through the side h; `vertices` is the next free vertex.
  /// Returns the sides that got a vertex, first of each new vertex, or none if the chord meets
  /// itself.
  std::vector<Index> splitChord(Index h, Index& vertices);

  /// The two ends of an edge, smaller one first.
  using Pair = std::pair<Index, Index>;
  static Pair pairOf(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }
  /// The edges of each pair of vertices that has any, by one half-edge each.
  std::map<Pair, std::vector<Index>> edges() const;
  /// Pairs of vertices that share more than one edge: for each a half-edge of the surplus.
  std::vector<Index> repeatedEdges() const;
};

/**
 * Turns a graph into one without repeated edges and loose vertices, by local operations that keep
 * it a surface of its topology: loose quads are closed, repeated edges are rotated, or cut with
 * their chord. Then edges are rotated where that makes the numbers of edges at vertices evener.
 * False: some repeated edge is left, or cancelled.
 */
bool mendGraph(
  QuadGraph& graph, std::vector<Vec3>& points, std::vector<VertexKind>& kind, Monitor& monitor);

/// Every quad in 2 x 2: no edge is repeated afterwards.
void subdivideGraph(QuadGraph& graph, std::vector<Vec3>& points, std::vector<VertexKind>& kind);

/// The graph as a layout; unused points are dropped. Region 0 everywhere.
LayoutDraft draftOf(
  const QuadGraph& graph, const std::vector<Vec3>& points, const std::vector<VertexKind>& kind);
} // namespace bsr
