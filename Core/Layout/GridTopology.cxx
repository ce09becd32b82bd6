#include "Layout/GridTopology.h"

#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
constexpr Index RealBase = 1 << 29; ///< stands for a coordinate that is not whole

class TopologyBuilder
{
public:
  TopologyBuilder(
    const TriangleSurface& s, GridTopology& topology, int mostSingular, Monitor& monitor)
      : S(s),
        T(topology),
        MostSingular(mostSingular),
        M(monitor),
        Cut(s.Vertex.size(), 0),
        Jump(s.Vertex.size(), 0),
        Singular(s.Points.size(), 0),
        Border(s.Points.size(), 0)
  {
  }

  void run()
  {
    this->T.Used.assign(this->S.Points.size(), 0);
    for (Index h = 0; h < this->count(); ++h)
    {
      this->T.Used[this->S.start(h)] |= this->inside(h);
      this->Border[this->S.start(h)] |= this->borderEdge(h);
      this->Border[this->S.end(h)] |= this->borderEdge(h);
    }
    this->comb();
    this->findSingular();
    this->goOn(this->T.Singular <= this->MostSingular);
    if (this->T.Usable)
    {
      this->prune();
      this->segments();
    }
    if (this->T.Usable)
    {
      this->corners();
    }
    if (this->T.Usable)
    {
      this->constraints();
    }
  }

private:
  /// The topology is of use only if `condition` holds and the monitor does not cancel.
  bool goOn(bool condition = true)
  {
    this->T.Usable = this->T.Usable && condition && !this->M.cancelled();
    return this->T.Usable;
  }
  bool goOnAt(Index i) { return i % 512 != 0 ? this->T.Usable : this->goOn(); }

  Index count() const { return static_cast<Index>(this->S.Vertex.size()); }
  bool inside(Index h) const { return this->T.Field.Inside[h / 3] != 0; }
  bool borderEdge(Index h) const { return this->inside(h) && !this->inside(this->S.Opposite[h]); }
  bool innerEdge(Index h) const { return this->inside(h) && this->inside(this->S.Opposite[h]); }

  int jump(Index h) const
  {
    const Index o = this->S.Opposite[h];
    const double angle = edgeAngle(this->S, o) + M_PI - edgeAngle(this->S, h) -
                         this->T.Field.Angle[o / 3] + this->T.Field.Angle[h / 3];
    return static_cast<int>(std::lround(angle / (0.5 * M_PI))) & 3;
  }

