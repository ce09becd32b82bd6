#include "Contour/ContourSkin.h"
#include "ContourStacks.h"
#include "Spline/Evaluate.h"
#include "Spline/ModelCheck.h"
#include "Spline/SampleModel.h"
#include "Spline/SplitPatch.h"
#include "WatchMonitor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using bsr::Polyline;
using bsr::Vec3;

bsr::Result<bsr::ContourSkinResult> skin(
  const std::vector<Polyline>& lines, const bsr::ContourSkinOptions& options = {})
{
  bsr::Monitor monitor;
  return bsr::skinContours(lines, options, monitor);
}

bsr::ContourSkinOptions withControlPoints(int u, int v)
{
  bsr::ContourSkinOptions options;
  options.Fit.CountU = u;
  options.Fit.CountV = v;
  return options;
}

/// Six times the volume between the surface's samples and the origin: positive where a closed
/// surface is oriented outward; for an open one the fan over its border closes it.
double orientedVolume(const bsr::SplineModel& model)
{
  bsr::Monitor monitor;
  bsr::SampleOptions options;
  options.Outward = false;
  const auto s = bsr::sampleModel(model, options, monitor);
  Vec3 top = Vec3::Constant(-1e300);
  for (const Vec3& p : s->Points)
  {
    top = p.z() > top.z() ? p : top;
  }
  double sum = 0.0;
  for (const auto& q : s->Polygons)
  {
    for (int k = 1; k + 1 < (q[3] < 0 ? 3 : 4); ++k)
    {
      sum += (s->Points[q[0]] - top).dot((s->Points[q[k]] - top).cross(s->Points[q[k + 1]] - top));
    }
  }
  return sum;
}

std::vector<bsr::ContourStack> stackOf(const std::vector<Polyline>& lines)
{
  bsr::Monitor monitor;
  return {*bsr::buildStack(lines, {}, monitor)};
}
} // namespace

TEST(ContourSkin, DataSetHasThePapersSize)
{
  const auto stack = stackOf(bsrtest::rectangleBasedObject());
  std::vector<bsr::ContourNote> notes;
  const auto pieces = bsr::cutPieces(stack[0], bsr::SkinBase::Automatic, notes);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(notes.empty());
  EXPECT_FALSE(pieces[0].Closed);
  bsr::SkinGrid grid = bsr::arrangeGrid(stack[0], pieces[0].Legs, 12);
  bsr::alignGrid(stack[0], grid);
  // x = 12, n = 7, m = 7: x + 2 (n - 1) + 2 m rows, 4 n + 2 m columns (eqs. 10 and 11)
  EXPECT_EQ(grid.Rows, 38);
  EXPECT_EQ(grid.Columns, 42);
  int cores = 0;
  int first = 0;
  for (const bsr::SkinRing& r : grid.Rings)
  {
    cores += r.Core && r.Rows == 12 && r.Columns == 2 ? 1 : 0; // 2 x points
    const bool base = stack[0].Contours[r.Contour].Slice == 7;
    first += base ? r.size() : 0;
    for (std::size_t k = 1; k < r.Shares.size(); ++k)
    {
      EXPECT_GE(r.Shares[k], r.Shares[k - 1]);
    }
    EXPECT_LE(r.Shares.back(), r.Shares.front() + 1.0);
  }
  EXPECT_EQ(cores, 2);
  EXPECT_EQ(first, 2 * (12 + 12 + 2) + 2 * (28 + 2) - 4); // eq. 9
  for (std::size_t k = 0; k < grid.Points.size(); ++k)    // every node lies on its slice
  {
    ASSERT_GE(grid.RingOf[k], 0);
    const auto& c = stack[0].Contours[grid.Rings[grid.RingOf[k]].Contour];
    EXPECT_NEAR(grid.Points[k].z(), 0.5 * (c.Slice + 1), 1e-9);
  }
}

