#include "Common/UnionFind.h"
#include "Contour/BranchedSurface.h"
#include "Contour/WeldModel.h"

#include <algorithm>
#include <map>
#include <set>

namespace bsr
{
namespace
{
constexpr int MaximumSpans = 12; ///< of a patch along u

int wrap(int u, int n)
{
  return (u % n + n) % n;
}

/// Where a column's start lies at an end of a tube: on an arc of a junction or cap, from its start.
struct Place
{
  Index Arc = -1;
  int Offset = 0;
  int Spans = 0;
};

/// A patch before its sides are numbered for the model.
struct Draft
{
  std::vector<ControlRow> Rows;
  std::vector<double> KnotsU;
  std::vector<double> KnotsV;
  std::array<int, 2> Degree{};
  std::array<std::int64_t, 4> Neighbors{-1, -1, -1, -1};
  bool Turned = false; ///< u and v are exchanged in the model
  Shell Side = Shell::Outer;
  PatchOrigin Origin;
};

class Assembler
{
public:
  Assembler(const ContourStack& stack, const BranchedNetwork& net,
    const std::vector<TubeSurface>& tubes, const InsertedRows& inserted,
    const BranchedOptions& options)
      : Stack(stack),
        Net(net),
        Tubes(tubes),
        Inserted(inserted),
        Options(options),
        Cuts(net.Tubes.size()),
        PatchAt(net.Tubes.size())
  {
  }

  BranchedSurface run()
  {
    this->findShells();
    this->findCuts();
    for (std::size_t t = 0; t < this->Tubes.size(); ++t)
    {
      this->addTube(static_cast<Index>(t));
    }
    for (std::size_t t = 0; t < this->Tubes.size(); ++t)
    {
      this->joinTube(static_cast<Index>(t));
      for (int e = 0; e < 2; ++e)
      {
        if (this->Net.Tubes[t].Capped[e])
        {
          this->addCap(static_cast<Index>(t), e);
        }
      }
    }
    this->write();
    weldModel(this->Out.Model);
    this->Out.Network = this->Net;
    return std::move(this->Out);
  }

private:
  /// Surfaces of holes only are inner shells.
  void findShells()
  {
    const std::size_t n = this->Net.Tubes.size();
    UnionFind sets(static_cast<std::int64_t>(n));
    for (const Junction& j : this->Net.Junctions)
    {
      for (const Index b : j.Branches)
      {
        sets.join(j.Stem, b);
      }
    }
    std::vector<char> outer(n, 0);
    for (std::size_t t = 0; t < n; ++t)
    {
      char& o = outer[sets.find(static_cast<std::int64_t>(t))];
      o = o || !this->Net.Tubes[t].Hole ? 1 : 0;
    }
    for (std::size_t t = 0; t < n; ++t)
    {
      this->Inner.push_back(outer[sets.find(static_cast<std::int64_t>(t))] ? 0 : 1);
    }
  }

  int columns(Index t) const { return this->Net.Tubes[t].Columns; }

  Place placeAt(Index t, int end, int u) const
  {
    const Tube& tube = this->Net.Tubes[t];
    const int n = tube.Columns;
    if (tube.Junctions[end] >= 0)
    {
      const Junction& j = this->Net.Junctions[tube.Junctions[end]];
      for (std::size_t a = 0; a < j.Arcs.size(); ++a)
      {
        const JunctionArc& arc = j.Arcs[a];
        const bool stem = j.Stem == t;
        const int offset = wrap(u - (stem ? arc.StemColumn : arc.BranchColumn), n);
        if ((stem || j.Branches[arc.Branch] == t) && offset < arc.Spans)
        {
          return {static_cast<Index>(a), offset, arc.Spans};
        }
      }
    }
    else if (tube.Capped[end])
    {
      const std::vector<int>& c = tube.Corners[end];
      for (int a = 0; a < 4; ++a)
      {
        const int spans = wrap(c[(a + 1) % 4] - c[a], n);
        const int offset = wrap(u - c[a], n);
        if (offset < spans)
        {
          return {static_cast<Index>(a), offset, spans};
        }
      }
    }
    return {};
  }

