#include "Mesh/FiberEnds.h"

#include "Mesh/RegionCut.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace bsr
{
namespace
{
constexpr int Bins = 72;             ///< directions around the axis
constexpr double WindowHeight = 1.0; ///< of the mouth's radius, up and down the axis
constexpr double WindowRadius = 2.6; ///< of the mouth's radius
constexpr double MostLoss = 0.4;     ///< of the mouth's radius: how far within the outermost
constexpr double Stiffness = 0.5;    ///< of the rim against jumps
constexpr double FreeDetour = 0.1;   ///< of the mouth's radius: from a smooth end
constexpr double DetourCost = 3.0;   ///< of what is farther, against distance outwards
constexpr int NormalRings = 4;       ///< that the normals are averaged over
constexpr double LeastTurn = 0.15;   ///< cosine of axis and radius with the rim's normal
constexpr int Smoothing = 3;         ///< rounds on the function that is cut
constexpr double MostTilt = 0.7;     ///< cosine between mouth and rim plane at least
constexpr double Snap = 0.2;         ///< of an edge
constexpr double Pi = 3.14159265358979323846;

/// Cylinder coordinates around the axis of a mouth.
struct Frame
{
  Vec3 Center;
  Vec3 Axis;
  Vec3 U;
  Vec3 V;

  Frame(const Vec3& center, const Vec3& axis) : Center(center), Axis(axis.normalized())
  {
    this->U = this->Axis.unitOrthogonal();
    this->V = this->Axis.cross(this->U);
  }
  double height(const Vec3& p) const { return (p - this->Center).dot(this->Axis); }
  double radius(const Vec3& p) const
  {
    const Vec3 d = p - this->Center;
    return (d - d.dot(this->Axis) * this->Axis).norm();
  }
  /// Angle in bins, 0..Bins.
  double bin(const Vec3& p) const
  {
    const Vec3 d = p - this->Center;
    const double a = std::atan2(d.dot(this->V), d.dot(this->U)) / (2.0 * Pi) * Bins;
    return a < 0.0 ? a + Bins : a;
  }
  Vec3 radial(double bin) const
  {
    const double a = bin / Bins * 2.0 * Pi;
    return std::cos(a) * this->U + std::sin(a) * this->V;
  }
};

using Profile = std::array<double, Bins>;

template <class T>
const T& ring(const std::array<T, Bins>& values, int i)
{
  return values[((i % Bins) + Bins) % Bins];
}

/// Median of five, then a narrow bell.
Profile smoothed(const Profile& p)
{
  Profile median{};
  for (int i = 0; i < Bins; ++i)
  {
    std::array<double, 5> w{ring(p, i - 2), ring(p, i - 1), p[i], ring(p, i + 1), ring(p, i + 2)};
    std::sort(w.begin(), w.end());
    median[i] = w[2];
  }
  Profile out{};
  for (int i = 0; i < Bins; ++i)
  {
    out[i] = (6.0 * median[i] + 4.0 * (ring(median, i - 1) + ring(median, i + 1)) +
               ring(median, i - 2) + ring(median, i + 2)) /
             16.0;
  }
  return out;
}

/// The rim in a frame: for each direction its radius and height.
struct Rim
{
  Profile Radius{};
  Profile Height{};

  Vec3 point(const Frame& f, int i) const
  {
    return f.Center + this->Radius[i] * f.radial(i + 0.5) + this->Height[i] * f.Axis;
  }
  /// Radius minus height of the rim, between the directions.
  double offset(double bin) const
  {
    const double x = bin - 0.5;
    const int i = static_cast<int>(std::floor(x));
    const double t = x - i;
    const auto at = [this](int k) { return ring(this->Radius, k) - ring(this->Height, k); };
    return (1.0 - t) * at(i) + t * at(i + 1);
  }
};

/// A point of the surface where the rim may pass, in the frame's coordinates.
struct Candidate
{
  double Radius;
  double Height;
  double Loss; ///< how much less far out it lies than the outermost of its direction
};

using Candidates = std::array<std::vector<Candidate>, Bins>;

/// Outward vertex normals, averaged over some rings of neighbors; the surface may be turned inside
/// out, as isosurfaces of a distance that is negative inside are.
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

/// Height of the rim as a smooth function of the direction, robust against detours.
struct SmoothHeight
{
  static constexpr int Terms = 5; ///< a plane and an oval
  using Coefficients = Eigen::Matrix<double, Terms, 1>;
  Coefficients Weights = Coefficients::Zero();

  static Coefficients terms(double bin)
  {
    const double a = bin / Bins * 2.0 * Pi;
    Coefficients t;
    t << 1.0, std::cos(a), std::sin(a), std::cos(2.0 * a), std::sin(2.0 * a);
    return t;
  }
  double at(double bin) const { return this->Weights.dot(terms(bin)); }

  /// The least sum of absolute deviations, by least squares with weights.
  static SmoothHeight through(const Rim& rim, double radius)
  {
    SmoothHeight f;
    for (int round = 0; round < 12; ++round)
    {
      Eigen::Matrix<double, Terms, Terms> normal = Eigen::Matrix<double, Terms, Terms>::Zero();
      Coefficients right = Coefficients::Zero();
      for (int i = 0; i < Bins; ++i)
      {
        const Coefficients t = terms(i + 0.5);
        const double deviation = round == 0 ? 0.0 : std::abs(rim.Height[i] - f.at(i + 0.5));
        const double weight = 1.0 / (0.02 * radius + deviation);
        normal += weight * t * t.transpose();
        right += weight * rim.Height[i] * t;
      }
      f.Weights = normal.ldlt().solve(right);
    }
    return f;
  }
};

/// The outermost points of each direction where the surface turns from end to wall, `lean` weighing
/// radius against height; what is far from a `smooth` end, if known, counts as less far out.
Candidates rimCandidates(const TriangleMesh& mesh, const std::vector<Vec3>& normals,
  const Frame& frame, double radius, double lean, const SmoothHeight* smooth)
{
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
      if (normals[i].dot(frame.Axis) < LeastTurn || normals[i].dot(frame.radial(bin)) < LeastTurn)
      {
        continue; // wall that flares, or the face's inner border
      }
      const int b = std::min(static_cast<int>(bin), Bins - 1);
      const double detour =
        smooth ? std::max(std::abs(h - smooth->at(bin)) - FreeDetour * radius, 0.0) : 0.0;
      candidates[b].push_back({r, h, DetourCost * detour - (lean * r + h)});
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

/// The closed sequence of candidates with the least losses and jumps: dynamic programming, twice
/// around, of which the middle turn is taken.
std::optional<Rim> searchRim(const TriangleMesh& mesh, const std::vector<Vec3>& normals,
  const Frame& frame, double radius, double lean, const SmoothHeight* smooth = nullptr)
{
  Candidates candidates = rimCandidates(mesh, normals, frame, radius, lean, smooth);
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
  const double arc = 2.0 * Pi * radius / Bins;
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
  Rim rim;
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

/// The frame of the plane through a rim.
Frame planeOf(const Rim& rim, const Frame& frame)
{
  Vec3 center = Vec3::Zero();
  for (int i = 0; i < Bins; ++i)
  {
    center += rim.point(frame, i) / Bins;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < Bins; ++i)
  {
    const Vec3 d = rim.point(frame, i) - center;
    covariance += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Vec3 axis = solver.eigenvectors().col(0);
  if (axis.dot(frame.Axis) < 0.0)
  {
    axis = -axis;
  }
  return {center, axis};
}

/// Vertices reachable from `seed` over edges between vertices for which inside() holds.
template <class Inside>
std::vector<char> connected(
  const std::vector<std::vector<Index>>& neighbors, Index seed, const Inside& inside)
{
  std::vector<char> reached(neighbors.size(), 0);
  std::vector<Index> stack{seed};
  reached[seed] = 1;
  while (!stack.empty())
  {
    const Index v = stack.back();
    stack.pop_back();
    for (const Index w : neighbors[v])
    {
      if (!reached[w] && inside(w))
      {
        reached[w] = 1;
        stack.push_back(w);
      }
    }
  }
  return reached;
}

std::vector<std::vector<Index>> neighborsOf(const TriangleMesh& mesh)
{
  std::vector<std::vector<Index>> neighbors(mesh.Points.size());
  for (const auto& t : mesh.Triangles)
  {
    for (int c = 0; c < 3; ++c)
    {
      neighbors[t[c]].push_back(t[(c + 1) % 3]);
    }
  }
  return neighbors;
}

/// Vertex of the cap: the nearest to the axis, not far below or above the mouth.
Index capVertex(const TriangleMesh& mesh, const Frame& frame, double radius)
{
  Index best = -1;
  double nearest = 0.3 * radius;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    const double h = frame.height(mesh.Points[i]);
    const double r = frame.radius(mesh.Points[i]);
    if (std::abs(h) < 2.0 * radius && r < nearest && h > highest)
    {
      highest = h;
      best = static_cast<Index>(i);
    }
  }
  return best;
}

/// Averages a function over neighbors.
void smooth(std::vector<double>& value, const std::vector<std::vector<Index>>& neighbors)
{
  for (int round = 0; round < Smoothing; ++round)
  {
    std::vector<double> next = value;
    for (std::size_t i = 0; i < value.size(); ++i)
    {
      double sum = 0.0;
      for (const Index n : neighbors[i])
      {
        sum += value[n];
      }
      if (!neighbors[i].empty())
      {
        next[i] = 0.5 * (value[i] + sum / static_cast<double>(neighbors[i].size()));
      }
    }
    value = std::move(next);
  }
  for (double& v : value)
  {
    v = v == 0.0 ? -1e-12 : v;
  }
}

/// The function whose zero level is the rim: made positive in one connected part without holes.
std::optional<std::vector<double>> endFunction(
  const TriangleMesh& mesh, const Frame& frame, const Rim& rim, double radius)
{
  const auto neighbors = neighborsOf(mesh);
  double widest = 0.0;
  for (const double r : rim.Radius)
  {
    widest = std::max(widest, r);
  }
  std::vector<double> value(mesh.Points.size());
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    const Vec3& p = mesh.Points[i];
    const double f = frame.height(p) - frame.radius(p) + rim.offset(frame.bin(p));
    const bool far = (p - frame.Center).norm() > 2.0 * widest;
    value[i] = far ? -std::max(std::abs(f), 1e-9 * radius) : (f == 0.0 ? 1e-9 * radius : f);
  }
  smooth(value, neighbors);
  const Index seed = capVertex(mesh, frame, radius);
  const auto lowest = std::min_element(value.begin(), value.end());
  if (seed < 0 || *lowest >= 0.0)
  {
    return std::nullopt;
  }
  // The cap may lie so deep in the lumen that it is negative: what counts is that the ring of the
  // end face, which is positive, parts it from the body.
  const auto outside = static_cast<Index>(lowest - value.begin());
  const auto below = connected(neighbors, outside, [&](Index v) { return value[v] < 0.0; });
  if (below[seed])
  {
    return std::nullopt;
  }
  const auto end = connected(neighbors, seed, [&](Index v) { return !below[v]; });
  const auto body = connected(neighbors, outside, [&](Index v) { return !end[v]; });
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    value[i] = body[i] ? -std::abs(value[i]) : std::abs(value[i]);
  }
  return value;
}

/// Marks triangles on the positive side of the cut with a region; false where another has them.
bool mark(TriangleMesh& mesh, const std::vector<double>& value, Index region)
{
  for (std::size_t t = 0; t < mesh.Triangles.size(); ++t)
  {
    double sum = 0.0;
    for (const Index v : mesh.Triangles[t])
    {
      sum += value[v];
    }
    if (sum > 0.0)
    {
      if (mesh.Region[t] != 0)
      {
        return false;
      }
      mesh.Region[t] = region;
    }
  }
  return true;
}

/// Tries to cut one end; says why not.
std::string cutEnd(FiberEnds& ends, const EndMouth& mouth, double lean)
{
  if (!(mouth.Radius > 0.0) || !(mouth.Direction.norm() > 0.0) || !mouth.Center.allFinite())
  {
    return "its radius or direction is not valid";
  }
  Frame frame(mouth.Center, mouth.Direction);
  const auto normals = wideNormals(ends.Surface);
  std::optional<Rim> rim;
  for (int round = 0; round < 4; ++round)
  {
    rim = searchRim(ends.Surface, normals, frame, mouth.Radius, lean);
    if (!rim)
    {
      return "the surface does not go round it";
    }
    if (round < 3)
    {
      const Frame plane = planeOf(*rim, frame);
      if (plane.Axis.dot(mouth.Direction.normalized()) < MostTilt)
      {
        break;
      }
      frame = plane;
    }
  }
  for (int round = 0; round < 2; ++round)
  {
    const SmoothHeight smooth = SmoothHeight::through(*rim, mouth.Radius);
    const auto smoother = searchRim(ends.Surface, normals, frame, mouth.Radius, lean, &smooth);
    rim = smoother ? smoother : rim;
  }
  auto value = endFunction(ends.Surface, frame, *rim, mouth.Radius);
  if (!value)
  {
    return "no cap lies over it";
  }
  TriangleMesh cut = ends.Surface;
  cutAtZero(cut, *value, Snap);
  const auto region = static_cast<Index>(ends.Rims.size() + 1);
  if (!mark(cut, *value, region))
  {
    return "it overlaps another end";
  }
  auto loops = regionLoops(cut, region);
  if (loops.size() != 1 || regionEuler(cut, region) != 1)
  {
    return "its region is not a disc";
  }
  ends.Surface = std::move(cut);
  ends.Rims.push_back(std::move(loops.front()));
  return {};
}
} // namespace

Result<FiberEnds> findFiberEnds(
  const TriangleMesh& closedSurface, const std::vector<EndMouth>& mouths, Monitor& monitor)
{
  if (closedSurface.Triangles.empty())
  {
    return Status::invalidInput("The closed surface has no triangles. Contour SignedDistance of "
                                "the Closing filter's output at 0.");
  }
  FiberEnds ends;
  ends.Surface = closedSurface;
  ends.Surface.Region.assign(closedSurface.Triangles.size(), 0);
  for (std::size_t m = 0; m < mouths.size(); ++m)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    std::string why = cutEnd(ends, mouths[m], 1.15);
    for (const double lean : {1.5, 0.8})
    {
      why = why.empty() ? why : cutEnd(ends, mouths[m], lean);
    }
    if (!why.empty())
    {
      ends.Note += (ends.Note.empty() ? "Mouth " : " Mouth ") + std::to_string(m + 1) +
                   " of the lumen was not made an end: " + why + ".";
    }
    monitor.progress(static_cast<double>(m + 1) / static_cast<double>(mouths.size()));
  }
  return ends;
}
} // namespace bsr
