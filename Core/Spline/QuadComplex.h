#pragma once

#include "Common/Status.h"
#include "Mesh/Meshes.h"

#include <Eigen/Geometry>

namespace bsr
{
/// The faces around a vertex, counter-clockwise; open at a border vertex.
struct VertexFan
{
  /// Outgoing half-edge 4 * face + corner of each face; face k lies between spoke k and k + 1.
  std::vector<Index> HalfEdges;
  bool Closed = true;

  int faces() const { return static_cast<int>(this->HalfEdges.size()); }
  int spokes() const { return this->faces() + (this->Closed ? 0 : 1); }
};

/// An edge by its half-edges; the stored direction is that of First.
struct QuadEdge
{
  Index First = -1;
  Index Second = -1; ///< twin, or -1 at a border
};

/**
 * Connectivity of an oriented quad 2-manifold with or without border.
 * Half-edge 4 * face + k runs from corner k to corner k + 1 of the face; its side of the patch is k
 * (v = 0, u = 1, v = 1, u = 0). Vertices that no quad uses have an empty fan.
 */
class QuadComplex
{
public:
  /// Fails, naming the place and the cure, on corners out of range or repeated in a quad, edges
  /// with more than two quads or inconsistent orientation, vertices with several fans, and inner
  /// vertices of valence 2 (doublets).
  static Result<QuadComplex> build(std::vector<std::array<Index, 4>> quads, Index vertices);

  Index faces() const { return static_cast<Index>(this->Quads.size()); }
  Index vertices() const { return static_cast<Index>(this->Fans.size()); }
  Index edges() const { return static_cast<Index>(this->Edges.size()); }
  const std::array<Index, 4>& quad(Index face) const { return this->Quads[face]; }
  const VertexFan& fan(Index vertex) const { return this->Fans[vertex]; }
  const QuadEdge& edge(Index e) const { return this->Edges[e]; }
  Index twin(Index halfEdge) const { return this->Twins[halfEdge]; }
  Index edgeOf(Index halfEdge) const { return this->EdgeOf[halfEdge]; }
  Index from(Index halfEdge) const { return this->Quads[halfEdge / 4][halfEdge % 4]; }
  Index to(Index halfEdge) const { return this->Quads[halfEdge / 4][(halfEdge + 1) % 4]; }
  bool closed() const { return this->BorderEdges == 0; }
  Index borderEdges() const { return this->BorderEdges; }

  /// Vertices - edges + faces, unused vertices not counted.
  int eulerCharacteristic() const;

  /// The border as loops of half-edges (each without twin), surface on their left.
  std::vector<std::vector<Index>> borderLoops() const;

private:
  Status linkTwins();
  Status buildFans(Index vertices);
  void listEdges();

  std::vector<std::array<Index, 4>> Quads;
  std::vector<Index> Twins;
  std::vector<Index> EdgeOf;
  std::vector<QuadEdge> Edges;
  std::vector<VertexFan> Fans;
  Index BorderEdges = 0;
};
} // namespace bsr
