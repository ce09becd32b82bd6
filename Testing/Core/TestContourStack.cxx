#include "Contour/ContourStack.h"
#include "Contour/SampleContour.h"
#include "ContourStacks.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using bsr::Polyline;
using bsr::Vec3;

constexpr double TwoPi = 6.283185307179586;

Polyline circle(double x, double y, double z, double radius, int n = 40, bool clockwise = false)
{
  Polyline line;
  for (int i = 0; i <= n; ++i)
  {
    const double t = (clockwise ? -1.0 : 1.0) * TwoPi * (i % n) / n;
    line.Points.emplace_back(x + radius * std::cos(t), y + radius * std::sin(t), z);
  }
  return line;
}

/// Two legs up to z = 2, one trunk from z = 3 to 5.
std::vector<Polyline> trousers()
{
  std::vector<Polyline> lines;
  for (int s = 0; s < 3; ++s)
  {
    lines.push_back(circle(-2.0, 0.0, s, 1.5, 30 + s, s == 1));
    lines.push_back(circle(2.0, 0.0, s + (s == 2 ? 1e-4 : 0.0), 1.5, 17));
  }
  for (int s = 3; s < 6; ++s)
  {
    lines.push_back(circle(0.0, 0.0, s, 3.8));
  }
  return lines;
}

bsr::Result<bsr::ContourStack> build(
  const std::vector<Polyline>& lines, const bsr::StackOptions& options = {})
{
  bsr::Monitor monitor;
  return bsr::buildStack(lines, options, monitor);
}

std::string failure(const std::vector<Polyline>& lines)
{
  const auto stack = build(lines);
  EXPECT_FALSE(stack.isOk());
  return stack.status().message();
}
} // namespace

TEST(ContourStack, TrousersHaveTwoLegsAndOneTrunk)
{
  std::vector<Polyline> lines = trousers();
  std::swap(lines[0], lines[7]); // any order
  const auto stack = build(lines);
  ASSERT_TRUE(stack.isOk()) << stack.status().message();
  EXPECT_EQ(stack->Slices.size(), 6u);
  EXPECT_EQ(stack->Components, 1);
  EXPECT_EQ(stack->Branches, 3);
  EXPECT_EQ(stack->Links.size(), 8u);
  for (const bsr::Contour& c : stack->Contours)
  {
    EXPECT_GT(bsr::signedArea(c.Flat), 0.0);
    EXPECT_EQ(c.Below.size(), c.Slice == 0 ? 0u : c.Slice == 3 ? 2u : 1u);
    EXPECT_EQ(c.Above.size(), c.Slice == 5 ? 0u : 1u);
    EXPECT_EQ(c.Points.size() + 1, lines[c.Source].Points.size());
  }
}

TEST(ContourStack, TiltedAndObliquePlanes)
{
  const Eigen::AngleAxisd oblique(0.7, Vec3(1.0, 2.0, 3.0).normalized());
  for (const double tilt : {0.0, 0.12})
  {
    std::vector<Polyline> lines = trousers();
    for (Polyline& l : lines)
    {
      const double z = l.Points[0].z();
      const Eigen::AngleAxisd own(tilt * std::sin(2.0 * std::round(z)), Vec3::UnitY());
      for (Vec3& p : l.Points)
      {
        p = oblique * (own * (p - Vec3(0, 0, z)) + Vec3(0, 0, z));
      }
    }
    const auto stack = build(lines);
    ASSERT_TRUE(stack.isOk()) << stack.status().message();
    EXPECT_EQ(stack->Slices.size(), 6u) << tilt;
    EXPECT_EQ(stack->Branches, 3) << tilt;
  }
}

TEST(ContourStack, HolesAreNestedAndLinkedAmongThemselves)
{
  std::vector<Polyline> lines;
  for (int s = 0; s < 4; ++s)
  {
    lines.push_back(circle(0.0, 0.0, s, 1.0));
    lines.push_back(circle(0.1, 0.0, s, 3.0));
  }
  const auto stack = build(lines);
  ASSERT_TRUE(stack.isOk());
  EXPECT_EQ(stack->Components, 2);
  for (const bsr::Contour& c : stack->Contours)
  {
    EXPECT_EQ(c.hole(), c.Area < 5.0);
    EXPECT_EQ(c.Parent >= 0, c.hole());
  }
}

