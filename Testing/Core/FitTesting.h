#pragma once

#include "SplineMeshes.h"

#include "Spline/Evaluate.h"
#include "Spline/G1Fit.h"

#include <gtest/gtest.h>

#include <functional>

/// Points on known surfaces, put on the quads of small layouts, and fits of them.
namespace fits
{
using namespace bsr;

using Project = std::function<Vec3(const Vec3&)>;

inline Vec3 bilinear(const QuadMesh& m, Index f, double u, double v)
{
  const auto& q = m.Quads[f];
  return (1 - v) * ((1 - u) * m.Points[q[0]] + u * m.Points[q[1]]) +
         v * ((1 - u) * m.Points[q[3]] + u * m.Points[q[2]]);
}

/// n x n points a quad, put on a surface; sides as given.
inline PartitionedPoints sample(
  const QuadMesh& m, int n, const Project& onto, double noise = 0.0, int side = -1)
{
  PartitionedPoints p;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (Index f = 0; f < static_cast<Index>(m.Quads.size()); ++f)
  {
    for (int k = 0; k < n * n; ++k)
    {
      const Vec2 uv((k % n + 0.5) / n, (k / n + 0.5) / n);
      const Vec3 d(normal(random), normal(random), normal(random));
      p.Points.push_back(onto(bilinear(m, f, uv[0], uv[1])) + noise * d);
      p.QuadId.push_back(f);
      p.UV.push_back(uv);
      if (side >= 0)
      {
        p.Side.push_back(static_cast<std::uint8_t>(side));
      }
    }
  }
  return p;
}

inline void append(PartitionedPoints& a, const PartitionedPoints& b)
{
  a.Points.insert(a.Points.end(), b.Points.begin(), b.Points.end());
  a.QuadId.insert(a.QuadId.end(), b.QuadId.begin(), b.QuadId.end());
  a.UV.insert(a.UV.end(), b.UV.begin(), b.UV.end());
  a.Side.insert(a.Side.end(), b.Side.begin(), b.Side.end());
}

inline Vec3 toSphere(const Vec3& p)
{
  return p.normalized();
}

/// Root mean square and largest distance of the model's surface to where `onto` projects it.
inline std::pair<double, double> deviation(
  const SplineModel& model, const Project& onto, Shell side)
{
  double sum = 0.0;
  double worst = 0.0;
  int count = 0;
  for (const SplinePatch& p : model.Patches)
  {
    for (int k = 0; k < 64 && p.Side == side; ++k)
    {
      const Vec3 x = evaluatePatch(model, p, (k % 8 + 0.5) / 8, (k / 8 + 0.5) / 8).Point;
      const double d = (x - onto(x)).norm();
      sum += d * d;
      worst = std::max(worst, d);
      ++count;
    }
  }
  return {std::sqrt(sum / count), worst};
}

inline G1FitResult fitted(const PartitionedPoints& p, const QuadMesh& m, const G1FitOptions& o)
{
  Monitor monitor;
  auto r = fitG1(p, m, o, monitor);
  EXPECT_TRUE(r) << r.status().message();
  return r ? std::move(*r) : G1FitResult();
}
} // namespace fits
