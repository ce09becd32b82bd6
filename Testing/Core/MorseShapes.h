#ifndef MorseShapes_h
#define MorseShapes_h

#include "Common/CounterRandom.h"
#include "Mesh/BuildSurface.h"
#include "ScanMeshes.h"

#include <cmath>
#include <functional>
#include <map>

/// Surfaces of known shape for tests of functions on them.
namespace bsrtest
{
struct AnalyticSurface
{
  bsr::TriangleMesh Mesh;
  int Euler = 2;

  bsr::TriangleSurface surface() const
  {
    bsr::RepairReport report;
    bsr::Monitor monitor;
    return bsr::buildSurfaces(this->Mesh, {}, report, monitor)->front();
  }
};

/// The torus of radii 3 and 1, n points around the axis and m around the tube.
inline AnalyticSurface torus(int n, int m)
{
  return {torusMesh(n, m), 0};
}

/// An open tube of radius 1 and length 4 along z, n points along and m around.
inline AnalyticSurface tube(int n, int m)
{
  return {tubeMesh(m, n), 0};
}

/// An octahedron, each triangle split in four `levels` times, on an ellipsoid.
inline AnalyticSurface ellipsoid(const bsr::Vec3& axes, int levels)
{
  using bsr::Index;
  AnalyticSurface s;
  auto& p = s.Mesh.Points;
  p = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.Mesh.Triangles = {
    {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level)
  {
    std::map<std::pair<Index, Index>, Index> middle;
    std::vector<std::array<Index, 3>> fine;
    for (const auto& t : s.Mesh.Triangles)
    {
      std::array<Index, 3> m{};
      for (int k = 0; k < 3; ++k)
      {
        const std::pair<Index, Index> e = std::minmax(t[k], t[(k + 1) % 3]);
        auto at = middle.emplace(e, static_cast<Index>(p.size()));
        if (at.second)
        {
          p.push_back((p[e.first] + p[e.second]).normalized());
        }
        m[k] = at.first->second;
      }
      fine.push_back({t[0], m[0], m[2]});
      fine.push_back({m[0], t[1], m[1]});
      fine.push_back({m[2], m[1], t[2]});
      fine.push_back({m[0], m[1], m[2]});
    }
    s.Mesh.Triangles = std::move(fine);
  }
  for (auto& q : p)
  {
    q = q.cwiseProduct(axes);
  }
  return s;
}

/// The zero set of a function that is negative inside, by tetrahedra of a grid of n cells a unit.
inline AnalyticSurface zeroSet(const std::function<double(const bsr::Vec3&)>& f,
  const bsr::Vec3& low, const bsr::Vec3& high, int n, int euler)
{
  using bsr::Index;
  using bsr::Vec3;
  AnalyticSurface s;
  s.Euler = euler;
  const Eigen::Vector3i size = ((high - low) * n).array().ceil().cast<int>();
  const auto at = [&](int i, int j, int k) -> Vec3 { return low + Vec3(i, j, k) / n; };
  const auto id = [&](int i, int j, int k)
  { return (static_cast<std::int64_t>(k) * (size[1] + 1) + j) * (size[0] + 1) + i; };
  std::map<std::pair<std::int64_t, std::int64_t>, Index> cut;
  struct Corner
  {
    std::int64_t Id;
    Vec3 P;
    double Value;
  };
  const auto point = [&](const Corner& a, const Corner& b)
  {
    const auto made =
      cut.emplace(std::minmax(a.Id, b.Id), static_cast<Index>(s.Mesh.Points.size()));
    if (made.second)
    {
      const Corner& lo = a.Id < b.Id ? a : b;
      const Corner& hi = a.Id < b.Id ? b : a;
      const double t = std::min(0.99, std::max(0.01, lo.Value / (lo.Value - hi.Value)));
      s.Mesh.Points.push_back(lo.P + t * (hi.P - lo.P));
    }
    return made.first->second;
  };
  const auto triangle = [&](Index a, Index b, Index c, const Vec3& outward)
  {
    const Vec3 normal =
      (s.Mesh.Points[b] - s.Mesh.Points[a]).cross(s.Mesh.Points[c] - s.Mesh.Points[a]);
    s.Mesh.Triangles.push_back(
      normal.dot(outward) > 0 ? std::array<Index, 3>{a, b, c} : std::array<Index, 3>{a, c, b});
  };
  const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      for (int i = 0; i < size[0]; ++i)
      {
        for (const auto& way : order)
        {
          std::vector<Corner> in;
          std::vector<Corner> out;
          std::array<int, 3> at3 = {i, j, k};
          for (int step = 0; step < 4; ++step)
          {
            const Vec3 p = at(at3[0], at3[1], at3[2]);
            const Corner c{id(at3[0], at3[1], at3[2]), p, f(p)};
            (c.Value < 0.0 ? in : out).push_back(c);
            if (step < 3)
            {
              ++at3[way[step]];
            }
          }
          if (in.empty() || out.empty())
          {
            continue;
          }
          Vec3 outward = Vec3::Zero();
          for (const Corner& a : in)
          {
            for (const Corner& b : out)
            {
              outward += b.P - a.P;
            }
          }
          if (in.size() == 2)
          {
            const Index a = point(in[0], out[0]);
            const Index b = point(in[0], out[1]);
            const Index c = point(in[1], out[1]);
            const Index d = point(in[1], out[0]);
            triangle(a, b, c, outward);
            triangle(a, c, d, outward);
          }
          else
          {
            const Corner& alone = in.size() == 1 ? in[0] : out[0];
            const auto& others = in.size() == 1 ? out : in;
            triangle(
              point(alone, others[0]), point(alone, others[1]), point(alone, others[2]), outward);
          }
        }
      }
    }
  }
  return s;
}

/// Genus 2: a tube around a lemniscate in the x, y plane; n cells a unit.
inline AnalyticSurface doubleTorus(int n)
{
  const auto f = [](const bsr::Vec3& p)
  {
    const double x2 = p.x() * p.x();
    const double y2 = p.y() * p.y();
    const double curve = x2 * (1.0 - x2) - y2;
    return curve * curve + 0.5 * p.z() * p.z() - 0.02;
  };
  return zeroSet(f, {-1.3, -0.8, -0.5}, {1.3, 0.8, 0.5}, n, -2);
}

inline void addNoise(std::vector<double>& values, double amplitude)
{
  bsr::CounterRandom random(7, 0);
  for (double& v : values)
  {
    v += random.uniform(-amplitude, amplitude);
  }
}
} // namespace bsrtest

#endif
