#pragma once

#include "Spline/Basis.h"
#include "Spline/SplineModel.h"

#include <cmath>
#include <functional>

/// Small spline models with known shape, for tests.
namespace bsr::samples
{
constexpr double Pi = 3.14159265358979323846;

/// A control point from lattice indices; the same indices must give the same bits.
using LatticePoint = std::function<Vec4(int, int)>;

/// How a family of patches is laid over a lattice of control points.
struct Lattice
{
  int PatchesU = 1;
  int PatchesV = 1;
  int DegreeU = 3;
  int DegreeV = 3;
  int SegmentsU = 1; ///< polynomial pieces a patch, inner knots doubled as in BSplineG1Fit
  int SegmentsV = 1;
  Shell Side = Shell::Outer;
};

inline int latticeStep(int degree, int segments)
{
  return degree + (segments - 1) * std::max(1, degree - 1);
}

inline std::vector<double> latticeKnots(int degree, int segments)
{
  return segmentKnots(degree, segments, std::max(1, degree - 1));
}

/// Adds PatchesU x PatchesV patches; patch (a, b) owns lattice points a * step ... (a + 1) * step.
inline void addLattice(SplineModel& m, const Lattice& l, const LatticePoint& f)
{
  const int su = latticeStep(l.DegreeU, l.SegmentsU);
  const int sv = latticeStep(l.DegreeV, l.SegmentsV);
  const auto ku = static_cast<std::int64_t>(m.Knots.size());
  for (const double k : latticeKnots(l.DegreeU, l.SegmentsU))
  {
    m.Knots.push_back(k);
  }
  const auto kv = static_cast<std::int64_t>(m.Knots.size());
  for (const double k : latticeKnots(l.DegreeV, l.SegmentsV))
  {
    m.Knots.push_back(k);
  }
  for (int b = 0; b < l.PatchesV; ++b)
  {
    for (int a = 0; a < l.PatchesU; ++a)
    {
      const auto first = static_cast<std::int64_t>(m.ControlPoints.size());
      m.Patches.push_back({l.Side, l.DegreeU, l.DegreeV, su + 1, sv + 1, first, ku, kv});
      m.Neighbors.push_back({-1, -1, -1, -1});
      for (int j = 0; j <= sv; ++j)
      {
        for (int i = 0; i <= su; ++i)
        {
          m.ControlPoints.push_back(f(a * su + i, b * sv + j));
        }
      }
    }
  }
}

/// Control points along a side, in its parameter's direction.
inline std::vector<Vec4> sidePoints(const SplineModel& m, std::size_t patch, int side)
{
  const SplinePatch& p = m.Patches[patch];
  const bool alongU = side % 2 == 0;
  std::vector<Vec4> out;
  for (int k = 0; k < (alongU ? p.CountU : p.CountV); ++k)
  {
    const int i = alongU ? k : (side == 1 ? p.CountU - 1 : 0);
    const int j = alongU ? (side == 2 ? p.CountV - 1 : 0) : k;
    out.push_back(
      m.ControlPoints[p.FirstControlPoint + static_cast<std::int64_t>(j) * p.CountU + i]);
  }
  return out;
}

/// Makes neighbors of sides with bit-identical control points (collapsed sides have none).
inline void connect(SplineModel& m)
{
  const std::size_t n = 4 * m.Patches.size();
  std::vector<std::vector<Vec4>> sides;
  for (std::size_t i = 0; i < n; ++i)
  {
    sides.push_back(sidePoints(m, i / 4, static_cast<int>(i % 4)));
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    const bool collapsed = std::all_of(sides[i].begin(), sides[i].end(),
      [&](const Vec4& p) { return p.head<3>() == sides[i][0].head<3>(); });
    for (std::size_t j = i + 1; j < n && !collapsed; ++j)
    {
      const std::vector<Vec4> back(sides[j].rbegin(), sides[j].rend());
      if (m.Neighbors[i / 4][i % 4] < 0 && m.Neighbors[j / 4][j % 4] < 0 &&
          (sides[i] == sides[j] || sides[i] == back))
      {
        m.Neighbors[i / 4][i % 4] = static_cast<std::int64_t>(j);
        m.Neighbors[j / 4][j % 4] = static_cast<std::int64_t>(i);
      }
    }
  }
}

/// The six faces of a cube of `cells` patches a side, control points blown up to a sphere's.
/// `inward` turns the normals to the middle.
inline void addBall(SplineModel& m, double radius, int cells, int segments, bool inward,
  Shell side = Shell::Outer, const Vec3& center = Vec3::Zero())
{
  const int n = cells * latticeStep(3, segments);
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    const bool high = face % 2 != 0;
    Lattice l{cells, cells, 3, 3, segments, segments, side};
    addLattice(m, l,
      [&](int i, int j)
      {
        std::array<int, 3> c{};
        const bool swap = high != inward;
        c[axis] = high ? n : -n;
        c[(axis + 1) % 3] = 2 * (swap ? i : j) - n;
        c[(axis + 2) % 3] = 2 * (swap ? j : i) - n;
        const Vec3 p = Vec3(c[0], c[1], c[2]).normalized() * radius + center;
        return Vec4(p[0], p[1], p[2], 1.0);
      });
  }
}

