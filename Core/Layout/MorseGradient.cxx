#include "Layout/MorseGradient.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Half-edges out of a vertex into its real triangles, counter-clockwise. On a boundary from one
/// boundary edge to the other; the last one has the hole on its left.
struct Fan
{
  std::vector<Index> Edges;
  bool Closed = true;
};

Fan fanOf(const TriangleSurface& s, Index v)
{
  Fan fan;
  Index first = s.Out[v];
  s.around(v,
    [&](Index h)
    {
      if (s.hole(s.Opposite[h] / 3) && !s.hole(h / 3))
      {
        first = h;
        fan.Closed = false;
      }
    });
  Index h = first;
  do
  {
    if (!s.Virtual[s.end(h)])
    {
      fan.Edges.push_back(h);
    }
    h = s.turn(h);
  } while (h != first);
  return fan;
}

/// Pairs one vertex with its way down, and the triangles and edges below it.
class LowerStar
{
public:
  LowerStar(const TriangleSurface& s, MorseGradient& g, std::vector<Index>& saddles, Index v)
      : S(s), G(g), Saddles(saddles), V(v), F(fanOf(s, v)), Count(static_cast<int>(F.Edges.size()))
  {
    for (Index h : this->F.Edges)
    {
      this->Below.push_back(g.lower(s.end(h), v));
    }
  }

  void pair()
  {
    const int below = static_cast<int>(std::count(this->Below.begin(), this->Below.end(), true));
    if (!this->F.Closed)
    {
      this->pairOnBoundary(below);
    }
    else if (below == this->Count)
    {
      this->wholeFan(this->steepest(0, this->Count - 1));
    }
    else if (below > 0)
    {
      this->arcs(-1);
    }
  }

private:
  int wrap(int i) const { return (i + this->Count) % this->Count; }
  Index edge(int i) const { return this->F.Edges[this->wrap(i)]; }
  /// Triangle between edge i and i + 1.
  Index triangle(int i) const { return this->edge(i) / 3; }
  double slope(int i) const
  {
    const Index w = this->S.end(this->edge(i));
    const double length = (this->S.Points[w] - this->S.Points[this->V]).norm();
    return (this->G.Value[this->V] - this->G.Value[w]) / std::max(length, 1e-300);
  }
  bool onBoundary(Index v) const
  {
    bool found = false;
    this->S.around(v, [&](Index h) { found = found || this->S.Virtual[this->S.end(h)]; });
    return found;
  }
  /// Paths inside keep away from boundaries where they can.
  int steepest(int first, int last) const
  {
    int best = first;
    std::pair<bool, double> bestKey(true, -1.0);
    for (int i = first; i <= last; ++i)
    {
      const bool boundary = this->onBoundary(this->S.end(this->edge(i)));
      const double slope = this->slope(i);
      if (i == first || (boundary != bestKey.first ? !boundary : slope > bestKey.second))
      {
        best = i;
        bestKey = {boundary, slope};
      }
    }
    return best;
  }
  void crossed(int triangle, int edge)
  {
    // The half-edge of the triangle on this edge: its own start, or the one that ends at V.
    const Index h = this->edge(edge);
    this->G.Up[this->triangle(triangle)] =
      this->wrap(triangle) == this->wrap(edge) ? h : this->S.Opposite[h];
  }

  /// Triangles of the arc of edges first..last ascend away from the edge `root`.
  void arc(int first, int last, int root)
  {
    for (int i = first; i < last; ++i)
    {
      this->crossed(i, i < root ? i : i + 1);
    }
  }

  /// All neighbors are lower (inside): the triangle opposite to the way down is the maximum.
  void wholeFan(int root)
  {
    this->G.Down[this->V] = this->edge(root);
    const int top = root + this->Count / 2;
    for (int i = root; i < root + this->Count; ++i)
    {
      if (i != top)
      {
        this->crossed(i, i < top ? i + 1 : i);
      }
    }
  }

