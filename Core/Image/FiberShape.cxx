#include "Image/FiberShape.h"

#include "Common/CounterRandom.h"
#include "Image/FiberPhantom.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// A smooth random function of x within [-1, 1]: a few waves, the shortest `shortest` long.
class SmoothWave
{
public:
  SmoothWave(CounterRandom& random, double shortest)
  {
    double total = 0.0;
    for (int i = 0; i < 4; ++i)
    {
      this->Frequency[i] = 2.0 * Pi / (shortest * random.uniform(1.0 + 0.4 * i, 1.4 + 0.8 * i));
      this->Phase[i] = random.uniform(0.0, 2.0 * Pi);
      this->Amplitude[i] = random.uniform(0.5, 1.0);
      total += this->Amplitude[i];
    }
    for (double& a : this->Amplitude)
    {
      a /= 0.75 * total; // the waves hardly ever meet; at() clamps where they do
    }
  }
  /// Value, first and second derivative.
  std::array<double, 3> at(double x) const
  {
    std::array<double, 3> f{};
    for (int i = 0; i < 4; ++i)
    {
      const double w = this->Frequency[i];
      const double c = this->Amplitude[i] * std::cos(w * x + this->Phase[i]);
      const double s = this->Amplitude[i] * std::sin(w * x + this->Phase[i]);
      f[0] += c;
      f[1] -= w * s;
      f[2] -= w * w * c;
    }
    return f;
  }
  double clamped(double x) const { return std::clamp(this->at(x)[0], -1.0, 1.0); }

private:
  double Frequency[4];
  double Phase[4];
  double Amplitude[4];
};

/// Sum of c[2m] cos((m+1) angle) + c[2m+1] sin((m+1) angle).
template <std::size_t N>
double trigonometric(const std::array<double, N>& c, double cosine, double sine)
{
  double sum = 0.0;
  double cm = cosine;
  double sm = sine;
  for (std::size_t m = 0; m < N; m += 2)
  {
    sum += c[m] * cm + c[m + 1] * sm;
    const double next = cm * cosine - sm * sine;
    sm = sm * cosine + cm * sine;
    cm = next;
  }
  return sum;
}

FiberShape::Station blend(const FiberShape::Station& a, const FiberShape::Station& b, double t)
{
  FiberShape::Station s;
  const double r = 1.0 - t;
  s.Center = r * a.Center + t * b.Center;
  s.Derivative = r * a.Derivative + t * b.Derivative;
  s.Second = r * a.Second + t * b.Second;
  s.U = r * a.U + t * b.U;
  s.V = r * a.V + t * b.V;
  s.Bean = r * a.Bean + t * b.Bean;
  for (int w = 0; w < 2; ++w)
  {
    s.A[w] = r * a.A[w] + t * b.A[w];
    s.B[w] = r * a.B[w] + t * b.B[w];
    for (std::size_t i = 0; i < s.Wave[w].size(); ++i)
    {
      s.Wave[w][i] = r * a.Wave[w][i] + t * b.Wave[w][i];
    }
  }
  return s;
}
} // namespace

FiberShape::FiberShape(const FiberPhantomOptions& o)
{
  this->Voxel = std::min({o.Spacing[0], o.Spacing[1], o.Spacing[2]});
  const double length = (o.Dimensions[0] - 1) * o.Spacing[0];
  const double across =
    std::min((o.Dimensions[1] - 1) * o.Spacing[1], (o.Dimensions[2] - 1) * o.Spacing[2]);
  this->Radius = 0.25 * across;
  this->Thickness = o.WallThickness * this->Radius;
  this->Open = o.OpenEnds;
  this->Ends = {0.5 * length * (1.0 - o.Length), 0.5 * length * (1.0 + o.Length)};
  const double cap = std::min(0.85 * this->Radius, 0.3 * o.Length * length);
  this->Cap = {cap, std::max(cap - this->Thickness, 0.3 * cap)};

  const double pad = 1.2 * this->Radius + 8.0 * this->Voxel;
  this->First = this->Ends[0] - pad;
  this->Step = 0.25 * this->Voxel;
  this->Stations.resize(
    2 + static_cast<std::size_t>((this->Ends[1] - this->Ends[0] + 2.0 * pad) / this->Step));
  this->design(o);
  this->fitCenterline(o);
  this->setFrames(o.Twist);
}

