#pragma once

#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * A layout that is edited by local operations, each of which keeps it a valid layout of the same
 * topology (Daniels et al. 2008, Tarini et al. 2010) or is refused. Creases and boundaries stay:
 * their vertices are never merged with those of others.
 *
 * Between begin() and the next begin() everything can be taken back by rollback(). Removed quads
 * keep their number with corner 0 at -1.
 */
class QuadEditor
{
public:
  using Quad = std::array<Index, 4>;

  explicit QuadEditor(const LayoutDraft& draft);

  std::vector<Vec3> Points;
  std::vector<VertexKind> Kind;
  std::vector<Quad> Quads;
  std::vector<Index> Region;              ///< per quad
  std::vector<std::vector<Index>> Around; ///< quads at each vertex
  std::vector<std::uint8_t> Rim;          ///< per vertex: on a boundary
  int MostEdges = 7;     ///< of a vertex, where no operation has to start from more
  int LeastRimEdges = 3; ///< of a vertex of a boundary after rotate()

  bool alive(Index quad) const { return this->Quads[quad][0] >= 0; }
  int count() const { return this->Alive; }
  int valence(Index v) const
  {
    return static_cast<int>(this->Around[v].size()) + (this->Rim[v] != 0 ? 1 : 0);
  }
  /// Corner of a quad that is v.
  int corner(Index quad, Index v) const;
  /// Quads at any of some vertices, sorted.
  std::vector<Index> quadsAt(const std::vector<Index>& vertices) const;
  static void sortUnique(std::vector<Index>& list);
  /// The quad on the other side of the edge from corner k, or -1.
  Index neighbor(Index quad, int k) const;
  /// Is the edge from corner k a crease or a boundary?
  bool crease(Index quad, int k) const { return (this->Mark[quad] >> k & 1) != 0; }

  /// Change of the sum over vertices of how far their valences are from ideal, for the operations.
  double collapseGain(Index quad, int k) const;
  double rotateGain(Index quad, int k, int way) const;
  double excess(Index v, int valence) const;

  void begin();
  void rollback();
  void move(Index v, const Vec3& p);

  /// Merges corners k and k + 2 of a quad; interior vertices left with two quads go with them.
  /// Returns the merged vertex, or -1 if refused (then rollback).
  Index collapse(Index quad, int k);
  /// Turns the edge from corner k within the hexagon of its quads; way is 1 or -1.
  bool rotate(Index quad, int k, int way);

  /// The layout, without what was removed.
  LayoutDraft draft() const;

private:
  struct Saved
  {
    Index Id;
    Quad Corners;
    std::uint8_t Mark;
  };
  struct SavedVertex
  {
    Index Id;
    Vec3 Point;
    VertexKind Kind;
    std::uint8_t Rim;
    std::vector<Index> Around;
  };

  void keep(Index quad);
  void keepVertex(Index v);
  void unlink(Index quad, Index v);
  void remove(Index quad);
  void mark(Index a, Index b);
  bool closeDoublets(std::vector<Index> vertices);
  bool closeDoublet(Index v);
  /// One fan of quads, valences in bounds, no repeated quads.
  bool sound(Index v, int mostEdges) const;
  bool creaseEdge(Index a, Index b) const;

  std::vector<std::uint8_t> Mark; ///< per quad, bit k: the edge from corner k is a crease
  int Alive = 0;
  int AliveBefore = 0;
  std::vector<Saved> QuadJournal;
  std::vector<SavedVertex> VertexJournal;
};
} // namespace bsr
