#include "Contour/DisjointSurface.h"

#include "Contour/WeldModel.h"
#include "Spline/Basis.h"

#include <algorithm>
#include <numeric>

namespace bsr
{
namespace
{
using Column = std::vector<Vec3>;

Column columnOf(const std::vector<ControlRow>& rows, std::size_t i)
{
  Column c;
  for (const ControlRow& r : rows)
  {
    c.push_back(r[i]);
  }
  return c;
}

double distance(const Column& a, const Column& b)
{
  double d = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    d = std::max(d, (a[i] - b[i]).norm());
  }
  return d;
}

/// Splits a disjoint surface into patches.
class Splitter
{
public:
  Splitter(const DisjointSurface& surface, double tolerance)
      : Surface(surface),
        KnotsV(
          disjointKnots(surface.OrderV, static_cast<int>(surface.Rows.size()), surface.UniformV))
  {
    Vec3 low = surface.Rows[0][0];
    Vec3 high = low;
    for (const ControlRow& r : surface.Rows)
    {
      for (const Vec3& p : r)
      {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    this->Near = tolerance * (high - low).norm();
    this->cutAlongU();
  }

  DisjointModel run()
  {
    const auto [from, to] = disjointRangeV(this->Surface);
    std::vector<double> ends(1, from);
    for (const double k : this->KnotsV)
    {
      if (k > ends.back() && k <= to)
      {
        ends.push_back(k);
      }
    }
    std::vector<double> cuts(1, from);
    std::vector<std::vector<Index>> partners;
    for (std::size_t s = 0; s + 1 < ends.size(); ++s)
    {
      std::vector<Index> now = this->partnersOn(ends[s], ends[s + 1]);
      if (!partners.empty() && now == partners.back())
      {
        cuts.back() = ends[s + 1];
        continue;
      }
      partners.push_back(std::move(now));
      cuts.push_back(ends[s + 1]);
    }
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    {
      this->addPatches(cuts[i], cuts[i + 1], partners[i], i == 0, i + 2 == cuts.size());
    }
    weldModel(this->Out.Model);
    return std::move(this->Out);
  }

private:
  void cutAlongU()
  {
    const auto total = static_cast<int>(this->Surface.Rows[0].size());
    const std::vector<double> knots =
      disjointKnots(this->Surface.OrderU, total, this->Surface.UniformU);
    for (const auto& [from, to] : disjointRanges(this->Surface))
    {
      std::vector<ControlRow> rows;
      for (const ControlRow& r : this->Surface.Rows)
      {
        KnotCurve piece = curvePiece({knots, r}, this->Surface.OrderU, from, to);
        rows.push_back(std::move(piece.Points));
        if (rows.size() == 1)
        {
          this->KnotsU.push_back(std::move(piece.Knots));
        }
      }
      this->Curves.push_back(std::move(rows));
    }
  }

  Column sideOn(std::size_t curve, bool end, double a, double b) const
  {
    const std::size_t i = end ? this->Curves[curve][0].size() - 1 : 0;
    return curvePiece({this->KnotsV, columnOf(this->Curves[curve], i)}, this->Surface.OrderV, a, b)
      .Points;
  }

  /// For the end of each curve the curve whose start runs along it, or -1.
  std::vector<Index> partnersOn(double a, double b) const
  {
    const std::size_t n = this->Curves.size();
    std::vector<Index> partner(n, -1);
    std::vector<char> taken(n, 0);
    for (const bool own : {true, false})
    {
      for (std::size_t t = 0; t < n; ++t)
      {
        const Column end = this->sideOn(t, true, a, b);
        for (std::size_t o = 0; o < n && partner[t] < 0; ++o)
        {
          if (!taken[o] && (o == t) == own &&
              distance(end, this->sideOn(o, false, a, b)) <= this->Near)
          {
            partner[t] = static_cast<Index>(o);
            taken[o] = 1;
          }
        }
      }
    }
    return partner;
  }

  std::int64_t addKnots(const std::vector<double>& knots)
  {
    auto& all = this->Out.Model.Knots;
    const auto first = static_cast<std::int64_t>(all.size());
    all.insert(all.end(), knots.begin(), knots.end());
    return first;
  }

  void addPatch(std::size_t t, double a, double b)
  {
    SplineModel& m = this->Out.Model;
    SplinePatch p;
    p.DegreeU = this->Surface.OrderU - 1;
    p.DegreeV = this->Surface.OrderV - 1;
    p.CountU = static_cast<int>(this->Curves[t][0].size());
    std::vector<KnotCurve> columns;
    columns.reserve(this->Curves[t][0].size());
    for (int i = 0; i < p.CountU; ++i)
    {
      columns.push_back(
        curvePiece({this->KnotsV, columnOf(this->Curves[t], static_cast<std::size_t>(i))},
          this->Surface.OrderV, a, b));
    }
    p.CountV = static_cast<int>(columns[0].Points.size());
    p.FirstKnotU = this->addKnots(this->KnotsU[t]);
    p.FirstKnotV = this->addKnots(columns[0].Knots);
    p.FirstControlPoint = static_cast<std::int64_t>(m.ControlPoints.size());
    for (int j = 0; j < p.CountV; ++j)
    {
      for (int i = 0; i < p.CountU; ++i)
      {
        const Vec3& c = columns[i].Points[j];
        m.ControlPoints.emplace_back(c[0], c[1], c[2], 1.0);
      }
    }
    m.Patches.push_back(p);
  }

  void addPatches(double a, double b, const std::vector<Index>& partner, bool first, bool last)
  {
    SplineModel& m = this->Out.Model;
    const auto base = static_cast<std::int64_t>(m.Patches.size());
    const auto n = static_cast<std::int64_t>(this->Curves.size());
    for (std::int64_t t = 0; t < n; ++t)
    {
      this->addPatch(static_cast<std::size_t>(t), a, b);
      m.Neighbors.push_back(
        {first ? -1 : 4 * (base - n + t) + 2, -1, last ? -1 : 4 * (base + n + t), -1});
    }
    this->Out.Torn += 2 * static_cast<int>(n);
    for (std::int64_t t = 0; t < n; ++t)
    {
      if (partner[t] >= 0)
      {
        m.Neighbors[base + t][1] = 4 * (base + partner[t]) + 3;
        m.Neighbors[base + partner[t]][3] = 4 * (base + t) + 1;
        this->Out.Torn -= 2;
        continue;
      }
      const auto curve = static_cast<std::size_t>(t);
      this->Out.TornGap = std::max(this->Out.TornGap,
        distance(this->sideOn(curve, true, a, b), this->sideOn(curve, false, a, b)));
    }
  }

  const DisjointSurface& Surface;
  std::vector<double> KnotsV;
  double Near = 0.0;
  std::vector<std::vector<ControlRow>> Curves; ///< rows of each curve, clamped along u
  std::vector<std::vector<double>> KnotsU;
  DisjointModel Out;
};
} // namespace

Status checkDisjoint(const DisjointSurface& s)
{
  if (s.OrderU < 2 || s.OrderV < 2 || s.OrderU > MaximumDegree + 1 || s.OrderV > MaximumDegree + 1)
  {
    return Status::invalidParameter(
      "Orders must be 2 to " + std::to_string(MaximumDegree + 1) + ".");
  }
  const int total = std::accumulate(s.Counts.begin(), s.Counts.end(), 0);
  for (const int c : s.Counts)
  {
    if (c < s.OrderU)
    {
      return Status::invalidInput(
        "A disjoint curve has " + std::to_string(c) + " control points; give at least OrderU.");
    }
  }
  if (s.Counts.empty() || static_cast<int>(s.Rows.size()) < s.OrderV)
  {
    return Status::invalidInput("A disjoint surface needs a curve and at least OrderV rows.");
  }
  for (const ControlRow& r : s.Rows)
  {
    bool finite = static_cast<int>(r.size()) == total;
    for (const Vec3& p : r)
    {
      finite = finite && p.allFinite();
    }
    if (!finite)
    {
      return Status::invalidInput(
        "Each row of a disjoint surface must have as many finite control points as its curves.");
    }
  }
  return Status::ok();
}

std::vector<double> disjointKnots(int order, int count, bool uniform)
{
  if (uniform)
  {
    return clampedKnots(order, count - order + 1);
  }
  std::vector<double> knots(static_cast<std::size_t>(count) + order);
  std::iota(knots.begin(), knots.end(), 0.0);
  return knots;
}

std::vector<std::array<double, 2>> disjointRanges(const DisjointSurface& surface)
{
  const int total = std::accumulate(surface.Counts.begin(), surface.Counts.end(), 0);
  const std::vector<double> x = disjointKnots(surface.OrderU, total, surface.UniformU);
  std::vector<std::array<double, 2>> ranges;
  int first = 0;
  for (const int count : surface.Counts)
  {
    ranges.push_back({x[first + surface.OrderU - 1], x[first + count]});
    first += count;
  }
  return ranges;
}

std::array<double, 2> disjointRangeV(const DisjointSurface& surface)
{
  const auto rows = static_cast<int>(surface.Rows.size());
  const std::vector<double> y = disjointKnots(surface.OrderV, rows, surface.UniformV);
  return {y[surface.OrderV - 1], y[rows]};
}

Vec3 evaluateDisjoint(const DisjointSurface& s, double u, double v)
{
  const auto rows = static_cast<int>(s.Rows.size());
  const auto total = static_cast<int>(s.Rows[0].size());
  const std::vector<double> x = disjointKnots(s.OrderU, total, s.UniformU);
  const std::vector<double> y = disjointKnots(s.OrderV, rows, s.UniformV);
  const BasisValues n = evaluateBasis(x.data(), s.OrderU - 1, total, u);
  const BasisValues m = evaluateBasis(y.data(), s.OrderV - 1, rows, v);
  Vec3 point = Vec3::Zero();
  for (int j = 0; j < s.OrderV; ++j)
  {
    for (int i = 0; i < s.OrderU; ++i)
    {
      point += m.Value[j] * n.Value[i] * s.Rows[m.First + j][n.First + i];
    }
  }
  return point;
}

Result<DisjointModel> modelOfDisjoint(const DisjointSurface& surface, double tolerance)
{
  if (Status s = checkDisjoint(surface); !s)
  {
    return s;
  }
  return Splitter(surface, tolerance).run();
}
} // namespace bsr
