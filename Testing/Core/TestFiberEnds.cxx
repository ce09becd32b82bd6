#include "Mesh/FiberEnds.h"
#include "Mesh/RegionCut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace bsr;

namespace
{
constexpr double Pi = 3.14159265358979323846;

/// The closed surface of a tube along x from -30 to 30: outer radius 12, at both ends a ring-shaped
/// face and a cap that dips inwards by `dip` from radius 8 on. The ends are slanted by `slant`
/// along y.
TriangleMesh capsule(double dip, double slant = 0.0)
{
  std::vector<std::pair<double, double>> profile; // (x, radius)
  for (int end = 0; end < 2; ++end)
  {
    const double s = end == 0 ? -1.0 : 1.0;
    std::vector<std::pair<double, double>> half;
    for (double r = 0.5; r < 8.0; r += 1.0)
    {
      half.emplace_back(s * (30.0 - dip * (1.0 - r * r / 64.0)), r);
    }
    for (double r = 8.0; r < 12.0; r += 1.0)
    {
      half.emplace_back(s * 30.0, r);
    }
    for (double x = 30.0; x > 0.5; x -= 1.0)
    {
      half.emplace_back(s * x, 12.0);
    }
    if (end == 1)
    {
      std::reverse(half.begin(), half.end());
    }
    profile.insert(profile.end(), half.begin(), half.end());
  }
  constexpr int around = 60;
  TriangleMesh mesh;
  mesh.Points.emplace_back(-30.0 + dip, 0.0, 0.0);
  for (const auto& p : profile)
  {
    for (int j = 0; j < around; ++j)
    {
      const double a = 2.0 * Pi * j / around;
      const double y = p.second * std::cos(a);
      mesh.Points.emplace_back(p.first + slant * y * p.first / 30.0, y, p.second * std::sin(a));
    }
  }
  const auto last = static_cast<Index>(mesh.Points.size());
  mesh.Points.emplace_back(30.0 - dip, 0.0, 0.0);
  const auto id = [](std::size_t i, int j)
  { return static_cast<Index>(1 + i * around + static_cast<std::size_t>(j % around)); };
  for (int j = 0; j < around; ++j)
  {
    mesh.Triangles.push_back({0, id(0, j + 1), id(0, j)});
    mesh.Triangles.push_back({last, id(profile.size() - 1, j), id(profile.size() - 1, j + 1)});
    for (std::size_t i = 0; i + 1 < profile.size(); ++i)
    {
      mesh.Triangles.push_back({id(i, j), id(i, j + 1), id(i + 1, j)});
      mesh.Triangles.push_back({id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)});
    }
  }
  return mesh;
}

std::vector<EndMouth> bothMouths()
{
  return {{{-27.0, 0.5, 0.0}, {-1.0, 0.1, 0.0}, 7.5}, {{27.0, 0.0, 0.5}, {1.0, 0.0, 0.1}, 7.5}};
}

/// A raw surface that is outer wall all over.
FiberWall rawWall(const TriangleMesh& mesh)
{
  return {mesh, std::vector<std::uint8_t>(mesh.Points.size(), 0)};
}

/// How far the tube of capsule() ends before x = 30 in each direction: a wide notch.
double notched(const Vec3& p, double deep)
{
  const double a = std::atan2(p.z(), p.y()) / 1.5;
  return deep * std::pow(std::max(0.0, 1.0 - a * a), 2.0);
}

/// The capsule with a notch in the end at x = 30, with bumps all around the body.
TriangleMesh notchedCapsule(double deep, double rough)
{
  TriangleMesh mesh = capsule(4.0);
  for (Vec3& p : mesh.Points)
  {
    p.x() -= notched(p, deep) * std::max(0.0, p.x() - 10.0) / 20.0;
    const double r = std::hypot(p.y(), p.z());
    const double bump =
      r > 11.5 ? rough * std::sin(1.7 * p.x()) * std::sin(9.0 * std::atan2(p.z(), p.y())) : 0.0;
    p.y() *= (r + bump) / std::max(r, 1.0);
    p.z() *= (r + bump) / std::max(r, 1.0);
  }
  return mesh;
}