inline SplineModel ball(double radius = 1.0, int cells = 1, int segments = 1)
{
  SplineModel m;
  addBall(m, radius, cells, segments, false);
  connect(m);
  return m;
}

/// A ball with a concentric void.
inline SplineModel hollowBall(double outer = 1.0, double inner = 0.5)
{
  SplineModel m;
  addBall(m, outer, 2, 1, false);
  addBall(m, inner, 1, 1, true, Shell::Inner);
  connect(m);
  return m;
}

/// Exact torus of 16 rational biquadratic patches.
inline SplineModel torus(double big = 3.0, double small = 1.0)
{
  static const double c[9][3] = {{1, 0, 1}, {1, 1, 0}, {0, 1, 1}, {-1, 1, 0}, {-1, 0, 1},
    {-1, -1, 0}, {0, -1, 1}, {1, -1, 0}, {1, 0, 1}};
  const double half = std::sqrt(0.5);
  SplineModel m;
  addLattice(m, {4, 4, 2, 2, 1, 1, Shell::Outer},
    [&](int i, int j)
    {
      const double r = big + small * c[j][0];
      const double w = (c[i][2] == 1 ? 1 : half) * (c[j][2] == 1 ? 1 : half);
      return Vec4(r * c[i][0], r * c[i][1], small * c[j][1], w);
    });
  connect(m);
  return m;
}

/// Exact sphere of 8 rational biquadratic octants; the sides at the poles are collapsed.
inline SplineModel octantSphere(double radius = 1.0)
{
  static const double c[9][2] = {
    {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  static const double s[5][2] = {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}};
  const double half = std::sqrt(0.5);
  SplineModel m;
  addLattice(m, {4, 2, 2, 2, 1, 1, Shell::Outer},
    [&](int i, int j)
    {
      const double w = (i % 2 ? half : 1.0) * (j % 2 ? half : 1.0);
      return Vec4(radius * s[j][0] * c[i][0], radius * s[j][0] * c[i][1], radius * s[j][1], w);
    });
  connect(m);
  return m;
}

/// A bent tube: outer and inner shell of `around` x `along` bicubic patches, ruled walls at its
/// two ends. All normals point out of the material.
inline SplineModel tube(int around = 6, int along = 4, int segments = 3)
{
  const int nu = around * latticeStep(3, segments);
  const int nv = along * latticeStep(3, segments);
  const auto point = [&](int i, int j, double radius)
  {
    const double a = 2 * Pi * (i % nu) / nu;
    const double t = static_cast<double>(j) / nv;
    const double r = radius * (1.0 + 0.15 * std::cos(2 * a + t));
    const double bend = 0.8 * t * t;
    return Vec4(r * std::cos(a) + bend, 0.7 * r * std::sin(a), 5.0 * t, 1.0);
  };
  SplineModel m;
  addLattice(m, {around, along, 3, 3, segments, segments, Shell::Outer},
    [&](int i, int j) { return point(i, j, 1.0); });
  addLattice(m, {around, along, 3, 3, segments, segments, Shell::Inner},
    [&](int i, int j) { return point(nu - i, j, 0.6); });
  addLattice(m, {around, 1, 3, 1, segments, 1, Shell::Wall},
    [&](int i, int j) { return point(nu - i, 0, j ? 0.6 : 1.0); });
  addLattice(m, {around, 1, 3, 1, segments, 1, Shell::Wall},
    [&](int i, int j) { return point(i, nv, j ? 0.6 : 1.0); });
  connect(m);
  return m;
}
} // namespace bsr::samples
