#include "Contour/BranchedSurface.h"
#include "Spline/Basis.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double BendLimit = 1.0; ///< change of a column's step, in mean steps
/// Spans of a patch along v, at most; short where a long one folds or bends more than samples tell.
constexpr std::size_t LongSpans = 10;
constexpr std::size_t ShortSpans = 3;

double meanDistance(const ControlRow& a, const ControlRow& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    sum += (a[i] - b[i]).norm();
  }
  return sum / static_cast<double>(a.size());
}

/// Inserted rows of one end of a tube, over [column, column + spans].
std::vector<ControlRow> endRowsOver(const BranchedNetwork& net, Index t, int end,
  const InsertedRows& inserted, int order, int column, int spans)
{
  const Tube& tube = net.Tubes[t];
  const auto cut = [&](const std::vector<ControlRow>& rows, int first, int total)
  {
    const int from = ((column - first) % tube.Columns + tube.Columns) % tube.Columns;
    std::vector<ControlRow> out;
    out.reserve(rows.size());
    for (const ControlRow& r : rows)
    {
      out.push_back(curvePiece({clampedKnots(order, total), r}, order, from, from + spans).Points);
    }
    return out;
  };
  const auto holds = [&](int first, int total)
  {
    const int from = ((column - first) % tube.Columns + tube.Columns) % tube.Columns;
    return from + spans <= total;
  };
  if (tube.Junctions[end] >= 0)
  {
    const Junction& j = net.Junctions[tube.Junctions[end]];
    for (std::size_t a = 0; a < j.Arcs.size(); ++a)
    {
      const JunctionArc& arc = j.Arcs[a];
      const bool stem = j.Stem == t;
      const int first = stem ? arc.StemColumn : arc.BranchColumn;
      if ((stem || j.Branches[arc.Branch] == t) && holds(first, arc.Spans))
      {
        const ArcRows& rows = inserted.Junctions[tube.Junctions[end]].Arcs[a];
        return cut(stem ? rows.Stem : rows.Branch, first, arc.Spans);
      }
    }
  }
  else if (tube.Capped[end])
  {
    const std::vector<int>& c = tube.Corners[end];
    for (std::size_t a = 0; a < 4; ++a)
    {
      const int total = (c[(a + 1) % 4] - c[a] + tube.Columns) % tube.Columns;
      if (holds(c[a], total))
      {
        return cut(inserted.Caps[t][end].Arcs[a], c[a], total);
      }
    }
  }
  return {};
}

/// Knots and sites of a tube's rows along v.
class KnotPlan
{
public:
  KnotPlan(std::vector<double> data, const std::array<bool, 2>& fixed,
    const std::array<double, 2>& reach, const RowOptions& rows, bool periodic)
      : Order(rows.OrderV), Fixed(fixed), Periodic(periodic), Sites(std::move(data))
  {
    const RowSites own = rowSites(rows);
    const int perEnd = rows.fixedRows() - this->Order + (this->Order + 1) / 2;
    const int steps = this->Order % 2 == 1 ? perEnd : rows.fixedRows() - this->Order / 2;
    const double from = this->Sites.front() - (fixed[0] ? reach[0] : 0.0);
    const double to = this->Sites.back() + (fixed[1] ? reach[1] : 0.0);
    std::vector<double> inner;
    for (int k = 1; fixed[0] && k <= steps; ++k)
    {
      inner.push_back(from + k * reach[0] / own.Data);
    }
    for (std::size_t i = 0; i < this->Sites.size(); ++i)
    {
      if (this->Order % 2 == 0)
      {
        inner.push_back(this->Sites[i]);
      }
      else if (i > 0)
      {
        inner.push_back(0.5 * (this->Sites[i - 1] + this->Sites[i]));
      }
    }
    for (int k = steps; fixed[1] && k >= 1; --k)
    {
      inner.push_back(to - k * reach[1] / own.Data);
    }
    this->close(inner, from, to);
  }

  std::vector<double> Knots;

private:
  void close(std::vector<double> inner, double from, double to)
  {
    const auto l = static_cast<std::size_t>(this->Order);
    const std::size_t drop = this->Order % 2 == 1 ? (l - 1) / 2 : l / 2;
    std::vector<double> low(l, from);
    std::vector<double> high(l, to);
    for (const bool upper : {false, true})
    {
      if (this->Fixed[upper ? 1 : 0])
      {
        continue;
      }
      if (!this->Periodic)
      {
        const auto cut = static_cast<std::ptrdiff_t>(std::min(drop, inner.size()));
        upper ? inner.erase(inner.end() - cut, inner.end())
              : inner.erase(inner.begin(), inner.begin() + cut);
        continue;
      }
      const bool several = inner.size() > 1;
      const double step = !several ? to - from
                          : upper  ? inner.back() - inner[inner.size() - 2]
                                   : inner[1] - inner[0];
      auto& side = upper ? high : low;
      side.resize(l - drop);
      for (std::size_t k = 0; k < side.size(); ++k)
      {
        side[k] = upper ? inner.back() + static_cast<double>(k + 1) * step
                        : inner.front() - static_cast<double>(side.size() - k) * step;
      }
    }
    this->Knots = low;
    this->Knots.insert(this->Knots.end(), inner.begin(), inner.end());
    this->Knots.insert(this->Knots.end(), high.begin(), high.end());
  }

