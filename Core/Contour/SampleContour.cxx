#include "Contour/SampleContour.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr int AlignSamples = 96;

/// Sum of squares between samples of two closed curves.
double mismatch(const std::vector<Vec3>& a, const ArcCurve& curve, double start)
{
  Vec3 shift = Vec3::Zero();
  double sum = 0.0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    const Vec3 d = curve.at(start + static_cast<double>(i) / n) - a[i];
    shift += d;
    sum += d.squaredNorm();
  }
  return sum - shift.squaredNorm() / n;
}
} // namespace

ArcCurve::ArcCurve(const std::vector<Vec3>& points, bool closed) : Points(points), IsClosed(closed)
{
  if (closed)
  {
    this->Points.push_back(points.front());
  }
  this->Arc.assign(1, 0.0);
  for (std::size_t i = 1; i < this->Points.size(); ++i)
  {
    this->Arc.push_back(this->Arc.back() + (this->Points[i] - this->Points[i - 1]).norm());
  }
}

Vec3 ArcCurve::at(double t) const
{
  t = this->IsClosed ? t - std::floor(t) : std::clamp(t, 0.0, 1.0);
  const double s = t * this->length();
  const auto next = std::upper_bound(this->Arc.begin() + 1, this->Arc.end() - 1, s);
  const auto i = static_cast<std::size_t>(next - this->Arc.begin());
  const double h = this->Arc[i] - this->Arc[i - 1];
  const double r = h > 0.0 ? (s - this->Arc[i - 1]) / h : 0.0;
  return this->Points[i - 1] + r * (this->Points[i] - this->Points[i - 1]);
}

double ArcCurve::nearest(const Vec3& p) const
{
  double best = std::numeric_limits<double>::infinity();
  double share = 0.0;
  for (std::size_t i = 1; i < this->Points.size(); ++i)
  {
    const Vec3 d = this->Points[i] - this->Points[i - 1];
    const double l = d.squaredNorm();
    const double r = l > 0.0 ? std::clamp(d.dot(p - this->Points[i - 1]) / l, 0.0, 1.0) : 0.0;
    const double distance = (this->Points[i - 1] + r * d - p).squaredNorm();
    if (distance < best)
    {
      best = distance;
      share = this->Arc[i - 1] + r * (this->Arc[i] - this->Arc[i - 1]);
    }
  }
  return this->length() > 0.0 ? share / this->length() : 0.0;
}

std::vector<Vec3> sampleCurve(const ArcCurve& curve, int n, double start)
{
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(n));
  const double step = 1.0 / (curve.closed() ? n : std::max(n - 1, 1));
  for (int i = 0; i < n; ++i)
  {
    points.push_back(curve.at(start + i * step));
  }
  return points;
}

double alignedStart(const ArcCurve& previous, double previousStart, const ArcCurve& curve)
{
  const std::vector<Vec3> a = sampleCurve(previous, AlignSamples, previousStart);
  double best = std::numeric_limits<double>::infinity();
  double start = 0.0;
  double step = 1.0 / AlignSamples;
  for (int i = 0; i < AlignSamples; ++i)
  {
    const double m = mismatch(a, curve, i * step);
    if (m < best)
    {
      best = m;
      start = i * step;
    }
  }
  for (int round = 0; round < 8; ++round) // halve the step about the best
  {
    step *= 0.5;
    for (const double t : {start - step, start + step})
    {
      const double m = mismatch(a, curve, t);
      if (m < best)
      {
        best = m;
        start = t;
      }
    }
  }
  return start - std::floor(start);
}
} // namespace bsr