  /// Every arc of lower neighbors has one edge left over: the way down, or a saddle.
  void arcs(int taken)
  {
    int start = 0; // an index whose predecessor is not below
    if (this->F.Closed)
    {
      while (this->Below[this->wrap(start - 1)])
      {
        ++start;
      }
    }
    std::vector<int> roots;
    for (int i = start; i < start + this->Count; ++i)
    {
      if (!this->Below[this->wrap(i)])
      {
        continue;
      }
      const int first = i;
      while (i + 1 < start + this->Count && this->Below[this->wrap(i + 1)])
      {
        ++i;
      }
      if (!this->F.Closed && (first == 0 || i == this->Count - 1))
      {
        this->arc(first, i, first == 0 ? first : i); // its edge lies on the boundary
        continue;
      }
      roots.push_back(this->steepest(first, i));
      this->arc(first, i, roots.back());
    }
    if (taken < 0)
    {
      const auto main = std::max_element(
        roots.begin(), roots.end(), [&](int a, int b) { return this->slope(a) < this->slope(b); });
      this->G.Down[this->V] = this->edge(*main);
      roots.erase(main);
    }
    for (int r : roots)
    {
      this->Saddles.push_back(this->edge(r));
    }
  }

  void pairOnBoundary(int below)
  {
    const int last = this->Count - 1;
    const bool first = this->Below[0];
    if (!first && !this->Below[last])
    {
      this->G.Boundary[this->V] = below == 0 ? BoundaryNode::Minimum : BoundaryNode::LowerSaddle;
      if (below > 0)
      {
        this->arcs(-1);
      }
      return;
    }
    const bool both = first && this->Below[last];
    const int down = both ? (this->slope(0) >= this->slope(last) ? 0 : last) : (first ? 0 : last);
    this->G.Down[this->V] = this->edge(down);
    if (below < this->Count)
    {
      this->arcs(down);
      if (both)
      {
        this->G.Boundary[this->V] = BoundaryNode::UpperSaddle;
        this->G.UpperEdge[this->V] = down == 0 ? this->S.Opposite[this->edge(last)] : this->edge(0);
      }
      return;
    }
    this->G.Boundary[this->V] = BoundaryNode::Maximum;
    const int top = last / 2;
    for (int i = 0; i < last; ++i)
    {
      if (i != top)
      {
        this->crossed(i, i < top ? i + 1 : i);
      }
    }
  }

  const TriangleSurface& S;
  MorseGradient& G;
  std::vector<Index>& Saddles;
  Index V;
  Fan F;
  int Count;
  std::vector<char> Below;
};

} // namespace

Index MorseGradient::descend(const TriangleSurface& s, Index vertex) const
{
  while (this->Down[vertex] >= 0)
  {
    vertex = s.end(this->Down[vertex]);
  }
  return vertex;
}

Index MorseGradient::ascend(const TriangleSurface& s, Index triangle) const
{
  while (this->Up[triangle] >= 0)
  {
    triangle = s.Opposite[this->Up[triangle]] / 3;
  }
  return triangle;
}

Index MorseGradient::top(const TriangleSurface& s, Index triangle) const
{
  const auto c = s.corners(triangle);
  const Index ab = this->lower(c[0], c[1]) ? c[1] : c[0];
  return this->lower(ab, c[2]) ? c[2] : ab;
}

Index MorseGradient::minima(const TriangleSurface& s) const
{
  Index n = 0;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    n += this->Down[v] < 0 && !s.Virtual[v];
  }
  return n;
}

Index MorseGradient::maxima(const TriangleSurface& s) const
{
  Index n = 0;
  for (Index t = 0; t < s.faces(); ++t)
  {
    n += this->Up[t] < 0 && !s.hole(t);
  }
  return n;
}

MorseGradient morseGradient(const TriangleSurface& s, std::vector<double> values)
{
  MorseGradient g;
  g.Value = std::move(values);
  g.Down.assign(s.Points.size(), -1);
  g.Up.assign(s.Region.size(), -1);
  g.Boundary.assign(s.Points.size(), BoundaryNode::None);
  g.UpperEdge.assign(s.Points.size(), -1);
  for (Index v = 0; v < s.vertices(); ++v)
  {
    if (!s.Virtual[v])
    {
      LowerStar(s, g, g.Saddles, v).pair();
    }
  }
  return g;
}

} // namespace bsr