  int Order;
  std::array<bool, 2> Fixed;
  bool Periodic;
  std::vector<double> Sites;
};

class TubeMaker
{
public:
  TubeMaker(const BranchedNetwork& net, Index tube, const std::vector<ControlRow>& sections,
    const InsertedRows& inserted, const BranchedOptions& options, const RowOptions& rows, bool fine)
      : Net(net),
        T(tube),
        Data(sections),
        Inserted(inserted),
        Options(options),
        Rows(rows),
        MaximumSpans(fine ? ShortSpans : LongSpans)
  {
    const Tube& t = net.Tubes[tube];
    for (int e = 0; e < 2; ++e)
    {
      this->Fixed[e] = t.Junctions[e] >= 0 || t.Capped[e];
      this->Reach[e] = t.Junctions[e] >= 0 ? inserted.Junctions[t.Junctions[e]].Reach
                       : t.Capped[e]       ? inserted.Caps[tube][e].Reach
                                           : 0.0;
    }
  }

  TubeSurface run()
  {
    this->addSections();
    this->addBetween();
    for (std::size_t i = 0; i < this->Data.size(); ++i)
    {
      this->Sites.push_back(
        i == 0 ? 0.0 : this->Sites[i - 1] + meanDistance(this->Data[i - 1], this->Data[i]));
    }
    this->From = this->Sites.front();
    this->To = this->Sites.back();
    this->addPhantoms();
    const KnotPlan plan(this->Sites, this->Fixed, this->Reach, this->Rows, this->periodic());
    TubeSurface out;
    out.Arcs = this->arcs();
    this->Knots = plan.Knots;
    this->fillArcs(out);
    this->clamp(out);
    this->cut(out);
    return out;
  }

private:
  /// Whether a row of data was added beyond an open end.
  bool phantom(Eigen::Index i) const
  {
    return i < this->Phantoms[0] ||
           i + this->Phantoms[1] >= static_cast<Eigen::Index>(this->Data.size());
  }

  bool periodic() const { return this->Options.PeriodicKnots; }

  /// Rows half-way between others until the order has enough of them.
  void addSections()
  {
    const int fixed =
      this->Rows.fixedRows() * ((this->Fixed[0] ? 1 : 0) + (this->Fixed[1] ? 1 : 0));
    while (
      fixed + static_cast<int>(this->Data.size()) < this->Options.OrderV && this->Data.size() > 1)
    {
      ControlRow middle = this->Data[0];
      for (std::size_t i = 0; i < middle.size(); ++i)
      {
        middle[i] = 0.5 * (this->Data[0][i] + this->Data[1][i]);
      }
      this->Data.insert(this->Data.begin() + 1, std::move(middle));
    }
  }

  /// Where rows move far across what follows or went before, rows between them, on curves that do
  /// not overshoot.
  void addBetween()
  {
    if (!this->Options.Interpolate)
    {
      return;
    }
    std::vector<ControlRow> rows;
    for (std::size_t k = 0; k + 1 < this->Data.size(); ++k)
    {
      rows.push_back(this->Data[k]);
      if (this->bends(k))
      {
        ControlRow middle;
        for (std::size_t i = 0; i < this->Data[k].size(); ++i)
        {
          const Vec3 chord = this->Data[k + 1][i] - this->Data[k][i];
          const Vec3 before = k > 0 ? Vec3(this->Data[k][i] - this->Data[k - 1][i]) : chord;
          const Vec3 after =
            k + 2 < this->Data.size() ? Vec3(this->Data[k + 2][i] - this->Data[k + 1][i]) : chord;
          middle.emplace_back(this->Data[k][i] + 0.5 * chord +
                              0.125 * (limited(before, chord) - limited(chord, after)));
        }
        rows.push_back(std::move(middle));
      }
    }
    rows.push_back(this->Data.back());
    this->Data.swap(rows);
  }

