#pragma once

#include "Common/Monitor.h"
#include "Mesh/Decimate.h"
#include "Mesh/Quadric.h"

namespace bsr
{
/// What triangles a collapse may leave.
struct CollapseLimits
{
  double Turn = 0.34;   ///< least cosine of the angle that a triangle turns by
  double Sliver = 0.12; ///< least height over longest side, unless it was less before
};

/// A surface with the quadrics of its vertices, to be decimated; the engine of decimate().
class QuadricCollapse
{
public:
  /// Once cancelled, of no use.
  QuadricCollapse(TriangleSurface& s, Monitor& monitor);

  /// Triangles that are not virtual.
  Index faces() const;
  /// Renumbers along a space-filling curve, see sortAlongCurve. False when cancelled.
  bool sort(double shift, Monitor& monitor);
  /// Drops what was removed.
  void compact();
  /// Collapses edges inside blocks of consecutive vertices in parallel, each block to `keep` of
  /// its triangles. False when cancelled.
  bool collapseInBlocks(Index blockVertices, double keep, Monitor& monitor);
  /// Collapses edges, cheapest first, until the options are met; where that leaves too many
  /// triangles, again with looser limits on their shape. False when cancelled.
  bool collapseAll(const DecimateOptions& options, Monitor& monitor);

private:
  struct Candidate
  {
    double Cost;
    Index HalfEdge;
    std::uint32_t Stamp;
    bool operator>(const Candidate& o) const
    {
      return this->Cost != o.Cost ? this->Cost > o.Cost : this->HalfEdge > o.HalfEdge;
    }
  };
  using Heap = std::vector<Candidate>;

  void buildQuadrics(Index first, Index last);
  bool fillHeap(Heap& heap, Monitor& monitor) const;
  void addCrease(Quadric& q, Index h) const;
  void collapseBlock(Index first, Index last, double keep);
  /// Takes the cheapest candidate and collapses it if that is sound; triangles removed.
  Index collapseCheapest(Heap& heap, double maximumError, const CollapseLimits& limits);
  Index apply(Index h, const Vec3& x, Heap& heap);

  Index directed(Index h) const;
  Vec3 place(Index h) const;
  Candidate candidate(Index edge) const;
  std::uint32_t stamp(Index h) const;
  bool shapesStay(Index h, const Vec3& x, const CollapseLimits& limits) const;
  bool fanStays(Index v, Index other, const Vec3& x, const CollapseLimits& limits) const;

  TriangleSurface& S;
  Vec3 Origin;
  std::vector<Quadric> Quadrics;
  std::vector<std::uint32_t> Version;
  std::vector<std::uint8_t> Degree; ///< per vertex: crease edges (3: or more); collapses keep it
  /// Per vertex: edges to it may be collapsed (all, or those inside a block).
  std::vector<std::uint8_t> Movable;
};
} // namespace bsr
