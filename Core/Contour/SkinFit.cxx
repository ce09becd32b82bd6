#include "Contour/SkinFit.h"

#include "Common/Parallel.h"
#include "Spline/Evaluate.h"
#include "Spline/SampleModel.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double CapWeight = 10.0;
constexpr double BridgeWeight = 0.1;
constexpr double CornerWeight = 1e3;
constexpr double BorderWeight = 4.0;

/// How a relaxed fit starts.
struct Attempt
{
  int Passes;     ///< of fit and move on the first knots
  double Share;   ///< of the data set's lines: control points of the first knots
  int Most;       ///< of them
  double Fairing; ///< times the given one
};

/// Whether a surface is so far from the tolerance that it is given up for something else.
bool hopeless(const SkinSurface& s, const SkinFitOptions& options)
{
  return options.Hopeless > 0.0 && s.Rms > options.Hopeless * options.Tolerance;
}

class Fitter
{
public:
  Fitter(const SkinGrid& grid, const std::vector<CapPoint>& caps, const SkinFitOptions& options,
    const Attempt& attempt, Monitor& monitor)
      : Grid(grid), Caps(caps), Options(options), Try(attempt), Mon(monitor)
  {
  }

  Result<SkinSurface> run()
  {
    this->Lines[0] = this->averagedParameters(true);
    this->Lines[1] = this->averagedParameters(false);
    this->collect();
    const bool relaxed = this->Options.Parameters == SkinParameters::Relaxed;
    const bool given = this->Options.CountU > 0 && this->Options.CountV > 0;
    this->startKnots(relaxed, given);
    for (int round = 0;; ++round)
    {
      if (Status s = relaxed ? this->relax(round == 0) : this->fitLines(); !s)
      {
        return s;
      }
      this->openCorners();
      if (!this->measure())
      {
        return Status::cancelled();
      }
      this->Mon.progress(1.0 - 1.0 / (1.5 + round));
      const bool fine = 4 * this->Out.Shape.controlPoints() > this->Options.ControlPointLimit;
      if (this->Out.Reached || given || (fine && hopeless(this->Out, this->Options)) ||
          !this->refine())
      {
        return std::move(this->Out);
      }
    }
  }

private:
  /// Parameters of the columns (or rows), averaged over all rows (columns); sets the mean length.
  std::vector<double> averagedParameters(bool columns)
  {
    const int count = columns ? this->Grid.Columns : this->Grid.Rows;
    const int lines = columns ? this->Grid.Rows : this->Grid.Columns;
    const bool root = this->Options.Parameters == SkinParameters::Centripetal;
    std::vector<double> mean(static_cast<std::size_t>(count), 0.0);
    double length = 0.0;
    int counted = 0;
    for (int l = 0; l < lines; ++l)
    {
      std::vector<double> along(1, 0.0);
      double chords = 0.0;
      for (int k = 1; k < count; ++k)
      {
        const auto at = [&](int i)
        { return this->Grid.Points[columns ? this->Grid.node(l, i) : this->Grid.node(i, l)]; };
        const double d = (at(k) - at(k - 1)).norm();
        chords += d;
        along.push_back(along.back() + (root ? std::sqrt(d) : d));
      }
      if (along.back() > 0.0)
      {
        ++counted;
        length += chords;
        for (int k = 0; k < count; ++k)
        {
          mean[k] += along[k] / along.back();
        }
      }
    }
    for (double& t : mean)
    {
      t /= std::max(counted, 1);
    }
    mean.back() = 1.0;
    this->Length[columns ? 0 : 1] = length / std::max(counted, 1);
    return mean;
  }

  /// Samples inside stay off the border, by half the way to the first line.
  Vec2 inside(const SkinSample& s, const Vec2& uv) const
  {
    Vec2 r = uv;
    for (const int d : {0, 1})
    {
      const auto& lines = this->Lines[d];
      const double low = s.Fixed[d] || s.Fixed[1 - d] ? 0.0 : 0.5 * lines[1];
      const double high =
        s.Fixed[d] || s.Fixed[1 - d] ? 1.0 : 0.5 * (1.0 + lines[lines.size() - 2]);
      r[d] = std::clamp(r[d], low, high);
    }
    return r;
  }

  static double interpolated(const std::vector<double>& table, double x)
  {
    const auto i = static_cast<std::size_t>(
      std::clamp(std::floor(x), 0.0, static_cast<double>(table.size()) - 2.0));
    const double t = x - static_cast<double>(i);
    return (1.0 - t) * table[i] + t * table[i + 1];
  }

