#ifndef Tunnels_h
#define Tunnels_h

#include "Mesh/Meshes.h"

#include <algorithm>
#include <array>
#include <map>

namespace bsrtest
{
/// A surface of genus 9: a block of 3 x 3 tunnels, of n cells a tunnel and a wall.
inline bsr::TriangleMesh tunnels(int n)
{
  const int size = 7 * n;
  const auto solid = [&](int i, int j, int k)
  {
    return i >= 0 && j >= 0 && k >= 0 && i < size && j < size && k < n &&
           ((i / n) % 2 == 0 || (j / n) % 2 == 0);
  };
  bsr::TriangleMesh mesh;
  std::map<std::array<int, 3>, bsr::Index> number;
  const auto point = [&](const std::array<int, 3>& p)
  {
    const auto added = number.try_emplace(p, static_cast<bsr::Index>(mesh.Points.size()));
    if (added.second)
    {
      mesh.Points.emplace_back(p[0], p[1], p[2]);
    }
    return added.first->second;
  };
  for (int i = 0; i < size; ++i)
  {
    for (int j = 0; j < size; ++j)
    {
      for (int k = 0; k < n; ++k)
      {
        for (int axis = 0; axis < 3 && solid(i, j, k); ++axis)
        {
          for (int side = 0; side < 2; ++side)
          {
            std::array<int, 3> there = {i, j, k};
            there[axis] += 2 * side - 1;
            if (solid(there[0], there[1], there[2]))
            {
              continue;
            }
            std::array<int, 3> a = {i, j, k};
            a[axis] += side;
            std::array<int, 3> b = a;
            std::array<int, 3> c = a;
            ++b[(axis + (side ? 1 : 2)) % 3];
            ++c[(axis + (side ? 2 : 1)) % 3];
            std::array<int, 3> d = b;
            ++d[(axis + (side ? 2 : 1)) % 3];
            mesh.Triangles.push_back({point(a), point(b), point(d)});
            mesh.Triangles.push_back({point(a), point(d), point(c)});
          }
        }
      }
    }
  }
  return mesh;
}

/// The same without two opposite outer walls: two loops, Euler characteristic -18.
inline bsr::TriangleMesh openTunnels(int n)
{
  bsr::TriangleMesh mesh = tunnels(n);
  const auto onWall = [&](const std::array<bsr::Index, 3>& t, double x)
  { return std::all_of(t.begin(), t.end(), [&](bsr::Index v) { return mesh.Points[v][0] == x; }); };
  mesh.Triangles.erase(std::remove_if(mesh.Triangles.begin(), mesh.Triangles.end(),
                         [&](const auto& t) { return onWall(t, 0.0) || onWall(t, 7.0 * n); }),
    mesh.Triangles.end());
  return mesh;
}
} // namespace bsrtest

#endif
