#include "Spline/LayoutEnds.h"

#include <map>

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

/// The quads of a region that are joined with quad f by edges.
std::vector<Index> groupAround(
  const QuadComplex& complex, const std::vector<Index>& region, Index f, std::vector<char>& visited)
{
  std::vector<Index> group{f};
  visited[f] = 1;
  for (std::size_t i = 0; i < group.size(); ++i)
  {
    for (int k = 0; k < 4; ++k)
    {
      const Index t = complex.twin(4 * group[i] + k);
      if (t >= 0 && !visited[t / 4] && region[t / 4] == region[f])
      {
        visited[t / 4] = 1;
        group.push_back(t / 4);
      }
    }
  }
  return group;
}

/// The largest group of each region > 0.
std::map<Index, std::vector<Index>> largestGroups(
  const QuadComplex& complex, const std::vector<Index>& region)
{
  std::map<Index, std::vector<Index>> largest;
  std::vector<char> visited(complex.faces(), 0);
  for (Index f = 0; f < complex.faces(); ++f)
  {
    if (region[f] > 0 && !visited[f])
    {
      auto group = groupAround(complex, region, f, visited);
      auto& best = largest[region[f]];
      if (group.size() > best.size())
      {
        best = std::move(group);
      }
    }
  }
  return largest;
}

/// Euler characteristic 1 and one border loop.
bool isDisc(const QuadMesh& quads, const std::vector<Index>& group)
{
  std::vector<std::array<Index, 4>> own;
  own.reserve(group.size());
  for (const Index f : group)
  {
    own.push_back(quads.Quads[f]);
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

CutLayout cutEnds(const QuadMesh& quads, const std::vector<Index>& region)
{
  CutLayout cut = without(quads, {});
  const auto full = QuadComplex::build(quads.Quads, static_cast<Index>(quads.Points.size()));
  if (region.size() != quads.Quads.size() || !full)
  {
    return cut;
  }
  std::vector<char> removed(region.size(), 0);
  std::string message;
  for (const auto& [id, group] : largestGroups(*full, region))
  {
    std::vector<char> attempt = removed;
    for (const Index f : group)
    {
      attempt[f] = 1;
    }
    CutLayout next = without(quads, attempt);
    const bool sound =
      isDisc(quads, group) && !next.Quads.Quads.empty() &&
      QuadComplex::build(next.Quads.Quads, static_cast<Index>(quads.Points.size())).isOk();
    if (!sound)
    {
      message = "End " + std::to_string(id) +
                " was kept closed: its cap is not a disc of quads bounded by one loop.";
      continue;
    }
    next.Ends = cut.Ends + 1;
    cut = std::move(next);
    removed = std::move(attempt);
  }
  cut.Message = message;
  return cut;
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
