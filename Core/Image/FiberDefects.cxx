#include "Image/FiberDefects.h"

#include "Common/CounterRandom.h"
#include "Image/FiberPhantom.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// A place on the wall: a point of either side and the wall's own directions.
struct Place
{
  Vec3 Out, In;       ///< facing points of the outer and inner wall
  Vec3 Normal;        ///< from inner to outer
  Vec3 Along, Around; ///< tangents: along the fiber, around it
  double Thickness;
  Vec3 at(double share) const { return this->In + share * (this->Out - this->In); }
};

/// Draws and builds defects; one stream of random numbers a kind, so that the kinds do not mix.
class Painter
{
public:
  Painter(const FiberPhantomOptions& options, const FiberShape& shape)
      : Options(options), Shape(shape), R(shape.meanRadius()), H(shape.voxel())
  {
  }

  std::vector<FiberDefect> Defects;

  void holes(int count)
  {
    CounterRandom random = this->stream(10);
    for (int i = 0; i < count; ++i)
    {
      const Place p = this->place(random);
      if (random.uniform() < 0.6)
      {
        const double radius = random.uniform(0.07, 0.2) * this->R;
        this->rod(p.at(-0.3) - this->H * p.Normal, p.at(1.3) + this->H * p.Normal, radius, true);
      }
      else
      {
        const double angle = random.uniform(-0.7, 0.7);
        const Vec3 length = std::cos(angle) * p.Along + std::sin(angle) * p.Around;
        this->ellipsoid(p.at(0.5), length, p.Normal,
          Vec3(random.uniform(0.3, 0.7) * this->R, p.Thickness + 2.0 * this->H,
            std::max(random.uniform(0.04, 0.09) * this->R, 0.7 * this->H)));
      }
    }
  }

  void pits(int count)
  {
    CounterRandom random = this->stream(11);
    for (int i = 0; i < count; ++i)
    {
      const Place p = this->place(random);
      const double depth = random.uniform(0.3, 0.7) * p.Thickness;
      const double wide = random.uniform(0.05, 0.14) * this->R;
      this->ellipsoid(p.Out, p.Along, p.Normal, Vec3(wide * random.uniform(0.8, 1.6), depth, wide));
    }
  }

  void tunnels(int count)
  {
    CounterRandom random = this->stream(12);
    for (int i = 0; i < count; ++i)
    {
      const Place p = this->place(random);
      const double radius = this->H * random.uniform(0.7, 1.8);
      Vec3 drift(0, 0, 0);
      Vec3 from = p.at(-0.15) - 0.5 * this->H * p.Normal;
      constexpr int steps = 6;
      for (int k = 1; k <= steps; ++k)
      {
        drift += this->H * (random.normal() * p.Along + random.normal() * p.Around);
        const Vec3 to = p.at(-0.15 + 1.3 * k / steps) + drift;
        this->rod(from, to, radius, false);
        from = to;
      }
    }
  }

  void cavities(int count)
  {
    CounterRandom random = this->stream(13);
    for (int i = 0; i < count; ++i)
    {
      const Place p = this->place(random);
      const double radius = std::min(this->H * random.uniform(0.8, 2.6), 0.36 * p.Thickness);
      const Vec3 center = p.at(random.uniform(0.3, 0.7));
      this->ellipsoid(center, (p.Along + random.uniform(-1, 1) * p.Around).normalized(), p.Normal,
        Vec3(radius * random.uniform(1.0, 2.2), radius, radius * random.uniform(0.8, 1.4)));
    }
  }

  void debris(int count)
  {
    CounterRandom random = this->stream(14);
    for (int i = 0; i < count; ++i)
    {
      const Place p = this->place(random);
      const double kind = random.uniform();
      if (kind < 0.22)
      {
        this->fibril(random, p, random.uniform() < 0.7);
        continue;
      }
      const double radius = this->H + random.uniform(0.02, 0.07) * this->R;
      Vec3 center = p.Out + 0.5 * radius * p.Normal; // adhering outside
      if (kind < 0.5)
      {
        center = p.Out + random.uniform(0.2, 0.6) * this->R * p.Normal; // loose outside
      }
      else if (kind < 0.65)
      {
        center = p.In - 0.5 * radius * p.Normal; // adhering inside
      }
      else if (kind < 0.75)
      {
        center = p.In - random.uniform(0.15, 0.35) * this->R * p.Normal; // loose inside
      }
      this->clump(random, center, radius);
    }
  }

private:
  CounterRandom stream(std::uint64_t number) const
  {
    return {static_cast<std::uint64_t>(this->Options.Seed), number};
  }