  /// The column across an end: tube and column of the other side of a junction, or the opposite
  /// side of a cap.
  std::pair<Index, int> across(Index t, int end, int u) const
  {
    const Place p = this->placeAt(t, end, u);
    const Tube& tube = this->Net.Tubes[t];
    if (tube.Junctions[end] >= 0)
    {
      const Junction& j = this->Net.Junctions[tube.Junctions[end]];
      const JunctionArc& arc = j.Arcs[p.Arc];
      const Index other = j.Stem == t ? j.Branches[arc.Branch] : j.Stem;
      const int first = j.Stem == t ? arc.BranchColumn : arc.StemColumn;
      return {other, wrap(first + p.Offset, this->columns(other))};
    }
    const int opposite = tube.Corners[end][(p.Arc + 2) % 4];
    return {t, wrap(opposite + p.Spans - p.Offset, tube.Columns)};
  }

  /// All columns at which tubes are cut: corners, and their continuations through junctions.
  void findCuts()
  {
    std::vector<std::pair<Index, int>> open;
    const auto add = [&](Index t, int u)
    {
      if (this->Cuts[t].insert(u).second)
      {
        open.emplace_back(t, u);
      }
    };
    for (std::size_t t = 0; t < this->Tubes.size(); ++t)
    {
      for (const TubeArc& a : this->Tubes[t].Arcs)
      {
        add(static_cast<Index>(t), a.Column);
      }
      if (this->Cuts[t].size() < 2)
      {
        const int n = this->columns(static_cast<Index>(t));
        add(static_cast<Index>(t), wrap(*this->Cuts[t].begin() + n / 2, n));
      }
    }
    this->spread(open);
    for (std::size_t t = 0; t < this->Tubes.size(); ++t)
    {
      this->addBetween(static_cast<Index>(t), add);
      this->spread(open);
    }
  }

  /// More cuts where columns between two are many.
  template <class Add>
  void addBetween(Index t, const Add& add)
  {
    const std::vector<int> cuts(this->Cuts[t].begin(), this->Cuts[t].end());
    const int n = this->columns(t);
    for (std::size_t k = 0; k < cuts.size(); ++k)
    {
      const int spans = k + 1 < cuts.size() ? cuts[k + 1] - cuts[k] : n + cuts[0] - cuts[k];
      const int pieces = (spans + MaximumSpans - 1) / MaximumSpans;
      for (int i = 1; i < pieces; ++i)
      {
        add(t, wrap(cuts[k] + spans * i / pieces, n));
      }
    }
  }

  /// Continues cuts through junctions and across caps.
  void spread(std::vector<std::pair<Index, int>>& open)
  {
    while (!open.empty())
    {
      const auto [t, u] = open.back();
      open.pop_back();
      for (int e = 0; e < 2; ++e)
      {
        const Place p = this->placeAt(t, e, u);
        if (p.Arc >= 0 && p.Offset > 0)
        {
          const auto [other, column] = this->across(t, e, u);
          if (this->Cuts[other].insert(column).second)
          {
            open.emplace_back(other, column);
          }
        }
      }
    }
  }

  void addTube(Index t)
  {
    const int order = this->Options.OrderU;
    for (const TubeArc& arc : this->Tubes[t].Arcs)
    {
      std::vector<int> cuts(1, 0);
      for (int k = 1; k <= arc.Spans; ++k)
      {
        if (k == arc.Spans || this->Cuts[t].count(wrap(arc.Column + k, this->columns(t))) > 0)
        {
          cuts.push_back(k);
        }
      }
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
      {
        std::vector<ControlRow> rows;
        for (const ControlRow& r : arc.Rows)
        {
          rows.push_back(cuts.size() == 2 ? r
                                          : curvePiece({clampedKnots(order, arc.Spans), r}, order,
                                              cuts[k], cuts[k + 1])
                                              .Points);
        }
        this->PatchAt[t][wrap(arc.Column + cuts[k], this->columns(t))] =
          static_cast<std::int64_t>(this->Drafts.size());
        this->addStrip(t, transposed(rows), cuts[k + 1] - cuts[k]);
      }
    }
  }

  /// The patches of a strip of a tube, upward; `columns` along v.
  void addStrip(Index t, const std::vector<ControlRow>& columns, int spans)
  {
    const TubeSurface& tube = this->Tubes[t];
    for (std::size_t c = 0; c + 1 < tube.CutsV.size(); ++c)
    {
      Draft d;
      d.KnotsU = clampedKnots(this->Options.OrderU, spans);
      for (const ControlRow& column : columns)
      {
        KnotCurve piece =
          curvePiece({tube.KnotsV, column}, this->Options.OrderV, tube.CutsV[c], tube.CutsV[c + 1]);
        d.Rows.push_back(std::move(piece.Points));
        d.KnotsV = std::move(piece.Knots);
      }
      d.Rows = transposed(d.Rows);
      d.Degree = {this->Options.OrderU - 1, this->Options.OrderV - 1};
      this->setOrigin(d, t, -1);
      d.Origin.End = 2 * (c + 1) > tube.CutsV.size() - 1 ? 1 : 0;
      this->Drafts.push_back(std::move(d));
      const auto own = static_cast<std::int64_t>(this->Drafts.size()) - 1;
      if (c > 0)
      {
        this->join(own - 1, 2, own, 0);
      }
    }
  }

