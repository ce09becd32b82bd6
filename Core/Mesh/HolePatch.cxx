#include "Mesh/HolePatch.h"

#include "Common/Parallel.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bsr
{
namespace
{

Vec3 normalOf(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return (b - a).cross(c - a).stableNormalized();
}

double cotangent(const Vec3& apex, const Vec3& a, const Vec3& b)
{
  const double s = (a - apex).cross(b - apex).norm();
  return (a - apex).dot(b - apex) / std::max(s, 1e-300);
}
} // namespace

HolePatch::HolePatch(const std::vector<Vec3>& loop,
  const std::vector<std::array<Index, 3>>& triangles, const std::vector<double>& spacing,
  std::function<bool(Index, Index)> taken)
    : LoopSize(static_cast<Index>(loop.size())), Spacing(spacing), Taken(std::move(taken))
{
  TriangleSurface& s = this->Surface;
  s.Points = loop;
  std::map<std::pair<Index, Index>, Index> at;
  const auto add = [&](Index a, Index b, Index c, Index region)
  {
    const std::array<Index, 3> corner = {a, b, c};
    for (int k = 0; k < 3; ++k)
    {
      at[{corner[k], corner[(k + 1) % 3]}] = static_cast<Index>(s.Vertex.size());
      s.Vertex.push_back(corner[k]);
    }
    s.Region.push_back(region);
  };
  for (const auto& t : triangles)
  {
    add(t[0], t[1], t[2], 0);
  }
  const Index n = this->LoopSize;
  s.Points.emplace_back(Vec3::Zero());
  this->Spacing.push_back(0.0);
  for (Index i = 0; i < n; ++i)
  {
    add((i + 1) % n, i, n, TriangleSurface::HoleRegion);
  }
  s.Virtual.assign(s.Points.size(), 0);
  s.Virtual[n] = 1;
  s.Opposite.resize(s.Vertex.size());
  s.Crease.assign(s.Vertex.size(), 0);
  s.Out.assign(s.Points.size(), -1);
  for (const auto& [edge, h] : at)
  {
    s.Opposite[h] = at[{edge.second, edge.first}];
    s.Out[edge.first] = h;
  }
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    s.Crease[h] = s.hole(h / 3) != s.hole(s.Opposite[h] / 3);
  }
}

double HolePatch::relative(Index h) const
{
  const Index a = this->Surface.start(h);
  const Index b = this->Surface.end(h);
  return (this->Surface.Points[a] - this->Surface.Points[b]).norm() /
         (0.5 * (this->Spacing[a] + this->Spacing[b]));
}

/// The spacing at a new vertex: the loop's, weighted by the inverse square of the distance.
void HolePatch::setSpacing(Index v)
{
  double sum = 0.0;
  double weights = 0.0;
  for (Index i = 0; i < this->LoopSize; ++i)
  {
    const double d = (this->Surface.Points[v] - this->Surface.Points[i]).squaredNorm();
    const double w = 1.0 / std::max(d, 1e-300);
    sum += w * this->Spacing[i];
    weights += w;
  }
  this->Spacing[v] = sum / weights;
}

void HolePatch::split()
{
  TriangleSurface& s = this->Surface;
  const auto count = static_cast<Index>(s.Vertex.size());
  for (Index h = 0; h < count; ++h)
  {
    if (this->real(h) && !s.Crease[h] && h < s.Opposite[h] && this->relative(h) > 4.0 / 3.0)
    {
      const Vec3 middle = 0.5 * (s.Points[s.start(h)] + s.Points[s.end(h)]);
      const Index v = s.split(h, middle);
      this->Spacing.push_back(0.0);
      this->setSpacing(v);
    }
  }
}

void HolePatch::collapse()
{
  TriangleSurface& s = this->Surface;
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    if (this->real(h) && this->inner(s.start(h)) && this->relative(h) < 0.55 && s.canCollapse(h))
    {
      const bool keep = !this->inner(s.end(h));
      const Vec3 x =
        keep ? s.Points[s.end(h)] : Vec3(0.5 * (s.Points[s.start(h)] + s.Points[s.end(h)]));
      if (s.valence(s.start(h)) + s.valence(s.end(h)) <= 13 && this->keepsChords(h))
      {
        s.collapse(h, x);
      }
    }
  }
}