  Place place(CounterRandom& random) const
  {
    const double low = this->Shape.capBase(0);
    const double high = this->Shape.capBase(1);
    const double margin = this->Shape.openEnds() ? 0.4 * (low - this->Shape.begin()) : 0.0;
    const double x = random.uniform(low - margin, high + margin);
    const double angle = random.uniform(0.0, 2.0 * Pi);
    const double step = 0.02;
    const auto outer = [this](double at, double a)
    { return this->Shape.wallPoint(FiberShape::Outer, at, std::cos(a), std::sin(a)); };
    Place p;
    p.Out = outer(x, angle);
    p.In = this->Shape.wallPoint(FiberShape::Inner, x, std::cos(angle), std::sin(angle));
    p.Along = (outer(x + this->H, angle) - outer(x - this->H, angle)).normalized();
    const Vec3 around = outer(x, angle + step) - outer(x, angle - step);
    p.Normal = around.cross(p.Along).normalized();
    if (p.Normal.dot(p.Out - p.In) < 0.0)
    {
      p.Normal = -p.Normal;
    }
    p.Around = p.Normal.cross(p.Along);
    p.Thickness = (p.Out - p.In).norm();
    return p;
  }

  void rod(const Vec3& begin, const Vec3& finish, double radius, bool flat)
  {
    FiberDefect d;
    d.Kind = flat ? FiberDefect::Shape::FlatRod : FiberDefect::Shape::Rod;
    d.Begin = begin;
    d.Finish = finish;
    d.Radius = radius;
    this->Defects.push_back(d);
  }

  void ellipsoid(const Vec3& center, const Vec3& first, const Vec3& second, const Vec3& half)
  {
    FiberDefect d;
    d.Kind = FiberDefect::Shape::Ellipsoid;
    d.Begin = center;
    const Vec3 across = (second - second.dot(first) * first).normalized();
    d.Axes.col(0) = first;
    d.Axes.col(1) = across;
    d.Axes.col(2) = first.cross(across);
    d.HalfAxes = half;
    this->Defects.push_back(d);
  }

  void solidRod(const Vec3& begin, const Vec3& finish, double radius, double value)
  {
    this->rod(begin, finish, radius, false);
    this->Defects.back().Solid = true;
    this->Defects.back().Value = value;
  }

  static Vec3 direction(CounterRandom& random)
  {
    const Vec3 v(random.normal(), random.normal(), random.normal());
    return v / std::max(v.norm(), 1e-6);
  }

  void clump(CounterRandom& random, const Vec3& center, double radius)
  {
    const double value = random.uniform(0.55, 1.2);
    const int grains = 2 + random.below(5);
    for (int g = 0; g < grains; ++g)
    {
      const Vec3 at = center + random.uniform(0.0, 1.2) * radius * direction(random);
      const Vec3 to = at + random.uniform(0.0, 0.8) * radius * direction(random);
      this->solidRod(at, to, radius * random.uniform(0.5, 1.0), value);
    }
  }

  void fibril(CounterRandom& random, const Place& p, bool outside)
  {
    const double radius = this->H * random.uniform(0.7, 1.4);
    const Vec3 away = outside ? p.Normal : Vec3(-p.Normal);
    Vec3 heading = (direction(random) + 1.4 * away).normalized();
    Vec3 from = outside ? p.Out : p.In;
    const int pieces = 3 + random.below(6);
    for (int k = 0; k < pieces; ++k)
    {
      const Vec3 to = from + 0.12 * this->R * heading;
      this->solidRod(from, to, radius, 0.95);
      heading = (heading + 0.35 * direction(random)).normalized();
      from = to;
    }
  }

  const FiberPhantomOptions& Options;
  const FiberShape& Shape;
  double R;
  double H;
};
} // namespace

double FiberDefect::distance(const Vec3& p) const
{
  if (this->Kind == Shape::Ellipsoid)
  {
    const Vec3 q = (this->Axes.transpose() * (p - this->Begin)).cwiseQuotient(this->HalfAxes);
    const double level = q.norm();
    const double slope = q.cwiseQuotient(this->HalfAxes).norm();
    return slope > 1e-12 ? level * (level - 1.0) / slope : -this->HalfAxes.minCoeff();
  }
  const Vec3 axis = this->Finish - this->Begin;
  const double square = axis.squaredNorm();
  const double along = square > 0.0 ? (p - this->Begin).dot(axis) / square : 0.0;
  const Vec3 foot = this->Begin + std::clamp(along, 0.0, 1.0) * axis;
  if (this->Kind == Shape::Rod)
  {
    return (p - foot).norm() - this->Radius;
  }
  const double beyond = (std::abs(along - 0.5) - 0.5) * std::sqrt(square);
  return std::max((p - this->Begin - along * axis).norm() - this->Radius, beyond);
}

double FiberDefect::reach() const
{
  return this->Kind == Shape::Ellipsoid ? this->HalfAxes.maxCoeff()
                                        : 0.5 * (this->Finish - this->Begin).norm() + this->Radius;
}

Vec3 FiberDefect::middle() const
{
  return this->Kind == Shape::Ellipsoid ? this->Begin : Vec3(0.5 * (this->Begin + this->Finish));
}

std::vector<FiberDefect> makeFiberDefects(
  const FiberPhantomOptions& options, const FiberShape& shape)
{
  const auto automatic = [&](int count, int perHole)
  { return count < 0 ? perHole * options.Holes : count; };
  Painter painter(options, shape);
  painter.holes(options.Holes);
  painter.pits(automatic(options.Pits, 2));
  painter.tunnels(automatic(options.Tunnels, 8));
  painter.cavities(automatic(options.Cavities, 6));
  painter.debris(options.Debris);
  return std::move(painter.Defects);
}
} // namespace bsr
