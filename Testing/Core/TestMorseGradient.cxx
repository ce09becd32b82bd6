#include "Layout/MorseCells.h"
#include "MorseShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

namespace
{
using namespace bsr;
using bsrtest::AnalyticSurface;

using Function = std::function<double(const Vec3&)>;

std::vector<double> sampled(const TriangleSurface& s, const Function& f)
{
  std::vector<double> values;
  for (const Vec3& p : s.Points)
  {
    values.push_back(f(p));
  }
  return values;
}

/// Every edge serves one kind of path at most, every path ends, and the Morse relation holds.
void expectGradient(const TriangleSurface& s, const MorseGradient& g, int euler)
{
  std::vector<int> uses(s.Vertex.size(), 0);
  const auto use = [&](Index h) { ++uses[std::min(h, s.Opposite[h])]; };
  for (Index v = 0; v < s.vertices(); ++v)
  {
    if (g.Down[v] >= 0)
    {
      EXPECT_EQ(s.start(g.Down[v]), v);
      use(g.Down[v]);
    }
  }
  for (Index t = 0; t < s.faces(); ++t)
  {
    if (g.Up[t] >= 0)
    {
      EXPECT_EQ(g.Up[t] / 3, t);
      EXPECT_FALSE(s.hole(s.Opposite[g.Up[t]] / 3));
      use(g.Up[t]);
    }
  }
  for (Index h : g.Saddles)
  {
    use(h);
  }
  EXPECT_LE(*std::max_element(uses.begin(), uses.end()), 1);
  // Twice V - E + F, so that what lies on boundaries counts half.
  int sum = 0;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    const BoundaryNode b = g.Boundary[v];
    sum += b == BoundaryNode::Minimum || b == BoundaryNode::Maximum;
    sum -= b == BoundaryNode::LowerSaddle || b == BoundaryNode::UpperSaddle;
    sum += 2 * (g.Down[v] < 0 && b == BoundaryNode::None && !s.Virtual[v]);
  }
  for (Index t = 0; t < s.faces(); ++t)
  {
    sum += 2 * (g.Up[t] < 0 && !s.hole(t) && g.Boundary[g.top(s, t)] != BoundaryNode::Maximum);
  }
  sum -= 2 * static_cast<int>(g.Saddles.size());
  EXPECT_EQ(sum, 2 * euler);
}

/// Each cell is a disc, and what lies between cells are paths that never cross.
void expectCells(const MorseCells& cells, int euler)
{
  ASSERT_EQ(cells.Problem, "");
  const auto& surface = cells.Surface;
  std::set<std::pair<Index, Index>> edges;
  std::vector<std::set<Index>> pointsOf(cells.Cells);
  std::vector<std::set<std::pair<Index, Index>>> edgesOf(cells.Cells);
  std::vector<int> facesOf(cells.Cells, 0);
  std::set<Index> points;
  for (std::size_t t = 0; t < surface.Mesh.Triangles.size(); ++t)
  {
    const Index cell = surface.Cell[t];
    ASSERT_TRUE(cell >= 0 && cell < cells.Cells);
    ++facesOf[cell];
    const auto& c = surface.Mesh.Triangles[t];
    for (int k = 0; k < 3; ++k)
    {
      const std::pair<Index, Index> e = std::minmax(c[k], c[(k + 1) % 3]);
      edges.insert(e);
      edgesOf[cell].insert(e);
      points.insert(c[k]);
      pointsOf[cell].insert(c[k]);
    }
  }
  // The cut surface is still the surface.
  EXPECT_EQ(static_cast<int>(points.size()) - static_cast<int>(edges.size()) +
              static_cast<int>(surface.Mesh.Triangles.size()),
    euler);
  // A closed disc whose outline may touch itself: the Euler characteristic is 1 - touches.
  for (Index c = 0; c < cells.Cells; ++c)
  {
    EXPECT_LE(
      static_cast<int>(pointsOf[c].size()) - static_cast<int>(edgesOf[c].size()) + facesOf[c], 1);
    EXPECT_GT(facesOf[c], 0);
  }
}

struct Count
{
  Index Minima;
  Index Saddles;
  Index Maxima;
};

/// `noise`: persistence of what the triangles add to the function.
void expectCount(
  const AnalyticSurface& shape, const Function& f, const Count& count, double noise = 0.0)
{
  const TriangleSurface s = shape.surface();
  MorseGradient g = morseGradient(s, sampled(s, f));
  const auto pairs = persistencePairs(s, g);
  cancelPairs(s, pairs,
    std::count_if(
      pairs.begin(), pairs.end(), [&](const PersistencePair& p) { return p.Persistence < noise; }),
    g);
  expectGradient(s, g, shape.Euler);
  EXPECT_EQ(g.minima(s), count.Minima);
  EXPECT_EQ(static_cast<Index>(g.Saddles.size()), count.Saddles);
  EXPECT_EQ(g.maxima(s), count.Maxima);
  const MorseCells cells = morseCells(s, g);
  expectCells(cells, shape.Euler);
  EXPECT_EQ(cells.Cells, std::max<Index>(1, 2 * count.Saddles));
}
} // namespace

TEST(MorseGradient, HeightOnTheTorus)
{
  // A ring that stands upright, tilted a little so that the height is a Morse function.
  expectCount(bsrtest::torus(90, 40),
    [](const Vec3& p) { return p.x() + 0.2 * p.z() + 0.05 * p.y(); }, {1, 2, 1});
}

