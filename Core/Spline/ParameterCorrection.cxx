#include "Spline/ParameterCorrection.h"

#include "Common/Parallel.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double LargestStep = 0.25;

struct Step
{
  double U = 0.0;
  double V = 0.0;
};

/// Minimizes the quadratic model; along a border that is active if the step would leave there.
Step modelStep(double a, double b, double c, double gu, double gv, double u, double v)
{
  const double det = a * c - b * b;
  Step s;
  if (det > 1e-12 * a * c)
  {
    s = {(c * gu - b * gv) / det, (a * gv - b * gu) / det};
  }
  else
  {
    s = {a > 0 ? gu / a : 0.0, c > 0 ? gv / c : 0.0};
  }
  const bool blockedU = (u <= 0.0 && s.U < 0.0) || (u >= 1.0 && s.U > 0.0);
  const bool blockedV = (v <= 0.0 && s.V < 0.0) || (v >= 1.0 && s.V > 0.0);
  if (blockedU)
  {
    s = {0.0, blockedV || c <= 0 ? 0.0 : gv / c};
  }
  else if (blockedV)
  {
    s = {a > 0 ? gu / a : 0.0, 0.0};
  }
  const double size = std::max(std::abs(s.U), std::abs(s.V));
  if (size > LargestStep)
  {
    s.U *= LargestStep / size;
    s.V *= LargestStep / size;
  }
  return s;
}

/// Where the unclamped first-order step points: the side that it leaves through, or -1.
int leavingSide(const SurfacePoint& s, const Vec3& e, double u, double v)
{
  if (v <= 0.0 && s.Dv.dot(e) < 0.0)
  {
    return 0;
  }
  if (u >= 1.0 && s.Du.dot(e) > 0.0)
  {
    return 1;
  }
  if (v >= 1.0 && s.Dv.dot(e) > 0.0)
  {
    return 2;
  }
  return u <= 0.0 && s.Du.dot(e) < 0.0 ? 3 : -1;
}

void taylor(const NetEvaluator& surface, FitPoint& p)
{
  const SurfacePoint s = surface.at(p.Patch, p.U, p.V);
  const Vec3 e = p.Position - s.Point;
  const Step d = modelStep(
    s.Du.squaredNorm(), s.Du.dot(s.Dv), s.Dv.squaredNorm(), s.Du.dot(e), s.Dv.dot(e), p.U, p.V);
  p.U = std::clamp(p.U + d.U, 0.0, 1.0);
  p.V = std::clamp(p.V + d.V, 0.0, 1.0);
}

/// `at(u, v)` gives the point of p's patch.
template <class At>
void newton(const At& at, FitPoint& p, int iterations = 12)
{
  for (int i = 0; i < iterations; ++i)
  {
    const SurfacePoint s = at(p.U, p.V);
    const Vec3 e = p.Position - s.Point;
    const double gu = s.Du.dot(e);
    const double gv = s.Dv.dot(e);
    double a = s.Du.squaredNorm() - s.Duu.dot(e);
    double b = s.Du.dot(s.Dv) - s.Duv.dot(e);
    double c = s.Dv.squaredNorm() - s.Dvv.dot(e);
    if (a <= 0.0 || a * c - b * b <= 1e-9 * a * std::abs(c))
    {
      a = s.Du.squaredNorm();
      b = s.Du.dot(s.Dv);
      c = s.Dv.squaredNorm();
    }
    Step d = modelStep(a, b, c, gu, gv, p.U, p.V);
    const double before = e.squaredNorm();
    double u = p.U;
    double v = p.V;
    for (int half = 0; half < 8; ++half)
    {
      u = std::clamp(p.U + d.U, 0.0, 1.0);
      v = std::clamp(p.V + d.V, 0.0, 1.0);
      if ((p.Position - at(u, v).Point).squaredNorm() <= before)
      {
        break;
      }
      d.U *= 0.5;
      d.V *= 0.5;
      u = p.U;
      v = p.V;
    }
    const double moved = std::abs(u - p.U) + std::abs(v - p.V);
    p.U = u;
    p.V = v;
    if (moved < 1e-10)
    {
      return;
    }
  }
}

/// Hands a point that sits on a side and wants across to the neighbor there.
bool cross(const NetEvaluator& surface, const QuadComplex& complex, FitPoint& p)
{
  const SurfacePoint s = surface.at(p.Patch, p.U, p.V);
  const int side = leavingSide(s, p.Position - s.Point, p.U, p.V);
  const Index twin = side < 0 ? -1 : complex.twin(4 * p.Patch + side);
  if (twin < 0)
  {
    return false;
  }
  const double along[4] = {p.U, p.V, 1.0 - p.U, 1.0 - p.V};
  const double t = 1.0 - along[side];
  const double uv[4][2] = {{t, 0.0}, {1.0, t}, {1.0 - t, 1.0}, {0.0, 1.0 - t}};
  p.Patch = twin / 4;
  p.U = uv[twin % 4][0];
  p.V = uv[twin % 4][1];
  return true;
}
} // namespace

void correctParameters(const PatchNet& net, const NetPoints& surface, CorrectionMethod method,
  std::vector<FitPoint>& points, const QuadComplex* complex)
{
  correctParameters(NetEvaluator(net, surface), method, points, complex);
}

void correctParameters(const NetEvaluator& evaluator, CorrectionMethod method,
  std::vector<FitPoint>& points, const QuadComplex* complex)
{
  const auto step = [&](FitPoint& p)
  {
    if (method == CorrectionMethod::Taylor)
    {
      taylor(evaluator, p);
    }
    else
    {
      newton([&](double u, double v) { return evaluator.at(p.Patch, u, v); }, p);
    }
  };
  parallelFor(0, static_cast<std::int64_t>(points.size()), 1024,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        FitPoint& p = points[i];
        if (p.Fixed)
        {
          continue;
        }
        step(p);
        if (complex && cross(evaluator, *complex, p))
        {
          step(p);
        }
      }
    });
}

void correctOnPatch(const RationalPatch& patch, FitPoint* first, FitPoint* last, int iterations)
{
  for (FitPoint* p = first; p != last; ++p)
  {
    if (!p->Fixed)
    {
      newton([&](double u, double v) { return patch.at(u, v); }, *p, iterations);
    }
  }
}

std::vector<Residual> residuals(
  const PatchNet& net, const NetPoints& surface, const std::vector<FitPoint>& points)
{
  return residuals(NetEvaluator(net, surface), points);
}

std::vector<Residual> residuals(const NetEvaluator& evaluator, const std::vector<FitPoint>& points)
{
  std::vector<Residual> r(points.size());
  parallelFor(0, static_cast<std::int64_t>(points.size()), 2048,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        const SurfacePoint s = evaluator.at(points[i].Patch, points[i].U, points[i].V);
        const Vec3 e = points[i].Position - s.Point;
        const Vec3 n = s.normal();
        const double size = n.norm();
        r[i] = {e.norm(), size > 0.0 ? e.dot(n) / size : e.norm(), 1.0};
        const double known = points[i].Normal.norm() * size;
        if (known > 0.0)
        {
          r[i].Cosine = std::abs(points[i].Normal.dot(n)) / known;
        }
      }
    });
  return r;
}

double weightedRms(
  const PatchNet& net, const NetPoints& surface, const std::vector<FitPoint>& points)
{
  const auto r = residuals(net, surface, points);
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i)
  {
    sum += points[i].weight() * r[i].Distance * r[i].Distance;
    weight += points[i].weight();
  }
  return std::sqrt(sum / std::max(weight, 1e-300));
}
} // namespace bsr
