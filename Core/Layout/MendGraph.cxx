#include "Layout/QuadGraph.h"

#include <algorithm>
#include <map>

namespace bsr
{
namespace
{
/// Local operations on a graph, judged by the numbers of edges at the vertices.
class Mender
{
public:
  Mender(QuadGraph& graph, std::vector<Vec3>& points, std::vector<VertexKind>& kind)
      : G(graph), Points(points), Kind(kind)
  {
  }

  /// False if an edge is left, or cancelled.
  bool run(Monitor& monitor)
  {
    const Index most = 2 * this->G.quads() + 20;
    for (int pass = 0; pass < 200 && this->G.quads() <= most && !monitor.cancelled(); ++pass)
    {
      this->G.removeLoose(this->vertices());
      const auto repeated = this->G.repeatedEdges();
      if (repeated.empty())
      {
        return true;
      }
      this->index();
      if (!this->rotateOne(repeated) && !this->cutOne(repeated))
      {
        return false;
      }
    }
    return false;
  }

  /// Rotates the edges that gain most, as long as any does.
  void even(Monitor& monitor)
  {
    for (int pass = 0; pass < 400 && !monitor.cancelled(); ++pass)
    {
      this->index();
      Index best = -1;
      int bestTurns = 0;
      int bestGain = -3;
      for (Index h = 0; h < this->G.halfEdges(); ++h)
      {
        for (int turns = 1; turns <= 2 && this->G.alive(h) && h < this->G.Opposite[h]; ++turns)
        {
          const int gain = this->gain(h, turns);
          if (gain < bestGain)
          {
            bestGain = gain;
            best = h;
            bestTurns = turns;
          }
        }
      }
      if (best < 0)
      {
        return;
      }
      this->turn(best, bestTurns);
    }
  }

private:
  static constexpr int Never = 1000000;

  Index vertices() const { return static_cast<Index>(this->Points.size()); }
  void index()
  {
    this->Rings = this->G.rings(this->vertices());
    this->Edges = this->G.edges();
  }
  void turn(Index h, int turns)
  {
    for (int i = 0; i < turns; ++i)
    {
      this->G.rotate(h);
    }
  }
  /// Change of the squared distance to the regular number of edges.
  int excess(Index v, int change) const
  {
    const QuadGraph::Ring& r = this->Rings[v];
    const int off = r.Boundary ? r.Corners - 2 : r.Corners - 4;
    return (off + change) * (off + change) - off * off;
  }
  /// What rotating h so many times changes; Never if it may not be.
  int gain(Index h, int turns) const
  {
    const QuadGraph& g = this->G;
    const Index o = g.Opposite[h];
    if (o < 0 || h / 4 == o / 4)
    {
      return Never;
    }
    const Index a = g.start(h);
    const Index b = g.end(h);
    const Index far = QuadGraph::next(QuadGraph::next(o));
    const Index c = turns == 1 ? g.start(far) : g.end(far); // beside a, then beside b
    const Index there = QuadGraph::next(QuadGraph::next(h));
    const Index d = turns == 1 ? g.start(there) : g.end(there);
    const auto least = [&](Index v) { return this->Rings[v].Boundary ? 2 : 4; };
    if (c == d || a == b || this->Rings[a].Corners < least(a) ||
        this->Rings[b].Corners < least(b) || this->Edges.count(QuadGraph::pairOf(c, d)) != 0 ||
        c == a || c == b || d == a || d == b)
    {
      return Never;
    }
    return this->excess(a, -1) + this->excess(b, -1) + this->excess(c, 1) + this->excess(d, 1);
  }

  bool rotateOne(const std::vector<Index>& repeated)
  {
    Index best = -1;
    int bestTurns = 0;
    int bestGain = Never;
    for (Index h : repeated)
    {
      for (Index x : this->Edges[QuadGraph::pairOf(this->G.start(h), this->G.end(h))])
      {
        for (int turns = 1; turns <= 2; ++turns)
        {
          const int gain = this->gain(x, turns);
          if (gain < bestGain)
          {
            bestGain = gain;
            best = x;
            bestTurns = turns;
          }
        }
      }
    }
    if (best >= 0)
    {
      this->turn(best, bestTurns);
    }
    return best >= 0;
  }

  bool cutOne(const std::vector<Index>& repeated)
  {
    for (Index h : repeated)
    {
      for (Index x : this->Edges[QuadGraph::pairOf(this->G.start(h), this->G.end(h))])
      {
        Index next = this->vertices();
        for (Index side : this->G.splitChord(x, next))
        {
          // The side ends at the new vertex; the other half starts there.
          const Index a = this->G.start(side);
          const Index b = this->otherEnd(side);
          this->Points.push_back(0.5 * (this->Points[a] + this->Points[b]));
          const bool border = this->G.Opposite[side] < 0;
          this->Kind.push_back(border ? VertexKind::Crease : VertexKind::Free);
        }
        if (next > 0 && static_cast<std::size_t>(next) == this->Points.size() &&
            this->Points.size() > this->Rings.size())
        {
          return true;
        }
      }
    }
    return false;
  }

  /// End of the edge that was cut at the end of `side`.
  Index otherEnd(Index side) const
  {
    // side: a -> m in (a, m, n, d); across m -> n lies (m, b, c, n).
    const Index across = this->G.Opposite[QuadGraph::next(side)];
    return this->G.end(QuadGraph::next(across));
  }

  QuadGraph& G;
  std::vector<Vec3>& Points;
  std::vector<VertexKind>& Kind;
  std::vector<QuadGraph::Ring> Rings;
  std::map<QuadGraph::Pair, std::vector<Index>> Edges;
};
} // namespace

bool mendGraph(
  QuadGraph& graph, std::vector<Vec3>& points, std::vector<VertexKind>& kind, Monitor& monitor)
{
  Mender mender(graph, points, kind);
  if (!mender.run(monitor))
  {
    return false;
  }
  mender.even(monitor);
  return true;
}

} // namespace bsr