  void setOrigin(Draft& d, Index t, Index cap) const
  {
    const Tube& tube = this->Net.Tubes[t];
    d.Origin = {t, cap, this->Stack.Contours[tube.Contours[0]].Component, cap == 1 ? 1 : 0};
    d.Turned = cap == 0;
    d.Side = this->Inner[t] ? Shell::Inner : Shell::Outer;
  }

  void join(std::int64_t a, int sideA, std::int64_t b, int sideB)
  {
    this->Drafts[a].Neighbors[sideA] = 4 * b + sideB;
    this->Drafts[b].Neighbors[sideB] = 4 * a + sideA;
  }

  /// Patches of a strip.
  std::int64_t pieces(Index t) const
  {
    return static_cast<std::int64_t>(this->Tubes[t].CutsV.size()) - 1;
  }

  void joinTube(Index t)
  {
    const auto& patches = this->PatchAt[t];
    for (auto p = patches.begin(); p != patches.end(); ++p)
    {
      const auto next = std::next(p) == patches.end() ? patches.begin() : std::next(p);
      const std::int64_t pieces = this->pieces(t);
      for (std::int64_t k = 0; k < pieces; ++k)
      {
        this->join(p->second + k, 1, next->second + k, 3);
      }
      if (this->Net.Tubes[t].Junctions[1] >= 0)
      {
        const auto [other, column] = this->across(t, 1, p->first);
        this->join(p->second + pieces - 1, 2, this->PatchAt[other].at(column), 0);
      }
    }
  }

  /// Cuts of a cap along an arc, from its start.
  std::vector<int> cutsOn(Index t, int end, int arc) const
  {
    const Tube& tube = this->Net.Tubes[t];
    const std::vector<int>& c = tube.Corners[end];
    const int spans = wrap(c[(arc + 1) % 4] - c[arc], tube.Columns);
    std::vector<int> cuts;
    for (int k = 0; k <= spans; ++k)
    {
      if (k == 0 || k == spans || this->Cuts[t].count(wrap(c[arc] + k, tube.Columns)) > 0)
      {
        cuts.push_back(k);
      }
    }
    return cuts;
  }

  void addCap(Index t, int end)
  {
    const int order = this->Options.OrderU;
    const std::vector<int> cu = this->cutsOn(t, end, 0);
    const std::vector<int> cv = this->cutsOn(t, end, 1);
    const auto first = static_cast<std::int64_t>(this->Drafts.size());
    const auto nu = static_cast<std::int64_t>(cu.size()) - 1;
    const auto nv = static_cast<std::int64_t>(cv.size()) - 1;
    for (std::int64_t j = 0; j < nv; ++j)
    {
      for (std::int64_t i = 0; i < nu; ++i)
      {
        Draft d;
        d.Rows = pieceOfNet(this->Inserted.Caps[t][end].Net, order, {cu.back(), cv.back()},
          {cu[i], cu[i + 1]}, {cv[j], cv[j + 1]});
        d.KnotsU = clampedKnots(order, cu[i + 1] - cu[i]);
        d.KnotsV = clampedKnots(order, cv[j + 1] - cv[j]);
        d.Degree = {order - 1, order - 1};
        this->setOrigin(d, t, end);
        this->Drafts.push_back(std::move(d));
        if (i > 0)
        {
          this->join(first + j * nu + i - 1, 1, first + j * nu + i, 3);
        }
        if (j > 0)
        {
          this->join(first + (j - 1) * nu + i, 2, first + j * nu + i, 0);
        }
      }
    }
    const std::vector<int>& c = this->Net.Tubes[t].Corners[end];
    const int n = this->columns(t);
    const int side = end == 0 ? 0 : 2;
    const auto below = [&](int column)
    { return this->PatchAt[t].at(wrap(column, n)) + (end == 0 ? 0 : this->pieces(t) - 1); };
    for (std::int64_t i = 0; i < nu; ++i)
    {
      this->join(first + i, 0, below(c[0] + cu[i]), side);
      this->join(first + (nv - 1) * nu + i, 2, below(c[2] + cu.back() - cu[i + 1]), side);
    }
    for (std::int64_t j = 0; j < nv; ++j)
    {
      this->join(first + j * nu + nu - 1, 1, below(c[1] + cv[j]), side);
      this->join(first + j * nu, 3, below(c[3] + cv.back() - cv[j + 1]), side);
    }
  }