TEST(ContourStack, OverridesByHand)
{
  bsr::StackOptions options;
  options.ComponentOf = {0, 1, 0, 1, 0, 1, 0, 0, 0};
  auto stack = build(trousers(), options);
  ASSERT_TRUE(stack.isOk());
  EXPECT_EQ(stack->Components, 2);
  options.ComponentOf = {-1, -2, -1, -2, -1, -2, -1, -1, -1};
  stack = build(trousers(), options);
  ASSERT_TRUE(stack.isOk());
  EXPECT_EQ(stack->Branches, 1);
  EXPECT_EQ(stack->Dropped.size(), 3u);
  options = {};
  options.SliceOf = {7, 7, 1, 1, 2, 2, 3, 4, 5};
  EXPECT_EQ(build(trousers(), options)->Slices.size(), 6u);
  options.SliceOf = {1};
  EXPECT_EQ(build(trousers(), options).status().code(), bsr::StatusCode::InvalidParameter);
}

TEST(ContourStack, SpecksAreDroppedAndNamed)
{
  std::vector<Polyline> lines = trousers();
  lines.push_back({{Vec3(9, 9, 1)}, false});
  lines.push_back(circle(8.0, 8.0, 2.0, 0.01));
  const auto stack = build(lines);
  ASSERT_TRUE(stack.isOk());
  ASSERT_EQ(stack->Dropped.size(), 2u);
  EXPECT_EQ(stack->Dropped[0].Source, 9);
}

TEST(ContourStack, BadInputIsNamed)
{
  EXPECT_NE(failure({}).find("no polyline"), std::string::npos);
  EXPECT_NE(failure({{{Vec3::Zero()}, false}}).find("No contour is left"), std::string::npos);
  EXPECT_NE(failure({{}, {}}).find("No contour is left"), std::string::npos);
  EXPECT_NE(failure({circle(0, 0, 0, 1)}).find("two slices"), std::string::npos);
  EXPECT_NE(
    failure({circle(0, 0, 0, 1), circle(3, 0, 0, 1)}).find("two slices"), std::string::npos);
  std::vector<Polyline> lines = trousers();
  lines[8] = circle(0.0, 0.0, 5.0, 3.8, 16);
  std::swap(lines[8].Points[3], lines[8].Points[6]);
  EXPECT_NE(failure(lines).find("Polyline 8 in slice 5 crosses itself"), std::string::npos);
  lines = trousers();
  lines.push_back(circle(2.0, 0.0, 5.0, 3.8));
  EXPECT_NE(failure(lines).find("cross each other"), std::string::npos);
  lines = trousers();
  for (Vec3& p : lines[7].Points)
  {
    p.z() += 0.8 * std::sin(p.x());
  }
  EXPECT_NE(failure(lines).find("Polyline 7 is not planar"), std::string::npos);
  lines = trousers();
  lines[2].Points[3].x() = std::nan("");
  EXPECT_NE(failure(lines).find("not a finite number"), std::string::npos);
}

TEST(ContourStack, AlignedStartUndoesARotation)
{
  std::vector<Vec3> ellipse;
  std::vector<Vec3> turned;
  for (int i = 0; i < 200; ++i)
  {
    const double t = TwoPi * i / 200;
    const double s = t + 1.0;
    ellipse.emplace_back(3.0 * std::cos(t), std::sin(t) + 0.2 * std::cos(2 * t), 0.0);
    turned.emplace_back(3.0 * std::cos(s) + 9.0, std::sin(s) + 0.2 * std::cos(2 * s), 1.0);
  }
  const bsr::ArcCurve a(ellipse, true);
  const bsr::ArcCurve b(turned, true);
  const double start = bsr::alignedStart(a, 0.0, b);
  EXPECT_LT((b.at(start) - Vec3(9, 0, 1) - a.at(0.0)).norm(), 0.02);
}

TEST(ContourStack, TwoHundredRandomStacksAreUnderstood)
{
  using bsrtest::StackKind;
  int plain = 0;
  for (int seed = 0; seed < 200; ++seed)
  {
    const bsrtest::RandomStack random = bsrtest::randomStack(seed);
    const auto stack = build(random.Lines);
    EXPECT_TRUE(stack.isOk()) << random.Name << ": " << stack.status().message();
    if (!stack)
    {
      continue;
    }
    // three legs may enclose a gap where they meet: a hole of its own, or a speck
    const bool gap = random.Kind == StackKind::OneToThree;
    EXPECT_LE(stack->Dropped.size(), gap ? 1u : 0u) << random.Name;
    const bsr::Index loops = static_cast<bsr::Index>(stack->Links.size()) + stack->Components -
                             static_cast<bsr::Index>(stack->Contours.size());
    EXPECT_EQ(loops, random.Kind == StackKind::OneTwoOne ? 1 : 0) << random.Name;
    const bsr::Index components = random.Kind == StackKind::Nested ? 2 : 1;
    EXPECT_GE(stack->Components, components) << random.Name;
    EXPECT_LE(stack->Components, components + (gap ? 1 : 0)) << random.Name;
    plain += random.Kind == StackKind::Tube ? stack->Branches : 0;
  }
  EXPECT_EQ(plain, 23);
}
