#include "Layout/Sizing.h"

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

/// Largest principal curvature of each triangle, averaged.
std::vector<double> bending(const TriangleSurface& s, const std::vector<std::uint8_t>& inside)
{
  const std::vector<Vec3> form = faceCurvature(s, inside);
  std::vector<double> value(form.size(), 0.0);
  for (std::size_t f = 0; f < form.size(); ++f)
  {
    const Vec3& q = form[f];
    value[f] = 0.5 * std::abs(q[0] + q[2]) + std::hypot(0.5 * (q[0] - q[2]), q[1]);
  }
  for (int round = 0; round < Averaging; ++round)
  {
    std::vector<double> next = value;
    for (Index f = 0; f < s.faces(); ++f)
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
    value.swap(next);
  }
  return value;
}
} // namespace

Sizing::Sizing(const TriangleSurface& s, double cell)
{
  std::vector<std::uint8_t> inside(s.Region.size());
  for (Index f = 0; f < s.faces(); ++f)
  {
    inside[f] = !s.hole(f);
  }
  const std::vector<double> bent = bending(s, inside);
  std::vector<double> limit(bent.size());
  for (std::size_t f = 0; f < bent.size(); ++f)
  {
    limit[f] = std::min(Bend / std::max(bent[f], 1e-300), 10.0 * cell);
  }
  for (int round = 0; round < 40; ++round)
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
  this->Tree = TriangleTree(s.Points, std::move(triangles));
}

double Sizing::bounded(double limit, double cell)
{
  return std::clamp(limit, Smallest * cell, cell);
}

double Sizing::limit(const Vec3& p) const
{
  return this->Limit[this->Tree.nearest(p).Triangle];
}

double Sizing::side(const Vec3& p, double cell) const
{
  return bounded(this->limit(p), cell);
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
      const double side = bounded(this->Limit[f], cell);
      got += this->Area[f] / (side * side);
    }
    cell *= std::pow(got / quads, 0.4);
  }
  return cell;
}
} // namespace bsr
