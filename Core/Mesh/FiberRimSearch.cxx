#include "Mesh/FiberRim.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr int Bins = MouthFrame::Bins;
constexpr double WindowHeight = 1.0; ///< of the mouth's radius, up and down the axis
constexpr double WindowRadius = 3.5; ///< of the mouth's radius
constexpr double MostLoss = 0.4;     ///< of the mouth's radius: how far within the outermost
constexpr double Stiffness = 0.5;    ///< of the rim against jumps
constexpr double FreeDetour = 0.1;   ///< of the mouth's radius: from a smooth end
constexpr double DetourCost = 3.0;   ///< of what is farther, against distance outwards
constexpr double WebCost = 3.0;      ///< of a distance off the wall, against distance outwards
constexpr int NormalRings = 4;       ///< that the normals are averaged over
constexpr double LeastTurn = 0.15;   ///< cosine of axis and radius with the rim's normal

/// Median of five, then a narrow bell.
RimProfile smoothed(const RimProfile& p)
{
  RimProfile median{};
  for (int i = 0; i < Bins; ++i)
  {
    std::array<double, 5> w{ring(p, i - 2), ring(p, i - 1), p[i], ring(p, i + 1), ring(p, i + 2)};
    std::sort(w.begin(), w.end());
    median[i] = w[2];
  }
  RimProfile out{};
  for (int i = 0; i < Bins; ++i)
  {
    out[i] = (6.0 * median[i] + 4.0 * (ring(median, i - 1) + ring(median, i + 1)) +
               ring(median, i - 2) + ring(median, i + 2)) /
             16.0;
  }
  return out;
}

/// A point of the surface where the rim may pass, in the frame's coordinates.
struct Candidate
{
  double Radius;
  double Height;
  double Loss; ///< how much less far out it lies than the outermost of its direction
};

using Candidates = std::array<std::vector<Candidate>, Bins>;

/// The outermost points of each direction where the surface turns from end to wall, `lean` weighing
/// radius against height; what is far from a `smooth` end, if known, or off the wall counts as less
/// far out.
Candidates rimCandidates(const RimSurface& surface, const MouthFrame& frame, double radius,
  double lean, const RimProfile* smooth)
{
  const TriangleMesh& mesh = surface.Mesh;
  Candidates candidates;
  const double reach = std::hypot(WindowHeight, WindowRadius) * radius;
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    const Vec3& p = mesh.Points[i];
    if ((p - frame.Center).squaredNorm() > reach * reach)
    {
      continue;
    }
    const double h = frame.height(p);
    const double r = frame.radius(p);
    if (std::abs(h) <= WindowHeight * radius && r <= WindowRadius * radius)
    {
      const double bin = frame.bin(p);
      const int b = std::min(static_cast<int>(bin), Bins - 1);
      if (surface.Normals[i].dot(frame.Axis) < LeastTurn ||
          surface.Normals[i].dot(frame.radial(bin)) < LeastTurn)
      {
        continue; // wall that flares, or the face's inner border
      }
      const double detour =
        smooth ? std::max(std::abs(h - (*smooth)[b]) - FreeDetour * radius, 0.0) : 0.0;
      candidates[b].push_back(
        {r, h, DetourCost * detour + WebCost * surface.Off[i] - (lean * r + h)});
    }
  }
  for (auto& list : candidates)
  {
    std::sort(list.begin(), list.end(),
      [](const Candidate& x, const Candidate& y)
      { return x.Loss != y.Loss ? x.Loss < y.Loss : x.Radius < y.Radius; });
    const double best = list.empty() ? 0.0 : list.front().Loss;
    std::vector<Candidate> kept;
    for (Candidate c : list)
    {
      c.Loss -= best;
      const bool apart = kept.empty() || c.Loss - kept.back().Loss > 0.004 * radius;
      if (c.Loss <= MostLoss * radius && apart)
      {
        kept.push_back(c);
      }
    }
    list = std::move(kept);
  }
  return candidates;
}
} // namespace

std::vector<Vec3> wideNormals(const TriangleMesh& mesh)
{
  std::vector<Vec3> normal(mesh.Points.size(), Vec3::Zero());
  for (int round = 0; round <= NormalRings; ++round)
  {
    std::vector<Vec3> next(mesh.Points.size(), Vec3::Zero());
    for (const auto& t : mesh.Triangles)
    {
      const Vec3 n =
        round == 0
          ? Vec3(
              (mesh.Points[t[1]] - mesh.Points[t[0]]).cross(mesh.Points[t[2]] - mesh.Points[t[0]]))
          : Vec3(normal[t[0]] + normal[t[1]] + normal[t[2]]);
      for (const Index v : t)
      {
        next[v] += n;
      }
    }
    for (Vec3& n : next)
    {
      n = n.norm() > 0.0 ? Vec3(n.normalized()) : n;
    }
    normal = std::move(next);
  }
  double volume = 0.0;
  for (const auto& t : mesh.Triangles)
  {
    const Vec3& origin = mesh.Points.front();
    const Vec3 a = mesh.Points[t[0]] - origin;
    volume += a.dot((mesh.Points[t[1]] - origin).cross(mesh.Points[t[2]] - origin));
  }
  for (Vec3& n : normal)
  {
    n = volume < 0.0 ? Vec3(-n) : n;
  }
  return normal;
}

// Dynamic programming, three times around, of which the middle turns are taken.
std::optional<FiberRim> searchRim(const RimSurface& surface, const MouthFrame& frame, double radius,
  double lean, const RimProfile* smooth)
{
  Candidates candidates = rimCandidates(surface, frame, radius, lean, smooth);
  int missing = 0;
  for (int i = 0; i < 2 * Bins; ++i)
  {
    auto& list = candidates[i % Bins];
    if (list.empty())
    {
      missing += i < Bins;
      list = ring(candidates, i - 1);
    }
  }
  if (missing > Bins / 3 || candidates[0].empty())
  {
    return std::nullopt;
  }
  constexpr int Turns = 3;
  std::vector<std::vector<int>> from(Turns * Bins);
  std::vector<double> cost(candidates[0].size(), 0.0);
  const double arc = 2.0 * MouthFrame::Pi * radius / Bins;
  for (int i = 1; i < Turns * Bins; ++i)
  {
    const auto& before = ring(candidates, i - 1);
    const auto& here = ring(candidates, i);
    std::vector<double> next(here.size());
    from[i].resize(here.size());
    for (std::size_t c = 0; c < here.size(); ++c)
    {
      next[c] = std::numeric_limits<double>::infinity();
      for (std::size_t d = 0; d < before.size(); ++d)
      {
        const double dr = here[c].Radius - before[d].Radius;
        const double dh = here[c].Height - before[d].Height;
        const double total = cost[d] + Stiffness * (dr * dr + dh * dh) / arc;
        if (total < next[c])
        {
          next[c] = total;
          from[i][c] = static_cast<int>(d);
        }
      }
      next[c] += here[c].Loss;
    }
    cost = std::move(next);
  }
  auto at = static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  FiberRim rim;
  for (int i = Turns * Bins - 1; i >= Bins; --i)
  {
    rim.Radius[i % Bins] = ring(candidates, i)[at].Radius;
    rim.Height[i % Bins] = ring(candidates, i)[at].Height;
    at = from[i][at];
  }
  rim.Radius = smoothed(rim.Radius);
  rim.Height = smoothed(rim.Height);
  return rim;
}
} // namespace bsr