TEST(ContourSkin, ObjectsOfThePaper)
{
  for (const bool circles : {false, true})
  {
    const auto lines = circles ? bsrtest::circleBasedObject() : bsrtest::rectangleBasedObject();
    for (const auto parameters : {bsr::SkinParameters::Relaxed, bsr::SkinParameters::Chord})
    {
      bsr::ContourSkinOptions options = withControlPoints(circles ? 19 : 20, 21);
      options.Fit.Parameters = parameters;
      const auto result = skin(lines, options);
      ASSERT_TRUE(result.isOk()) << result.status().message();
      ASSERT_EQ(result->Skins.size(), 1u);
      const bsr::SkinReport& r = result->Skins[0];
      EXPECT_LE(r.AverageError, 2.0);
      EXPECT_LE(r.AverageErrorPerControlPoint, 2.0);
      EXPECT_LT(r.Measures.SecondDerivativeJump, 1e-6);
      EXPECT_GT(r.Measures.EndHeight, 0.0);
      EXPECT_LT(r.Measures.EndHeight, 1.0);
      if (parameters == bsr::SkinParameters::Relaxed)
      {
        EXPECT_EQ(r.FoldedPatches, 0);
        EXPECT_EQ(r.Patches, 1);
        EXPECT_GT(r.Measures.ConvexShare, 0.9);
        EXPECT_LT(r.Rms, 0.01 * result->Stack.meanDiameter());
        EXPECT_GT(orientedVolume(result->Model), 0.0);
      }
    }
  }
}

TEST(ContourSkin, RefinesToTheTolerance)
{
  std::vector<Polyline> lines = bsrtest::circleBasedObject();
  bsr::ContourSkinOptions options;
  int before = 0;
  for (const double tolerance : {0.2, 0.05, 0.02})
  {
    options.Fit.Tolerance = tolerance;
    const auto result = skin(lines, options);
    ASSERT_TRUE(result.isOk());
    const bsr::SkinReport& r = result->Skins[0];
    EXPECT_TRUE(r.Reached) << tolerance;
    EXPECT_LE(r.Rms, tolerance);
    EXPECT_LE(r.AverageError, tolerance);
    EXPECT_GE(r.CountU * r.CountV, before);
    before = r.CountU * r.CountV;
  }
  options.Fit.ControlPointLimit = 100;
  const auto limited = skin(lines, options);
  ASSERT_TRUE(limited.isOk());
  EXPECT_LE(limited->Skins[0].CountU * limited->Skins[0].CountV, 100);
  EXPECT_FALSE(limited->Skins[0].Reached);
  EXPECT_FALSE(limited->Notes.empty());
}

TEST(ContourSkin, HigherDegreeAndCentripetal)
{
  bsr::ContourSkinOptions options = withControlPoints(20, 21);
  options.Fit.Parameters = bsr::SkinParameters::Centripetal;
  options.Fit.Degree = 4;
  const auto result = skin(bsrtest::rectangleBasedObject(), options);
  ASSERT_TRUE(result.isOk());
  EXPECT_EQ(result->Model.Patches[0].DegreeU, 4);
  EXPECT_LE(result->Skins[0].AverageError, 2.0);
}

TEST(ContourSkin, LegsUpwardsAreTheMirrorImage)
{
  std::vector<Polyline> lines = bsrtest::circleBasedObject();
  for (Polyline& l : lines)
  {
    for (Vec3& p : l.Points)
    {
      p.z() = -p.z();
    }
  }
  const auto result = skin(lines, withControlPoints(19, 21));
  ASSERT_TRUE(result.isOk());
  EXPECT_EQ(result->Skins[0].FoldedPatches, 0);
  EXPECT_LE(result->Skins[0].AverageError, 2.0);
}