void FiberShape::design(const FiberPhantomOptions& o)
{
  CounterRandom random(static_cast<std::uint64_t>(o.Seed), 1);
  const double r = this->Radius;
  const SmoothWave size(random, 5.0 * r);
  const SmoothWave collapse(random, 4.0 * r);
  const SmoothWave wall(random, 3.0 * r);
  std::vector<SmoothWave> waves;
  waves.reserve(16);
  for (int i = 0; i < 16; ++i)
  {
    waves.emplace_back(random, 3.5 * r);
  }
  // Relative amplitude of the waves of 1..4 times the angle, by wall.
  constexpr double amplitude[2][4] = {{0.0, 0.02, 0.035, 0.02}, {0.05, 0.04, 0.03, 0.015}};
  for (std::size_t i = 0; i < this->Stations.size(); ++i)
  {
    const double x = this->First + static_cast<double>(i) * this->Step;
    Station& s = this->Stations[i];
    const double c = o.Collapse * (0.6 + 0.4 * collapse.clamped(x));
    const double scale = r * (1.0 + 0.08 * size.clamped(x));
    const double w = this->Thickness * (1.0 + 0.2 * wall.clamped(x));
    s.A[Outer] = scale * (1.08 + 0.42 * c);
    s.B[Outer] = scale * (0.98 - 0.52 * c);
    s.Bean = 0.55 * c * scale;
    s.A[Inner] = std::max(s.A[Outer] - 1.1 * w, 0.3 * s.A[Outer]);
    s.B[Inner] = std::max(s.B[Outer] - w, 0.3 * s.B[Outer]);
    for (int side = 0; side < 2; ++side)
    {
      for (int k = 0; k < 8; ++k)
      {
        s.Wave[side][k] = amplitude[side][k / 2] * waves[8 * side + k].clamped(x);
      }
    }
  }
}

double FiberShape::farthest() const
{
  double far = 0.0;
  for (const Station& s : this->Stations)
  {
    // |u| <= A m, |v| <= B m + Bean / 2 with the modulation m.
    const double m = 1.12;
    far = std::max(far, std::hypot(m * s.A[Outer], m * s.B[Outer] + 0.5 * s.Bean));
    far = std::max(far, m * s.A[Outer] + 0.3 * s.Bean);
  }
  return far;
}