  void collect()
  {
    for (std::size_t r = 0; r < this->Grid.Rings.size(); ++r)
    {
      const SkinRing& ring = this->Grid.Rings[r];
      int sub = 1;
      if (this->Options.Parameters == SkinParameters::Relaxed && this->Options.PointSpacing > 0.0)
      {
        sub = std::clamp(static_cast<int>(std::ceil(this->Grid.Curves[r].length() /
                                                    (this->Options.PointSpacing * ring.size()))),
          1, 12);
      }
      for (int k = 0; k < ring.size() * sub; ++k)
      {
        const double at = static_cast<double>(k) / sub;
        this->add(this->Grid.at(static_cast<Index>(r), at), ring.place(at), static_cast<Index>(r));
        this->Out.Samples.back().Node = k % sub == 0;
        this->Out.Samples.back().Sample.Weight = 1.0 / sub;
      }
    }
    if (this->Grid.Rings.empty()) // a sheet: all nodes
    {
      for (int r = 0; r < this->Grid.Rows; ++r)
      {
        for (int c = 0; c < this->Grid.Columns; ++c)
        {
          this->add(this->Grid.Points[this->Grid.node(r, c)], Vec2(c, r), -1);
          this->Out.Samples.back().Node = true;
        }
      }
    }
    this->pinBorder();
    for (const CapPoint& c : this->Caps)
    {
      this->add(c.Point, c.Place, c.Ring);
      this->Out.Samples.back().Cap = true;
      this->Out.Samples.back().Bridge = c.Bridge;
      this->Out.Samples.back().Sample.Weight = c.Bridge ? BridgeWeight : CapWeight;
    }
  }

  void add(const Vec3& point, const Vec2& place, Index ring)
  {
    SkinSample s;
    s.Sample.Point = point;
    const Vec2 p =
      this->Options.Parameters == SkinParameters::Relaxed ? this->Grid.rounded(place) : place;
    s.Sample.UV = {interpolated(this->Lines[0], p.x()), interpolated(this->Lines[1], p.y())};
    s.Place = place;
    s.Ring = ring;
    this->Out.Samples.push_back(s);
  }

  void pinBorder()
  {
    for (SkinSample& s : this->Out.Samples)
    {
      s.Fixed[0] = s.Place.x() <= 0.0 || s.Place.x() >= this->Grid.Columns - 1;
      s.Fixed[1] = s.Place.y() <= 0.0 || s.Place.y() >= this->Grid.Rows - 1;
      s.Sample.Weight *= s.Fixed[0] && s.Fixed[1]   ? CornerWeight
                         : s.Fixed[0] || s.Fixed[1] ? BorderWeight
                                                    : 1.0;
    }
  }

  void startKnots(bool relaxed, bool given)
  {
    TensorShape& shape = this->Out.Shape;
    const auto& o = this->Options;
    shape.DegreeU = std::min(o.Degree, this->Grid.Columns - 1);
    shape.DegreeV = std::min(o.Degree, this->Grid.Rows - 1);
    const auto count = [&](int asked, int degree, int points)
    {
      const int least = degree + 1;
      // a relaxed fit starts fine enough for each leg to have spans of its own
      const int start = relaxed ? std::clamp(static_cast<int>(points * this->Try.Share) + degree,
                                    least + 4, std::max(this->Try.Most, least + 4))
                                : least;
      return std::clamp(given ? asked : start, least, points);
    };
    int nu = count(o.CountU, shape.DegreeU, this->Grid.Columns);
    int nv = count(o.CountV, shape.DegreeV, this->Grid.Rows);
    while (!given && nu * nv > o.ControlPointLimit && nu + nv > shape.DegreeU + shape.DegreeV + 2)
    {
      const bool wide = nu - shape.DegreeU > nv - shape.DegreeV;
      --(wide ? nu : nv);
    }
    shape.KnotsU = dataKnots(this->Lines[0], shape.DegreeU, nu);
    shape.KnotsV = dataKnots(this->Lines[1], shape.DegreeV, nv);
  }

  Status fitLines()
  {
    this->Out.Control = fitGrid(this->Out.Shape, this->Lines[0], this->Lines[1], this->Grid.Points);
    for (const Vec3& c : this->Out.Control)
    {
      if (!c.allFinite())
      {
        return Status::failed("The least-squares fit of the data set is singular; lower "
                              "ControlPointLimit or raise Tolerance.");
      }
    }
    return this->Mon.cancelled() ? Status::cancelled() : Status::ok();
  }

