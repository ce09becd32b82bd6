#include "Contour/RelaxSpace.h"

#include "Common/UnionFind.h"
#include "Spline/Topology.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Contact = 1e-6;   ///< relative error up to which a contact is taken as kept
constexpr double Vanishing = 1e-9; ///< of a factor in a condition

/// Numbers of control points of a patch, seen from its sides.
struct Grid
{
  explicit Grid(const SplineModel& model, std::int64_t patch)
      : Model(model), P(model.Patches[patch])
  {
  }

  int along(int side) const { return side % 2 == 0 ? this->P.CountU : this->P.CountV; }
  int degreeAlong(int side) const { return side % 2 == 0 ? this->P.DegreeU : this->P.DegreeV; }
  int degreeAcross(int side) const { return this->degreeAlong(side + 1); }

  /// The control point at k along a side (from its start), `depth` rows away from it.
  std::int64_t point(int side, int k, int depth) const
  {
    const int u = side == 1 ? this->P.CountU - 1 - depth : side == 3 ? depth : k;
    const int v = side == 2 ? this->P.CountV - 1 - depth : side == 0 ? depth : k;
    return this->P.FirstControlPoint + static_cast<std::int64_t>(v) * this->P.CountU + u;
  }

  /// Knots across a side, from it inward, or along it, from either end: increasing from 0.
  std::vector<double> knots(bool v, bool fromEnd) const
  {
    const int count = v ? this->P.CountV : this->P.CountU;
    const int degree = v ? this->P.DegreeV : this->P.DegreeU;
    const double* k = this->Model.Knots.data() + (v ? this->P.FirstKnotV : this->P.FirstKnotU);
    std::vector<double> out;
    out.reserve(static_cast<std::size_t>(count) + static_cast<std::size_t>(degree) + 1);
    for (int i = 0; i < count + degree + 1; ++i)
    {
      out.push_back(fromEnd ? k[count + degree] - k[count + degree - i] : k[i] - k[0]);
    }
    return out;
  }
  std::vector<double> knotsAcross(int side) const
  {
    return this->knots(side % 2 == 0, side == 1 || side == 2);
  }
  std::vector<double> knotsAlong(int side, bool fromEnd) const
  {
    return this->knots(side % 2 == 1, fromEnd);
  }

  const SplineModel& Model;
  const SplinePatch& P;
};

/// A patch at a vertex: entered through one side, left through the other; for each whether the
/// vertex is at the side's end.
struct Sector
{
  std::int64_t Patch;
  int In, Out;
  bool InEnd, OutEnd;
};

/// The other side at a corner of a patch, given by a side and one of its ends.
std::pair<int, bool> otherSide(int side, bool end)
{
  const bool high = side == 1 || side == 2; // the other side's parameter is at its end
  return {side % 2 == 0 ? (end ? 1 : 3) : (end ? 2 : 0), high};
}

/// All patches around a vertex, in order; empty where it lies on a border.
std::vector<Sector> sectorsAround(const SplineModel& model, std::int64_t patch, int side, bool end)
{
  std::vector<Sector> out;
  std::int64_t p = patch;
  int in = side;
  bool inEnd = end;
  do
  {
    const auto [next, nextEnd] = otherSide(in, inEnd);
    out.push_back({p, in, next, inEnd, nextEnd});
    const SideMatch m = matchSide(model, p, next);
    if (m.Patch < 0 || !m.Same || out.size() > 256)
    {
      return {};
    }
    p = m.Patch;
    in = m.Side;
    inEnd = nextEnd != m.Reversed;
  } while (p != patch || in != side || inEnd != end);
  return out;
}

/// Factors of the control points from a clamped end in the derivative of an order (1, 2) there.
std::vector<double> endDerivative(const std::vector<double>& knots, int degree, int order)
{
  const double a = knots[degree + 1] - knots[1];
  if (order == 1)
  {
    return {-degree / a, degree / a};
  }
  const double b = knots[degree + 2] - knots[2];
  const double c = degree * (degree - 1.0) / (knots[degree + 1] - knots[2]);
  return {c / a, -c / a - c / b, c / b};
}

class SpaceMaker
{
public:
  SpaceMaker(const SplineModel& model, const std::vector<std::int64_t>& region)
      : Model(model),
        Region(region),
        Inside(model.Patches.size(), 0),
        Class(static_cast<std::int64_t>(model.ControlPoints.size()))
  {
    for (const std::int64_t p : region)
    {
      this->Inside[p] = 1;
    }
  }

