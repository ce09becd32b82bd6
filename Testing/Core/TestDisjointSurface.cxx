#include "Contour/SurfaceReport.h"
#include "Crossings.h"
#include "PublishedSurfaces.h"
#include "Spline/ClosestPoint.h"
#include "Spline/Evaluate.h"
#include "Spline/ModelCheck.h"
#include "Spline/SampleModel.h"
#include "Spline/Topology.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace bsr;
using namespace bsrtest;

namespace
{
DisjointModel modelOf(const DisjointSurface& s)
{
  auto m = modelOfDisjoint(s);
  EXPECT_TRUE(m.isOk()) << m.status().message();
  if (!m)
  {
    return {};
  }
  const Status valid = checkModel(m->Model);
  EXPECT_TRUE(valid.isOk()) << valid.message();
  return std::move(*m);
}

double largestJump(const SplineModel& m)
{
  double worst = 0.0;
  for (const SideJumps& j : normalJumps(m))
  {
    worst = std::max(worst, *std::max_element(j.begin(), j.end()));
  }
  return worst;
}
} // namespace

TEST(DisjointSurface, RangesSkipTheColumnsBetweenCurves)
{
  DisjointSurface s;
  s.Counts = {6, 8, 5};
  s.Rows.assign(4, ControlRow(19, Vec3::Zero()));
  const auto r = disjointRanges(s); // section 2.1: u max 1 = x(n1 + 2), u min 2 = u max 1 + k - 1
  ASSERT_EQ(r.size(), 3u);
  EXPECT_EQ(r[0], (std::array<double, 2>{2.0, 6.0}));
  EXPECT_EQ(r[1], (std::array<double, 2>{8.0, 14.0}));
  EXPECT_EQ(r[2], (std::array<double, 2>{16.0, 19.0}));
  s.UniformU = true;
  EXPECT_EQ(disjointRanges(s)[0], (std::array<double, 2>{0.0, 4.0}));
  EXPECT_EQ(disjointRanges(s)[2][1], 17.0);
}

TEST(DisjointSurface, ModelIsTheSameSurface)
{
  for (const bool uniform : {false, true})
  {
    DisjointSurface s = publishedSurface(PublishedModel::SharedEdge);
    s.UniformU = uniform;
    s.UniformV = uniform;
    const DisjointModel m = modelOf(s);
    const auto ranges = disjointRanges(s);
    const auto v = disjointRangeV(s);
    std::size_t next = 0;
    for (std::size_t p = 0; p < m.Model.Patches.size(); ++p)
    {
      const auto d = patchDomain(m.Model, m.Model.Patches[p]);
      const auto& range = ranges[next++ % ranges.size()];
      for (const double t : {0.1, 0.37, 0.8})
      {
        const double u = d[0] + t * (d[1] - d[0]);
        const double w = d[2] + t * (d[3] - d[2]);
        EXPECT_EQ(d[0], range[0]);
        EXPECT_GE(d[2], v[0]);
        EXPECT_LE(d[3], v[1]);
        EXPECT_LT(
          (evaluatePatch(m.Model, m.Model.Patches[p], u, w).Point - evaluateDisjoint(s, u, w))
            .norm(),
          1e-12);
      }
    }
  }
}

/// Section 3: what is wrong with the earlier models.
TEST(DisjointSurface, EarlierModelsIntersectAndTear)
{
  const DisjointModel first = modelOf(publishedSurface(PublishedModel::First));
  EXPECT_EQ(first.Torn, 0);
  EXPECT_GT(crossings(first.Model), 10);
  for (const PublishedModel k : {PublishedModel::SecondWrapped, PublishedModel::SecondRepeated})
  {
    const DisjointModel second = modelOf(publishedSurface(k));
    EXPECT_GE(second.Torn, 4);
    EXPECT_GT(second.TornGap, 0.1);
  }
}

/// Figures 6, 8 and 9: closed, without self-intersection. The tangent planes of 5.2 agree along the
/// parameter lines only: in space the sheets meet in a cusp at the crotch (180 degrees).
TEST(DisjointSurface, PublishedJunctionsAreClosed)
{
  for (const PublishedModel k :
    {PublishedModel::Superimposed, PublishedModel::SharedEdge, PublishedModel::Asymmetric})
  {
    SCOPED_TRACE(static_cast<int>(k));
    const DisjointModel m = modelOf(publishedSurface(k));
    EXPECT_EQ(m.Torn, 0);
    EXPECT_EQ(crossings(m.Model), 0);
    const auto [component, count] = patchComponents(m.Model);
    EXPECT_EQ(count, 1);
    // Section 6 is smooth along the seams, but its patches have no normal at the crotch.
    const std::vector<double> size = patchJacobians(m.Model);
    const bool degenerate = *std::min_element(size.begin(), size.end()) < 0.0;
    if (k == PublishedModel::Asymmetric)
    {
      EXPECT_LT(largestJump(m.Model), 1e-6);
      EXPECT_TRUE(degenerate);
    }
    else
    {
      EXPECT_GT(largestJump(m.Model), 170.0);
    }
  }
}