  /// Fits and moves parameters by turns, with ever less fairing.
  Status relax(bool first)
  {
    TensorSolver solver(this->Out.Shape, this->Length[0], this->Length[1]);
    const int passes = first ? this->Try.Passes : 1;
    const double last = this->Try.Fairing * this->Options.Fairing;
    const double start = std::max(first ? 0.03 : 0.0, last);
    for (int pass = 0; pass < passes; ++pass)
    {
      const double t =
        passes > 1 ? std::min(1.0, 1.25 * static_cast<double>(pass) / (passes - 1)) : 1.0;
      const double fairing = std::pow(start, 1.0 - t) * std::pow(last, t);
      std::vector<TensorSample> samples;
      for (const SkinSample& s : this->Out.Samples)
      {
        samples.push_back(s.Sample);
      }
      this->Out.Control = solver.solve(samples, fairing);
      if (this->Out.Control.empty())
      {
        return Status::failed("The fit is singular; raise Fairing or lower ControlPointLimit.");
      }
      if (this->Mon.cancelled())
      {
        return Status::cancelled();
      }
      if (!this->project(pass + 1 < passes ? 2 : 8))
      {
        return Status::cancelled();
      }
    }
    return Status::ok();
  }

  /**
   * At a corner of the patch the border runs straight on where the contour is smooth, and the two
   * tangents may even turn past each other. Keeps the angle between them below 179 degrees, by
   * moving their control points into the surface, and the next inner one inside.
   */
  void openCorners()
  {
    const int nu = this->Out.Shape.countU();
    const int nv = this->Out.Shape.countV();
    for (const int cu : {0, 1})
    {
      for (const int cv : {0, 1})
      {
        const auto at = [&](int i, int j) -> Vec3&
        { return this->Out.Control[(cv ? nv - 1 - j : j) * nu + (cu ? nu - 1 - i : i)]; };
        const auto node = [&](int i, int j)
        {
          return this->Grid.Points[this->Grid.node(
            cv ? this->Grid.Rows - 1 - j : j, cu ? this->Grid.Columns - 1 - i : i)];
        };
        const Vec3 p = at(0, 0);
        const double a = (at(1, 0) - p).norm();
        const double b = (at(0, 1) - p).norm();
        if (!(a > 0.0) || !(b > 0.0))
        {
          continue;
        }
        const Vec3 along = ((at(1, 0) - p) / a - (at(0, 1) - p) / b).normalized();
        Vec3 in = node(1, 1) - node(0, 0);
        in = (in - along.dot(in) * along).normalized();
        if (!in.allFinite())
        {
          continue;
        }
        constexpr double Least = 0.01;
        Vec3& pa = at(1, 0);
        Vec3& pb = at(0, 1);
        pa += std::max(0.0, Least * a - in.dot(pa - p)) * in;
        pb += std::max(0.0, Least * b - in.dot(pb - p)) * in;
        Vec3& twist = at(1, 1);
        const double depth = std::max(in.dot(pa - p), in.dot(pb - p)) + 0.1 * std::min(a, b);
        twist += std::max(0.0, depth - in.dot(twist - p)) * in;
      }
    }
  }