/// A capsule whose surface rises from the rim at x = 30 to a ridge behind it, `height` high and
/// `width` radians to either side of y.
TriangleMesh webbed(double width, double height)
{
  TriangleMesh mesh = capsule(4.0);
  for (Vec3& p : mesh.Points)
  {
    const double r = std::hypot(p.y(), p.z());
    const double across = std::max(0.0, 1.0 - std::abs(std::atan2(p.z(), p.y())) / width);
    const double along = std::max(0.0, 1.0 - std::abs(p.x() - 23.0) / 7.0);
    if (r > 11.5)
    {
      const double scale = (r + height * along * std::sqrt(across)) / r;
      p.y() *= scale;
      p.z() *= scale;
    }
  }
  return mesh;
}

/// Root mean square and largest distance of a rim from the circle of radius 12 at |x| = 30.
std::pair<double, double> offRim(const FiberEnds& ends, const std::vector<Index>& rim)
{
  double sum = 0.0;
  double most = 0.0;
  for (const Index v : rim)
  {
    const Vec3& p = ends.Surface.Points[v];
    const double off = std::hypot(std::hypot(p.y(), p.z()) - 12.0, std::abs(p.x()) - 30.0);
    sum += off * off;
    most = std::max(most, off);
  }
  return {std::sqrt(sum / static_cast<double>(rim.size())), most};
}

/// The least cosine between the normals of a triangle before and after points have moved.
double leastCosine(const TriangleMesh& before, const TriangleMesh& after)
{
  double least = 1.0;
  for (const auto& t : before.Triangles)
  {
    const auto normal = [&t](const TriangleMesh& m)
    {
      return Vec3((m.Points[t[1]] - m.Points[t[0]]).cross(m.Points[t[2]] - m.Points[t[0]]))
        .normalized();
    };
    least = std::min(least, normal(before).dot(normal(after)));
  }
  return least;
}
} // namespace

TEST(FiberEnds, CutsBothEndsAlongTheOuterRim)
{
  for (const double slant : {0.0, 0.3})
  {
    Monitor monitor;
    const TriangleMesh mesh = capsule(4.0, slant);
    const auto ends = findFiberEnds(mesh, bothMouths(), {}, monitor);
    ASSERT_TRUE(ends);
    EXPECT_EQ(ends->Note, "");
    ASSERT_EQ(ends->Rims.size(), 2u);
    for (Index k = 1; k <= 2; ++k)
    {
      EXPECT_EQ(regionEuler(ends->Surface, k), 1);
      EXPECT_EQ(regionLoops(ends->Surface, k).size(), 1u);
      double sum = 0.0;
      for (const Index v : ends->Rims[k - 1])
      {
        const Vec3& p = ends->Surface.Points[v];
        const double off =
          std::hypot(std::hypot(p.y(), p.z()) - 12.0, std::abs(p.x()) - (30.0 + slant * p.y()));
        EXPECT_LT(off, 3.0);
        sum += off * off;
      }
      EXPECT_LT(std::sqrt(sum / static_cast<double>(ends->Rims[k - 1].size())), 1.2);
    }
    EXPECT_EQ(regionEuler(ends->Surface, 0), 0); // the body is a tube
  }
}

TEST(FiberEnds, TheRimDoesNotDiveIntoASteepCap)
{
  // A notch of 2 in the wall's crest, beside which the cap falls by another 12.
  TriangleMesh mesh = capsule(4.0);
  for (Vec3& p : mesh.Points)
  {
    const double a = std::atan2(p.z(), p.y()) / 0.45;
    const double share = std::pow(std::max(0.0, 1.0 - a * a), 2.0);
    const double top = std::max(0.0, p.x() - 20.0) / 10.0;
    const double r = std::hypot(p.y(), p.z());
    p.x() -= share * top * (2.0 + (r > 3.0 && r < 11.5 ? 12.0 : 0.0));
  }
  Monitor monitor;
  const auto ends = findFiberEnds(mesh, bothMouths(), {}, monitor);
  ASSERT_TRUE(ends);
  ASSERT_EQ(ends->Rims.size(), 2u) << ends->Note;
  for (const auto& rim : ends->Rims)
  {
    EXPECT_LT(offRim(*ends, rim).second, 3.0);
  }
}