  /// Turns the crosses so that neighbors of a spanning tree of triangles agree; the rest is cut.
  void comb()
  {
    std::vector<std::uint8_t> seen(this->S.Region.size(), 0);
    for (Index h = 0; h < this->count(); ++h)
    {
      this->Cut[h] = this->innerEdge(h);
    }
    std::vector<Index> queue;
    int pieces = 0;
    for (Index seed = 0; seed < this->S.faces(); ++seed)
    {
      if (seen[seed] || !this->T.Field.Inside[seed])
      {
        continue;
      }
      ++pieces;
      seen[seed] = 1;
      queue.assign(1, seed);
      for (std::size_t i = 0; i < queue.size(); ++i)
      {
        for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h)
        {
          const Index o = this->S.Opposite[h];
          if (!this->inside(o) || seen[o / 3])
          {
            continue;
          }
          seen[o / 3] = 1;
          this->T.Field.Angle[o / 3] += 0.5 * M_PI * this->jump(h);
          this->Cut[h] = this->Cut[o] = 0;
          queue.push_back(o / 3);
        }
      }
    }
    for (Index h = 0; h < this->count(); ++h)
    {
      const Index o = this->S.Opposite[h];
      this->Jump[h] = !this->innerEdge(h) ? 0 : o < h ? (4 - this->Jump[o]) & 3 : this->jump(h);
    }
    this->T.Usable = pieces == 1;
  }

  void findSingular()
  {
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      if (this->T.Used[v] && !this->Border[v])
      {
        int sum = 0;
        this->S.around(v, [&](Index h) { sum += this->Jump[h]; });
        this->Singular[v] = (sum & 3) != 0;
        this->T.Singular += this->Singular[v];
      }
    }
  }

  int cutDegree(Index v) const
  {
    int n = 0;
    this->S.around(v, [&](Index h) { n += this->Cut[h]; });
    return n;
  }

  /// Takes back cuts that end at regular vertices.
  void prune()
  {
    std::vector<Index> stack(this->S.vertices());
    std::iota(stack.begin(), stack.end(), Index(0));
    while (!stack.empty())
    {
      const Index v = stack.back();
      stack.pop_back();
      if (!this->T.Used[v] || this->Border[v] || this->Singular[v] || this->cutDegree(v) != 1)
      {
        continue;
      }
      this->S.around(v,
        [&](Index h)
        {
          if (this->Cut[h])
          {
            this->Cut[h] = this->Cut[this->S.Opposite[h]] = 0;
            stack.push_back(this->S.end(h));
          }
        });
    }
  }

  bool node(Index v) const
  {
    return this->Border[v] || this->Singular[v] || this->cutDegree(v) != 2;
  }

  /// Numbers the cuts between nodes; each has one transition.
  void segments()
  {
    this->T.Segment.assign(this->S.Vertex.size(), -1);
    this->T.Forward.assign(this->S.Vertex.size(), 0);
    for (int round = 0; round < 2; ++round) // the second round finds cuts without nodes
    {
      for (Index h = 0; h < this->count(); ++h)
      {
        if (this->Cut[h] && this->T.Segment[h] < 0 && (round == 1 || this->node(this->S.start(h))))
        {
          this->walk(h);
        }
      }
    }
  }

  void walk(Index h)
  {
    const Index id = this->Segments++;
    for (Index x = h; x >= 0 && this->T.Segment[x] < 0;)
    {
      const Index o = this->S.Opposite[x];
      this->T.Segment[x] = this->T.Segment[o] = id;
      this->T.Forward[x] = 1;
      if (this->Jump[x] != this->Jump[h])
      {
        this->T.Usable = false;
      }
      Index onward = -1;
      if (!this->node(this->S.end(x)))
      {
        this->S.around(
          this->S.end(x), [&](Index y) { onward = this->Cut[y] && y != o ? y : onward; });
      }
      x = onward;
    }
  }

  /// Takes a corner's form over half-edge e, from the triangle of its opposite to its own.
  void cross(Index e, CornerForm& form) const
  {
    const Index segment = this->T.Segment[e];
    if (segment < 0)
    {
      return;
    }
    if (!this->T.Forward[e])
    {
      // The opposite runs with the cut: uv' = turned(uv) + shift.
      this->turn(form, this->Jump[this->S.Opposite[e]]);
      addForm(form.Form[0], {{2 * segment, 1}}, 1);
      addForm(form.Form[1], {{2 * segment + 1, 1}}, 1);
    }
    else
    {
      addForm(form.Form[0], {{2 * segment, 1}}, -1);
      addForm(form.Form[1], {{2 * segment + 1, 1}}, -1);
      this->turn(form, 4 - this->Jump[e]);
    }
  }

  static void turn(CornerForm& form, int n)
  {
    form.Turn = (form.Turn + n) & 3;
    for (int i = 0; i < (n & 3); ++i)
    {
      IntegerForm u;
      addForm(u, form.Form[1], -1);
      form.Form[1] = std::move(form.Form[0]);
      form.Form[0] = std::move(u);
    }
  }

  void corners()
  {
    this->T.Corners.assign(this->S.Vertex.size(), {});
    std::vector<std::uint8_t> done(this->S.Vertex.size(), 0);
    this->Closing.assign(this->S.Points.size(), {});
    for (Index v = 0; v < this->S.vertices() && this->goOnAt(v); ++v)
    {
      if (!this->T.Used[v])
      {
        continue;
      }
      Index first = this->S.Out[v];
      if (this->Border[v])
      {
        int fans = 0;
        this->S.around(v,
          [&](Index h)
          {
            first = this->borderEdge(h) ? h : first;
            fans += this->borderEdge(h);
          });
        this->T.Usable = this->T.Usable && fans == 1;
      }
      CornerForm form;
      Index h = first;
      do
      {
        this->T.Corners[h] = form;
        h = this->S.turn(h);
        if (!this->inside(h))
        {
          break;
        }
        this->cross(h, form);
      } while (h != first);
      this->Closing[v] = form;
    }
  }

  /// The coordinate c of a corner over the unknowns (RealBase and more: not whole).
  IntegerForm coordinate(Index h, int c) const
  {
    const CornerForm& corner = this->T.Corners[h];
    int from = 0;
    const int sign = corner.source(c, from);
    const Index slot = 2 * this->S.start(h) + from;
    IntegerForm form = corner.Form[c];
    const Index id = this->T.Whole[slot] >= 0 ? this->T.Whole[slot] : RealBase + slot;
    addForm(form, {{id, 1}}, sign);
    return form;
  }

  int axis(Index h) const
  {
    const double angle = edgeAngle(this->S, h) - this->T.Field.Angle[h / 3];
    return static_cast<int>(std::lround(angle / (0.5 * M_PI))) & 3;
  }

  bool aligned(Index h) const { return this->inside(h) && this->S.Crease[h]; }

  void markWhole(Index h, int c)
  {
    int from = 0;
    this->T.Corners[h].source(c, from);
    Index& id = this->T.Whole[2 * this->S.start(h) + from];
    id = id < 0 ? 2 * this->Segments + this->WholeCount++ : id;
  }

  void constraints()
  {
    this->T.Whole.assign(2 * this->S.Points.size(), -1);
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      for (int c = 0; c < 2 && this->Singular[v]; ++c)
      {
        this->T.Whole[2 * v + c] = 2 * this->Segments + this->WholeCount++;
      }
    }
    for (Index h = 0; h < this->count(); ++h)
    {
      if (this->aligned(h))
      {
        const int c = this->axis(h) % 2 == 0 ? 1 : 0;
        this->markWhole(h, c);
        this->markWhole(TriangleSurface::next(h), c);
      }
    }
    std::vector<IntegerForm> loops = this->evenLoops();
    const Index base = 2 * this->Segments + this->WholeCount;
    this->T.Kernel = IntegerKernel(base + static_cast<Index>(loops.size()));
    this->requireClosing();
    for (Index h = 0; h < this->count() && this->goOnAt(h); ++h)
    {
      if (this->aligned(h))
      {
        const int c = this->axis(h) % 2 == 0 ? 1 : 0;
        IntegerForm row = this->coordinate(h, c);
        addForm(row, this->coordinate(TriangleSurface::next(h), c), -1);
        this->T.Kernel.require(row);
      }
    }
    for (std::size_t i = 0; i < loops.size(); ++i)
    {
      loops[i][base + static_cast<Index>(i)] = -2;
      this->T.Kernel.require(loops[i]);
    }
    if (this->goOn())
    {
      this->T.Kernel.finish();
    }
  }

  /// Once around a vertex leads back to the same coordinates.
  void requireClosing()
  {
    for (Index v = 0; v < this->S.vertices() && this->goOnAt(v); ++v)
    {
      if (!this->T.Used[v] || this->Border[v])
      {
        continue;
      }
      for (int c = 0; c < 2; ++c)
      {
        IntegerForm row = this->Closing[v].Form[c];
        if (this->Closing[v].Turn != 0)
        {
          int from = 0;
          const int sign = this->Closing[v].source(c, from);
          addForm(row, {{this->T.Whole[2 * v + from], 1}}, sign);
          addForm(row, {{this->T.Whole[2 * v + c], 1}}, -1);
        }
        this->T.Kernel.require(row);
      }
    }
  }

  /// The number of cells around each border towards a region, where it is whole by itself.
  std::vector<IntegerForm> evenLoops() const
  {
    std::vector<IntegerForm> loops;
    std::vector<std::uint8_t> done(this->S.Vertex.size(), 0);
    for (Index h = 0; h < this->count(); ++h)
    {
      if (!this->borderEdge(h) || done[h] || this->S.hole(this->S.Opposite[h] / 3))
      {
        continue;
      }
      IntegerForm sum;
      for (Index x = h; !done[x];)
      {
        done[x] = 1;
        const int m = this->axis(x);
        const int sign = m < 2 ? 1 : -1;
        addForm(sum, this->coordinate(TriangleSurface::next(x), m % 2), sign);
        addForm(sum, this->coordinate(x, m % 2), -sign);
        // The next border half-edge starts where this one ends.
        Index y = TriangleSurface::next(x);
        while (!this->borderEdge(y))
        {
          y = TriangleSurface::next(this->S.Opposite[y]);
        }
        x = y;
      }
      if (sum.empty() || sum.rbegin()->first < RealBase)
      {
        loops.push_back(sum);
      }
    }
    return loops;
  }

  const TriangleSurface& S;
  GridTopology& T;
  int MostSingular;
  Monitor& M;
  std::vector<std::uint8_t> Cut;
  std::vector<int> Jump;
  std::vector<std::uint8_t> Singular;
  std::vector<std::uint8_t> Border;
  std::vector<CornerForm> Closing; ///< per vertex: the form after one turn
  Index Segments = 0;
  Index WholeCount = 0;