  /// Moves each sample's parameters towards its nearest point. False: cancelled.
  bool project(int steps)
  {
    const SplineModel model = modelOf(this->Out.Shape, this->Out.Control);
    const SplinePatch& patch = model.Patches[0];
    auto& samples = this->Out.Samples;
    return parallelForUntilCancelled(0, static_cast<std::int64_t>(samples.size()), 512, this->Mon,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t k = begin; k < end; ++k)
        {
          for (int s = 0; s < steps && this->step(model, patch, samples[k]); ++s)
          {
          }
        }
      });
  }

  /// One damped Gauss-Newton step; false where it no longer helps.
  bool step(const SplineModel& model, const SplinePatch& patch, SkinSample& s) const
  {
    Vec2& uv = s.Sample.UV;
    const SurfacePoint p = evaluatePatch(model, patch, uv.x(), uv.y());
    const Vec3 e = s.Sample.Point - p.Point;
    Eigen::Matrix2d m;
    m << p.Du.dot(p.Du), p.Du.dot(p.Dv), p.Du.dot(p.Dv), p.Dv.dot(p.Dv);
    Vec2 g(p.Du.dot(e), p.Dv.dot(e));
    const double damp = 1e-6 * m.trace() + 1e-300;
    for (const int d : {0, 1})
    {
      m(d, d) += damp;
      if (s.Fixed[d])
      {
        m(d, d) = 1.0;
        m(0, 1) = m(1, 0) = 0.0;
        g[d] = 0.0;
      }
    }
    Vec2 move = m.ldlt().solve(g);
    const Vec2 limit(0.5 / (patch.CountU - patch.DegreeU), 0.5 / (patch.CountV - patch.DegreeV));
    move *= std::min({1.0, limit.x() / std::max(std::abs(move.x()), 1e-300),
      limit.y() / std::max(std::abs(move.y()), 1e-300)});
    for (double share = 1.0; share > 0.1; share *= 0.5)
    {
      const Vec2 next = this->inside(s, uv + share * move);
      const double d =
        (evaluatePatch(model, patch, next.x(), next.y()).Point - s.Sample.Point).squaredNorm();
      if (d < e.squaredNorm())
      {
        const bool far = d < 0.9999 * e.squaredNorm();
        uv = next;
        return far;
      }
    }
    return false;
  }

  /// Errors of the data set, and distances of the samples from the surface. False: cancelled.
  bool measure()
  {
    SkinSurface& o = this->Out;
    const SplineModel model = modelOf(o.Shape, o.Control);
    const SplinePatch& patch = model.Patches[0];
    const auto squared = [&](const SkinSample& s, const Vec2& uv)
    { return (evaluatePatch(model, patch, uv.x(), uv.y()).Point - s.Sample.Point).squaredNorm(); };
    const std::size_t n = o.Samples.size();
    this->Errors.assign(n, 0.0);
    std::vector<double> nearest(n, 0.0);
    const bool done = parallelForUntilCancelled(0, static_cast<std::int64_t>(n), 256, this->Mon,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t k = begin; k < end; ++k)
        {
          const SkinSample& s = o.Samples[k];
          this->Errors[k] = squared(s, s.Sample.UV);
          SkinSample close = s;
          for (int i = 0; i < 8 && !s.Cap && this->step(model, patch, close); ++i)
          {
          }
          nearest[k] = squared(s, close.Sample.UV);
        }
      });
    o.TotalError = 0.0;
    o.Max = 0.0;
    double sum = 0.0;
    std::int64_t nodes = 0;
    std::int64_t count = 0;
    for (std::size_t k = 0; k < n; ++k)
    {
      const SkinSample& s = o.Samples[k];
      o.TotalError += s.Node ? this->Errors[k] : 0.0;
      nodes += s.Node ? 1 : 0;
      sum += s.Cap ? 0.0 : nearest[k];
      o.Max = s.Cap ? o.Max : std::max(o.Max, std::sqrt(nearest[k]));
      count += s.Cap ? 0 : 1;
    }
    o.AverageError = o.TotalError / static_cast<double>(nodes);
    o.Rms = std::sqrt(sum / static_cast<double>(count));
    const double tolerance = this->Options.Tolerance;
    o.Reached = o.AverageError <= tolerance && o.Rms <= tolerance;
    return done;
  }

  /// New knots in the middle of the spans whose mean error is too large (section 2.5); false where
  /// no span may be halved.
  bool refine()
  {
    TensorShape& shape = this->Out.Shape;
    const double allowed =
      std::min(this->Options.Tolerance, this->Options.Tolerance * this->Options.Tolerance);
    const auto u = this->splitSpans(shape.KnotsU, shape.DegreeU, 0, allowed);
    const auto v = this->splitSpans(shape.KnotsV, shape.DegreeV, 1, allowed);
    TensorShape finer = shape;
    finer.KnotsU = u;
    finer.KnotsV = v;
    if (finer.controlPoints() == shape.controlPoints() ||
        finer.controlPoints() > this->Options.ControlPointLimit)
    {
      return false;
    }
    shape = finer;
    return true;
  }

  std::vector<double> splitSpans(
    const std::vector<double>& knots, int degree, int direction, double allowed) const
  {
    const int count = static_cast<int>(knots.size()) - degree - 1;
    std::vector<double> sum(knots.size(), 0.0);
    std::vector<double> number(knots.size(), 0.0);
    for (std::size_t k = 0; k < this->Out.Samples.size(); ++k)
    {
      const SkinSample& s = this->Out.Samples[k];
      if (!s.Cap)
      {
        const auto span = std::clamp<std::ptrdiff_t>(
          std::upper_bound(knots.begin(), knots.end(), s.Sample.UV[direction]) - knots.begin() - 1,
          degree, count - 1);
        sum[span] += this->Errors[k];
        number[span] += 1.0;
      }
    }
    const auto& lines = this->Lines[direction];
    std::vector<double> finer;
    for (std::size_t k = 0; k < knots.size(); ++k)
    {
      finer.push_back(knots[k]);
      if (number[k] > 0.0 && sum[k] > allowed * number[k] && knots[k + 1] > knots[k])
      {
        const double middle = 0.5 * (knots[k] + knots[k + 1]);
        // each half must hold a line of the data set
        const auto holds = [&](double a, double b)
        {
          const auto first = std::lower_bound(lines.begin(), lines.end(), a);
          return first != lines.end() && *first < b;
        };
        if (holds(knots[k], middle) && holds(middle, knots[k + 1] + 1e-12))
        {
          finer.push_back(middle);
        }
      }
    }
    return finer;
  }

  const SkinGrid& Grid;
  const std::vector<CapPoint>& Caps;
  const SkinFitOptions& Options;
  Attempt Try;
  Monitor& Mon;
  std::array<std::vector<double>, 2> Lines; ///< parameters of the columns and the rows
  std::array<double, 2> Length{};
  std::vector<double> Errors;
  SkinSurface Out;
};
} // namespace

