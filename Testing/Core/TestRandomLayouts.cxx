// Layouts of seeded random surfaces. Five hundred of them, with a table of quality and time:
//   BSR_RANDOM_SHAPES=1-500 BSRCoreTests --gtest_filter='*RandomLayouts.Range*'
#include "Layout/QuadRemesh.h"
#include "PolygonTopology.h"
#include "RandomSurface.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace
{
using namespace bsr;
using bsrtest::PolygonTopology;

struct Outcome
{
  std::string Problem;
  double Seconds = 0.0; ///< of processor time
  double CountRatio = 0.0;
  double MinJacobian = 0.0;
  double AngleDeviation = 0.0;
  double Irregular = 0.0; ///< share of the vertices
  double Distance = 0.0;  ///< largest, in sides of a mean quad
  int Flipped = 0;
};

/// Every component of the layout is one of the clean surface's, and those that are missing are
/// reported as specks. (Dirt may add specks of its own.)
std::string topologyProblem(const bsrtest::RandomSurface& surface, const QuadLayout& layout)
{
  const PolygonTopology<3> wanted(surface.Clean.Triangles);
  const PolygonTopology<4> got(layout.Mesh.Quads);
  const auto missing = static_cast<std::ptrdiff_t>(wanted.Components.size()) -
                       static_cast<std::ptrdiff_t>(got.Components.size());
  const bool dirty = surface.Kind == bsrtest::Dirt::SpecksFins;
  const bool includes = missing >= 0
                          ? std::includes(wanted.Components.begin(), wanted.Components.end(),
                              got.Components.begin(), got.Components.end())
                          : std::includes(got.Components.begin(), got.Components.end(),
                              wanted.Components.begin(), wanted.Components.end());
  if (!includes || (!dirty && missing != layout.Repairs.Specks) ||
      (dirty && missing > layout.Repairs.Specks))
  {
    return "topology" + bsrtest::text(got.Components) + " for" + bsrtest::text(wanted.Components);
  }
  return {};
}

Outcome outcomeOf(unsigned seed, int grid)
{
  Outcome o;
  const bsrtest::RandomSurface surface = bsrtest::randomSurface(seed, grid);
  QuadRemeshOptions options;
  options.NumberOfQuads = surface.Target;
  Monitor monitor;
  const std::clock_t start = std::clock();
  const auto layout = quadRemesh(surface.Mesh, options, monitor);
  o.Seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  if (!layout)
  {
    o.Problem = layout.status().message();
    return o;
  }
  o.Problem = bsrtest::layoutProblem(layout->Mesh);
  if (o.Problem.empty())
  {
    o.Problem = topologyProblem(surface, *layout);
  }
  const double quads = static_cast<double>(layout->Mesh.Quads.size());
  double area = 0.0;
  for (const auto& q : layout->Mesh.Quads)
  {
    const auto& p = layout->Mesh.Points;
    area += 0.5 * (p[q[2]] - p[q[0]]).cross(p[q[3]] - p[q[1]]).norm();
  }
  o.CountRatio = quads / surface.Target;
  o.Flipped = bsrtest::flippedQuads(layout->Mesh);
  o.MinJacobian = layout->Report.MinJacobian;
  o.AngleDeviation = layout->Report.MeanAngleDeviation;
  o.Irregular = layout->Report.Irregular / static_cast<double>(layout->Mesh.Points.size());
  o.Distance = layout->Distance.Maximum / std::sqrt(area / quads);
  return o;
}

void printPercentiles(const char* name, std::vector<double> values)
{
  if (values.empty())
  {
    return;
  }
  std::sort(values.begin(), values.end());
  const auto at = [&](double share)
  { return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]; };
  std::printf("%-28s %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f\n", name, at(0.0), at(0.05), at(0.5),
    at(0.95), at(0.99), at(1.0));
}

void printTable(const std::vector<Outcome>& outcomes)
{
  const auto column = [&](double Outcome::*member)
  {
    std::vector<double> values;
    values.reserve(outcomes.size());
    for (const Outcome& o : outcomes)
    {
      values.push_back(o.*member);
    }
    return values;
  };
  std::printf("%-28s %8s %8s %8s %8s %8s %8s\n", "", "min", "5 %", "50 %", "95 %", "99 %", "max");
  printPercentiles("seconds (processor)", column(&Outcome::Seconds));
  printPercentiles("quads / quads asked", column(&Outcome::CountRatio));
  printPercentiles("smallest scaled Jacobian", column(&Outcome::MinJacobian));
  printPercentiles("mean angle deviation", column(&Outcome::AngleDeviation));
  printPercentiles("irregular / vertices", column(&Outcome::Irregular));
  printPercentiles("distance / side of a quad", column(&Outcome::Distance));
}

class RandomLayouts : public testing::TestWithParam<unsigned>
{
};
} // namespace

TEST_P(RandomLayouts, AreValid)
{
  constexpr unsigned each = 4;
  for (unsigned seed = each * GetParam() + 1; seed <= each * (GetParam() + 1); ++seed)
  {
    const Outcome o = outcomeOf(seed, 24);
    EXPECT_EQ(o.Problem, "") << "seed " << seed << ": " << bsrtest::randomSurface(seed, 24).Text;
    EXPECT_EQ(o.Flipped, 0) << "seed " << seed;
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomLayouts, testing::Range(0U, 15U));

TEST(RandomLayouts, Range)
{
  const char* range = std::getenv("BSR_RANDOM_SHAPES");
  unsigned first = 1;
  unsigned last = 0;
  if (range == nullptr || std::sscanf(range, "%u-%u", &first, &last) != 2)
  {
    GTEST_SKIP() << "set BSR_RANDOM_SHAPES, for instance to 1-500";
  }
  std::vector<Outcome> outcomes;
  int invalid = 0;
  int flipped = 0;
  int offCount = 0;
  int distant = 0;
  for (unsigned seed = first; seed <= last; ++seed)
  {
    const int grid = 24 + 8 * static_cast<int>(seed % 5);
    const Outcome o = outcomeOf(seed, grid);
    const bool count = o.CountRatio >= 0.9 && o.CountRatio <= 1.1;
    const bool far = o.Distance > 10.0;
    if (!o.Problem.empty() || o.Flipped > 0 || !count || far || o.Seconds > 20.0)
    {
      std::printf(
        "seed %3u grid %d (%s): %s flipped %d quads x %.2f sJ %.2f distance %.1f sides %.1f s\n",
        seed, grid, bsrtest::randomSurface(seed, grid).Text.c_str(), o.Problem.c_str(), o.Flipped,
        o.CountRatio, o.MinJacobian, o.Distance, o.Seconds);
      std::fflush(stdout);
    }
    EXPECT_EQ(o.Problem, "") << "seed " << seed << " grid " << grid;
    EXPECT_EQ(o.Flipped, 0) << "seed " << seed << " grid " << grid;
    invalid += !o.Problem.empty();
    flipped += o.Flipped > 0;
    offCount += !count;
    distant += far;
    outcomes.push_back(o);
    if (seed == last || outcomes.size() % 50 == 0)
    {
      std::printf("%zu shapes: %d invalid, %d with flipped quads, %d off the count by over 10 %%, "
                  "%d off the surface by over 10 sides of a quad\n",
        outcomes.size(), invalid, flipped, offCount, distant);
      printTable(outcomes);
      std::fflush(stdout);
    }
  }
}
