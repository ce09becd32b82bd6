#include "Layout/Sizing.h"

#include "Common/Parallel.h"
#include "Mesh/Curvature.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double Bend = 1.5;     ///< largest angle, in radians, that a quad turns by
constexpr double Smallest = 0.3; ///< smallest side, relative to flat places
constexpr int Averaging = 14;    ///< steps of averaging over neighbors: about half a quad
constexpr double Growth = 0.5;   ///< of the side per distance

/// Largest principal curvature of each triangle, averaged; incomplete once cancelled.
std::vector<double> bending(
  const TriangleSurface& s, const std::vector<std::uint8_t>& inside, Monitor& monitor)
{
  const std::vector<Vec3> form = faceCurvature(s, inside, monitor);
  std::vector<double> value(form.size(), 0.0);
  for (std::size_t f = 0; f < form.size(); ++f)
  {
    const Vec3& q = form[f];
    value[f] = 0.5 * std::abs(q[0] + q[2]) + std::hypot(0.5 * (q[0] - q[2]), q[1]);
  }
  for (int round = 0; round < Averaging; ++round)
  {
    std::vector<double> next = value;
    parallelForUntilCancelled(0, s.faces(), 4096, monitor,
      [&](std::int64_t first, std::int64_t last)
      {
        for (auto f = static_cast<Index>(first); f < last; ++f)
        {
          double sum = value[f];
          double weight = 1.0;
          for (Index h = 3 * f; h < 3 * f + 3 && inside[f]; ++h)
          {
            const Index g = s.Opposite[h] / 3;
            sum += inside[g] ? value[g] : 0.0;
            weight += inside[g];
          }
          next[f] = sum / weight;
        }
      });
    value.swap(next);
  }
  return value;
}
} // namespace

Sizing::Sizing(const TriangleSurface& s, double cell, QuadSizing kind, const Sizing::Field& field,
  Monitor& monitor)
{
  std::vector<std::uint8_t> inside(s.Region.size());
  for (Index f = 0; f < s.faces(); ++f)
  {
    inside[f] = !s.hole(f);
  }
  const std::vector<double> bent = bending(s, inside, monitor);
  std::vector<double> limit(bent.size());
  for (std::size_t f = 0; f < bent.size(); ++f)
  {
    limit[f] = std::min(Bend / std::max(bent[f], 1e-300), 10.0 * cell);
  }
  for (int round = 0; round < 40 && !monitor.cancelled(); ++round)
  {
    bool changed = false;
    for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
    {
      const Index f = h / 3;
      const Index g = s.Opposite[h] / 3;
      const double step = 0.6 * (s.Points[s.end(h)] - s.Points[s.start(h)]).norm();
      if (inside[f] && inside[g] && limit[f] > limit[g] + Growth * step)
      {
        limit[f] = limit[g] + Growth * step;
        changed = true;
      }
    }
    if (!changed)
    {
      break;
    }
  }
  if (monitor.cancelled())
  {
    return;
  }
  std::vector<std::array<Index, 3>> triangles;
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (inside[f])
    {
      triangles.push_back(s.corners(f));
      this->Limit.push_back(limit[f]);
      this->Area.push_back(s.areaNormal(f).norm());
    }
  }
  if (monitor.cancelled())
  {
    return;
  }
  this->Tree = TriangleTree(s.Points, std::move(triangles), monitor);
  this->Cell = cell;
  this->Factor.assign(this->Area.size(), 1.0);
  if (kind != QuadSizing::Uniform)
  {
    this->setFactors(s, bent, kind, field);
  }
}

/// Relative sides, bounded and with a geometric mean of about 1.
void Sizing::setFactors(const TriangleSurface& s, const std::vector<double>& bent, QuadSizing kind,
  const Sizing::Field& field)
{
  double logs = 0.0;
  double total = 0.0;
  std::size_t i = 0;
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (s.hole(f))
    {
      continue;
    }
    const auto c = s.corners(f);
    double value = 1.0;
    if (kind == QuadSizing::Array && field)
    {
      value = field((s.Points[c[0]] + s.Points[c[1]] + s.Points[c[2]]) / 3.0);
    }
    else if (kind == QuadSizing::Curvature)
    {
      value = 1.0 / std::sqrt(std::max(bent[f], 1e-3 / this->Cell));
    }
    this->Factor[i] = value;
    logs += this->Area[i] * std::log(value);
    total += this->Area[i++];
  }
  const double mean = std::exp(logs / std::max(total, 1e-300));
  const bool bounded = kind == QuadSizing::Curvature;
  for (double& value : this->Factor)
  {
    value = bounded ? std::clamp(value / mean, 0.4, 2.0) : std::clamp(value / mean, 0.05, 20.0);
  }
}

double Sizing::sideIn(Index triangle, double cell) const
{
  const double side = this->Factor[triangle] * cell;
  return std::clamp(this->Limit[triangle], Smallest * side, side);
}

double Sizing::side(const Vec3& p, double cell) const
{
  return this->sideIn(this->Tree.nearest(p).Triangle, cell);
}

Result<Sizing> Sizing::measured(TriangleSurface s, const ReferenceSurface& reference, int quads,
  QuadSizing kind, const Sizing::Field& field, Monitor& monitor)
{
  // Bending shows on triangles of a fifth of a quad.
  const double cell = std::sqrt(s.area() / quads);
  SubMonitor quiet(monitor, 0.0, 0.0);
  if (Status status = remesh(
        s, reference, [&](const Vec3&) { return 0.2 * cell; }, 3, quiet);
      !status)
  {
    return status;
  }
  Sizing sizing(s, cell, kind, field, monitor);
  return monitor.cancelled() ? Result<Sizing>(Status::cancelled()) : std::move(sizing);
}

double Sizing::cellFor(double quads) const
{
  double total = 0.0;
  for (double a : this->Area)
  {
    total += a;
  }
  double cell = std::sqrt(total / quads);
  for (int round = 0; round < 30; ++round)
  {
    double got = 0.0;
    for (std::size_t f = 0; f < this->Area.size(); ++f)
    {
      const double side = this->sideIn(static_cast<Index>(f), cell);
      got += this->Area[f] / (side * side);
    }
    cell *= std::pow(got / quads, 0.4);
  }
  return cell;
}
} // namespace bsr
