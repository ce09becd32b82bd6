#pragma once

#include "Mesh/Meshes.h"

#include <cmath>
#include <map>
#include <random>
#include <set>

/// Small quad meshes with every kind of vertex, for the tests of Core/Spline.
namespace meshes
{
using bsr::Index;
using bsr::QuadMesh;
using bsr::Vec3;

/// The surface of a set of unit cells of the integer grid, outward oriented.
inline QuadMesh cells(const std::vector<std::array<int, 3>>& filled)
{
  const std::set<std::array<int, 3>> in(filled.begin(), filled.end());
  std::map<std::array<int, 3>, Index> number;
  QuadMesh m;
  const auto vertex = [&](std::array<int, 3> p)
  {
    const auto [it, isNew] = number.emplace(p, static_cast<Index>(m.Points.size()));
    if (isNew)
    {
      m.Points.emplace_back(p[0], p[1], p[2]);
    }
    return it->second;
  };
  for (const auto& c : filled)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int side = 0; side < 2; ++side)
      {
        auto next = c;
        next[axis] += side ? 1 : -1;
        if (in.count(next))
        {
          continue;
        }
        const int a = (axis + 1) % 3;
        const int b = (axis + 2) % 3;
        std::array<Index, 4> q{};
        for (int k = 0; k < 4; ++k)
        {
          auto p = c;
          p[axis] += side;
          p[a] += k == 1 || k == 2;
          p[b] += k == 2 || k == 3;
          q[side ? k : 3 - k] = vertex(p);
        }
        m.Quads.push_back(q);
      }
    }
  }
  return m;
}

inline QuadMesh cube()
{
  return cells({{0, 0, 0}});
}
inline QuadMesh branch()
{
  return cells({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
}
inline QuadMesh cross()
{
  return cells({{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
}

inline QuadMesh torus(int nu, int nv, double major = 3.0, double minor = 1.0)
{
  QuadMesh m;
  for (int j = 0; j < nv; ++j)
  {
    for (int i = 0; i < nu; ++i)
    {
      const double a = 2 * M_PI * i / nu;
      const double b = 2 * M_PI * j / nv;
      const double r = major + minor * std::cos(b);
      m.Points.emplace_back(r * std::cos(a), r * std::sin(a), minor * std::sin(b));
      const Index i1 = (i + 1) % nu;
      const Index j1 = (j + 1) % nv;
      m.Quads.push_back({j * nu + i, j * nu + i1, j1 * nu + i1, j1 * nu + i});
    }
  }
  return m;
}

/// An open tube along x with `around` quads a ring.
inline QuadMesh tube(int around, int along, double radius = 1.0, double length = 4.0)
{
  QuadMesh m;
  for (int j = 0; j <= along; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      const double a = 2 * M_PI * i / around;
      m.Points.emplace_back(length * j / along, radius * std::cos(a), radius * std::sin(a));
    }
  }
  for (int j = 0; j < along; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      const Index i1 = (i + 1) % around;
      m.Quads.push_back(
        {j * around + i, j * around + i1, (j + 1) * around + i1, (j + 1) * around + i});
    }
  }
  return m;
}

/// 2 n quads; two vertices of valence n, the others 3.
inline QuadMesh trapezohedron(int n)
{
  QuadMesh m;
  m.Points = {Vec3(0, 0, 1.2), Vec3(0, 0, -1.2)};
  for (int k = 0; k < 2 * n; ++k)
  {
    const double a = M_PI * k / n;
    m.Points.emplace_back(std::cos(a), std::sin(a), k % 2 ? -0.25 : 0.25);
  }
  for (int k = 0; k < 2 * n; k += 2)
  {
    const Index a = 2 + k;
    const Index b = 2 + (k + 1) % (2 * n);
    const Index c = 2 + (k + 2) % (2 * n);
    const Index z = 2 + (k + 2 * n - 1) % (2 * n);
    m.Quads.push_back({0, a, b, c});
    m.Quads.push_back({1, b, a, z});
  }
  return m;
}

/// One quad becomes four; points are averaged.
inline QuadMesh subdivide(const QuadMesh& in)
{
  QuadMesh m;
  m.Points = in.Points;
  std::map<std::pair<Index, Index>, Index> middle;
  const auto midpoint = [&](Index a, Index b)
  {
    const auto key = std::minmax(a, b);
    const auto [it, isNew] = middle.emplace(key, static_cast<Index>(m.Points.size()));
    if (isNew)
    {
      m.Points.push_back(0.5 * (in.Points[a] + in.Points[b]));
    }
    return it->second;
  };
  for (std::size_t f = 0; f < in.Quads.size(); ++f)
  {
    const auto& q = in.Quads[f];
    std::array<Index, 4> mid{};
    Vec3 c = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
    {
      mid[k] = midpoint(q[k], q[(k + 1) % 4]);
      c += 0.25 * in.Points[q[k]];
    }
    const Index center = static_cast<Index>(m.Points.size());
    m.Points.push_back(c);
    for (int k = 0; k < 4; ++k)
    {
      m.Quads.push_back({q[k], mid[k], center, mid[(k + 3) % 4]});
      if (!in.Region.empty())
      {
        m.Region.push_back(in.Region[f]);
      }
    }
  }
  return m;
}

/// Without the quads listed.
inline QuadMesh without(QuadMesh m, const std::set<int>& removed)
{
  QuadMesh out;
  out.Points = std::move(m.Points);
  for (std::size_t f = 0; f < m.Quads.size(); ++f)
  {
    if (!removed.count(static_cast<int>(f)))
    {
      out.Quads.push_back(m.Quads[f]);
    }
  }
  return out;
}

/// A cube subdivided `levels` times and blown up to a sphere of diameter 2.
inline QuadMesh sphere(int levels)
{
  QuadMesh m = cube();
  for (auto& p : m.Points)
  {
    p -= Vec3(0.5, 0.5, 0.5);
  }
  for (int l = 0; l < levels; ++l)
  {
    m = subdivide(m);
  }
  for (auto& p : m.Points)
  {
    p.normalize();
  }
  return m;
}
} // namespace meshes