public:
  const std::vector<int>& jumps() const { return this->Jump; }
};
} // namespace

void GridTopology::transitions(const TriangleSurface& s, const std::vector<std::int64_t>& free,
  std::vector<std::uint8_t>& turn, std::vector<GridPoint>& shift) const
{
  auto value = [&](Index variable)
  {
    std::int64_t sum = 0;
    for (const auto& [i, factor] : this->Kernel.variable(variable))
    {
      sum += factor * free[i];
    }
    return sum;
  };
  turn.assign(s.Vertex.size(), 0);
  shift.assign(s.Vertex.size(), GridPoint{0, 0});
  for (std::size_t h = 0; h < s.Vertex.size(); ++h)
  {
    if (this->Segment[h] < 0)
    {
      continue;
    }
    const GridPoint t{value(2 * this->Segment[h]), value(2 * this->Segment[h] + 1)};
    turn[h] = this->Turn[h];
    // Backward: uv = turned(uv' - t) by the inverse, which is this half-edge's own turn.
    shift[h] = this->Forward[h] ? t : turned(GridPoint{-t[0], -t[1]}, this->Turn[h]);
  }
}

GridTopology gridTopology(
  const TriangleSurface& s, const CrossField& field, int mostSingular, Monitor& monitor)
{
  GridTopology topology;
  topology.Field = field;
  TopologyBuilder builder(s, topology, mostSingular, monitor);
  builder.run();
  topology.Turn.assign(builder.jumps().begin(), builder.jumps().end());
  return topology;
}
} // namespace bsr