TEST(FiberEnds, TheRimPassesAWebOverDebris)
{
  const TriangleMesh mesh = webbed(0.4, 8.0);
  Monitor monitor;
  const auto ends = findFiberEnds(mesh, bothMouths(), {}, monitor);
  ASSERT_TRUE(ends);
  ASSERT_EQ(ends->Rims.size(), 2u) << ends->Note;
  EXPECT_LT(offRim(*ends, ends->Rims[1]).first, 1.0);
  EXPECT_LT(offRim(*ends, ends->Rims[1]).second, 2.0);
}

TEST(FiberEnds, TheWallTellsWideWebs)
{
  const TriangleMesh mesh = webbed(1.0, 12.0);
  Monitor monitor;
  const auto ends = findFiberEnds(mesh, bothMouths(), rawWall(capsule(4.0)), monitor);
  ASSERT_TRUE(ends);
  ASSERT_EQ(ends->Rims.size(), 2u) << ends->Note;
  EXPECT_LT(offRim(*ends, ends->Rims[1]).first, 1.5);
  EXPECT_LT(offRim(*ends, ends->Rims[1]).second, 3.0);
}

TEST(FiberEnds, TheRimFollowsANotchThatTheClosedSurfaceSpans)
{
  // A notch of 4 that the closed surface fills by half, and a rough wall the closed surface lies
  // on.
  const TriangleMesh raw = notchedCapsule(4.0, 0.4);
  TriangleMesh closed = notchedCapsule(2.0, 0.0);
  for (Vec3& p : closed.Points)
  {
    const double r = std::hypot(p.y(), p.z());
    p.y() *= r > 11.5 ? 12.5 / r : 1.0;
    p.z() *= r > 11.5 ? 12.5 / r : 1.0;
  }
  const auto offNotch = [](const FiberEnds& ends)
  {
    double sum = 0.0;
    for (const Index v : ends.Rims[1])
    {
      const Vec3& p = ends.Surface.Points[v];
      sum += std::pow(std::hypot(p.y(), p.z()) - 12.0, 2.0) +
             std::pow(p.x() - 30.0 + notched(p, 4.0), 2.0);
    }
    return std::sqrt(sum / static_cast<double>(ends.Rims[1].size()));
  };
  Monitor monitor;
  const auto alone = findFiberEnds(closed, bothMouths(), {}, monitor);
  const auto ends = findFiberEnds(closed, bothMouths(), rawWall(raw), monitor);
  ASSERT_TRUE(alone && ends);
  ASSERT_EQ(alone->Rims.size(), 2u) << alone->Note;
  ASSERT_EQ(ends->Rims.size(), 2u) << ends->Note;
  EXPECT_GT(offNotch(*alone), 0.8);
  EXPECT_LT(offNotch(*ends), 0.65);
  TriangleMesh inside = raw; // a raw surface turned inside out is the same wall
  for (auto& t : inside.Triangles)
  {
    std::swap(t[1], t[2]);
  }
  const auto turned = findFiberEnds(closed, bothMouths(), rawWall(inside), monitor);
  ASSERT_TRUE(turned);
  EXPECT_NEAR(offNotch(*turned), offNotch(*ends), 0.05);
}

TEST(FiberEnds, AGapInTheWallIsPassedStraight)
{
  TriangleMesh raw = capsule(4.0);
  std::vector<std::array<Index, 3>> kept;
  for (const auto& t : raw.Triangles)
  {
    const Vec3& p = raw.Points[t[0]];
    if (p.x() < 15.0 || std::abs(std::atan2(p.z(), p.y())) > 0.4)
    {
      kept.push_back(t);
    }
  }
  raw.Triangles = kept;
  Monitor monitor;
  const auto ends = findFiberEnds(capsule(4.0), bothMouths(), rawWall(raw), monitor);
  ASSERT_TRUE(ends);
  ASSERT_EQ(ends->Rims.size(), 2u) << ends->Note;
  EXPECT_LT(offRim(*ends, ends->Rims[1]).first, 0.2);
  EXPECT_LT(offRim(*ends, ends->Rims[1]).second, 0.5);
}

TEST(FiberEnds, FindsTheRimOfAWallThickerThanItsLumenIsWide)
{
  auto mouths = bothMouths();
  mouths[0].Radius = mouths[1].Radius = 3.8;
  Monitor monitor;
  const auto ends = findFiberEnds(capsule(4.0), mouths, {}, monitor);
  ASSERT_TRUE(ends);
  ASSERT_EQ(ends->Rims.size(), 2u) << ends->Note;
  for (const auto& rim : ends->Rims)
  {
    EXPECT_LT(offRim(*ends, rim).first, 1.2);
  }
}

