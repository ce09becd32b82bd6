#include "Spline/LayoutEnds.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr int SideSamples = 8; ///< of a border side
constexpr double Reach = 0.25; ///< of the mean side, from a border's vertices to the curve

double sampleAt(int k)
{
  return (k + 0.5) / SideSamples;
}

/// Samples of the sides of a loop: a smooth curve through its vertices.
std::vector<std::array<Vec3, SideSamples>> smoothSides(const std::vector<Vec3>& v)
{
  const std::size_t n = v.size();
  std::vector<std::array<Vec3, SideSamples>> sides(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const Vec3& a = v[i];
    const Vec3& b = v[(i + 1) % n];
    const double length = (b - a).norm();
    const Vec3 ta = length * tangent(v[(i + n - 1) % n], a, b);
    const Vec3 tb = length * tangent(a, b, v[(i + 2) % n]);
    for (int k = 0; k < SideSamples; ++k)
    {
      sides[i][k] = hermite(a, ta, b, tb, sampleAt(k));
    }
  }
  return sides;
}

/// A closed polyline, by the length along it.
class ClosedCurve
{
public:
  explicit ClosedCurve(const std::vector<Vec3>& points) : Points(points), Start{0.0}
  {
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      this->Start.push_back(this->Start.back() + (this->point(i + 1) - points[i]).norm());
    }
  }

  double length() const { return this->Start.back(); }

  /// Place and distance of the nearest point.
  std::pair<double, double> nearest(const Vec3& p) const
  {
    std::pair<double, double> best = {0.0, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < this->Points.size(); ++i)
    {
      const Vec3& a = this->Points[i];
      const Vec3 d = this->point(i + 1) - a;
      const double t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-300), 0.0, 1.0);
      const double distance = (a + t * d - p).norm();
      if (distance < best.second)
      {
        best = {this->Start[i] + t * d.norm(), distance};
      }
    }
    return best;
  }

  /// The point at a place, which may lie beyond the end.
  Vec3 at(double place) const
  {
    place -= std::floor(place / this->length()) * this->length();
    const auto next = std::upper_bound(this->Start.begin() + 1, this->Start.end() - 1, place);
    const auto i = static_cast<std::size_t>(next - this->Start.begin()) - 1;
    const double side = this->Start[i + 1] - this->Start[i];
    const double t = side > 0.0 ? (place - this->Start[i]) / side : 0.0;
    return (1.0 - t) * this->Points[i] + t * this->point(i + 1);
  }

private:
  const Vec3& point(std::size_t i) const { return this->Points[i % this->Points.size()]; }

  const std::vector<Vec3>& Points;
  std::vector<double> Start; ///< of each segment, and the end of the last
};

/// Where the vertices of a loop lie on a curve, going forward (or back: negative way) once around;
/// empty if they do not.
std::vector<double> placesOn(const ClosedCurve& curve, const std::vector<Vec3>& v, double reach)
{
  std::vector<double> place;
  for (const Vec3& p : v)
  {
    const auto [at, distance] = curve.nearest(p);
    if (!(distance <= reach))
    {
      return {};
    }
    place.push_back(at);
  }
  const double length = curve.length();
  const auto forward = [&](std::size_t i)
  {
    const double step = place[(i + 1) % place.size()] - place[i];
    return step < 0.0 ? step + length : step;
  };
  double around = 0.0;
  for (std::size_t i = 0; i < place.size(); ++i)
  {
    around += forward(i);
  }
  // Forward steps add up to one turn; backward ones to one less than there are vertices.
  const bool back = std::lround(around / length) == std::lround(place.size() - 1.0);
  if (!back && std::lround(around / length) != 1)
  {
    return {};
  }
  std::vector<double> steps(1, place[0]);
  for (std::size_t i = 0; i < place.size(); ++i)
  {
    steps.push_back(steps.back() + forward(i) - (back ? length : 0.0));
  }
  return steps;
}

/// Samples of the sides of a loop along the curve that it follows; empty if there is none.
std::vector<std::array<Vec3, SideSamples>> sidesAlong(
  const std::vector<ClosedCurve>& curves, const std::vector<Vec3>& v)
{
  double mean = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i)
  {
    mean += (v[(i + 1) % v.size()] - v[i]).norm() / static_cast<double>(v.size());
  }
  for (const ClosedCurve& curve : curves)
  {
    const std::vector<double> place = placesOn(curve, v, Reach * mean);
    if (place.empty())
    {
      continue;
    }
    std::vector<std::array<Vec3, SideSamples>> sides(v.size());
    for (std::size_t i = 0; i < v.size(); ++i)
    {
      for (int k = 0; k < SideSamples; ++k)
      {
        const double t = sampleAt(k);
        sides[i][k] = curve.at((1.0 - t) * place[i] + t * place[i + 1]);
      }
    }
    return sides;
  }
  return {};
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
  const QuadComplex& complex, const std::vector<Vec3>& vertices, bool axialOnly)
{
  return rimSamples(complex, vertices, {}, axialOnly);
}

std::vector<RimSample> rimSamples(const QuadComplex& complex, const std::vector<Vec3>& vertices,
  const std::vector<std::vector<Vec3>>& rims, bool axialOnly)
{
  std::vector<RimSample> samples;
  std::vector<ClosedCurve> curves;
  curves.reserve(rims.size());
  for (const auto& rim : rims)
  {
    curves.emplace_back(rim);
  }
  for (const auto& loop : complex.borderLoops())
  {
    std::vector<Vec3> at;
    at.reserve(loop.size());
    for (const Index h : loop)
    {
      at.push_back(vertices[complex.from(h)]);
    }
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 0; i < at.size(); ++i)
    {
      area += (at[i] - at[0]).cross(at[(i + 1) % at.size()] - at[0]);
    }
    const Vec3 direction = axialOnly && area.norm() > 0.0 ? Vec3(area.normalized()) : Vec3::Zero();
    std::vector<std::array<Vec3, SideSamples>> sides = sidesAlong(curves, at);
    if (sides.empty())
    {
      sides = smoothSides(at);
    }
    for (std::size_t i = 0; i < at.size(); ++i)
    {
      for (int k = 0; k < SideSamples; ++k)
      {
        samples.push_back({loop[i], sampleAt(k), sides[i][k], direction});
      }
    }
  }
  return samples;
}
} // namespace bsr