/// Whether two vertices may be joined: points of the loop may be joined outside already.
bool HolePatch::joinable(Index a, Index b) const
{
  return this->inner(a) || this->inner(b) || !this->Taken || !this->Taken(a, b);
}

/// Whether the collapse of h joins no two points of the loop that are joined outside.
bool HolePatch::keepsChords(Index h) const
{
  const TriangleSurface& s = this->Surface;
  bool keeps = true;
  s.around(s.start(h),
    [&](Index x)
    {
      const Index n = s.end(x);
      const bool there = n == s.end(h) || n == s.apex(h) || n == s.apex(s.Opposite[h]);
      keeps = keeps && (there || this->joinable(n, s.end(h)));
    });
  return keeps;
}

/// Towards Delaunay, as long as no edge gets sharper than it was.
void HolePatch::flip()
{
  TriangleSurface& s = this->Surface;
  for (int pass = 0; pass < 8; ++pass)
  {
    bool any = false;
    for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
    {
      if (!this->real(h) || s.Crease[h] || h > s.Opposite[h] || !s.canFlip(h))
      {
        continue;
      }
      if (!this->joinable(s.apex(h), s.apex(s.Opposite[h])))
      {
        continue;
      }
      const Vec3& a = s.Points[s.start(h)];
      const Vec3& b = s.Points[s.end(h)];
      const Vec3& c = s.Points[s.apex(h)];
      const Vec3& d = s.Points[s.apex(s.Opposite[h])];
      const double before = normalOf(a, b, c).dot(normalOf(b, a, d));
      const double after = normalOf(d, c, a).dot(normalOf(c, d, b));
      const bool rounder = cotangent(c, a, b) + cotangent(d, a, b) < -1e-6;
      if ((rounder && after >= std::min(0.5, before)) || (before < 0.0 && after > before + 0.3))
      {
        s.flip(h);
        any = true;
      }
    }
    if (!any)
    {
      break;
    }
  }
}

void HolePatch::relax(bool tangential)
{
  TriangleSurface& s = this->Surface;
  std::vector<Vec3> moved = s.Points;
  for (Index v = this->LoopSize; v < s.vertices(); ++v)
  {
    if (s.Out[v] < 0 || !this->inner(v))
    {
      continue;
    }
    Vec3 sum = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double weight = 0.0;
    s.around(v,
      [&](Index h)
      {
        const double w = s.areaNormal(h / 3).norm() + s.areaNormal(s.Opposite[h] / 3).norm();
        sum += w * s.Points[s.end(h)];
        weight += w;
        normal += s.areaNormal(h / 3);
      });
    if (!(weight > 0.0))
    {
      continue;
    }
    Vec3 step = sum / weight - s.Points[v];
    if (tangential && normal.norm() > 0.0)
    {
      normal.normalize();
      step -= normal * normal.dot(step);
    }
    moved[v] += 0.7 * step;
  }
  s.Points.swap(moved);
}

void HolePatch::refine()
{
  for (int round = 0; round < 10; ++round)
  {
    const auto before = this->Surface.aliveFaces();
    this->split();
    this->flip();
    this->collapse();
    this->flip();
    for (int i = 0; i < 5; ++i)
    {
      this->relax(false);
    }
    if (this->Surface.aliveFaces() == before)
    {
      break;
    }
  }
}

/// Newton steps along the gradient, each at most half a spacing.
void HolePatch::pull(const ImplicitSurface& implicit)
{
  TriangleSurface& s = this->Surface;
  parallelFor(this->LoopSize, s.vertices(), 16,
    [&](std::int64_t first, std::int64_t last)
    {
      for (auto v = static_cast<Index>(first); v < last; ++v)
      {
        if (s.Out[v] < 0 || !this->inner(v))
        {
          continue;
        }
        const auto f = implicit.at(s.Points[v]);
        const double g = f.Gradient.squaredNorm();
        Vec3 step = g > 0.01 ? Vec3(-f.F / g * f.Gradient) : Vec3(Vec3::Zero());
        const double limit = 0.5 * this->Spacing[v];
        step *= std::min(1.0, limit / std::max(step.norm(), 1e-300));
        s.Points[v] += step;
      }
    });
}