void FiberShape::fitCenterline(const FiberPhantomOptions& o)
{
  CounterRandom random(static_cast<std::uint64_t>(o.Seed), 2);
  const SmoothWave y(random, 9.0 * this->Radius);
  const SmoothWave z(random, 9.0 * this->Radius);
  for (std::size_t e = 0; e < 12; ++e)
  {
    const std::size_t times = (e % 6) / 2 + 1; // the angle
    this->Cut[e / 6][e % 6] =
      random.uniform(-0.10, 0.10) * this->Radius / static_cast<double>(times);
  }
  // Room left for bending in each direction; at least a little, so that the ends may come close.
  double widest = 0.0;
  for (const Station& s : this->Stations)
  {
    widest = std::max(widest, 1.06 * s.A[Outer]);
  }
  this->Reach = this->farthest();
  const Vec3 middle(
    0.0, 0.5 * (o.Dimensions[1] - 1) * o.Spacing[1], 0.5 * (o.Dimensions[2] - 1) * o.Spacing[2]);
  double ay = o.Bend * std::max(middle.y() - widest - 3.0 * this->Voxel, 0.02 * this->Radius);
  double az = o.Bend * std::max(middle.z() - widest - 3.0 * this->Voxel, 0.02 * this->Radius);
  for (int attempt = 0; attempt < 60; ++attempt)
  {
    double sharpest = 0.0;
    for (std::size_t i = 0; i < this->Stations.size(); ++i)
    {
      const double x = this->First + static_cast<double>(i) * this->Step;
      const auto fy = y.at(x);
      const auto fz = z.at(x);
      Station& s = this->Stations[i];
      s.Center = Vec3(x, middle.y() + ay * fy[0], middle.z() + az * fz[0]);
      s.Derivative = Vec3(1.0, ay * fy[1], az * fz[1]);
      s.Second = Vec3(0.0, ay * fy[2], az * fz[2]);
      sharpest = std::max(
        sharpest, s.Derivative.cross(s.Second).norm() / std::pow(s.Derivative.norm(), 3.0));
    }
    if (sharpest * this->Reach < 0.6)
    {
      break; // the normal planes do not meet within the fiber
    }
    ay *= 0.9;
    az *= 0.9;
  }
}

void FiberShape::setFrames(double twist)
{
  const double length = this->Ends[1] - this->Ends[0];
  for (Station& s : this->Stations)
  {
    const Vec3 t = s.Derivative.normalized();
    const Vec3 u = (Vec3::UnitY() - t.y() * t).normalized();
    const Vec3 v = t.cross(u);
    const double angle = 2.0 * Pi * twist * (s.Center.x() - this->Ends[0]) / length;
    s.U = std::cos(angle) * u + std::sin(angle) * v;
    s.V = std::cos(angle) * v - std::sin(angle) * u;
  }
}

FiberShape::Station FiberShape::station(double x) const
{
  const double f = std::clamp(
    (x - this->First) / this->Step, 0.0, static_cast<double>(this->Stations.size()) - 1.000001);
  const auto i = static_cast<std::size_t>(f);
  return blend(this->Stations[i], this->Stations[i + 1], f - static_cast<double>(i));
}

std::array<double, 2> FiberShape::levels(const Station& s, double x, double u, double v) const
{
  std::array<double, 2> f{};
  const double w = v - s.Bean * (u * u / (s.A[Outer] * s.A[Outer]) - 0.5);
  for (int side = 0; side < 2; ++side)
  {
    const double a = u / s.A[side];
    const double b = w / s.B[side];
    const double rho = std::hypot(a, b);
    const double inverse = rho > 1e-9 ? 1.0 / rho : 0.0;
    double level = rho / (1.0 + trigonometric(s.Wave[side], a * inverse, b * inverse));
    if (!this->Open)
    {
      const double beyond = std::max({this->capBase(0) - x, x - this->capBase(1), 0.0});
      level = std::hypot(level, beyond / this->Cap[side]);
    }
    f[side] = level - 1.0;
  }
  return f;
}

double FiberShape::cutOffset(int end, double cosine, double sine) const
{
  return trigonometric(this->Cut[end], cosine, sine);
}