  /// Whether some column's step between rows k and k + 1 is far from those beside it.
  bool bends(std::size_t k) const
  {
    double turn = 0.0;
    double step = 0.0;
    for (std::size_t i = 0; i < this->Data[k].size(); ++i)
    {
      const Vec3 chord = this->Data[k + 1][i] - this->Data[k][i];
      step += chord.norm() / static_cast<double>(this->Data[k].size());
      if (k > 0)
      {
        turn = std::max(turn, (chord - (this->Data[k][i] - this->Data[k - 1][i])).norm());
      }
      if (k + 2 < this->Data.size())
      {
        turn = std::max(turn, (this->Data[k + 2][i] - this->Data[k + 1][i] - chord).norm());
      }
    }
    // High orders swing where distances change abruptly: towards inserted slices they are graded.
    const bool graded =
      this->Options.OrderV > 4 &&
      ((this->Fixed[0] && k < 2) || (this->Fixed[1] && k + 3 > this->Data.size()));
    return graded || turn > BendLimit * step;
  }

  /// Tangent between two steps: their harmonic mean where they go the same way.
  static Vec3 limited(const Vec3& a, const Vec3& b)
  {
    const double along = a.dot(b);
    if (!(along > 0.0))
    {
      return Vec3::Zero();
    }
    const double la = a.norm();
    const double lb = b.norm();
    return along / (la * lb) * (2.0 * la * lb / (la + lb)) * (a / la + b / lb).normalized();
  }

  /// Interpolation with periodic knots: rows beyond an open end, continued in a straight line.
  void addPhantoms()
  {
    const int count =
      this->Options.Interpolate && this->periodic() ? (this->Rows.OrderV - 1) / 2 : 0;
    for (int k = 0; k<count&& this->Data.size()> 1; ++k)
    {
      if (!this->Fixed[0])
      {
        ++this->Phantoms[0];
        this->Sites.insert(this->Sites.begin(), 2.0 * this->Sites[0] - this->Sites[1]);
        this->Data.insert(this->Data.begin(), mirrored(this->Data[0], this->Data[1]));
      }
      if (!this->Fixed[1])
      {
        ++this->Phantoms[1];
        const std::size_t n = this->Data.size();
        this->Sites.push_back(2.0 * this->Sites[n - 1] - this->Sites[n - 2]);
        this->Data.push_back(mirrored(this->Data[n - 1], this->Data[n - 2]));
      }
    }
  }

  static ControlRow mirrored(const ControlRow& end, const ControlRow& next)
  {
    ControlRow row;
    for (std::size_t i = 0; i < end.size(); ++i)
    {
      row.emplace_back(2.0 * end[i] - next[i]);
    }
    return row;
  }

  std::vector<TubeArc> arcs() const
  {
    const Tube& t = this->Net.Tubes[this->T];
    std::vector<int> cuts = t.Corners[0];
    cuts.insert(cuts.end(), t.Corners[1].begin(), t.Corners[1].end());
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    if (cuts.empty())
    {
      cuts.push_back(0);
    }
    std::vector<TubeArc> arcs;
    for (std::size_t k = 0; k < cuts.size(); ++k)
    {
      TubeArc a;
      a.Column = cuts[k];
      a.Spans = k + 1 < cuts.size() ? cuts[k + 1] - cuts[k] : t.Columns + cuts[0] - cuts[k];
      arcs.push_back(std::move(a));
    }
    return arcs;
  }

  void fillArcs(TubeSurface& out)
  {
    const auto m = static_cast<Eigen::Index>(this->Data.size());
    const Eigen::Index low = this->Fixed[0] ? this->Rows.fixedRows() : 0;
    const auto count = static_cast<int>(this->Knots.size()) - this->Rows.OrderV;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(m, count);
    for (Eigen::Index i = 0; i < m; ++i)
    {
      if (this->phantom(i))
      {
        continue;
      }
      const BasisValues b =
        evaluateBasis(this->Knots.data(), this->Rows.OrderV - 1, count, this->Sites[i]);
      for (int k = 0; k < this->Rows.OrderV; ++k)
      {
        all(i, b.First + k) = b.Value[k];
      }
    }
    for (Eigen::Index i = 0; i < m; ++i) // control rows in a straight line
    {
      const Eigen::Index towards = i < this->Phantoms[0] ? 1 : -1;
      for (Eigen::Index k = 0; this->phantom(i) && k < 3; ++k)
      {
        all(i, low + i + k * towards) = k == 1 ? -2.0 : 1.0;
      }
    }
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(all.middleCols(low, m));
    for (TubeArc& a : out.Arcs)
    {
      this->fillArc(a, all, lu, low, m);
    }
  }