TEST(FiberEnds, MovingTheSurfaceToASmoothRimFoldsNothing)
{
  TriangleMesh mesh = capsule(4.0);
  for (Vec3& p : mesh.Points) // a rough end
  {
    const double a = std::atan2(p.z(), p.y());
    p.x() += p.x() > 20.0 ? 1.8 * std::sin(12.0 * a) * (p.x() - 20.0) / 10.0 : 0.0;
  }
  Monitor monitor;
  const auto ends = findFiberEnds(mesh, bothMouths(), {}, monitor);
  ASSERT_TRUE(ends);
  ASSERT_EQ(ends->Rims.size(), 2u) << ends->Note;
  EXPECT_LT(offRim(*ends, ends->Rims[1]).first, 0.75);
  TriangleMesh moved = mesh; // the cut appends points, the others keep their place in the list
  moved.Points.assign(ends->Surface.Points.begin(),
    ends->Surface.Points.begin() + static_cast<std::ptrdiff_t>(mesh.Points.size()));
  EXPECT_GT(leastCosine(mesh, moved), 0.0);
}

TEST(FiberEnds, WorksOnASurfaceTurnedInsideOut)
{
  TriangleMesh mesh = capsule(4.0);
  for (auto& t : mesh.Triangles)
  {
    std::swap(t[1], t[2]);
  }
  Monitor monitor;
  const auto ends = findFiberEnds(mesh, bothMouths(), {}, monitor);
  ASSERT_TRUE(ends);
  EXPECT_EQ(ends->Rims.size(), 2u) << ends->Note;
}

TEST(FiberEnds, NoMouthNoEnd)
{
  Monitor monitor;
  const auto ends = findFiberEnds(capsule(4.0), {}, {}, monitor);
  ASSERT_TRUE(ends);
  EXPECT_TRUE(ends->Rims.empty());
  EXPECT_EQ(ends->Surface.Triangles.size(), capsule(4.0).Triangles.size());
}

TEST(FiberEnds, LeavesOutWhatIsNotThereAndSaysSo)
{
  Monitor monitor;
  const auto ends = findFiberEnds(capsule(4.0),
    {{{200.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 8.0}, {{0, 0, 0}, {0, 0, 0}, 8.0}}, {}, monitor);
  ASSERT_TRUE(ends);
  EXPECT_TRUE(ends->Rims.empty());
  EXPECT_NE(ends->Note.find("Mouth 1"), std::string::npos);
  EXPECT_NE(ends->Note.find("Mouth 2"), std::string::npos);
}

TEST(FiberEnds, TheSameMouthTwiceIsOneEnd)
{
  Monitor monitor;
  auto mouths = bothMouths();
  mouths[1] = mouths[0];
  const auto ends = findFiberEnds(capsule(4.0), mouths, {}, monitor);
  ASSERT_TRUE(ends);
  EXPECT_EQ(ends->Rims.size(), 1u);
}

TEST(FiberEnds, RefusesAnEmptySurface)
{
  Monitor monitor;
  EXPECT_FALSE(findFiberEnds({}, bothMouths(), {}, monitor));
}

TEST(RegionCut, SplitsAlongALevelAndKeepsTheTopology)
{
  TriangleMesh mesh = capsule(0.0);
  mesh.Region.assign(mesh.Triangles.size(), 0);
  std::vector<double> value;
  for (const Vec3& p : mesh.Points)
  {
    value.push_back(p.x() - 0.37 * p.y() - 3.21);
  }
  cutAtZero(mesh, value, 0.2);
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    const auto& c = mesh.Triangles[t];
    const double lo = std::min({value[c[0]], value[c[1]], value[c[2]]});
    const double hi = std::max({value[c[0]], value[c[1]], value[c[2]]});
    EXPECT_FALSE(lo < 0.0 && hi > 0.0);
    mesh.Region[t] = hi > 0.0 ? 1 : 0;
  }
  EXPECT_EQ(regionLoops(mesh, 1).size(), 1u);
  EXPECT_EQ(regionEuler(mesh, 1), 1);
  EXPECT_EQ(regionEuler(mesh, 0), 1);
}