int countFolds(const SkinSurface& surface)
{
  constexpr int Fine = 5;
  const SplineModel model = modelOf(surface.Shape, surface.Control);
  std::array<std::vector<double>, 2> at;
  for (const int d : {0, 1})
  {
    const std::vector<double> ends = pieceEnds(model, model.Patches[0], d);
    for (std::size_t k = 0; k + 1 < ends.size(); ++k)
    {
      for (int i = 0; i < Fine; ++i)
      {
        at[d].push_back(ends[k] + (ends[k + 1] - ends[k]) * i / Fine);
      }
    }
    at[d].push_back(ends.back());
  }
  const std::size_t wide = at[0].size();
  std::vector<Vec3> normal(wide * at[1].size());
  parallelFor(0, static_cast<std::int64_t>(at[1].size()), 4,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t j = begin; j < end; ++j)
      {
        for (std::size_t i = 0; i < wide; ++i)
        {
          normal[j * wide + i] =
            evaluatePatch(model, model.Patches[0], at[0][i], at[1][j]).normal();
        }
      }
    });
  int folds = 0;
  for (std::size_t k = 0; k < normal.size(); ++k)
  {
    folds += k % wide > 0 && !(normal[k].dot(normal[k - 1]) > 0.0) ? 1 : 0;
    folds += k >= wide && !(normal[k].dot(normal[k - wide]) > 0.0) ? 1 : 0;
  }
  return folds;
}

Result<SkinSurface> fitSkin(const SkinGrid& grid, const std::vector<CapPoint>& caps,
  const SkinFitOptions& options, Monitor& monitor)
{
  // Few passes keep the data set's arrangement, many make it smoother; coarse first knots hold the
  // legs apart badly where they are thin, fine ones follow a bad arrangement. None is always best.
  std::vector<Attempt> attempts{{3, 0.25, 14, 1.0}, {3, 0.6, 60, 1.0}, {1, 0.25, 14, 1.0},
    {6, 0.4, 30, 1.0}, {3, 0.25, 14, 10.0}, {3, 0.6, 60, 10.0}, {8, 0.4, 30, 30.0}};
  if (options.Parameters != SkinParameters::Relaxed)
  {
    attempts.resize(1);
  }
  Result<SkinSurface> best = Status::failed("The surface could not be fitted.");
  for (std::size_t k = 0; k < attempts.size(); ++k)
  {
    const auto share = [&](std::size_t i)
    { return static_cast<double>(i) / static_cast<double>(attempts.size()); };
    SubMonitor part(monitor, share(k), share(k + 1));
    Result<SkinSurface> next = Fitter(grid, caps, options, attempts[k], part).run();
    if (!next && next.status().code() == StatusCode::Cancelled)
    {
      return next;
    }
    if (!next)
    {
      best = best ? std::move(best) : std::move(next);
      continue;
    }
    next->Folds = countFolds(*next);
    const auto score = [](const SkinSurface& s)
    { return s.Folds + (s.Reached ? 0.0 : 0.5) + (s.Folds > 0 ? 1.0 : 0.0); };
    if (!best || score(*next) < score(*best))
    {
      best = std::move(next);
    }
    if ((best->Folds == 0 && best->Reached) || hopeless(*best, options))
    {
      break;
    }
  }
  return best;
}
} // namespace bsr