  void fillArc(TubeArc& a, const Eigen::MatrixXd& all,
    const Eigen::PartialPivLU<Eigen::MatrixXd>& lu, Eigen::Index low, Eigen::Index m) const
  {
    const int order = this->Options.OrderU;
    const auto bottom =
      endRowsOver(this->Net, this->T, 0, this->Inserted, order, a.Column, a.Spans);
    auto top = endRowsOver(this->Net, this->T, 1, this->Inserted, order, a.Column, a.Spans);
    std::reverse(top.begin(), top.end());
    a.Rows = bottom;
    for (const ControlRow& r : this->Data)
    {
      a.Rows.push_back(periodicPiece(r, order, a.Column, a.Spans));
    }
    a.Rows.insert(a.Rows.end(), top.begin(), top.end());
    if (!this->Options.Interpolate)
    {
      return;
    }
    const auto columns = static_cast<Eigen::Index>(a.Rows[0].size());
    Eigen::MatrixXd right(m, 3 * columns);
    const auto rows = static_cast<Eigen::Index>(a.Rows.size());
    for (Eigen::Index i = 0; i < m; ++i)
    {
      for (Eigen::Index c = 0; c < columns; ++c)
      {
        Vec3 p = this->phantom(i) ? Vec3(Vec3::Zero()) : a.Rows[low + i][c];
        for (Eigen::Index r = 0; r < rows; ++r)
        {
          if ((r < low || r >= low + m) && all(i, r) != 0.0)
          {
            p -= all(i, r) * a.Rows[r][c];
          }
        }
        right.block<1, 3>(i, 3 * c) = p.transpose();
      }
    }
    const Eigen::MatrixXd solved = lu.solve(right);
    for (Eigen::Index i = 0; i < m; ++i)
    {
      for (Eigen::Index c = 0; c < columns; ++c)
      {
        a.Rows[low + i][c] = solved.block<1, 3>(i, 3 * c).transpose();
      }
    }
  }

  /// Periodic knots at open ends are replaced by clamped ones of the same surface.
  void clamp(TubeSurface& out) const
  {
    out.KnotsV = this->Knots;
    if (!this->periodic() || (this->Fixed[0] && this->Fixed[1]))
    {
      return;
    }
    const int order = this->Rows.OrderV;
    const bool trim = this->Options.Interpolate;
    const double a = !this->Fixed[0] && trim ? this->From : this->Knots[order - 1];
    const double b = !this->Fixed[1] && trim ? this->To : this->Knots[this->Knots.size() - order];
    for (TubeArc& arc : out.Arcs)
    {
      std::vector<ControlRow> rows;
      for (std::size_t c = 0; c < arc.Rows[0].size(); ++c)
      {
        KnotCurve column{this->Knots, {}};
        for (const ControlRow& r : arc.Rows)
        {
          column.Points.push_back(r[c]);
        }
        const KnotCurve piece = curvePiece(column, order, a, b);
        rows.resize(piece.Points.size(), ControlRow(arc.Rows[0].size()));
        for (std::size_t j = 0; j < piece.Points.size(); ++j)
        {
          rows[j][c] = piece.Points[j];
        }
        out.KnotsV = piece.Knots;
      }
      arc.Rows = std::move(rows);
    }
  }

  void cut(TubeSurface& out) const
  {
    std::vector<double> ends = out.KnotsV;
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    const auto last = ends.size() - 1;
    out.CutsV.push_back(ends.front());
    std::size_t spans = 0;
    for (std::size_t k = 1; k < last; ++k)
    {
      ++spans;
      const bool zone = (this->Fixed[0] && ends[k] >= this->From && ends[k - 1] < this->From) ||
                        (this->Fixed[1] && ends[k] <= this->To && ends[k + 1] > this->To);
      if (zone || spans >= this->MaximumSpans)
      {
        out.CutsV.push_back(ends[k]);
        spans = 0;
      }
    }
    out.CutsV.push_back(ends.back());
  }

  const BranchedNetwork& Net;
  const Index T;
  std::vector<ControlRow> Data;
  const InsertedRows& Inserted;
  const BranchedOptions& Options;
  const RowOptions& Rows;
  const std::size_t MaximumSpans;
  std::array<bool, 2> Fixed{};
  std::array<double, 2> Reach{};
  std::array<Eigen::Index, 2> Phantoms{};
  std::vector<double> Sites;
  double From = 0.0;
  double To = 0.0;
  std::vector<double> Knots;
};
} // namespace

TubeSurface makeTube(const BranchedNetwork& net, Index tube,
  const std::vector<ControlRow>& sections, const InsertedRows& inserted,
  const BranchedOptions& options, const RowOptions& rows, bool fine)
{
  return TubeMaker(net, tube, sections, inserted, options, rows, fine).run();
}
} // namespace bsr