  RelaxSpace run()
  {
    this->weld();
    this->start();
    for (const std::int64_t p : this->Region)
    {
      for (int side = 0; side < 4; ++side)
      {
        for (const bool end : {false, true})
        {
          this->fixVertex(p, side, end);
        }
      }
    }
    for (const std::int64_t p : this->Region)
    {
      for (int side = 0; side < 4; ++side)
      {
        this->joinSide(p, side);
      }
    }
    return this->finish();
  }

private:
  Vec3 at(std::int64_t point) const { return this->Model.ControlPoints[point].head<3>(); }

  void weld()
  {
    for (std::size_t i = 0; i < this->Model.Patches.size(); ++i)
    {
      const auto p = static_cast<std::int64_t>(i);
      const Grid own(this->Model, p);
      for (int s = 0; s < 4; ++s)
      {
        const SideMatch m = matchSide(this->Model, p, s);
        if (m.Patch < 0 || !m.Same)
        {
          continue;
        }
        const Grid other(this->Model, m.Patch);
        const int n = own.along(s);
        for (int k = 0; k < n; ++k)
        {
          this->Class.join(own.point(s, k, 0), other.point(m.Side, m.Reversed ? n - 1 - k : k, 0));
        }
      }
    }
  }

  /// One variable for each point of the region; none for those that other patches have too.
  void start()
  {
    const std::size_t n = this->Model.ControlPoints.size();
    std::vector<char> held(n, 1);
    const auto mark = [&](std::int64_t p, char value)
    {
      const SplinePatch& patch = this->Model.Patches[p];
      const std::int64_t count = static_cast<std::int64_t>(patch.CountU) * patch.CountV;
      for (std::int64_t k = 0; k < count; ++k)
      {
        held[this->Class.find(patch.FirstControlPoint + k)] = value;
      }
    };
    for (const std::int64_t p : this->Region)
    {
      mark(p, 0);
    }
    for (std::size_t p = 0; p < this->Model.Patches.size(); ++p)
    {
      if (!this->Inside[p])
      {
        mark(static_cast<std::int64_t>(p), 1);
      }
    }
    this->Form.resize(n);
    for (std::size_t k = 0; k < n; ++k)
    {
      if (!held[k] &&
          this->Class.find(static_cast<std::int64_t>(k)) == static_cast<std::int64_t>(k))
      {
        this->Form[k] = LinearForm(this->Count++);
      }
    }
    this->Plain = this->Count;
  }

  LinearForm& form(std::int64_t point) { return this->Form[this->Class.find(point)]; }

  /// A point of a star: center + X A + Y B.
  struct StarPoint
  {
    std::int64_t Point;
    double X, Y;
  };

  void fixVertex(std::int64_t p, int side, bool end)
  {
    const Grid own(this->Model, p);
    const std::int64_t vertex = this->Class.find(own.point(side, end ? own.along(side) - 1 : 0, 0));
    if (!this->Vertices.emplace(vertex, 0).second)
    {
      return;
    }
    const std::vector<Sector> sectors = sectorsAround(this->Model, p, side, end);
    if (sectors.empty() || sectors.size() == 4)
    {
      return;
    }
    this->Vertices[vertex] = 1;
    const std::vector<StarPoint> star = this->starPoints(sectors);
    const bool kept = this->regular(this->at(vertex), star);
    const int axes = this->Count;
    this->Count += kept ? 2 : 0;
    if (!kept)
    {
      this->demand(this->form(vertex));
    }
    for (const StarPoint& q : star)
    {
      LinearForm f = this->form(q.Point);
      if (kept)
      {
        f.add(this->form(vertex), -1.0);
        f.add(LinearForm(axes), -q.X).add(LinearForm(axes + 1), -q.Y);
      }
      this->demand(f);
    }
  }

  std::vector<StarPoint> starPoints(const std::vector<Sector>& sectors) const
  {
    const auto n = static_cast<double>(sectors.size());
    const double wide = 2.0 / (2.0 + 2.0 * std::cos(2.0 * Pi / n));
    std::vector<StarPoint> out;
    for (std::size_t k = 0; k < sectors.size(); ++k)
    {
      const Sector& s = sectors[k];
      const Grid g(this->Model, s.Patch);
      const double a = 2.0 * Pi * static_cast<double>(k) / n;
      const double b = 2.0 * Pi * static_cast<double>(k + 1) / n;
      const int degree = g.degreeAlong(s.In);
      const std::vector<double> knots = g.knotsAlong(s.In, s.InEnd);
      double place = 0.0;
      const int last = g.along(s.In) - 1;
      for (int j = 1; j <= std::min(degree, last); ++j)
      {
        place += (knots[j + degree] - knots[j]) / (knots[1 + degree] - knots[1]);
        out.push_back(
          {g.point(s.In, s.InEnd ? last - j : j, 0), place * std::cos(a), place * std::sin(a)});
      }
      out.push_back({g.point(s.In, s.InEnd ? last - 1 : 1, 1), wide * (std::cos(a) + std::cos(b)),
        wide * (std::sin(a) + std::sin(b))});
    }
    return out;
  }

