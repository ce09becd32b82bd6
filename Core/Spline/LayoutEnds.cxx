#include "Spline/LayoutEnds.h"

#include <numeric>

namespace bsr
{
namespace
{
CutLayout without(const QuadMesh& quads, const std::vector<char>& marked)
{
  CutLayout cut;
  cut.Quads.Points = quads.Points;
  cut.NewId.assign(quads.Quads.size(), -1);
  for (std::size_t f = 0; f < quads.Quads.size(); ++f)
  {
    if (marked.empty() || !marked[f])
    {
      cut.NewId[f] = static_cast<Index>(cut.Kept.size());
      cut.Kept.push_back(static_cast<Index>(f));
      cut.Quads.Quads.push_back(quads.Quads[f]);
    }
  }
  return cut;
}

/// Groups of marked quads joined by edges; -1 for the others.
std::pair<std::vector<int>, int> groupsOf(
  const QuadComplex& complex, const std::vector<char>& marked)
{
  std::vector<int> group(complex.faces(), -1);
  int groups = 0;
  for (Index f = 0; f < complex.faces(); ++f)
  {
    if (!marked[f] || group[f] >= 0)
    {
      continue;
    }
    std::vector<Index> stack{f};
    group[f] = groups;
    while (!stack.empty())
    {
      const Index g = stack.back();
      stack.pop_back();
      for (int k = 0; k < 4; ++k)
      {
        const Index t = complex.twin(4 * g + k);
        if (t >= 0 && marked[t / 4] && group[t / 4] < 0)
        {
          group[t / 4] = groups;
          stack.push_back(t / 4);
        }
      }
    }
    ++groups;
  }
  return {group, groups};
}

/// Euler characteristic 1 and one border loop.
bool isDisc(const QuadMesh& quads, const std::vector<int>& group, int g)
{
  std::vector<std::array<Index, 4>> own;
  for (std::size_t f = 0; f < group.size(); ++f)
  {
    if (group[f] == g)
    {
      own.push_back(quads.Quads[f]);
    }
  }
  const auto c = QuadComplex::build(own, static_cast<Index>(quads.Points.size()));
  return c && c->eulerCharacteristic() == 1 && c->borderLoops().size() == 1;
}

/// Tangent at b of the curve a b c, over the sides' lengths (a parabola's derivative).
Vec3 tangent(const Vec3& a, const Vec3& b, const Vec3& c)
{
  const double d0 = std::max((b - a).norm(), 1e-300);
  const double d1 = std::max((c - b).norm(), 1e-300);
  return (d1 / d0 * (b - a) + d0 / d1 * (c - b)) / (d0 + d1);
}

Vec3 hermite(const Vec3& a, const Vec3& ta, const Vec3& b, const Vec3& tb, double t)
{
  const double s = 1.0 - t;
  return s * s * (1 + 2 * t) * a + t * t * (3 - 2 * t) * b + s * s * t * ta - s * t * t * tb;
}
} // namespace

CutLayout cutEnds(const QuadMesh& quads, const std::vector<char>& marked)
{
  const auto full = QuadComplex::build(quads.Quads, static_cast<Index>(quads.Points.size()));
  if (marked.empty() || !full)
  {
    return without(quads, {});
  }
  const auto [group, groups] = groupsOf(*full, marked);
  std::vector<char> removed(marked.size(), 0);
  CutLayout cut = without(quads, {});
  std::string message;
  for (int g = 0; g < groups; ++g)
  {
    std::vector<char> attempt = removed;
    for (std::size_t f = 0; f < group.size(); ++f)
    {
      attempt[f] = attempt[f] || group[f] == g;
    }
    CutLayout next = without(quads, attempt);
    const bool sound =
      isDisc(quads, group, g) && !next.Quads.Quads.empty() &&
      QuadComplex::build(next.Quads.Quads, static_cast<Index>(quads.Points.size())).isOk();
    if (!sound)
    {
      message = "An end was kept closed: its cap is not a disc of quads bounded by one loop.";
      continue;
    }
    next.Ends = cut.Ends + 1;
    cut = std::move(next);
    removed = std::move(attempt);
  }
  cut.Message = message;
  return cut;
}

std::vector<char> markByRegion(const QuadMesh& quads)
{
  std::vector<char> marked(quads.Region.size(), 0);
  for (std::size_t f = 0; f < quads.Region.size(); ++f)
  {
    marked[f] = quads.Region[f] > 0 ? 1 : 0;
  }
  const bool any = std::accumulate(marked.begin(), marked.end(), 0) > 0;
  return any ? marked : std::vector<char>();
}

std::vector<RimSample> rimSamples(
  const QuadComplex& complex, const std::vector<Vec3>& v, bool axialOnly)
{
  std::vector<RimSample> samples;
  for (const auto& loop : complex.borderLoops())
  {
    const std::size_t n = loop.size();
    const auto at = [&](std::size_t i) -> const Vec3& { return v[complex.from(loop[i % n])]; };
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 0; i < n; ++i)
    {
      area += (at(i) - at(0)).cross(at(i + 1) - at(0));
    }
    const Vec3 direction = axialOnly && area.norm() > 0.0 ? Vec3(area.normalized()) : Vec3::Zero();
    for (std::size_t i = 0; i < n; ++i)
    {
      const double length = (at(i + 1) - at(i)).norm();
      const Vec3 ta = length * tangent(at(i + n - 1), at(i), at(i + 1));
      const Vec3 tb = length * tangent(at(i), at(i + 1), at(i + 2));
      for (int s = 0; s < 8; ++s)
      {
        const double t = (s + 0.5) / 8.0;
        samples.push_back({loop[i], t, hermite(at(i), ta, at(i + 1), tb, t), direction});
      }
    }
  }
  return samples;
}
} // namespace bsr
