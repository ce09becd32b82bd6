#include "Layout/MorseCells.h"

#include <algorithm>
#include <map>

namespace bsr
{
namespace
{
/// One side of a cell: from the maximum down to the minimum, or back up.
struct Chain
{
  std::vector<Index> Saddles; ///< nodes, in the order of going
  std::vector<Index> Sides;   ///< sides between the nodes, one more; -1: a new one
  Index Arc = -1;             ///< place in Sides of what runs along a boundary
  Index ArcPoint = -1;        ///< point in the middle of that
  bool Known = false;
};

/// The quads of the cells.
class Builder
{
public:
  Builder(const TriangleSurface& s, const MorseGradient& g, MorseCells& out)
      : S(s),
        G(g),
        Out(out),
        C(s, g, out.Surface),
        MinimumOf(s.Points.size(), -1),
        MaximumOf(s.Region.size(), -1),
        NodeOf(s.Points.size(), -1)
  {
  }

  void run()
  {
    this->C.run();
    this->Down.resize(this->C.cells());
    this->UpWards.resize(this->C.cells());
    this->Out.Cells = this->C.cells();
    this->extrema();
    this->saddles();
    this->boundaries();
    const auto ends = this->C.extrema();
    for (Index c = 0; c < this->C.cells() && this->Out.Problem.empty(); ++c)
    {
      this->cell(c, ends[c]);
    }
    if (this->Out.Problem.empty())
    {
      this->join();
    }
  }

private:
  Index node(Index point, CriticalPoint what, VertexKind kind)
  {
    this->Out.Points.push_back(this->Out.Surface.Mesh.Points[point]);
    this->Out.Kind.push_back(kind);
    this->Out.Surface.Critical[point] = what;
    this->Out.Minima += what == CriticalPoint::Minimum;
    this->Out.Maxima += what == CriticalPoint::Maximum;
    this->Out.Saddles += what == CriticalPoint::Saddle;
    return static_cast<Index>(this->Out.Points.size()) - 1;
  }
  VertexKind kindOf(Index vertex) const
  {
    return this->G.Boundary[vertex] == BoundaryNode::None ? VertexKind::Free : VertexKind::Crease;
  }

  void extrema()
  {
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      if (this->G.Down[v] < 0 && !this->S.Virtual[v])
      {
        this->MinimumOf[v] = this->node(this->C.point(v), CriticalPoint::Minimum, this->kindOf(v));
        this->NodeOf[v] = this->MinimumOf[v];
      }
    }
    for (Index t = 0; t < this->S.faces(); ++t)
    {
      if (this->G.Up[t] < 0 && !this->S.hole(t))
      {
        const Index v = this->G.top(this->S, t);
        this->MaximumOf[t] = this->node(this->C.point(v), CriticalPoint::Maximum, this->kindOf(v));
        this->NodeOf[v] = this->MaximumOf[t];
      }
    }
  }

  Index side() { return this->Sides++; }

  void chain(std::vector<Chain>& chains, Index cell, const std::vector<Index>& nodes,
    const std::vector<Index>& sides)
  {
    if (cell < 0 || chains[cell].Known)
    {
      this->Out.Problem = "the paths of the Morse-Smale complex do not bound quadrilaterals";
      return;
    }
    chains[cell].Saddles = nodes;
    chains[cell].Sides = sides;
    chains[cell].Known = true;
  }

  void saddles()
  {
    for (Index h : this->G.Saddles)
    {
      const Index m = this->C.middle(h);
      const Index u = this->C.point(this->S.start(h));
      const Index v = this->C.point(this->S.end(h));
      const Index n = this->node(m, CriticalPoint::Saddle, VertexKind::Free);
      const Index toU = this->side();
      const Index toV = this->side();
      const Index toLeft = this->side();
      const Index toRight = this->side();
      this->chain(this->Down, this->C.cellAt(m, v), {n}, {toLeft, toV});
      this->chain(this->UpWards, this->C.cellAt(u, m), {n}, {toU, toLeft});
      this->chain(this->Down, this->C.cellAt(m, u), {n}, {toRight, toU});
      this->chain(this->UpWards, this->C.cellAt(v, m), {n}, {toV, toRight});
    }
  }