TEST(ContourSkin, OpenContoursMakeASheet)
{
  std::vector<Polyline> lines;
  for (int s = 0; s < 8; ++s)
  {
    Polyline l;
    for (int i = 0; i <= 30; ++i)
    {
      const double x = 0.2 * (s % 2 ? 30 - i : i); // either direction
      l.Points.emplace_back(x, std::sin(x) + 0.05 * s * s, 0.5 * s);
    }
    lines.push_back(std::move(l));
  }
  const auto result = skin(lines);
  ASSERT_TRUE(result.isOk()) << result.status().message();
  ASSERT_EQ(result->Skins.size(), 1u);
  EXPECT_TRUE(result->Skins[0].Reached);
  EXPECT_EQ(result->Skins[0].FoldedPatches, 0);
  EXPECT_LT(result->Skins[0].Rms, 0.02);
}

TEST(ContourSkin, RandomStacksGiveASurfaceOrAReason)
{
  for (const int seed : {0, 5, 6, 7, 10, 12, 17})
  {
    const bsrtest::RandomStack random = bsrtest::randomStack(seed);
    const auto result = skin(random.Lines);
    ASSERT_TRUE(result.isOk()) << random.Name << ": " << result.status().message();
    EXPECT_TRUE(bsr::checkModel(result->Model).isOk()) << random.Name;
    ASSERT_FALSE(result->Skins.empty());
    for (const bsr::SkinReport& r : result->Skins)
    {
      EXPECT_EQ(r.FoldedPatches, 0) << random.Name;
      EXPECT_TRUE(r.Reached) << random.Name;
      EXPECT_LT(r.Measures.Reslice.There.Value[3], r.PointSpacing) << random.Name;
    }
  }
}

TEST(ContourSkin, BadInputIsNamed)
{
  const auto message = [](const bsr::ContourSkinOptions& options)
  {
    const auto result = skin(bsrtest::circleBasedObject(), options);
    EXPECT_EQ(result.status().code(), bsr::StatusCode::InvalidParameter);
    return result.status().message();
  };
  bsr::ContourSkinOptions options;
  options.Fit.Degree = 1;
  EXPECT_NE(message(options).find("Degree"), std::string::npos);
  options = {};
  options.Fit.Tolerance = std::nan("");
  EXPECT_NE(message(options).find("Tolerance"), std::string::npos);
  options = {};
  options.Fit.ControlPointLimit = 3;
  EXPECT_NE(message(options).find("ControlPointLimit"), std::string::npos);
  EXPECT_NE(message(withControlPoints(20, 3)).find("ControlPoints"), std::string::npos);
  options = {};
  options.CorePoints = 1;
  EXPECT_NE(message(options).find("CorePoints"), std::string::npos);
  // two lonely contours far apart
  const auto lonely =
    skin({bsrtest::ellipseAt(Vec3(0, 0, 0), 1, 1), bsrtest::ellipseAt(Vec3(50, 0, 1), 1, 1)});
  ASSERT_FALSE(lonely.isOk());
  EXPECT_NE(lonely.status().message().find("linked to no contour"), std::string::npos);
  EXPECT_FALSE(skin({}).isOk());
}

TEST(ContourSkin, BlocksAreTheSameSurface)
{
  bsr::TensorShape shape;
  std::vector<double> t;
  for (int i = 0; i <= 40; ++i)
  {
    t.push_back(std::pow(i / 40.0, 1.3));
  }
  shape.KnotsU = bsr::dataKnots(t, 3, 17);
  shape.KnotsV = bsr::dataKnots(t, 3, 11);
  std::vector<Vec3> control;
  for (int k = 0; k < 17 * 11; ++k)
  {
    control.emplace_back(k % 17, k / 17, std::sin(1.7 * k));
  }
  const bsr::SplineModel whole = bsr::splitPatch(shape, control, 0);
  const bsr::SplineModel parts = bsr::splitPatch(shape, control, 4);
  EXPECT_EQ(whole.Patches.size(), 1u);
  EXPECT_EQ(parts.Patches.size(), 8u);
  EXPECT_TRUE(bsr::checkModel(parts).isOk());
  for (const bsr::SplinePatch& p : parts.Patches)
  {
    const auto d = bsr::patchDomain(parts, p);
    for (const double a : {0.1, 0.5, 0.9})
    {
      const double u = d[0] + a * (d[1] - d[0]);
      const double v = d[2] + (1.0 - a * a) * (d[3] - d[2]);
      const Vec3 difference = bsr::evaluatePatch(parts, p, u, v).Point -
                              bsr::evaluatePatch(whole, whole.Patches[0], u, v).Point;
      EXPECT_LT(difference.norm(), 1e-12);
    }
  }
}