TEST(MorseGradient, HeightOnTheDoubleTorus)
{
  expectCount(
    bsrtest::doubleTorus(20), [](const Vec3& p) { return p.x() + 0.13 * p.y() + 0.08 * p.z(); },
    {1, 4, 1}, 0.03);
}

TEST(MorseGradient, SphericalHarmonicsOnTheSphere)
{
  // x y z: a maximum or minimum in each octant, a saddle on each half axis.
  // Axes that are no lines of the mesh, as a product is 0 all along its planes.
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).matrix();
  expectCount(
    bsrtest::ellipsoid({1, 1, 1}, 5), [&](const Vec3& p) { return (axes * p).prod(); }, {4, 6, 4});
  // x y: two maxima, two minima; saddles at the poles.
  expectCount(bsrtest::ellipsoid({1, 1, 1}, 4),
    [&](const Vec3& p) { return (axes * p).head<2>().prod(); }, {2, 2, 2});
}

TEST(MorseGradient, DistanceOnTheEllipsoid)
{
  expectCount(
    bsrtest::ellipsoid({3, 2, 1}, 5), [](const Vec3& p) { return p.squaredNorm(); }, {2, 2, 2});
}

TEST(MorseGradient, MonkeySaddleBecomesTwoSaddles)
{
  // Re (x + i y)^3 over the upper half, its mirror image below: a monkey saddle at either pole.
  expectCount(bsrtest::ellipsoid({1, 1, 1}, 4),
    [](const Vec3& p) { return p.x() * p.x() * p.x() - 3.0 * p.x() * p.y() * p.y(); }, {3, 4, 3});
}

TEST(MorseGradient, EqualValuesAreToldApart)
{
  for (const AnalyticSurface& shape :
    {bsrtest::torus(30, 20), bsrtest::ellipsoid({1, 1, 1}, 3), bsrtest::tube(20, 30)})
  {
    const TriangleSurface s = shape.surface();
    for (double steps : {0.0, 1.0, 4.0})
    {
      const MorseGradient g =
        morseGradient(s, sampled(s, [&](const Vec3& p) { return std::round(steps * p.x()); }));
      expectGradient(s, g, shape.Euler);
      expectCells(morseCells(s, g), shape.Euler);
    }
  }
}

TEST(MorseGradient, NoiseIsCancelledByPersistence)
{
  for (const AnalyticSurface& shape : {bsrtest::torus(90, 40), bsrtest::doubleTorus(14)})
  {
    const TriangleSurface s = shape.surface();
    std::vector<double> values =
      sampled(s, [](const Vec3& p) { return p.x() + 0.13 * p.y() + 0.08 * p.z(); });
    bsrtest::addNoise(values, 0.05);
    MorseGradient g = morseGradient(s, values);
    EXPECT_GT(g.minima(s), 5);
    const auto pairs = persistencePairs(s, g);
    EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end(),
      [](const auto& a, const auto& b) { return a.Persistence < b.Persistence; }));
    // All pairs: what the topology needs is left.
    MorseGradient bare = g;
    cancelPairs(s, pairs, pairs.size(), bare);
    expectGradient(s, bare, shape.Euler);
    EXPECT_EQ(bare.minima(s), 1);
    EXPECT_EQ(bare.maxima(s), 1);
    EXPECT_EQ(static_cast<int>(bare.Saddles.size()), 2 - shape.Euler);
    // Any number of pairs: still a gradient, every cell a quadrilateral.
    for (std::size_t n = 0; n <= pairs.size(); n += 1 + pairs.size() / 7)
    {
      MorseGradient some = g;
      cancelPairs(s, pairs, n, some);
      expectGradient(s, some, shape.Euler);
      const MorseCells cells = morseCells(s, some);
      expectCells(cells, shape.Euler);
      EXPECT_EQ(cells.Cells, 2 * static_cast<Index>(some.Saddles.size()));
    }
  }
}

TEST(MorseGradient, BoundariesAreLinesOfTheFlow)
{
  const AnalyticSurface shape = bsrtest::tube(40, 60);
  const TriangleSurface s = shape.surface();
  for (unsigned seed = 0; seed < 6; ++seed)
  {
    std::vector<double> values = sampled(s,
      [&](const Vec3& p)
      {
        const double a = std::atan2(p.y(), p.x());
        return std::cos(2.0 * a + seed) * std::cos(M_PI * p.z() / 2.0) + 0.1 * std::sin(a + seed);
      });
    bsrtest::addNoise(values, 0.02);
    smoothBoundaries(s, 0.1, values);
    MorseGradient g = morseGradient(s, values);
    expectGradient(s, g, shape.Euler);
    const auto pairs = persistencePairs(s, g);
    std::size_t n = 0;
    while (n < pairs.size() && pairs[n].Persistence < 0.1)
    {
      ++n;
    }
    cancelPairs(s, pairs, n, g);
    expectGradient(s, g, shape.Euler);
    const MorseCells cells = morseCells(s, g);
    expectCells(cells, shape.Euler);
    for (Index v = 0; v < s.vertices(); ++v)
    {
      if (g.Boundary[v] == BoundaryNode::None && s.creaseDegree(v) == 2)
      {
        EXPECT_EQ(s.Crease[g.Down[v]], 1) << "vertex " << v; // down along the boundary
      }
    }
  }
}
