#include "Spline/ClosestPoint.h"
#include "Common/Parallel.h"
#include "Spline/Bezier.h"
#include "Spline/Evaluate.h"
#include "Spline/Volume.h"

#include <cmath>

namespace bsr
{
namespace
{
/// Lower bounds are compared with computed distances: leave room for rounding.
constexpr double Slack = 1.0 - 1e-10;

/// Step of Newton's method on half the squared distance, with variables at a bound of `range` that
/// the gradient pushes outward held fixed.
Vec2 newtonStep(
  const SurfacePoint& s, const Vec3& r, const std::array<double, 4>& range, const Vec2& x)
{
  const Vec2 g(r.dot(s.Du), r.dot(s.Dv));
  const bool holdU = (x[0] <= range[0] && g[0] > 0) || (x[0] >= range[1] && g[0] < 0);
  const bool holdV = (x[1] <= range[2] && g[1] > 0) || (x[1] >= range[3] && g[1] < 0);
  const double gnU = s.Du.squaredNorm();
  const double gnV = s.Dv.squaredNorm();
  const double gnM = s.Du.dot(s.Dv);
  double hu = gnU + r.dot(s.Duu);
  double hv = gnV + r.dot(s.Dvv);
  double hm = gnM + r.dot(s.Duv);
  hu = hu > 1e-6 * gnU ? hu : gnU;
  hv = hv > 1e-6 * gnV ? hv : gnV;
  if (holdU || holdV)
  {
    return Vec2(holdU || !(hu > 0) ? 0.0 : -g[0] / hu, holdV || !(hv > 0) ? 0.0 : -g[1] / hv);
  }
  double det = hu * hv - hm * hm;
  if (!(det > 1e-9 * hu * hv))
  {
    hu = gnU;
    hv = gnV;
    hm = gnM;
    det = hu * hv - hm * hm;
  }
  if (!(det > 1e-14 * hu * hv))
  {
    return Vec2(hu > 0 ? -0.5 * g[0] / hu : 0.0, hv > 0 ? -0.5 * g[1] / hv : 0.0);
  }
  return Vec2((hm * g[1] - hv * g[0]) / det, (hm * g[0] - hu * g[1]) / det);
}

Vec2 clampTo(const Vec2& x, const std::array<double, 4>& r)
{
  return Vec2(std::clamp(x[0], r[0], r[1]), std::clamp(x[1], r[2], r[3]));
}

double percentile(const std::vector<double>& sorted, double share)
{
  const double x = share * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(x);
  const std::size_t j = std::min(i + 1, sorted.size() - 1);
  return sorted[i] + (x - static_cast<double>(i)) * (sorted[j] - sorted[i]);
}
} // namespace

ClosestPoint::ClosestPoint(const SplineModel& model) : Model(model), Flip(outwardFlips(model))
{
  std::vector<Box> boxes;
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    this->addCells(static_cast<Index>(p), boxes);
  }
  this->Tree = BoxTree(boxes);
}

void ClosestPoint::addCells(Index patch, std::vector<Box>& boxes)
{
  const SplinePatch& sp = this->Model.Patches[patch];
  const BezierPatch b = bezierPieces(this->Model, sp, 2);
  const std::int64_t width = b.size()[0];
  for (std::size_t j = 0; j + 1 < b.EndsV.size(); ++j)
  {
    for (std::size_t i = 0; i + 1 < b.EndsU.size(); ++i)
    {
      Cell c;
      c.Patch = patch;
      c.Range = {b.EndsU[i], b.EndsU[i + 1], b.EndsV[j], b.EndsV[j + 1]};
      const SurfacePoint s = evaluatePatch(
        this->Model, sp, 0.5 * (c.Range[0] + c.Range[1]), 0.5 * (c.Range[2] + c.Range[3]));
      Vec3 n = s.normal();
      n = n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3(Vec3::UnitZ());
      Vec3 a = s.Du - n * n.dot(s.Du);
      a = a.norm() > 0.0 ? Vec3(a.normalized()) : Vec3(n.unitOrthogonal());
      c.Center = s.Point;
      c.Axes << a.transpose(), n.cross(a).transpose(), n.transpose();
      Box box;
      Box local;
      for (int l = 0; l <= b.DegreeV; ++l)
      {
        for (int k = 0; k <= b.DegreeU; ++k)
        {
          const std::int64_t at = (static_cast<std::int64_t>(j) * b.DegreeV + l) * width +
                                  static_cast<std::int64_t>(i) * b.DegreeU + k;
          const Vec3 q = b.Points[at].head<3>();
          box.add(q);
          local.add(c.Axes * (q - c.Center));
        }
      }
      c.Low = local.Min;
      c.High = local.Max;
      this->Cells.push_back(c);
      boxes.push_back(box);
    }
  }
}

