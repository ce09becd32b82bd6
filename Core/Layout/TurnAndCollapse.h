#pragma once

// The last resort of coarsenLayout; used by Coarsen.cxx alone.

#include "Layout/LocalCoarsener.h"

namespace bsr::coarsening
{
/// Goes on where no single collapse is sound: an edge is turned first, so that one is.
class DeepCoarsener : public LocalCoarsener
{
public:
  /// Vertices may have one edge more than in layouts that are not at their limit.
  DeepCoarsener(const LayoutDraft& draft, const ReferenceSurface& reference,
    const CoarsenOptions& options, const Bounds& bounds, double cell2)
      : LocalCoarsener(draft, reference, options, bounds, cell2)
  {
    this->E.MostEdges = 8;
  }

  /// One quad or more less, if that goes; false: it does not, or cancelled.
  bool turnAndCollapse(Monitor& monitor)
  {
    const auto n = static_cast<Index>(this->E.Quads.size());
    for (Index i = 0; i < n; ++i)
    {
      if (i % 4 == 0 && monitor.cancelled())
      {
        return false;
      }
      const Index q = (this->Next + i) % n;
      for (int k = 0; k < 4 && this->E.alive(q); ++k)
      {
        if (!this->E.crease(q, k) && this->E.neighbor(q, k) > q &&
            (this->turned(q, k, 1) || this->turned(q, k, -1)))
        {
          this->Next = q;
          return true;
        }
      }
    }
    return false;
  }

private:
  /// Turns an edge and collapses a quad nearby.
  bool turned(Index q, int k, int way)
  {
    const Index o = this->E.neighbor(q, k);
    std::vector<Index> hexagon(this->E.Quads[q].begin(), this->E.Quads[q].end());
    hexagon.insert(hexagon.end(), this->E.Quads[o].begin(), this->E.Quads[o].end());
    QuadEditor::sortUnique(hexagon);
    const std::vector<Index> around = this->E.quadsAt(hexagon);
    std::vector<Index> ring;
    for (Index near : around)
    {
      ring.insert(ring.end(), this->E.Quads[near].begin(), this->E.Quads[near].end());
    }
    QuadEditor::sortUnique(ring);
    const std::vector<Index> old = this->E.quadsAt(ring);
    const double before = this->worst(old);
    const double far = this->farthest(old);
    for (std::size_t i = 0; i < 2 * around.size(); ++i)
    {
      this->E.begin();
      if (!this->E.rotate(q, k, way))
      {
        this->E.rollback();
        return false;
      }
      const int corner = static_cast<int>(i % 2);
      const QuadEditor::Quad corners = this->E.Quads[around[i / 2]];
      const double side = 0.5 * (this->Side[corners[corner]] + this->Side[corners[corner + 2]]);
      const Index v = this->E.collapse(around[i / 2], corner);
      double anyLoss = std::numeric_limits<double>::infinity();
      if (v >= 0 && this->settle(v, ring, old, before, far, anyLoss))
      {
        this->Side[v] = side;
        return true;
      }
      this->E.rollback();
    }
    return false;
  }

  Index Next = 0; ///< quad to start from: those before it were tried last
};
} // namespace bsr::coarsening