FiberShape::Local FiberShape::at(const Vec3& p, double margin) const
{
  Local local{0.0, 0.0, 0.0, false};
  const double last = this->First + this->Step * static_cast<double>(this->Stations.size() - 1);
  double x = std::clamp(p.x(), this->First, last);
  Station s = this->station(x);
  const double far = 1.3 * this->Reach + margin;
  if ((p - s.Center).squaredNorm() > far * far)
  {
    return local;
  }
  // The foot on the centerline: (p - c) . c' = 0.
  for (int i = 0; i < 8; ++i)
  {
    const Vec3 d = p - s.Center;
    const double slope =
      std::max(s.Derivative.squaredNorm() - d.dot(s.Second), 0.25 * s.Derivative.squaredNorm());
    const double step = d.dot(s.Derivative) / slope;
    x += step;
    if (x < this->First || x > last)
    {
      return local;
    }
    s = this->station(x);
    if (std::abs(step) < 1e-4 * this->Voxel)
    {
      break;
    }
  }
  const Vec3 d = p - s.Center;
  const double u = d.dot(s.U);
  const double v = d.dot(s.V);
  const auto f = this->levels(s, x, u, v);
  const double least = 0.5 * std::min(s.A[Outer], s.B[Outer]);
  if (f[Outer] * least > margin)
  {
    return local;
  }
  local.Near = true;
  local.CutDistance = -1e30;
  const double speed = s.Derivative.norm();
  if (this->Open)
  {
    const double a = u / s.A[Outer];
    const double b = (v - s.Bean * (u * u / (s.A[Outer] * s.A[Outer]) - 0.5)) / s.B[Outer];
    const double rho = std::max(std::hypot(a, b), 1e-9);
    const double low = this->Ends[0] + this->cutOffset(0, a / rho, b / rho);
    const double high = this->Ends[1] + this->cutOffset(1, a / rho, b / rho);
    local.CutDistance = speed * std::max(low - x, x - high);
  }
  local.OuterDistance = f[Outer] * s.B[Outer];
  local.InnerDistance = f[Inner] * s.B[Inner];
  const double leastInner = 0.5 * std::min(s.A[Inner], s.B[Inner]);
  if (std::abs(f[Outer]) * least > margin && std::abs(f[Inner]) * leastInner > margin)
  {
    return local;
  }
  // Distance to first order: the level divided by the length of its gradient.
  const double h = 0.25 * this->Voxel;
  const auto du0 = this->levels(s, x, u - h, v);
  const auto du1 = this->levels(s, x, u + h, v);
  const auto dv0 = this->levels(s, x, u, v - h);
  const auto dv1 = this->levels(s, x, u, v + h);
  // Along the fiber the frame turns, so the offset is projected anew.
  const Station s0 = this->station(x - h);
  const Station s1 = this->station(x + h);
  const auto dx0 = this->levels(s0, x - h, d.dot(s0.U), d.dot(s0.V));
  const auto dx1 = this->levels(s1, x + h, d.dot(s1.U), d.dot(s1.V));
  const double metric = std::max(speed - d.dot(s.Second) / speed, 0.25 * speed);
  double distance[2];
  for (int side = 0; side < 2; ++side)
  {
    const double gu = du1[side] - du0[side];
    const double gv = dv1[side] - dv0[side];
    const double gx = (dx1[side] - dx0[side]) / metric;
    distance[side] = f[side] * 2.0 * h / std::max(std::sqrt(gu * gu + gv * gv + gx * gx), 1e-12);
  }
  local.OuterDistance = distance[Outer];
  local.InnerDistance = distance[Inner];
  return local;
}

Vec3 FiberShape::wallPoint(Wall wall, double x, double cosine, double sine, double shrink) const
{
  const Station s = this->station(x);
  const double m = shrink * (1.0 + trigonometric(s.Wave[wall], cosine, sine));
  const double u = m * s.A[wall] * cosine;
  const double v = m * s.B[wall] * sine + s.Bean * (u * u / (s.A[Outer] * s.A[Outer]) - 0.5);
  return s.Center + u * s.U + v * s.V;
}

double FiberShape::cutAt(int end, Wall wall, double cosine, double sine) const
{
  // The cut is a function of the outer wall's angle, which at the inner wall depends on x a little.
  double x = this->Ends[end];
  for (int i = 0; i < 4; ++i)
  {
    const Station s = this->station(x);
    const double a = s.A[wall] * cosine / s.A[Outer];
    const double b = s.B[wall] * sine / s.B[Outer];
    const double rho = std::hypot(a, b);
    x = this->Ends[end] + this->cutOffset(end, a / rho, b / rho);
  }
  return x;
}
} // namespace bsr