ModelHit ClosestPoint::project(const Cell& cell, const Vec3& p) const
{
  const SplinePatch& patch = this->Model.Patches[cell.Patch];
  const Vec2 size(cell.Range[1] - cell.Range[0], cell.Range[3] - cell.Range[2]);
  Vec2 x(0.5 * (cell.Range[0] + cell.Range[1]), 0.5 * (cell.Range[2] + cell.Range[3]));
  SurfacePoint s = evaluatePatch(this->Model, patch, x[0], x[1]);
  double best = (s.Point - p).squaredNorm();
  for (int iteration = 0; iteration < 50; ++iteration)
  {
    const Vec2 step = newtonStep(s, s.Point - p, cell.Range, x);
    Vec2 next = clampTo(x + step, cell.Range);
    SurfacePoint at = evaluatePatch(this->Model, patch, next[0], next[1]);
    double d = (at.Point - p).squaredNorm();
    for (int halving = 0; d > best && halving < 12; ++halving)
    {
      next = 0.5 * (next + x);
      at = evaluatePatch(this->Model, patch, next[0], next[1]);
      d = (at.Point - p).squaredNorm();
    }
    if (d > best)
    {
      break;
    }
    const double moved = (next - x).cwiseQuotient(size).cwiseAbs().maxCoeff();
    x = next;
    s = at;
    best = d;
    if (moved < 1e-9)
    {
      break;
    }
  }
  ModelHit hit;
  hit.Patch = cell.Patch;
  hit.U = x[0];
  hit.V = x[1];
  hit.SquaredDistance = best;
  hit.Point = s.Point;
  hit.Normal = s.normal().normalized() * (this->Flip[cell.Patch] ? -1.0 : 1.0);
  return hit;
}

ModelHit ClosestPoint::find(const Vec3& p, Index hint, int shell) const
{
  ModelHit best;
  double bound = best.SquaredDistance;
  const auto visit = [&](Index i)
  {
    const Cell& c = this->Cells[i];
    if (i == best.Cell ||
        (shell >= 0 && static_cast<int>(this->Model.Patches[c.Patch].Side) != shell))
    {
      return;
    }
    const Vec3 x = c.Axes * (p - c.Center);
    if ((c.Low - x).cwiseMax(x - c.High).cwiseMax(0.0).squaredNorm() * Slack > bound)
    {
      return;
    }
    ModelHit hit = this->project(c, p);
    hit.Cell = i;
    if (hit.SquaredDistance < best.SquaredDistance ||
        (hit.SquaredDistance == best.SquaredDistance && i < best.Cell))
    {
      best = hit;
      bound = hit.SquaredDistance / Slack;
    }
  };
  if (hint >= 0)
  {
    visit(hint);
  }
  this->Tree.nearest(p, bound, visit);
  return best;
}

Vec3 ClosestPoint::edgeNormal(const ModelHit& hit) const
{
  // All pieces that touch the point, found by the tree; weighted alike. Patches that meet at a
  // corner may count with different angles, which matters only beyond very acute corners.
  Vec3 sum = Vec3::Zero();
  const double reach = 1e-18 * (hit.Point.squaredNorm() + 1e-300);
  std::vector<Index> seen;
  this->Tree.nearest(hit.Point, reach,
    [&](Index i)
    {
      const Cell& c = this->Cells[i];
      if (std::find(seen.begin(), seen.end(), c.Patch) != seen.end())
      {
        return;
      }
      const ModelHit h = this->project(c, hit.Point);
      const Vec3 extent = c.High - c.Low;
      if (h.SquaredDistance <= 1e-16 * extent.squaredNorm())
      {
        seen.push_back(c.Patch);
        sum += h.Normal.allFinite() ? h.Normal : Vec3(Vec3::Zero());
      }
    });
  return sum;
}

