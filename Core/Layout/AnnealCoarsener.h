#pragma once

// The last resort of coarsenLayout; used by Coarsen.cxx alone.

#include "Layout/LocalCoarsener.h"

namespace bsr::coarsening
{
/**
 * Goes on where every collapse would leave a vertex of too many edges, which near the least number
 * of quads is what stops coarsening, long before shapes do. Edges are turned at random (simulated
 * annealing, Kirkpatrick et al. 1983) so that some vertices get all the edges that are allowed and
 * others few: those collapse. Boundaries lose vertices the same way, by ears. The numbers are the
 * same in each run, and nothing runs in parallel.
 *
 * No quad around a step may get worse than the bound (or than the worst one there was), nor may the
 * quads around look away from the surface more than they did.
 */
class AnnealCoarsener : public LocalCoarsener
{
public:
  /// Vertices may have one edge more than in layouts that are not at their limit.
  AnnealCoarsener(const LayoutDraft& draft, const ReferenceSurface& reference,
    const CoarsenOptions& options, const Bounds& bounds, double cell2, Monitor& monitor);

  /// Down to `target` quads, or as far as it goes. False: cancelled.
  bool annealTo(int target, Monitor& monitor);
  /// Turns edges where the quads around get better shapes. False: cancelled.
  bool improve(Monitor& monitor);

private:
  /// An edge to be turned, in the hexagon of its two quads.
  struct Turn
  {
    Index Quad = -1;
    int Corner = 0;
    int Way = 1;
    std::vector<Index> Hexagon; ///< vertices, sorted; fewer than six: not to be turned
  };
  /// A quad and the first of the two corners that merge.
  struct Collapse
  {
    Index Quad;
    int Corner;
  };
  /// What a step may not make worse.
  struct Look
  {
    double Worst; ///< shape
    double Away;  ///< sum of how far the quads look away from the surface
    double Price; ///< sum of costs of bad shapes
  };

  Turn turnAt(Index quad, int corner, int way) const;
  Turn randomTurn();
  double random();
  bool rotate(const Turn& t) { return this->E.rotate(t.Quad, t.Corner, t.Way); }
  double potential(const std::vector<Index>& vertices) const;
  bool hasTip(const std::vector<Index>& vertices) const;
  bool isTip(Index v) const;
  std::vector<Collapse> collapsesNear(const std::vector<Index>& quads) const;
  bool mayCollapse(const Collapse& c) const;
  std::vector<Index> ring(const std::vector<Index>& core) const;
  Look look(const std::vector<Index>& quads) const;
  double away(Index quad) const;
  bool place(const std::vector<Index>& core, std::vector<Index> quads, const Look& before);
  bool step();
  bool turnAndCollapse(const Turn& t, const Collapse& c);
  bool turnOnly(const Turn& t, bool better);

  std::uint64_t State = 0x853c49e6748fea9b; ///< of the random numbers
};
} // namespace bsr::coarsening
