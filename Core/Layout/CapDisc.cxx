#include "Layout/CapDisc.h"

#include <algorithm>
#include <set>

namespace bsr
{
namespace
{
/// A disc of quads: points 0 .. n - 1 are the loop, then the inner ones.
struct Pattern
{
  std::vector<std::array<Index, 4>> Quads;
  Index Points = 0;
};

/// A grid of a x b quads whose border points are given by `border`, from corner (0, 0) on.
void addGrid(Pattern& pattern, const std::vector<Index>& border, int a, int b)
{
  std::vector<std::vector<Index>> id(a + 1, std::vector<Index>(b + 1, -1));
  std::size_t k = 0;
  for (int i = 0; i < a; ++i)
  {
    id[i][0] = border[k++];
  }
  for (int j = 0; j < b; ++j)
  {
    id[a][j] = border[k++];
  }
  for (int i = a; i > 0; --i)
  {
    id[i][b] = border[k++];
  }
  for (int j = b; j > 0; --j)
  {
    id[0][j] = border[k++];
  }
  for (int i = 1; i < a; ++i)
  {
    for (int j = 1; j < b; ++j)
    {
      id[i][j] = pattern.Points++;
    }
  }
  for (int i = 0; i < a; ++i)
  {
    for (int j = 0; j < b; ++j)
    {
      pattern.Quads.push_back({id[i][j], id[i + 1][j], id[i + 1][j + 1], id[i][j + 1]});
    }
  }
}

/// The pattern for n loop points whose grid is a quads wide, turned by `offset` points.
Pattern makePattern(int n, int a, int offset)
{
  Pattern pattern;
  pattern.Points = n;
  std::vector<Index> border(n);
  const bool ring = n >= 8;
  for (int i = 0; i < n; ++i)
  {
    border[i] = ring ? pattern.Points++ : (i + offset) % n;
  }
  for (int i = 0; i < n && ring; ++i)
  {
    const int j = (i + 1) % n;
    pattern.Quads.push_back({(i + offset) % n, (j + offset) % n, border[j], border[i]});
  }
  addGrid(pattern, border, a, n / 2 - a);
  return pattern;
}

/// Places the inner points at the mean of their neighbors.
std::vector<Vec3> placed(const Pattern& pattern, const std::vector<Vec3>& loop)
{
  Vec3 center = Vec3::Zero();
  for (const Vec3& p : loop)
  {
    center += p / static_cast<double>(loop.size());
  }
  std::vector<Vec3> points(pattern.Points, center);
  std::copy(loop.begin(), loop.end(), points.begin());
  for (int round = 0; round < 60; ++round)
  {
    std::vector<Vec3> sum(points.size(), Vec3::Zero());
    std::vector<double> weight(points.size(), 0.0);
    for (const auto& q : pattern.Quads)
    {
      for (int k = 0; k < 4; ++k)
      {
        sum[q[k]] += points[q[(k + 1) % 4]] + points[q[(k + 3) % 4]];
        weight[q[k]] += 2.0;
      }
    }
    for (std::size_t v = loop.size(); v < points.size(); ++v)
    {
      points[v] = sum[v] / weight[v];
    }
  }
  return points;
}

double evenness(const Pattern& pattern, const std::vector<Vec3>& p)
{
  double worst = 1.0;
  double mean = 0.0;
  for (const auto& q : pattern.Quads)
  {
    const double j = scaledJacobian(p[q[0]], p[q[1]], p[q[2]], p[q[3]]);
    worst = std::min(worst, j);
    mean += j / static_cast<double>(pattern.Quads.size());
  }
  return worst + mean;
}
} // namespace

bool capDisc(LayoutDraft& draft, std::vector<Index> loop, Index region)
{
  const int n = static_cast<int>(loop.size());
  if (n < 4 || n % 2 != 0 || std::set<Index>(loop.begin(), loop.end()).size() != loop.size() ||
      *std::min_element(loop.begin(), loop.end()) < 0)
  {
    return false;
  }
  std::vector<Vec3> rim;
  for (Index v : loop)
  {
    // With reserve(), GCC 12 warns of a free that is none.
    // NOLINTNEXTLINE(performance-inefficient-vector-operation)
    rim.push_back(draft.Mesh.Points[v]);
  }
  Pattern best;
  std::vector<Vec3> bestPoints;
  double bestValue = -1e300;
  const int square = n / 4;
  for (int a = std::max(1, square - 1); a <= square; ++a)
  {
    for (int offset = 0; offset < n / 2; ++offset)
    {
      Pattern pattern = makePattern(n, a, offset);
      std::vector<Vec3> points = placed(pattern, rim);
      const double value = evenness(pattern, points);
      if (value > bestValue + 1e-9)
      {
        bestValue = value;
        best = std::move(pattern);
        bestPoints = std::move(points);
      }
    }
  }
  std::vector<Index> number = loop;
  for (std::size_t i = loop.size(); i < bestPoints.size(); ++i)
  {
    number.push_back(static_cast<Index>(draft.Mesh.Points.size()));
    draft.Mesh.Points.push_back(bestPoints[i]);
    draft.Kind.push_back(VertexKind::Free);
  }
  for (const auto& q : best.Quads)
  {
    draft.Mesh.Quads.push_back({number[q[0]], number[q[1]], number[q[2]], number[q[3]]});
    draft.Mesh.Region.push_back(region);
  }
  return true;
}
} // namespace bsr