double ClosestPoint::signedDistance(const Vec3& p, const ModelHit& hit) const
{
  const Vec3 r = p - hit.Point;
  const double d = std::sqrt(hit.SquaredDistance);
  double side = r.dot(hit.Normal);
  // Off an edge the offset is not along the normal: ask the other patches too.
  if (!(std::abs(side) > 0.99 * d))
  {
    const Vec3 n = this->edgeNormal(hit);
    side = n.squaredNorm() > 1e-12 ? r.dot(n) : side;
  }
  return side < 0.0 ? -d : d;
}

namespace
{
Status checkPoints(
  const SplineModel& model, const std::vector<Vec3>& points, const DeviationOptions& options)
{
  if (points.empty())
  {
    return Status::invalidInput("There is no point to measure; check the filters above.");
  }
  std::array<bool, 3> has = {false, false, false};
  for (const SplinePatch& p : model.Patches)
  {
    has[static_cast<std::size_t>(p.Side)] = true;
  }
  for (const int shell : options.ShellOfPoint)
  {
    if (shell >= 0 && shell <= 2 && !has[static_cast<std::size_t>(shell)])
    {
      return Status::invalidInput("There are points of shell " + std::to_string(shell) +
                                  ", but the model has no such shell; turn MatchSides off.");
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!points[i].allFinite())
    {
      return Status::invalidInput(
        "Point " + std::to_string(i) + " has a NaN or infinite coordinate; remove such points.");
    }
  }
  return Status::ok();
}

void summarize(const DeviationOptions& options, Deviation& out)
{
  std::vector<double> values;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < out.Distance.size(); ++i)
  {
    if (options.ShellOfPoint.empty() || options.ShellOfPoint[i] <= 2)
    {
      values.push_back(std::abs(out.Distance[i]));
      sum += out.Distance[i];
      squares += out.Distance[i] * out.Distance[i];
    }
  }
  out.Counted = static_cast<std::int64_t>(values.size());
  if (values.empty())
  {
    return;
  }
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  out.RMS = std::sqrt(squares / n);
  out.Mean = sum / n;
  out.Max = values.back();
  out.Percentiles = {percentile(values, 0.5), percentile(values, 0.75), percentile(values, 0.9),
    percentile(values, 0.95), percentile(values, 0.99)};
}
} // namespace

Result<Deviation> measureDeviation(const SplineModel& model, const std::vector<Vec3>& points,
  const DeviationOptions& options, Monitor& monitor)
{
  if (Status s = checkPoints(model, points, options); !s)
  {
    return s;
  }
  const ClosestPoint closest(model);
  Deviation out;
  out.Distance.resize(points.size());
  out.PatchId.resize(points.size());
  const auto n = static_cast<std::int64_t>(points.size());
  const std::int64_t block = 10000;
  for (std::int64_t first = 0; first < n; first += block)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    monitor.progress(static_cast<double>(first) / static_cast<double>(n));
    parallelFor(first, std::min(first + block, n), 200,
      [&](std::int64_t begin, std::int64_t end)
      {
        Index hint = -1;
        for (std::int64_t i = begin; i < end; ++i)
        {
          const int shell = options.ShellOfPoint.empty() || options.ShellOfPoint[i] > 2
                              ? -1
                              : options.ShellOfPoint[i];
          const ModelHit hit = closest.find(points[i], hint, shell);
          hint = hit.Cell;
          out.Distance[i] = closest.signedDistance(points[i], hit);
          out.PatchId[i] = hit.Patch;
        }
      });
  }
  summarize(options, out);
  monitor.progress(1.0);
  return out;
}
} // namespace bsr
