#pragma once

#include "Common/Types.h"
#include "Mesh/Meshes.h"

namespace bsr
{
/**
 * A closed, oriented, 2-manifold triangle surface that can be edited: a corner table.
 *
 * Half-edge h belongs to triangle h / 3, starts at Vertex[h], ends at Vertex[next(h)]; Opposite[h]
 * is the same edge run through the other way. There are no boundaries: the holes of an open surface
 * are filled with fans of virtual triangles (Region HoleRegion) around a virtual vertex, so that
 * every operation needs one topological check only and keeps holes as it keeps regions.
 *
 * Edits keep the surface a closed 2-manifold of the same Euler characteristic, and keep each crease
 * (region border or sharp edge) a polyline with the same ends. Removed elements stay in the
 * arrays with Vertex = -1 (Out = -1 for vertices) until compact().
 */
class TriangleSurface
{
public:
  static constexpr Index HoleRegion = -1;

  std::vector<Vec3> Points;
  std::vector<Index> Vertex;         ///< start vertex of each half-edge, -1 once removed
  std::vector<Index> Opposite;       ///< twin of each half-edge
  std::vector<std::uint8_t> Crease;  ///< per half-edge: region border or sharp edge
  std::vector<Index> Region;         ///< per triangle
  std::vector<Index> Out;            ///< per vertex: one half-edge that starts there, -1 removed
  std::vector<std::uint8_t> Virtual; ///< per vertex: 1 for the middle of a filled hole

  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  Index start(Index h) const { return this->Vertex[h]; }
  Index end(Index h) const { return this->Vertex[next(h)]; }
  Index apex(Index h) const { return this->Vertex[prev(h)]; }
  /// The next half-edge out of the same vertex, turning around it.
  Index turn(Index h) const { return this->Opposite[prev(h)]; }
  Index faces() const { return static_cast<Index>(this->Region.size()); }
  Index vertices() const { return static_cast<Index>(this->Points.size()); }
  bool alive(Index face) const { return this->Vertex[3 * face] >= 0; }
  bool hole(Index face) const { return this->Region[face] == HoleRegion; }
  std::array<Index, 3> corners(Index face) const
  {
    return {this->Vertex[3 * face], this->Vertex[3 * face + 1], this->Vertex[3 * face + 2]};
  }

  /// Calls visit(h) for every half-edge that starts at v, in order around it.
  template <class Visit>
  void around(Index v, const Visit& visit) const
  {
    const Index first = this->Out[v];
    Index h = first;
    do
    {
      visit(h);
      h = this->turn(h);
    } while (h != first);
  }

  int valence(Index v) const;
  /// Number of crease edges at v: 0 smooth, 2 on a crease, anything else a corner.
  int creaseDegree(Index v) const;
  /// Number of vertices that both are joined to by an edge (repeated if by several).
  int commonNeighbors(Index a, Index b) const;
  Vec3 areaNormal(Index face) const;
  double area() const; ///< of all triangles but virtual ones
  Index aliveFaces() const;

  /// May the start of h be merged into its end without a change of topology or creases?
  bool canCollapse(Index h) const;
  /// Merges the start of h into its end, which moves to `position`. \pre canCollapse(h)
  void collapse(Index h, const Vec3& position);
  /// May the edge be replaced by the other diagonal of its two triangles?
  bool canFlip(Index h) const;
  void flip(Index h);
  /// Puts a vertex at `position` on the edge; returns it.
  Index split(Index h, const Vec3& position);

  /// Drops removed elements; keeps the order. Returns the new index of each old vertex or -1.
  std::vector<Index> compact();
  /// The triangles without the virtual ones; virtual vertices are dropped.
  TriangleMesh toMesh() const;
  /// V - E + F of the surface without its virtual parts, i.e. with its holes.
  int eulerCharacteristic() const;
};
} // namespace bsr
