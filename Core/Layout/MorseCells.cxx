#include "Layout/MorseCells.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace bsr
{
namespace
{
std::uint64_t keyOf(Index a, Index b)
{
  return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
}

/// The surface cut along the paths of all saddles.
class Cutter
{
public:
  Cutter(const TriangleSurface& s, const MorseGradient& g, PartitionedSurface& out)
      : S(s),
        G(g),
        Out(out),
        Crossed(s.Vertex.size(), 0),
        Walked(s.Vertex.size(), 0),
        Reached(s.Region.size(), 0),
        Middle(s.Vertex.size(), -1),
        Number(s.Points.size(), -1)
  {
  }

  void run()
  {
    this->trace();
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      if (!this->S.Virtual[v])
      {
        this->Number[v] = this->addPoint(this->S.Points[v], this->G.Value[v]);
      }
    }
    for (Index t = 0; t < this->S.faces(); ++t)
    {
      if (!this->S.hole(t))
      {
        this->cut(t);
      }
    }
    this->grow();
  }

  /// The triangle left of a directed edge of the cut surface, -1 if there is none.
  Index left(Index a, Index b) const
  {
    const auto at = this->Edges.find(keyOf(a, b));
    return at == this->Edges.end() ? -1 : at->second;
  }
  Index cellAt(Index a, Index b) const
  {
    const Index t = this->left(a, b);
    return t < 0 ? -1 : this->Out.Cell[t];
  }
  Index point(Index vertex) const { return this->Number[vertex]; }
  /// The point on an edge that a path crosses.
  Index middle(Index h)
  {
    const Index e = std::min(h, this->S.Opposite[h]);
    if (this->Middle[e] < 0)
    {
      const Index a = this->S.start(h);
      const Index b = this->S.end(h);
      this->Middle[e] = this->addPoint(
        0.5 * (this->S.Points[a] + this->S.Points[b]), 0.5 * (this->G.Value[a] + this->G.Value[b]));
    }
    return this->Middle[e];
  }
  Index cells() const { return this->Cells; }
  /// The extrema of each cell: triangle of the maximum, vertex of the minimum; -1 unknown.
  std::vector<std::pair<Index, Index>> extrema() const
  {
    std::vector<Index> vertexOf; // points begin with the vertices
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      if (!this->S.Virtual[v])
      {
        vertexOf.push_back(v);
      }
    }
    std::vector<std::pair<Index, Index>> found(this->Cells, {-1, -1});
    for (std::size_t t = 0; t < this->Origin.size(); ++t)
    {
      auto& of = found[this->Out.Cell[t]];
      if (of.second >= 0)
      {
        continue;
      }
      const Index top = this->G.ascend(this->S, this->Origin[t]);
      for (Index p : this->Out.Mesh.Triangles[t])
      {
        // The maximum itself lies between cells.
        if (p < static_cast<Index>(vertexOf.size()) && vertexOf[p] != this->G.top(this->S, top))
        {
          of = {top, this->G.descend(this->S, vertexOf[p])};
        }
      }
    }
    return found;
  }

private:
  Index addPoint(const Vec3& p, double value)
  {
    this->Out.Mesh.Points.push_back(p);
    this->Out.Eigenfunction.push_back(value);
    this->Out.Critical.push_back(CriticalPoint::Regular);
    return static_cast<Index>(this->Out.Mesh.Points.size()) - 1;
  }

  void trace()
  {
    for (Index h : this->G.Saddles)
    {
      const Index o = this->S.Opposite[h];
      this->walkDown(this->S.start(h));
      this->walkDown(this->S.end(h));
      this->Crossed[h] = this->Crossed[o] = 1;
      this->walkUp(h / 3);
      this->walkUp(o / 3);
    }
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      if (this->G.Boundary[v] == BoundaryNode::LowerSaddle)
      {
        this->walkDown(v);
      }
      else if (this->G.Boundary[v] == BoundaryNode::UpperSaddle)
      {
        const Index h = this->G.UpperEdge[v];
        this->Crossed[h] = this->Crossed[this->S.Opposite[h]] = 1;
        this->walkUp(h / 3);
      }
    }
  }
  void walkDown(Index v)
  {
    for (Index h = this->G.Down[v]; h >= 0 && !this->Walked[h]; h = this->G.Down[this->S.end(h)])
    {
      this->Walked[h] = this->Walked[this->S.Opposite[h]] = 1;
    }
  }
  void walkUp(Index t)
  {
    Index h = this->G.Up[t];
    for (; h >= 0 && !this->Crossed[h]; h = this->G.Up[t])
    {
      this->Crossed[h] = this->Crossed[this->S.Opposite[h]] = 1;
      t = this->S.Opposite[h] / 3;
    }
    if (h < 0)
    {
      this->Reached[t] = 1;
    }
  }

  void barrier(Index a, Index b) { this->Barriers[keyOf(std::min(a, b), std::max(a, b))] = 1; }
  void add(Index a, Index b, Index c)
  {
    const auto t = static_cast<Index>(this->Out.Mesh.Triangles.size());
    this->Out.Mesh.Triangles.push_back({a, b, c});
    this->Origin.push_back(this->Current);
    this->Edges[keyOf(a, b)] = t;
    this->Edges[keyOf(b, c)] = t;
    this->Edges[keyOf(c, a)] = t;
  }

  /// Splits a triangle along the paths through it.
  void cut(Index t)
  {
    this->Current = t;
    std::array<Index, 3> edges{};
    std::array<Index, 3> corner{};
    int crossings = 0;
    for (int k = 0; k < 3; ++k)
    {
      edges[k] = 3 * t + k;
      corner[k] = this->Number[this->S.start(edges[k])];
      crossings += this->Crossed[edges[k]];
    }
    for (int k = 0; k < 3; ++k)
    {
      if (this->Walked[edges[k]])
      {
        this->barrier(corner[k], corner[(k + 1) % 3]);
      }
    }
    if (crossings == 0)
    {
      this->add(corner[0], corner[1], corner[2]);
    }
    else if (this->Reached[t])
    {
      this->cutAtMaximum(t);
    }
    else if (crossings == 3)
    {
      this->cutAtMeeting(edges, corner);
    }
    else
    {
      this->cutThrough(edges, corner);
    }
  }

  /// Two crossed edges: the path goes straight between them.
  void cutThrough(const std::array<Index, 3>& edges, const std::array<Index, 3>& corner)
  {
    int k = 0; // the edge that is not crossed
    while (this->Crossed[edges[k]])
    {
      ++k;
    }
    const Index a = corner[k];
    const Index b = corner[(k + 1) % 3];
    const Index c = corner[(k + 2) % 3];
    const Index bc = this->middle(edges[(k + 1) % 3]);
    const Index ca = this->middle(edges[(k + 2) % 3]);
    this->add(c, ca, bc);
    this->add(a, b, bc);
    this->add(a, bc, ca);
    this->barrier(bc, ca);
  }

  /// All edges are crossed: the paths meet in the middle.
  void cutAtMeeting(const std::array<Index, 3>& edges, const std::array<Index, 3>& corner)
  {
    Vec3 center = Vec3::Zero();
    double value = 0.0;
    for (Index c : corner)
    {
      center += this->Out.Mesh.Points[c] / 3.0;
      value += this->Out.Eigenfunction[c] / 3.0;
    }
    const Index m = this->addPoint(center, value);
    for (int k = 0; k < 3; ++k)
    {
      const Index e = this->middle(edges[k]);
      this->add(corner[k], e, m);
      this->add(e, corner[(k + 1) % 3], m);
      this->barrier(e, m);
    }
  }

  /// The paths end at the highest corner.
  void cutAtMaximum(Index t)
  {
    const Index top = this->G.top(this->S, t);
    Index h = 3 * t;
    while (this->S.start(h) != top)
    {
      ++h;
    }
    const Index v = this->Number[top];
    const Index a = this->Number[this->S.end(h)];
    const Index b = this->Number[this->S.apex(h)];
    const Index across = TriangleSurface::next(h);
    const Index va = this->Crossed[h] ? this->middle(h) : -1;
    const Index bv =
      this->Crossed[TriangleSurface::prev(h)] ? this->middle(TriangleSurface::prev(h)) : -1;
    for (Index side : {va, bv})
    {
      if (side >= 0)
      {
        this->barrier(side, v);
      }
    }
    if (this->Crossed[across])
    {
      const Index n = this->middle(across);
      this->barrier(n, v);
      va < 0 ? this->add(v, a, n) : (this->add(v, va, n), this->add(va, a, n));
      bv < 0 ? this->add(v, n, b) : (this->add(v, n, bv), this->add(bv, n, b));
    }
    else if (va >= 0 && bv >= 0)
    {
      this->add(v, va, bv);
      this->add(va, a, b);
      this->add(va, b, bv);
    }
    else if (va >= 0)
    {
      this->add(v, va, b);
      this->add(va, a, b);
    }
    else
    {
      this->add(v, a, bv);
      this->add(bv, a, b);
    }
  }

  /// Cells by region growing between the paths.
  void grow()
  {
    for (Index h : this->G.Saddles)
    {
      const Index m = this->middle(h);
      this->barrier(m, this->Number[this->S.start(h)]);
      this->barrier(m, this->Number[this->S.end(h)]);
    }
    const auto& triangles = this->Out.Mesh.Triangles;
    this->Out.Cell.assign(triangles.size(), -1);
    std::vector<Index> queue;
    for (std::size_t seed = 0; seed < triangles.size(); ++seed)
    {
      if (this->Out.Cell[seed] >= 0)
      {
        continue;
      }
      this->Out.Cell[seed] = this->Cells;
      queue.assign(1, static_cast<Index>(seed));
      while (!queue.empty())
      {
        const auto& c = triangles[queue.back()];
        queue.pop_back();
        for (int k = 0; k < 3; ++k)
        {
          const Index a = c[k];
          const Index b = c[(k + 1) % 3];
          const Index other = this->left(b, a);
          if (other >= 0 && this->Out.Cell[other] < 0 &&
              this->Barriers.count(keyOf(std::min(a, b), std::max(a, b))) == 0)
          {
            this->Out.Cell[other] = this->Cells;
            queue.push_back(other);
          }
        }
      }
      ++this->Cells;
    }
  }

  const TriangleSurface& S;
  const MorseGradient& G;
  PartitionedSurface& Out;
  std::vector<std::uint8_t> Crossed; ///< per half-edge: a path up goes across
  std::vector<std::uint8_t> Walked;  ///< per half-edge: a path down goes along
  std::vector<std::uint8_t> Reached; ///< per triangle: paths up end here
  std::vector<Index> Middle;         ///< per half-edge, at the smaller one of an edge
  std::vector<Index> Number;         ///< point of each vertex
  std::vector<Index> Origin;         ///< per triangle of the cut surface: that it comes from
  std::unordered_map<std::uint64_t, Index> Edges; ///< triangle left of a directed edge
  std::unordered_map<std::uint64_t, char> Barriers;
  Index Cells = 0;
  Index Current = -1;
};

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
  Cutter C;
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