  bool regular(const Vec3& center, const std::vector<StarPoint>& star) const
  {
    Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
    Eigen::Matrix<double, 2, 3> r = Eigen::Matrix<double, 2, 3>::Zero();
    for (const StarPoint& q : star)
    {
      const Vec2 x(q.X, q.Y);
      m += x * x.transpose();
      r += x * (this->at(q.Point) - center).transpose();
    }
    const Eigen::Matrix<double, 2, 3> axes = m.inverse() * r;
    double error = 0.0;
    for (const StarPoint& q : star)
    {
      const Vec3 d = axes.transpose() * Vec2(q.X, q.Y) - (this->at(q.Point) - center);
      error = std::max(error, d.norm());
    }
    return error <= Contact * axes.norm();
  }

  /// Whether a vertex at an end of a side is one whose star is kept.
  bool isStar(const Grid& g, int side, bool end)
  {
    const auto v =
      this->Vertices.find(this->Class.find(g.point(side, end ? g.along(side) - 1 : 0, 0)));
    return v != this->Vertices.end() && v->second != 0;
  }

  /// A condition on the points across a side at k: factors of the points of both sides by depth.
  struct Across
  {
    std::vector<double> Own, Other;
  };

  void joinSide(std::int64_t p, int side)
  {
    const SideMatch m = matchSide(this->Model, p, side);
    if (m.Patch < 0 || !m.Same || (this->Inside[m.Patch] && 4 * m.Patch + m.Side < 4 * p + side))
    {
      return;
    }
    const Grid own(this->Model, p);
    const Grid other(this->Model, m.Patch);
    const std::vector<double> ku = own.knotsAcross(side);
    const std::vector<double> kv = other.knotsAcross(m.Side);
    const int du = own.degreeAcross(side);
    const int dv = other.degreeAcross(m.Side);
    Across first{endDerivative(ku, du, 1), endDerivative(kv, dv, 1)};
    const Across symmetric{{-1.0, 1.0}, {-1.0, 1.0}};
    const double byKnots = this->misfit(own, side, other, m, first);
    const double bySymmetry = this->misfit(own, side, other, m, symmetric);
    if (std::min(byKnots, bySymmetry) > Contact)
    {
      return; // C0
    }
    this->join(own, side, other, m, byKnots <= bySymmetry ? first : symmetric);
    if (byKnots <= bySymmetry && du > 2 && dv > 2)
    {
      Across second{endDerivative(ku, du, 2), endDerivative(kv, dv, 2)};
      for (double& f : second.Other)
      {
        f = -f;
      }
      if (this->misfit(own, side, other, m, second) <= Contact)
      {
        this->join(own, side, other, m, second);
      }
    }
  }

  std::pair<int, int> range(const Grid& g, int side)
  {
    return {
      this->isStar(g, side, false) ? 2 : 0, g.along(side) - (this->isStar(g, side, true) ? 2 : 0)};
  }

  /// Largest error of a condition, relative to its terms.
  double misfit(const Grid& own, int side, const Grid& other, const SideMatch& m, const Across& c)
  {
    const auto [from, to] = this->range(own, side);
    double error = 0.0;
    double size = 0.0;
    for (int k = from; k < to; ++k)
    {
      const int q = m.Reversed ? own.along(side) - 1 - k : k;
      const Vec3 base = this->at(own.point(side, k, 0));
      Vec3 sum = Vec3::Zero();
      for (std::size_t d = 1; d < c.Own.size(); ++d)
      {
        const auto depth = static_cast<int>(d);
        const Vec3 a = c.Own[d] * (this->at(own.point(side, k, depth)) - base);
        const Vec3 b = c.Other[d] * (this->at(other.point(m.Side, q, depth)) - base);
        sum += a + b;
        size = std::max({size, a.norm(), b.norm()});
      }
      error = std::max(error, sum.norm());
    }
    return size > 0.0 ? error / size : 0.0;
  }