  /// Half-edges with the surface on their left, around each boundary; cut into arcs at the nodes.
  void boundaries()
  {
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      const BoundaryNode b = this->G.Boundary[v];
      if (b == BoundaryNode::LowerSaddle)
      {
        this->NodeOf[v] = this->node(this->C.point(v), CriticalPoint::Saddle, VertexKind::Crease);
        this->PathOf[v] = this->side();
      }
      else if (b == BoundaryNode::UpperSaddle)
      {
        this->NodeOf[v] = this->node(
          this->C.middle(this->G.UpperEdge[v]), CriticalPoint::Saddle, VertexKind::Crease);
        this->PathOf[v] = this->side();
      }
    }
    std::vector<std::uint8_t> done(this->S.Points.size(), 0);
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      const BoundaryNode b = this->G.Boundary[v];
      if (!done[v] && (b == BoundaryNode::Maximum || b == BoundaryNode::UpperSaddle))
      {
        this->loop(v, done);
      }
    }
  }

  Index forward(Index v) const
  {
    Index out = -1;
    this->S.around(v,
      [&](Index h)
      {
        if (!this->S.hole(h / 3) && this->S.hole(this->S.Opposite[h] / 3))
        {
          out = h;
        }
      });
    return out;
  }

  void loop(Index first, std::vector<std::uint8_t>& done)
  {
    std::vector<Index> nodes; // vertices, in order
    std::vector<std::vector<Index>> between;
    Index v = first;
    do
    {
      done[v] = 1;
      if (this->G.Boundary[v] != BoundaryNode::None)
      {
        nodes.push_back(v);
        between.emplace_back();
      }
      between.back().push_back(v);
      v = this->S.end(this->forward(v));
    } while (v != first);
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      this->arc(nodes[i], nodes[(i + 1) % nodes.size()], between[i]);
    }
  }

  /// The boundary from node a to node b as a chain of the cell beside its upper end.
  void arc(Index a, Index b, std::vector<Index> vertices)
  {
    vertices.push_back(b);
    const auto isTop = [&](Index v)
    {
      return this->G.Boundary[v] == BoundaryNode::Maximum ||
             this->G.Boundary[v] == BoundaryNode::UpperSaddle;
    };
    const bool down = isTop(a);
    if (down == isTop(b))
    {
      this->Out.Problem = "the boundary does not rise and fall in turns";
      return;
    }
    const Index top = down ? a : b;
    const Index bottom = down ? b : a;
    const bool upperSaddle = this->G.Boundary[top] == BoundaryNode::UpperSaddle;
    const bool lowerSaddle = this->G.Boundary[bottom] == BoundaryNode::LowerSaddle;
    std::vector<Index> nodes;
    std::vector<Index> sides(1, this->side());
    const Index arcSide = sides[0];
    if (upperSaddle)
    {
      nodes.push_back(this->NodeOf[top]);
      sides.insert(sides.begin(), this->PathOf[top]);
    }
    if (lowerSaddle)
    {
      nodes.push_back(this->NodeOf[bottom]);
      sides.push_back(this->PathOf[bottom]);
    }
    if (!down)
    {
      std::reverse(nodes.begin(), nodes.end());
      std::reverse(sides.begin(), sides.end());
    }
    const Index cell = this->cellAtTop(top, down);
    auto& chains = down ? this->Down : this->UpWards;
    this->chain(chains, cell, nodes, sides);
    if (cell >= 0)
    {
      chains[cell].Arc =
        static_cast<Index>(std::find(sides.begin(), sides.end(), arcSide) - sides.begin());
      chains[cell].ArcPoint = this->C.point(this->middleVertex(vertices, top));
    }
  }

  /// A vertex halfway along an arc, not an end of it if there is another.
  Index middleVertex(const std::vector<Index>& v, Index top) const
  {
    double total = 0.0;
    for (std::size_t i = 1; i < v.size(); ++i)
    {
      total += (this->S.Points[v[i]] - this->S.Points[v[i - 1]]).norm();
    }
    double run = 0.0;
    for (std::size_t i = 1; i + 1 < v.size(); ++i)
    {
      run += (this->S.Points[v[i]] - this->S.Points[v[i - 1]]).norm();
      if (run >= 0.5 * total || i + 2 == v.size())
      {
        return v[i];
      }
    }
    return top;
  }

  /// The cell beside the boundary just below its upper node, before (down: after) it.
  Index cellAtTop(Index top, bool after)
  {
    if (this->G.Boundary[top] == BoundaryNode::UpperSaddle)
    {
      const Index h = this->G.UpperEdge[top];
      const Index m = this->C.middle(h);
      return after ? this->C.cellAt(m, this->C.point(this->S.end(h)))
                   : this->C.cellAt(this->C.point(this->S.start(h)), m);
    }
    if (after)
    {
      const Index h = this->forward(top);
      return this->C.cellAt(this->C.point(top), this->C.point(this->S.end(h)));
    }
    Index back = -1; // half-edge that ends at the node
    this->S.around(top,
      [&](Index h)
      {
        const Index o = this->S.Opposite[h];
        if (this->S.hole(h / 3) && !this->S.hole(o / 3))
        {
          back = o;
        }
      });
    return this->C.cellAt(this->C.point(this->S.start(back)), this->C.point(top));
  }

  Index boundaryNode(Index point)
  {
    this->Out.Points.push_back(this->Out.Surface.Mesh.Points[point]);
    this->Out.Kind.push_back(VertexKind::Crease);
    return static_cast<Index>(this->Out.Points.size()) - 1;
  }

  void quad(const std::array<Index, 4>& corners, const std::array<Index, 4>& sides)
  {
    this->Out.Graph.add(corners);
    this->SideOf.insert(this->SideOf.end(), sides.begin(), sides.end());
  }

  void cell(Index c, const std::pair<Index, Index>& ends)
  {
    const Index top = ends.first < 0 ? -1 : this->MaximumOf[ends.first];
    const Index bottom = ends.second < 0 ? -1 : this->MinimumOf[ends.second];
    Chain& d = this->Down[c];
    Chain& u = this->UpWards[c];
    if (!d.Known || !u.Known || top < 0 || bottom < 0)
    {
      this->Out.Problem = "a cell of the Morse-Smale complex is not a quadrilateral";
      return;
    }
    if (d.Saddles.size() == 1 && u.Saddles.size() == 1)
    {
      this->quad({top, d.Saddles[0], bottom, u.Saddles[0]},
        {d.Sides[0], d.Sides[1], u.Sides[0], u.Sides[1]});
      return;
    }
    // Around from the top: every chain without saddles, and the arc of a chain of two, gets a
    // point.
    if (d.Saddles.size() == 2 && u.Saddles.size() == 2)
    {
      const Index across = this->side();
      this->quad({top, d.Saddles[0], u.Saddles[0], u.Saddles[1]},
        {d.Sides[0], across, u.Sides[1], u.Sides[2]});
      this->quad({d.Saddles[0], d.Saddles[1], bottom, u.Saddles[0]},
        {d.Sides[1], d.Sides[2], u.Sides[0], across});
      return;
    }
    if (d.Saddles.size() < 2 && u.Saddles.size() < 2)
    {
      this->divide(d);
      this->divide(u);
      this->quad({top, d.Saddles[0], bottom, u.Saddles[0]},
        {d.Sides[0], d.Sides[1], u.Sides[0], u.Sides[1]});
      return;
    }
    const Index across = this->side();
    Chain& one = d.Saddles.size() == 2 ? u : d;
    Chain& two = d.Saddles.size() == 2 ? d : u;
    if (one.Saddles.empty())
    {
      this->divide(one);
    }
    this->divide(two);
    const auto& a = d.Saddles;
    const auto& b = u.Saddles;
    if (&two == &d)
    {
      this->quad({top, a[0], a[1], b[0]}, {d.Sides[0], d.Sides[1], across, u.Sides[1]});
      this->quad({a[1], a[2], bottom, b[0]}, {d.Sides[2], d.Sides[3], u.Sides[0], across});
    }
    else
    {
      this->quad({top, a[0], b[1], b[2]}, {d.Sides[0], across, u.Sides[2], u.Sides[3]});
      this->quad({a[0], bottom, b[0], b[1]}, {d.Sides[1], u.Sides[0], u.Sides[1], across});
    }
  }

  /// Puts a vertex in the middle of the boundary arc of a chain, if it has none or two saddles.
  void divide(Chain& chain)
  {
    if (chain.Saddles.size() == 1)
    {
      return;
    }
    if (chain.Arc < 0)
    {
      this->Out.Problem = "a cell of the Morse-Smale complex is not a quadrilateral";
      chain.Saddles.resize(3, 0);
      chain.Sides.resize(4, 0);
      return;
    }
    const Index n = this->boundaryNode(chain.ArcPoint);
    chain.Saddles.insert(chain.Saddles.begin() + chain.Arc, n);
    chain.Sides.insert(chain.Sides.begin() + chain.Arc + 1, this->side());
  }

  /// Links the two half-edges of each side.
  void join()
  {
    std::vector<Index> first(this->Sides, -1);
    for (std::size_t h = 0; h < this->SideOf.size(); ++h)
    {
      Index& f = first[this->SideOf[h]];
      if (f < 0)
      {
        f = static_cast<Index>(h);
      }
      else
      {
        this->Out.Graph.link(f, static_cast<Index>(h));
      }
    }
    const QuadGraph& g = this->Out.Graph;
    for (Index h = 0; h < g.halfEdges(); ++h)
    {
      const Index o = g.Opposite[h];
      if (o >= 0 && (g.start(h) != g.end(o) || g.end(h) != g.start(o)))
      {
        this->Out.Problem = "two cells of the Morse-Smale complex do not fit";
      }
    }
  }

  const TriangleSurface& S;
  const MorseGradient& G;
  MorseCells& Out;
  MorseCut C;
  std::vector<Index> MinimumOf;  ///< node of each minimum, per vertex
  std::vector<Index> MaximumOf;  ///< node of each maximum, per triangle
  std::vector<Index> NodeOf;     ///< node of each vertex of a boundary that is one
  std::map<Index, Index> PathOf; ///< side of the path from each saddle on a boundary
  std::vector<Chain> Down;       ///< per cell: maximum to minimum, counter-clockwise
  std::vector<Chain> UpWards;    ///< per cell: minimum to maximum
  std::vector<Index> SideOf;     ///< per half-edge of the graph
  Index Sides = 0;
};
} // namespace

MorseCells morseCells(const TriangleSurface& s, const MorseGradient& g)
{
  MorseCells cells;
  Builder(s, g, cells).run();
  return cells;
}
} // namespace bsr