TEST(ContourSkin, LegsOnBothSidesMakeAClosedSurface)
{
  const bsrtest::RandomStack random = bsrtest::randomStack(7);
  ASSERT_EQ(random.Kind, bsrtest::StackKind::TwoOneTwo);
  const auto result = skin(random.Lines);
  ASSERT_TRUE(result.isOk()) << result.status().message();
  ASSERT_EQ(result->Skins.size(), 1u);
  const bsr::SkinReport& r = result->Skins[0];
  EXPECT_TRUE(r.Closed);
  EXPECT_FALSE(r.SinglePatch);
  EXPECT_EQ(r.FoldedPatches, 0);
  EXPECT_LT(r.NormalJump, 1e-6);
  EXPECT_TRUE(r.Reached);
  EXPECT_GT(r.Measures.EndHeight, 0.1);
  EXPECT_LT(r.Measures.EndHeight, 1.0);
  EXPECT_GT(r.Measures.ConvexShare, 0.8);
  EXPECT_LT(r.Measures.Reslice.RMS, r.PointSpacing);
  EXPECT_NEAR(r.AverageErrorPerControlPoint,
    r.TotalError / static_cast<double>(result->Model.ControlPoints.size()), 1e-12);
  EXPECT_NEAR(r.AverageError, r.Rms * r.Rms, 1e-12);
  for (const auto& n : result->Model.Neighbors)
  {
    for (const std::int64_t code : n)
    {
      EXPECT_GE(code, 0);
    }
  }
  EXPECT_GT(orientedVolume(result->Model), 0.0);
}

TEST(ContourSkin, TellsProgressAndCanBeCancelledAnywhere)
{
  for (const int seed : {0, 2, 7}) // one patch; given up for a network; a network at once
  {
    const auto lines = bsrtest::randomStack(seed).Lines;
    bsrtest::expectWatchable(
      [&](bsr::Monitor& monitor) { return bsr::skinContours(lines, {}, monitor).status(); });
  }
}

TEST(ContourSkin, HandlesAndCavitiesAreWhole)
{
  const bsrtest::RandomStack random = bsrtest::randomStack(8);
  ASSERT_EQ(random.Kind, bsrtest::StackKind::OneTwoOne);
  std::vector<Polyline> lines = random.Lines;
  const auto handle = skin(lines);
  ASSERT_TRUE(handle.isOk()) << handle.status().message();
  ASSERT_EQ(handle->Skins.size(), 1u);
  EXPECT_EQ(handle->Skins[0].Contours, static_cast<bsr::Index>(lines.size()));
  EXPECT_EQ(handle->Skins[0].FoldedPatches, 0);
  EXPECT_TRUE(handle->Skins[0].Reached);
  EXPECT_LT(handle->Skins[0].NormalJump, 1e-6);
  EXPECT_TRUE(handle->Notes.empty());
}

TEST(ContourSkin, MissedToleranceIsToldPerContour)
{
  bsr::ContourSkinOptions options;
  options.Fit.ControlPointLimit = 60; // below the default: told, not cured
  options.Fit.Tolerance = 0.05;
  const auto result = skin(bsrtest::rectangleBasedObject(), options);
  ASSERT_TRUE(result.isOk());
  EXPECT_FALSE(result->Skins[0].Reached);
  int told = 0;
  for (const bsr::ContourNote& n : result->Notes)
  {
    told += n.Text.find("above the tolerance") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(told, 1);
}