/// Edges whose triangles are turned by more than 100 degrees.
std::vector<Index> HolePatch::folds() const
{
  const TriangleSurface& s = this->Surface;
  std::vector<Index> folded;
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    if (this->real(h) && !s.Crease[h] && h < s.Opposite[h] &&
        s.areaNormal(h / 3).stableNormalized().dot(
          s.areaNormal(s.Opposite[h] / 3).stableNormalized()) < -0.17)
    {
      folded.push_back(h);
    }
  }
  return folded;
}

/// Vertices at folds are merged with their nearest neighbor, or put between their neighbors.
void HolePatch::unfold()
{
  TriangleSurface& s = this->Surface;
  for (const Index edge : this->folds())
  {
    for (const Index side : {edge, s.Opposite[edge]})
    {
      if (s.Vertex[side] < 0 || !this->inner(s.start(side)))
      {
        continue;
      }
      const Index v = s.start(side);
      Index nearest = side;
      Vec3 center = Vec3::Zero();
      s.around(v,
        [&](Index h)
        {
          nearest = this->relative(h) < this->relative(nearest) ? h : nearest;
          center += s.Points[s.end(h)] / s.valence(v);
        });
      if (this->relative(nearest) < 0.8 && s.canCollapse(nearest) && this->keepsChords(nearest))
      {
        s.collapse(nearest, Vec3(s.Points[s.end(nearest)]));
        break;
      }
      s.Points[v] = center;
    }
  }
}

bool HolePatch::sound(const ImplicitSurface& implicit) const
{
  const TriangleSurface& s = this->Surface;
  for (Index v = this->LoopSize; v < s.vertices(); ++v)
  {
    if (s.Out[v] < 0 || !this->inner(v))
    {
      continue;
    }
    const auto f = implicit.at(s.Points[v]);
    if (!(std::abs(f.F) <= 0.1 * this->Spacing[v] * f.Gradient.norm()))
    {
      return false;
    }
  }
  return this->folds().empty();
}

bool HolePatch::project(const ImplicitSurface& implicit)
{
  const HolePatch membrane = *this;
  const auto most = 20 * static_cast<std::size_t>(this->Surface.aliveFaces()) + 1000;
  for (int round = 0; round < 60; ++round)
  {
    this->pull(implicit);
    this->relax(true);
    if (round % 3 == 2)
    {
      this->split();
      this->flip();
      this->collapse();
      this->flip();
    }
    if (this->Surface.Region.size() > most)
    {
      break; // it runs away
    }
    if (round > 8 && round % 4 == 0 && this->sound(implicit))
    {
      break;
    }
  }
  for (int i = 0; i < 12; ++i)
  {
    this->pull(implicit);
    if (i % 3 == 2)
    {
      this->collapse();
      this->unfold();
      this->flip();
    }
  }
  for (int i = 0; i < 5; ++i)
  {
    this->pull(implicit);
  }
  if (!this->sound(implicit))
  {
    *this = membrane;
    return false;
  }
  return true;
}

std::vector<Vec3> HolePatch::innerPoints() const
{
  std::vector<Vec3> p;
  for (Index v = this->LoopSize; v < this->Surface.vertices(); ++v)
  {
    if (this->Surface.Out[v] >= 0 && this->inner(v))
    {
      p.push_back(this->Surface.Points[v]);
    }
  }
  return p;
}

std::vector<std::array<Index, 3>> HolePatch::triangles() const
{
  const TriangleSurface& s = this->Surface;
  std::vector<Index> number(s.Points.size(), -1);
  Index next = this->LoopSize;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    number[v] = v < this->LoopSize ? v : (s.Out[v] >= 0 && this->inner(v) ? next++ : -1);
  }
  std::vector<std::array<Index, 3>> out;
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (s.alive(f) && !s.hole(f))
    {
      const auto c = s.corners(f);
      out.push_back({number[c[0]], number[c[1]], number[c[2]]});
    }
  }
  return out;
}
} // namespace bsr