/// Figure 10 (a): uniform knots along both directions leave the overall shape as it is.
TEST(DisjointSurface, UniformKnotsKeepTheShape)
{
  const DisjointModel periodic = modelOf(publishedSurface(PublishedModel::Asymmetric));
  const DisjointModel uniform = modelOf(uniformSurface(true));
  EXPECT_EQ(uniform.Torn, 0);
  EXPECT_EQ(crossings(uniform.Model), 0);
  EXPECT_EQ(patchComponents(uniform.Model).second, 1);
  EXPECT_LT(largestJump(uniform.Model), 1e-6);
  Monitor monitor;
  const auto samples = sampleModel(periodic.Model, {}, monitor);
  ASSERT_TRUE(samples.isOk());
  const auto deviation = measureDeviation(uniform.Model, samples->Points, {}, monitor);
  ASSERT_TRUE(deviation.isOk());
  EXPECT_LT(deviation->Max, 0.01 * 7.0); // of its size
}

/// Figure 10 (b): along v the contours differ at the ends only, where uniform knots start and end
/// in the first and last section ("at a predetermined position").
TEST(DisjointSurface, UniformKnotsAlongVChangeTheEndsOnly)
{
  const DisjointSurface periodic = publishedSurface(PublishedModel::Asymmetric);
  const DisjointSurface uniform = uniformSurface(false);
  const auto low = disjointRangeV(periodic);
  const auto own = disjointRangeV(uniform);
  EXPECT_EQ(low[1] - low[0], own[1] - own[0]);
  const int order = periodic.OrderV;
  for (const auto& range : disjointRanges(periodic))
  {
    for (const double t : {0.0, 0.21, 0.5, 0.87})
    {
      const double u = range[0] + t * (range[1] - range[0]);
      const auto apart = [&](double v)
      {
        return (
          evaluateDisjoint(periodic, u, low[0] + v) - evaluateDisjoint(uniform, u, own[0] + v))
          .norm();
      };
      for (double v = order - 1.0; v <= own[1] - own[0] - (order - 1.0); v += 0.3)
      {
        EXPECT_LT(apart(v), 1e-12) << v;
      }
      EXPECT_GT(apart(0.0), 0.1);
      EXPECT_NEAR(evaluateDisjoint(uniform, u, own[0]).z(), uniform.Rows.front()[0].z(), 1e-12);
      EXPECT_NEAR(
        evaluateDisjoint(uniform, u, own[1] - 1e-13).z(), uniform.Rows.back()[0].z(), 1e-9);
      EXPECT_GT(evaluateDisjoint(periodic, u, low[0]).z(), uniform.Rows.front()[0].z() + 0.1);
    }
  }
}

/// Figure 11: two stages of branching by one equation, arranged as in 6 (a) and in 5.2 (b): closed,
/// without self-intersection, smooth (a) or with the cusps of 5.2 at both crotches (b).
TEST(DisjointSurface, TwoStagesByOneEquation)
{
  for (const bool point : {true, false})
  {
    SCOPED_TRACE(point);
    const DisjointModel m = modelOf(twoStageSurface(point));
    EXPECT_EQ(m.Model.Patches.size(), 9u);
    EXPECT_EQ(m.Torn, 0);
    EXPECT_EQ(crossings(m.Model), 0);
    EXPECT_EQ(patchComponents(m.Model).second, 1);
    if (point)
    {
      EXPECT_LT(largestJump(m.Model), 1e-6);
    }
    else
    {
      EXPECT_GT(largestJump(m.Model), 170.0);
    }
  }
}

TEST(DisjointSurface, BadInputIsNamed)
{
  DisjointSurface s = publishedSurface(PublishedModel::SharedEdge);
  s.OrderV = 11;
  EXPECT_EQ(modelOfDisjoint(s).status().code(), StatusCode::InvalidParameter);
  s.OrderV = 3;
  s.Counts = {2, 10};
  EXPECT_EQ(modelOfDisjoint(s).status().code(), StatusCode::InvalidInput);
  s.Counts = {6, 5};
  EXPECT_EQ(modelOfDisjoint(s).status().code(), StatusCode::InvalidInput);
  s.Counts = {6, 6};
  s.Rows[1][3].x() = std::nan("");
  EXPECT_EQ(modelOfDisjoint(s).status().code(), StatusCode::InvalidInput);
  s.Rows.resize(2);
  EXPECT_EQ(modelOfDisjoint(s).status().code(), StatusCode::InvalidInput);
  s.Counts.clear();
  EXPECT_EQ(modelOfDisjoint(s).status().code(), StatusCode::InvalidInput);
}
