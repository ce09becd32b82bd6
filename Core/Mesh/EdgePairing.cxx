#include "Mesh/EdgePairing.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Angle of each face around the edge.
std::vector<double> anglesAround(const Vec3& a, const Vec3& b, const std::vector<EdgeFace>& faces)
{
  const Vec3 axis = (b - a).normalized();
  const bool sound = axis.allFinite() && axis.squaredNorm() > 0.5;
  const Vec3 x = sound ? axis.unitOrthogonal() : Vec3::UnitX();
  const Vec3 y = sound ? axis.cross(x) : Vec3::UnitY();
  std::vector<double> angle;
  for (const EdgeFace& f : faces)
  {
    const Vec3 w = f.Apex - a;
    angle.push_back(std::atan2(w.dot(y), w.dot(x)));
  }
  return angle;
}

/// Solids that touch along the edge: around it, faces alternate between entering and leaving one.
bool pairSolids(const std::vector<EdgeFace>& faces, const std::vector<Index>& order,
  std::vector<std::array<Index, 2>>& pairs)
{
  const std::size_t n = order.size();
  for (std::size_t i = 0; i < n; ++i)
  {
    if (faces[order[i]].Forward == faces[order[(i + 1) % n]].Forward)
    {
      return false;
    }
  }
  // The inside lies from a backward face, turning left around the edge, to the next forward one.
  for (std::size_t i = 0; i < n; ++i)
  {
    if (!faces[order[i]].Forward)
    {
      pairs.push_back({faces[order[i]].HalfEdge, faces[order[(i + 1) % n]].HalfEdge});
    }
  }
  return true;
}
} // namespace

std::vector<std::array<Index, 2>> pairAtEdge(
  const Vec3& a, const Vec3& b, std::vector<EdgeFace> faces)
{
  std::sort(faces.begin(), faces.end(),
    [](const EdgeFace& f, const EdgeFace& g) { return f.HalfEdge < g.HalfEdge; });
  const std::vector<double> angle = anglesAround(a, b, faces);
  const std::size_t n = faces.size();
  std::vector<Index> order(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    order[i] = static_cast<Index>(i);
  }
  std::stable_sort(
    order.begin(), order.end(), [&](Index i, Index j) { return angle[i] < angle[j]; });
  std::vector<std::array<Index, 2>> pairs;
  const bool fins =
    std::any_of(faces.begin(), faces.end(), [](const EdgeFace& f) { return f.Loose; });
  if (n % 2 == 0 && !fins && pairSolids(faces, order, pairs))
  {
    return pairs;
  }
  struct Choice
  {
    double Bend;
    std::size_t I;
    std::size_t J;
  };
  std::vector<Choice> choices;
  constexpr double against = 10.0; // faces of unlike orientation come last
  constexpr double loose = 4.0;
  for (std::size_t i = 0; i < n && n <= 64; ++i)
  {
    for (std::size_t j = i + 1; j < n; ++j)
    {
      const double turn = std::abs(std::remainder(angle[i] - angle[j], 2.0 * M_PI));
      choices.push_back({M_PI - turn + (faces[i].Forward == faces[j].Forward ? against : 0.0) +
                           loose * (faces[i].Loose + faces[j].Loose),
        i, j});
    }
  }
  std::stable_sort(choices.begin(), choices.end(),
    [](const Choice& c, const Choice& d) { return c.Bend < d.Bend; });
  std::vector<std::uint8_t> used(n, 0);
  for (const Choice& c : choices)
  {
    if (!used[c.I] && !used[c.J])
    {
      used[c.I] = used[c.J] = 1;
      pairs.push_back({faces[c.I].HalfEdge, faces[c.J].HalfEdge});
    }
  }
  return pairs;
}
} // namespace bsr
