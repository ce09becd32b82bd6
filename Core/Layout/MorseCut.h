#pragma once

#include "Layout/MorseGradient.h"

namespace bsr
{
/// What a vertex of a partitioned surface is for the function.
enum class CriticalPoint : std::uint8_t
{
  Regular = 0,
  Minimum = 1,
  Saddle = 2,
  Maximum = 3
};

/// A triangle surface cut along the paths of a Morse-Smale complex: each triangle is in one cell.
struct PartitionedSurface
{
  TriangleMesh Mesh;
  std::vector<Index> Cell;             ///< per triangle, from 0
  std::vector<double> Eigenfunction;   ///< per point
  std::vector<CriticalPoint> Critical; ///< per point
};

/**
 * Cuts a surface along the paths of all saddles of a gradient and grows the cells between.
 *
 * Paths down become edges of the cut surface as they are; edges that paths up cross are split in
 * their middle. Points of the cut surface begin with the vertices of the surface.
 */
class MorseCut
{
public:
  MorseCut(const TriangleSurface& s, const MorseGradient& g, PartitionedSurface& out);

  void run();

  /// The triangle left of a directed edge of the cut surface, -1 if there is none.
  Index left(Index a, Index b) const;
  Index cellAt(Index a, Index b) const;
  Index point(Index vertex) const { return this->Number[vertex]; }
  /// The point on an edge that a path crosses.
  Index middle(Index h);
  Index cells() const { return this->Cells; }
  /// The extrema of each cell: triangle of the maximum, vertex of the minimum; -1 unknown.
  std::vector<std::pair<Index, Index>> extrema() const;

private:
  Index addPoint(const Vec3& p, double value);

  void trace();
  void walkDown(Index v);
  void walkUp(Index t);

  void barrier(Index a, Index b) { this->Barriers.emplace_back(a, b); }
  void add(Index a, Index b, Index c);

  /// Splits a triangle along the paths through it.
  void cut(Index t);

  /// Two crossed edges: the path goes straight between them.
  void cutThrough(const std::array<Index, 3>& edges, const std::array<Index, 3>& corner);

  /// All edges are crossed: the paths meet in the middle.
  void cutAtMeeting(const std::array<Index, 3>& edges, const std::array<Index, 3>& corner);

  /// The paths end at the highest corner.
  void cutAtMaximum(Index t);

  /// Lists the directed edges by the point they start at.
  void index();
  /// Place of a directed edge in the list, -1 if there is none.
  Index place(Index a, Index b) const;
  /// Cells by region growing between the paths.
  void grow();

  const TriangleSurface& S;
  const MorseGradient& G;
  PartitionedSurface& Out;
  std::vector<std::uint8_t> Crossed; ///< per half-edge: a path up goes across
  std::vector<std::uint8_t> Walked;  ///< per half-edge: a path down goes along
  std::vector<std::uint8_t> Reached; ///< per triangle: paths up end here
  std::vector<Index> Middle;         ///< per half-edge, at the smaller one of an edge
  std::vector<Index> Number;         ///< point of each vertex
  std::vector<Index> Origin;         ///< per triangle of the cut surface: that it comes from
  std::vector<std::pair<Index, Index>> Barriers;
  std::vector<Index> First;        ///< per point: place of its first edge; one more at the end
  std::vector<Index> End;          ///< per directed edge: the point it ends at
  std::vector<Index> Left;         ///< per directed edge: the triangle left of it
  std::vector<std::uint8_t> Fence; ///< per directed edge: a path runs along
  Index Cells = 0;
  Index Current = -1;
};
} // namespace bsr
