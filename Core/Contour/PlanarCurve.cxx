#include "Contour/PlanarCurve.h"

#include "Mesh/PlaneVector.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
struct Segment
{
  Vec2 A, B;
  Index Curve, Id;
};

bool properlyCross(const Segment& s, const Segment& t)
{
  const Vec2 ds = s.B - s.A;
  const Vec2 dt = t.B - t.A;
  const double a = planeCross(ds, t.A - s.A);
  const double b = planeCross(ds, t.B - s.A);
  const double c = planeCross(dt, s.A - t.A);
  const double d = planeCross(dt, s.B - t.A);
  const double eps = 1e-12 * ds.norm() * dt.norm();
  return std::min(a, b) < -eps && std::max(a, b) > eps && std::min(c, d) < -eps &&
         std::max(c, d) > eps;
}

/// x of the crossings of a closed curve with the line at height y, sorted.
void scan(const Curve2& curve, double y, std::vector<double>& xs)
{
  xs.clear();
  for (std::size_t i = 0; i < curve.size(); ++i)
  {
    const Vec2& a = curve[i];
    const Vec2& b = curve[(i + 1) % curve.size()];
    if ((a.y() <= y) != (b.y() <= y))
    {
      xs.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
  }
  std::sort(xs.begin(), xs.end());
}

double commonLength(const std::vector<double>& a, const std::vector<double>& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < a.size(); i += 2)
  {
    for (std::size_t j = 0; j + 1 < b.size(); j += 2)
    {
      sum += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
    }
  }
  return sum;
}
} // namespace

double signedArea(const Curve2& curve)
{
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i)
  {
    sum += planeCross(curve[i] - curve[0], curve[i + 1] - curve[0]);
  }
  return 0.5 * sum;
}

Vec2 areaCentroid(const Curve2& curve)
{
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : curve)
  {
    mean += p / static_cast<double>(curve.size());
  }
  Vec2 sum = Vec2::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i)
  {
    const Vec2 a = curve[i] - mean;
    const Vec2 b = curve[(i + 1) % curve.size()] - mean;
    area += planeCross(a, b);
    sum += planeCross(a, b) * (a + b) / 3.0;
  }
  const double length = curveLength(curve, true);
  return std::abs(area) > 1e-9 * length * length ? Vec2(mean + sum / area) : mean;
}

double curveLength(const Curve2& curve, bool closed)
{
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i)
  {
    sum += (curve[i + 1] - curve[i]).norm();
  }
  return closed && curve.size() > 1 ? sum + (curve.front() - curve.back()).norm() : sum;
}

bool insideCurve(const Curve2& curve, const Vec2& p)
{
  bool inside = false;
  for (std::size_t i = 0; i < curve.size(); ++i)
  {
    const Vec2& a = curve[i];
    const Vec2& b = curve[(i + 1) % curve.size()];
    if ((a.y() <= p.y()) != (b.y() <= p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
    {
      inside = !inside;
    }
  }
  return inside;
}

double curveDistance(const Curve2& curve, bool closed, const Vec2& p)
{
  double best = std::numeric_limits<double>::infinity();
  const std::size_t n = curve.size();
  for (std::size_t i = 0; i < (closed || n < 2 ? n : n - 1); ++i)
  {
    const Vec2& a = curve[i];
    const Vec2 d = curve[(i + 1) % n] - a;
    const double l = d.squaredNorm();
    const double t = l > 0.0 ? std::clamp(d.dot(p - a) / l, 0.0, 1.0) : 0.0;
    best = std::min(best, (a + t * d - p).squaredNorm());
  }
  return std::sqrt(best);
}

CurveCrossing findCrossing(
  const std::vector<const Curve2*>& curves, const std::vector<char>& closed)
{
  std::vector<Segment> segments;
  for (std::size_t c = 0; c < curves.size(); ++c)
  {
    const Curve2& curve = *curves[c];
    const std::size_t n = curve.size();
    for (std::size_t i = 0; i < (closed[c] ? n : n - 1); ++i)
    {
      segments.push_back(
        {curve[i], curve[(i + 1) % n], static_cast<Index>(c), static_cast<Index>(i)});
    }
  }
  const auto low = [](const Segment& s) { return std::min(s.A.x(), s.B.x()); };
  std::stable_sort(segments.begin(), segments.end(),
    [&](const Segment& s, const Segment& t) { return low(s) < low(t); });
  for (std::size_t i = 0; i < segments.size(); ++i)
  {
    const double high = std::max(segments[i].A.x(), segments[i].B.x());
    for (std::size_t j = i + 1; j < segments.size() && low(segments[j]) <= high; ++j)
    {
      if (properlyCross(segments[i], segments[j]))
      {
        return {{segments[i].Curve, segments[j].Curve}, {segments[i].Id, segments[j].Id}};
      }
    }
  }
  return {};
}

double overlapShare(const Curve2& a, const Curve2& b)
{
  const double areaA = std::abs(signedArea(a));
  const double areaB = std::abs(signedArea(b));
  const Curve2& small = areaA <= areaB ? a : b;
  const Curve2& large = areaA <= areaB ? b : a;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec2& p : small)
  {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  constexpr int Lines = 96;
  std::vector<double> xs;
  std::vector<double> ys;
  double common = 0.0;
  double whole = 0.0;
  for (int i = 0; i < Lines; ++i)
  {
    const double y = low + (i + 0.5) / Lines * (high - low);
    scan(small, y, xs);
    scan(large, y, ys);
    common += commonLength(xs, ys);
    whole += commonLength(xs, xs);
  }
  return whole > 0.0 ? common / whole : 0.0;
}
} // namespace bsr
