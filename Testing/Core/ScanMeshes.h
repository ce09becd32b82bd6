#ifndef ScanMeshes_h
#define ScanMeshes_h

#include "Mesh/Meshes.h"

#include <cmath>
#include <map>
#include <random>
#include <set>

/// Triangle meshes of known shape for the tests of the scan pipeline.
namespace bsrtest
{
using bsr::Index;
using bsr::TriangleMesh;
using bsr::Vec3;

/// The unit sphere: an icosahedron, each triangle divided by four `levels` times.
inline TriangleMesh icosphere(int levels)
{
  TriangleMesh m;
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  for (const Vec3& p : {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0),
         Vec3(0, -1, g), Vec3(0, 1, g), Vec3(0, -1, -g), Vec3(0, 1, -g), Vec3(g, 0, -1),
         Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)})
  {
    m.Points.push_back(p.normalized());
  }
  m.Triangles = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
    {11, 10, 2}, {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9},
    {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
  for (int level = 0; level < levels; ++level)
  {
    std::map<std::pair<Index, Index>, Index> middle;
    std::vector<std::array<Index, 3>> fine;
    const auto mid = [&](Index a, Index b)
    {
      const auto [at, fresh] =
        middle.insert({std::minmax(a, b), static_cast<Index>(m.Points.size())});
      if (fresh)
      {
        m.Points.push_back((m.Points[a] + m.Points[b]).normalized());
      }
      return at->second;
    };
    for (const auto& t : m.Triangles)
    {
      const Index a = mid(t[0], t[1]);
      const Index b = mid(t[1], t[2]);
      const Index c = mid(t[2], t[0]);
      fine.insert(fine.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    m.Triangles = fine;
  }
  return m;
}

/// (m + 1) x (n + 1) points of the plane z = 0 at whole coordinates, open.
inline TriangleMesh gridMesh(int m, int n)
{
  TriangleMesh g;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i <= m; ++i)
    {
      g.Points.emplace_back(i, j, 0);
    }
  }
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const Index a = j * (m + 1) + i;
      const Index b = a + m + 1;
      g.Triangles.push_back({a, a + 1, b + 1});
      g.Triangles.push_back({a, b + 1, b});
    }
  }
  return g;
}

/// A torus of radii 3 and 1 around the z axis, m points around the axis and n around the tube.
inline TriangleMesh torusMesh(int m, int n)
{
  TriangleMesh t;
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const double a = 2 * M_PI * (i + 0.5 * (j % 2)) / m;
      const double b = 2 * M_PI * j / n;
      const double r = 3.0 + std::cos(b);
      t.Points.emplace_back(r * std::cos(a), r * std::sin(a), std::sin(b));
      const Index i1 = (i + 1) % m;
      const Index up = (j + 1) % n * m;
      const Index here = j * m;
      if (j % 2 == 0)
      {
        t.Triangles.push_back({here + i, here + i1, up + i});
        t.Triangles.push_back({here + i1, up + i1, up + i});
      }
      else
      {
        t.Triangles.push_back({here + i, here + i1, up + i1});
        t.Triangles.push_back({here + i, up + i1, up + i});
      }
    }
  }
  return t;
}

/// m x n quads on the torus of torusMesh, each point moved by up to `noise` in x, y and z.
inline bsr::QuadMesh torusQuads(int m, int n, double noise = 0.0)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shake(-noise, noise);
  bsr::QuadMesh q;
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const double a = 2 * M_PI * i / m;
      const double b = 2 * M_PI * j / n;
      const double r = 3 + std::cos(b);
      q.Points.push_back(Vec3(r * std::cos(a), r * std::sin(a), std::sin(b)) +
                         Vec3(shake(random), shake(random), shake(random)));
      const Index i1 = (i + 1) % m;
      const Index j1 = (j + 1) % n;
      q.Quads.push_back({j * m + i, j * m + i1, j1 * m + i1, j1 * m + i});
    }
  }
  return q;
}

/// An open tube of radius 1 and height 4 around the z axis; m points around, n along.
inline TriangleMesh tubeMesh(int m, int n)
{
  TriangleMesh t;
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const double a = 2 * M_PI * i / m;
      t.Points.emplace_back(std::cos(a), std::sin(a), 4.0 * j / n - 2.0);
      if (j < n)
      {
        const Index i1 = (i + 1) % m;
        t.Triangles.push_back({j * m + i, j * m + i1, (j + 1) * m + i1});
        t.Triangles.push_back({j * m + i, (j + 1) * m + i1, (j + 1) * m + i});
      }
    }
  }
  return t;
}

/// m x n quads of tubeMesh.
inline bsr::QuadMesh tubeQuads(int m, int n)
{
  bsr::QuadMesh q;
  q.Points = tubeMesh(m, n).Points;
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < m; ++i)
    {
      const Index right = (i + 1) % m;
      q.Quads.push_back({j * m + i, j * m + right, (j + 1) * m + right, (j + 1) * m + i});
    }
  }
  return q;
}

/// The mesh without the triangles whose center is `gone`, and without points that none uses.
template <class Gone>
TriangleMesh without(const TriangleMesh& mesh, const Gone& gone)
{
  TriangleMesh out;
  std::vector<Index> number(mesh.Points.size(), -1);
  for (const auto& t : mesh.Triangles)
  {
    if (gone((mesh.Points[t[0]] + mesh.Points[t[1]] + mesh.Points[t[2]]) / 3.0))
    {
      continue;
    }
    std::array<Index, 3> kept{};
    for (int k = 0; k < 3; ++k)
    {
      if (number[t[k]] < 0)
      {
        number[t[k]] = static_cast<Index>(out.Points.size());
        out.Points.push_back(mesh.Points[t[k]]);
      }
      kept[k] = number[t[k]];
    }
    out.Triangles.push_back(kept);
  }
  return out;
}

/// Vertices - edges + faces.
inline int euler(const TriangleMesh& m)
{
  std::set<std::pair<Index, Index>> edges;
  std::set<Index> used;
  for (const auto& t : m.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
      used.insert(t[k]);
    }
  }
  return static_cast<int>(used.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(m.Triangles.size());
}
} // namespace bsrtest

#endif