  void join(const Grid& own, int side, const Grid& other, const SideMatch& m, const Across& c)
  {
    double scale = 0.0;
    for (const auto* side2 : {&c.Own, &c.Other})
    {
      for (const double f : *side2)
      {
        scale = std::max(scale, std::abs(f));
      }
    }
    const auto [from, to] = this->range(own, side);
    for (int k = from; k < to; ++k)
    {
      const int q = m.Reversed ? own.along(side) - 1 - k : k;
      LinearForm f;
      for (std::size_t d = 0; d < c.Own.size(); ++d)
      {
        const auto depth = static_cast<int>(d);
        f.add(this->form(own.point(side, k, depth)), c.Own[d] / scale);
        f.add(this->form(other.point(m.Side, q, depth)), c.Other[d] / scale);
      }
      this->demand(f);
    }
  }

  /// A form with the variables that are known by others replaced.
  LinearForm reduced(LinearForm f) const
  {
    while (true)
    {
      const auto& t = f.terms();
      const auto known = std::find_if(
        t.begin(), t.end(), [this](const auto& x) { return this->Known.count(x.first) > 0; });
      if (known == t.end())
      {
        return f;
      }
      const auto [variable, factor] = *known;
      f.add(LinearForm(variable), -factor);
      f.add(this->Known.at(variable), factor);
    }
  }

  /// Makes a form vanish: its variable of largest factor, none of a star if possible, becomes
  /// known.
  void demand(const LinearForm& condition)
  {
    const LinearForm f = this->reduced(condition);
    const LinearForm::Term* best = nullptr;
    for (const bool star : {false, true})
    {
      for (const LinearForm::Term& t : f.terms())
      {
        if ((t.first >= this->Plain) == star && std::abs(t.second) > Vanishing &&
            (!best || std::abs(t.second) > std::abs(best->second)))
        {
          best = &t;
        }
      }
      if (best)
      {
        break;
      }
    }
    if (!best)
    {
      return;
    }
    const LinearForm::Term pivot = *best;
    LinearForm rest;
    for (const LinearForm::Term& t : f.terms())
    {
      if (t.first != pivot.first && std::abs(t.second) > 1e-3 * Vanishing)
      {
        rest.add(LinearForm(t.first), -t.second / pivot.second);
      }
    }
    this->Known.emplace(pivot.first, std::move(rest));
  }

  RelaxSpace finish()
  {
    RelaxSpace space;
    std::vector<int> number(static_cast<std::size_t>(this->Count), -1);
    space.Points.resize(this->Form.size());
    for (std::size_t k = 0; k < this->Form.size(); ++k)
    {
      const LinearForm f = this->reduced(this->form(static_cast<std::int64_t>(k)));
      for (const LinearForm::Term& t : f.terms())
      {
        int& n = number[t.first];
        n = n < 0 ? space.Variables++ : n;
        space.Points[k].add(LinearForm(n), t.second);
      }
    }
    return space;
  }

  const SplineModel& Model;
  const std::vector<std::int64_t>& Region;
  std::vector<char> Inside;
  UnionFind Class;
  std::map<std::int64_t, int> Vertices; ///< 1 where it has a star
  std::vector<LinearForm> Form;         ///< of each class of points
  std::map<int, LinearForm> Known;
  int Count = 0;
  int Plain = 0; ///< variables that belong to no star
};
} // namespace

RelaxSpace makeRelaxSpace(const SplineModel& model, const std::vector<std::int64_t>& region)
{
  return SpaceMaker(model, region).run();
}

std::vector<std::int64_t> growRegion(
  const SplineModel& model, const std::vector<std::int64_t>& patches, int rings)
{
  std::vector<char> inside(model.Patches.size(), 0);
  std::vector<std::int64_t> region = patches;
  for (const std::int64_t p : patches)
  {
    inside[p] = 1;
  }
  const auto add = [&](std::int64_t p)
  {
    if (!inside[p])
    {
      inside[p] = 1;
      region.push_back(p);
    }
  };
  std::size_t from = 0;
  for (int ring = 0; ring < rings; ++ring)
  {
    const std::size_t to = region.size();
    for (; from < to; ++from)
    {
      const std::int64_t p = region[from];
      for (int side = 0; side < 4; ++side)
      {
        if (const std::int64_t code = model.Neighbors[p][side]; code >= 0)
        {
          add(code / 4);
        }
        for (const Sector& s : sectorsAround(model, p, side, false))
        {
          add(s.Patch);
        }
      }
    }
  }
  std::sort(region.begin(), region.end());
  return region;
}
} // namespace bsr