  static std::vector<ControlRow> transposed(const std::vector<ControlRow>& rows)
  {
    std::vector<ControlRow> out(rows[0].size(), ControlRow(rows.size()));
    for (std::size_t j = 0; j < rows.size(); ++j)
    {
      for (std::size_t i = 0; i < rows[j].size(); ++i)
      {
        out[i][j] = rows[j][i];
      }
    }
    return out;
  }

  static std::vector<ControlRow> pieceOfNet(const std::vector<ControlRow>& net, int order,
    const std::array<int, 2>& spans, const std::array<int, 2>& u, const std::array<int, 2>& v)
  {
    std::vector<ControlRow> rows;
    rows.reserve(net.size());
    for (const ControlRow& r : net)
    {
      rows.push_back(curvePiece({clampedKnots(order, spans[0]), r}, order, u[0], u[1]).Points);
    }
    rows = transposed(rows);
    for (ControlRow& r : rows)
    {
      r = curvePiece({clampedKnots(order, spans[1]), r}, order, v[0], v[1]).Points;
    }
    return transposed(rows);
  }

  std::int64_t knotsOf(const std::vector<double>& knots)
  {
    const auto known = this->KnotIndex.find(knots);
    if (known != this->KnotIndex.end())
    {
      return known->second;
    }
    auto& all = this->Out.Model.Knots;
    const auto first = static_cast<std::int64_t>(all.size());
    all.insert(all.end(), knots.begin(), knots.end());
    this->KnotIndex.emplace(knots, first);
    return first;
  }

  void write()
  {
    SplineModel& m = this->Out.Model;
    for (Draft& d : this->Drafts)
    {
      if (d.Turned)
      {
        d.Rows = transposed(d.Rows);
        std::swap(d.KnotsU, d.KnotsV);
        std::swap(d.Degree[0], d.Degree[1]);
      }
      SplinePatch p;
      p.Side = d.Side;
      p.DegreeU = d.Degree[0];
      p.DegreeV = d.Degree[1];
      p.CountU = static_cast<int>(d.Rows[0].size());
      p.CountV = static_cast<int>(d.Rows.size());
      p.FirstKnotU = this->knotsOf(d.KnotsU);
      p.FirstKnotV = this->knotsOf(d.KnotsV);
      p.FirstControlPoint = static_cast<std::int64_t>(m.ControlPoints.size());
      for (const ControlRow& r : d.Rows)
      {
        for (const Vec3& c : r)
        {
          m.ControlPoints.emplace_back(c[0], c[1], c[2], 1.0);
        }
      }
      std::array<std::int64_t, 4> neighbors{};
      for (int s = 0; s < 4; ++s)
      {
        const std::int64_t code = d.Neighbors[s];
        const bool turned = code >= 0 && this->Drafts[code / 4].Turned;
        neighbors[d.Turned ? 3 - s : s] = turned ? code - code % 4 + (3 - code % 4) : code;
      }
      m.Neighbors.push_back(neighbors);
      m.Patches.push_back(p);
      this->Out.Origins.push_back(d.Origin);
    }
  }

  const ContourStack& Stack;
  const BranchedNetwork& Net;
  const std::vector<TubeSurface>& Tubes;
  const InsertedRows& Inserted;
  const BranchedOptions& Options;
  std::vector<char> Inner; ///< of each tube
  std::vector<std::set<int>> Cuts;
  std::vector<std::map<int, std::int64_t>> PatchAt; ///< by first column
  std::vector<Draft> Drafts;
  std::map<std::vector<double>, std::int64_t> KnotIndex;
  BranchedSurface Out;
};
} // namespace

BranchedSurface assemblePatches(const ContourStack& stack, const BranchedNetwork& net,
  const std::vector<TubeSurface>& tubes, const InsertedRows& inserted,
  const BranchedOptions& options)
{
  return Assembler(stack, net, tubes, inserted, options).run();
}
} // namespace bsr
