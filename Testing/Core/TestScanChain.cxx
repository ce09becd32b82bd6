#include "MorseShapes.h"

#include "Layout/GeodesicPartition.h"
#include "Layout/QuadRemesh.h"
#include "Spline/G1Fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace bsr;
using bsrtest::AnalyticSurface;

namespace
{
struct Fitted
{
  std::size_t Patches = 0;
  double Rms = 0.0; ///< of the bounding box's diagonal
};

/// Layout, geodesics and fit of a closed surface, with everything asserted that must hold.
Fitted fitted(const AnalyticSurface& s, int quads, LayoutMethod method)
{
  Monitor monitor;
  QuadRemeshOptions remesh;
  remesh.Method = method;
  remesh.NumberOfQuads = quads;
  const auto layout = quadRemesh(s.Mesh, remesh, monitor);
  EXPECT_TRUE(layout.isOk()) << layout.status().message();
  if (!layout)
  {
    return {};
  }
  EXPECT_EQ(layout->Report.Euler, s.Euler);
  const auto p = partitionGeodesic(s.Mesh.Points, s.Mesh, layout->Mesh, {}, monitor);
  EXPECT_TRUE(p.isOk()) << p.status().message();
  if (!p)
  {
    return {};
  }
  EXPECT_EQ(p->FailedQuads, 0);
  EXPECT_EQ(p->FoldedTriangles, 0);
  EXPECT_EQ(p->Points.EmptyQuads, 0);
  PartitionedPoints points;
  points.Points = s.Mesh.Points;
  points.QuadId = p->Points.QuadId;
  points.UV = p->Points.UV;
  G1FitOptions options;
  options.CorrelatedNoise = false;
  options.Robust = false;
  const auto fit = fitG1(points, layout->Mesh, options, monitor);
  EXPECT_TRUE(fit.isOk()) << fit.status().message();
  if (!fit)
  {
    return {};
  }
  EXPECT_EQ(fit->FoldedPatches, 0);
  EXPECT_LT(fit->MaxNormalJump, 1e-6);
  Vec3 low = s.Mesh.Points.front();
  Vec3 high = low;
  for (const Vec3& x : s.Mesh.Points)
  {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return {layout->Mesh.Quads.size(), fit->Rms / (high - low).norm()};
}

/// Exponent of the side of a patch in the error.
double order(const Fitted& coarse, const Fitted& fine)
{
  return 2.0 * std::log(coarse.Rms / fine.Rms) /
         std::log(static_cast<double>(fine.Patches) / static_cast<double>(coarse.Patches));
}

/// Of the line through some points by least squares.
double slope(const std::vector<Vec2>& points)
{
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : points)
  {
    mean += p / static_cast<double>(points.size());
  }
  double xy = 0.0;
  double xx = 0.0;
  for (const Vec2& p : points)
  {
    xy += (p[0] - mean[0]) * (p[1] - mean[1]);
    xx += (p[0] - mean[0]) * (p[0] - mean[0]);
  }
  return xy / xx;
}
} // namespace

// Cubics leave an error of the fourth order in the side of a patch; irregular vertices and counts
// that are not met to the point cost a part of it.
TEST(ScanChain, ErrorOfASphereFallsAtTheFourthOrder)
{
  const AnalyticSurface s = bsrtest::ellipsoid(Vec3(1, 1, 1), 5);
  const Fitted coarse = fitted(s, 24, LayoutMethod::FieldAligned);
  const Fitted fine = fitted(s, 150, LayoutMethod::FieldAligned);
  EXPECT_GT(order(coarse, fine), 3.3);
  EXPECT_LT(fine.Rms, 3e-6);
}

TEST(ScanChain, ErrorOfATorusFallsAtTheFourthOrder)
{
  const AnalyticSurface s = bsrtest::torus(150, 60);
  const Fitted coarse = fitted(s, 32, LayoutMethod::FieldAligned);
  const Fitted fine = fitted(s, 150, LayoutMethod::FieldAligned);
  EXPECT_GT(order(coarse, fine), 3.3);
  EXPECT_LT(fine.Rms, 5e-6);
}

TEST(ScanChain, ErrorOfAnEllipsoidFallsAtTheFourthOrder)
{
  const AnalyticSurface s = bsrtest::ellipsoid(Vec3(1, 0.7, 0.5), 5);
  // Two layouts differ in more than size, so the line through the errors of four is taken.
  std::vector<Vec2> errors;
  for (const int quads : {24, 60, 150, 300})
  {
    const Fitted f = fitted(s, quads, LayoutMethod::FieldAligned);
    errors.emplace_back(0.5 * std::log(static_cast<double>(f.Patches)), std::log(f.Rms));
  }
  EXPECT_GT(-slope(errors), 3.3);
  EXPECT_LT(errors.back()[1], std::log(5e-7));
}

TEST(ScanChain, MorseSmaleLayoutsGoThroughGeodesicsAndFit)
{
  const Fitted sphere =
    fitted(bsrtest::ellipsoid(Vec3(1, 0.8, 0.6), 5), 60, LayoutMethod::MorseSmale);
  EXPECT_GT(sphere.Patches, 40U);
  EXPECT_LT(sphere.Rms, 2e-4);
  const Fitted torus = fitted(bsrtest::torus(120, 48), 80, LayoutMethod::MorseSmale);
  EXPECT_GT(torus.Patches, 60U);
  EXPECT_LT(torus.Rms, 2e-4);
}
