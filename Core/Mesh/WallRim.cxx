#include "Mesh/WallRim.h"

#include "Mesh/SmoothRing.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr int Bins = MouthFrame::Bins;
constexpr int Turns = 6;             ///< of wall and height
constexpr double Band = 0.3;         ///< of the rim's radius, behind it: what the wall is fitted to
constexpr double LeastBand = 8.0;    ///< edges
constexpr double Bevel = 1.0;        ///< edges behind the rim that are rounded
constexpr double FirstSpread = 4.0;  ///< edges off the wall that count by a quarter, at first
constexpr double LastSpread = 2.0;   ///< and in the end
constexpr double LeastAlong = 0.6;   ///< cosine between a point's normal and the wall's
constexpr double SlopeWaves = 6.0;   ///< around, that the wall's slope follows
constexpr double RadiusWaves = 8.0;  ///< around, that the wall's radius follows
constexpr double HeightWaves = 6.0;  ///< around, that the rim's height follows
constexpr double SlopeCost = 0.03;   ///< of a slope against the axis
constexpr double CoverDepth = 2.0;   ///< edges off the wall that cover it
constexpr double CoverAlong = 0.3;   ///< cosine of normals that cover it
constexpr double Reach = 0.35;       ///< of the rim's radius: how far the rim moves
constexpr double Window = 0.2;       ///< of the rim's radius, below and above an end of the wall
constexpr double LeastWindow = 2.5;  ///< edges
constexpr double Jumps = 0.5;        ///< cost of a jump by a window from bin to bin
constexpr double ClearEnd = 0.5;     ///< of a window: covered below less covered above
constexpr double LeastWeight = 0.01; ///< of a height where the wall does not end
constexpr double HeightSpread = 2.0; ///< edges off the smooth height that count by a half

/// A point of the raw surface in cylinder coordinates; N along radius, around and along the axis.
struct WallPoint
{
  double Bin;
  double Radius;
  double Height;
  Vec3 N;
  double Area;
  bool Outer;
};

/// The wall near the rim, ruled: radius at the rim's height, and its growth with the height.
struct RuledWall
{
  FiberRim Rim;
  RimProfile Slope{};
  RimProfile Cos{}; ///< of the angle between the radius and the wall's normal across the axis
  RimProfile Sin{};

  void turn()
  {
    for (int i = 0; i < Bins; ++i)
    {
      const double growth = (ring(this->Rim.Radius, i + 1) - ring(this->Rim.Radius, i - 1)) * 0.25 *
                            Bins / MouthFrame::Pi;
      const double length = std::hypot(this->Rim.Radius[i], growth);
      this->Cos[i] = this->Rim.Radius[i] / length;
      this->Sin[i] = growth / length;
    }
  }
  /// Height above the rim (x) and distance outwards from the wall (y).
  Vec2 off(const WallPoint& p) const
  {
    const double h = p.Height - between(this->Rim.Height, p.Bin);
    const double r = p.Radius - between(this->Rim.Radius, p.Bin) - between(this->Slope, p.Bin) * h;
    return {h, r * between(this->Cos, p.Bin)};
  }
  /// Cosine between a point's normal and the wall's.
  double along(const WallPoint& p) const
  {
    const double c = between(this->Cos, p.Bin);
    const double s = between(this->Slope, p.Bin) * c;
    return (p.N.x() * c - p.N.y() * between(this->Sin, p.Bin) - p.N.z() * s) /
           std::sqrt(1.0 + s * s);
  }
};

int binOf(const WallPoint& p)
{
  return std::min(static_cast<int>(p.Bin), Bins - 1);
}

double meanOf(const RimProfile& p)
{
  double sum = 0.0;
  for (const double v : p)
  {
    sum += v;
  }
  return sum / Bins;
}

/// The samples around a rim, their normals turned outwards.
std::vector<WallPoint> around(
  const WallSamples& wall, const MouthFrame& frame, const FiberRim& rim, double radius)
{
  const double most = 1.5 * *std::max_element(rim.Radius.begin(), rim.Radius.end());
  std::vector<WallPoint> points;
  double outwards = 0.0;
  for (std::size_t i = 0; i < wall.Points.size(); ++i)
  {
    const Vec3& p = wall.Points[i];
    const double h = frame.height(p);
    const double r = frame.radius(p);
    if (std::abs(h) > 1.2 * radius || r > most || wall.Side[i] == 1)
    {
      continue;
    }
    const double bin = frame.bin(p);
    const Vec3 e = frame.radial(bin);
    const Vec3& n = wall.Normals[i];
    points.push_back({bin, r, h, {n.dot(e), n.dot(frame.Axis.cross(e)), n.dot(frame.Axis)},
      wall.Areas[i], wall.Side[i] == 0});
    outwards += points.back().Outer ? wall.Areas[i] * points.back().N.x() : 0.0;
  }
  for (WallPoint& p : points)
  {
    p.N = outwards < 0.0 ? Vec3(-p.N) : p.N;
  }
  return points;
}

/// Fits the wall to the outer points behind the rim; false where they are missing in more than half
/// of the directions.
bool fitWall(
  RuledWall& wall, const std::vector<WallPoint>& points, double band, double edge, double spread)
{
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(2 * Bins, 2 * Bins);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * Bins);
  for (const WallPoint& p : points)
  {
    const Vec2 off = wall.off(p);
    const double along = wall.along(p);
    if (!p.Outer || off.x() > -Bevel * edge || off.x() < -band ||
        std::abs(off.y()) > 3.0 * spread || along < LeastAlong)
    {
      continue;
    }
    const double share = 1.0 + off.y() * off.y() / (spread * spread);
    const double weight = p.Area * along / (share * share);
    const int i = binOf(p);
    normal(i, i) += weight;
    normal(i, Bins + i) += weight * off.x();
    normal(Bins + i, i) += weight * off.x();
    normal(Bins + i, Bins + i) += weight * off.x() * off.x();
    right[i] += weight * off.y();
    right[Bins + i] += weight * off.x() * off.y();
  }
  std::array<double, Bins> weights{};
  Eigen::VectorXd::Map(weights.data(), Bins) = normal.diagonal().head(Bins);
  std::nth_element(weights.begin(), weights.begin() + Bins / 2, weights.end());
  const double typical = weights[Bins / 2];
  if (!(typical > 0.0))
  {
    return false;
  }
  const double slopeScale = typical * band * band / 3.0;
  Eigen::MatrixXd bend = slopeScale * ringPenalty(SlopeWaves);
  bend.diagonal().array() += SlopeCost * slopeScale;
  const Eigen::MatrixXd curve = typical * ringPenalty(RadiusWaves);
  normal.topLeftCorner(Bins, Bins) += curve;
  normal.bottomRightCorner(Bins, Bins) += bend;
  normal.diagonal().head(Bins).array() += 1e-3 * typical;
  right.head(Bins) -= curve * Eigen::VectorXd::Map(wall.Rim.Radius.data(), Bins);
  right.tail(Bins) -= bend * Eigen::VectorXd::Map(wall.Slope.data(), Bins);
  const Eigen::VectorXd step = normal.ldlt().solve(right);
  for (int i = 0; i < Bins; ++i)
  {
    wall.Rim.Radius[i] += step[i] / wall.Cos[i];
    wall.Slope[i] += step[Bins + i] / wall.Cos[i];
  }
  return true;
}

/// How clearly the wall ends at each of a direction's heights, -1..1, for all directions: covered
/// in the window below, bare in the window above.
std::array<std::vector<double>, Bins> endsOfWall(const RuledWall& wall,
  const std::vector<WallPoint>& points, const RimProfile& middle, int steps, double step,
  int window, double edge)
{
  std::array<std::vector<double>, Bins> cover;
  cover.fill(std::vector<double>(steps, 0.0));
  // Each sample covers an edge of height.
  const int tall = std::max(1, static_cast<int>(std::lround(edge / step)));
  for (const WallPoint& p : points)
  {
    const double along = wall.along(p);
    if (along < CoverAlong || std::abs(wall.off(p).y()) > CoverDepth * edge)
    {
      continue;
    }
    const double at = (p.Height - between(middle, p.Bin)) / step + 0.5 * (steps - tall + 1);
    const int first = static_cast<int>(std::floor(at));
    for (int k = std::max(first, 0); k < std::min(first + tall, steps); ++k)
    {
      cover[binOf(p)][k] += p.Area * along / tall;
    }
  }
  std::array<std::vector<double>, Bins> score;
  for (int i = 0; i < Bins; ++i)
  {
    const double area = 2.0 * MouthFrame::Pi / Bins * wall.Rim.Radius[i] / wall.Cos[i] * step;
    std::vector<double> sum(steps + 1, 0.0);
    for (int k = 0; k < steps; ++k)
    {
      const double here =
        0.25 * ring(cover, i - 1)[k] + 0.5 * cover[i][k] + 0.25 * ring(cover, i + 1)[k];
      sum[k + 1] = sum[k] + std::min(here / area, 1.0);
    }
    score[i].resize(steps + 1);
    for (int k = 0; k <= steps; ++k)
    {
      const double below = sum[k] - sum[std::max(k - window, 0)];
      const double above = sum[std::min(k + window, steps)] - sum[k];
      score[i][k] = (below - above) / window;
    }
  }
  return score;
}

/// The closed path of heights, as their number in each direction, on which the wall ends most
/// clearly with the least jumps; three times around, of which the middle turn is taken.
std::array<int, Bins> clearestPath(const std::array<std::vector<double>, Bins>& score,
  const RimProfile& middle, double step, double window)
{
  const auto n = static_cast<int>(score[0].size());
  std::vector<std::vector<int>> from(3 * Bins, std::vector<int>(n, 0));
  std::vector<double> cost(n, 0.0);
  for (int i = 1; i < 3 * Bins; ++i)
  {
    const double rise = ring(middle, i) - ring(middle, i - 1);
    std::vector<double> next(n);
    for (int k = 0; k < n; ++k)
    {
      next[k] = std::numeric_limits<double>::infinity();
      for (int l = 0; l < n; ++l)
      {
        const double jump = (rise + (k - l) * step) / window;
        const double total = cost[l] + Jumps * jump * jump;
        if (total < next[k])
        {
          next[k] = total;
          from[i][k] = l;
        }
      }
      next[k] -= std::max(ring(score, i)[k], 0.0);
    }
    cost = std::move(next);
  }
  auto at = static_cast<int>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  std::array<int, Bins> path{};
  for (int i = 3 * Bins - 1; i >= Bins; --i)
  {
    path[i % Bins] = at;
    at = from[i][at];
  }
  return path;
}

/// The height where the wall ends, smooth around; `middle` is where it is sought. How clearly it
/// ends there, 0 where it does in less than a third of the directions.
double findHeight(RuledWall& wall, const std::vector<WallPoint>& points, const RimProfile& middle,
  double radius, double edge)
{
  const double step = std::max(0.25 * edge, 0.005 * radius);
  const int steps = static_cast<int>(2.0 * Reach * radius / step);
  const int window = std::max(
    1, static_cast<int>(std::lround(std::max(Window * radius, LeastWindow * edge) / step)));
  const auto score = endsOfWall(wall, points, middle, steps, step, window, edge);
  const auto path = clearestPath(score, middle, step, window * step);
  Eigen::VectorXd height(Bins);
  Eigen::VectorXd clear(Bins);
  for (int i = 0; i < Bins; ++i)
  {
    height[i] = middle[i] + (path[i] - 0.5 * steps) * step;
    clear[i] = std::max((score[i][path[i]] - ClearEnd) / (1.0 - ClearEnd), LeastWeight);
  }
  const SmoothRing ringOf(HeightWaves);
  Eigen::VectorXd weight = clear;
  Eigen::VectorXd smooth;
  for (int round = 0; round < 4; ++round)
  {
    smooth = ringOf.through(height, weight);
    const Eigen::ArrayXd off = (height - smooth).array() / (HeightSpread * edge);
    weight = clear.array() / (1.0 + off.square());
  }
  Eigen::VectorXd::Map(wall.Rim.Height.data(), Bins) = smooth;
  double clearness = 0.0;
  for (int i = 0; i < Bins; ++i)
  {
    const double at = (smooth[i] - middle[i]) / step + 0.5 * steps;
    const auto k = static_cast<std::size_t>(std::clamp(at + 0.5, 0.0, double(steps)));
    clearness += score[i][k] / Bins;
  }
  return 3 * (clear.array() > LeastWeight).count() < Bins ? 0.0 : std::max(clearness, 1e-6);
}
} // namespace

WallSamples sampleWall(const FiberWall& wall)
{
  WallSamples samples;
  const TriangleMesh& mesh = wall.Surface;
  if (mesh.Triangles.empty() || wall.Side.size() != mesh.Points.size())
  {
    return samples;
  }
  for (const auto& t : mesh.Triangles)
  {
    const Vec3& p = mesh.Points[t[0]];
    const Vec3 a = mesh.Points[t[1]] - p;
    const Vec3 b = mesh.Points[t[2]] - p;
    const Vec3 n = a.cross(b);
    samples.Edge +=
      (a.norm() + b.norm() + (b - a).norm()) / 3.0 / static_cast<double>(mesh.Triangles.size());
    std::array<std::uint8_t, 3> side{wall.Side[t[0]], wall.Side[t[1]], wall.Side[t[2]]};
    std::sort(side.begin(), side.end());
    if (n.norm() > 0.0)
    {
      samples.Points.push_back(p + (a + b) / 3.0);
      samples.Normals.push_back(n.normalized());
      samples.Areas.push_back(0.5 * n.norm());
      samples.Side.push_back(side[1]);
    }
  }
  return samples;
}

WallRim rimOnWall(const WallSamples& wall, const MouthFrame& frame, const FiberRim& start)
{
  const double radius = meanOf(start.Radius);
  const double edge = wall.Edge;
  if (!(edge > 0.0) || !(radius > 0.0))
  {
    return {start};
  }
  const auto points = around(wall, frame, start, radius);
  RuledWall ruled;
  ruled.Rim = start;
  const double band = std::max(Band * radius, LeastBand * edge);
  double spread = FirstSpread * edge;
  double clear = 0.0;
  for (int turn = 0; turn < Turns; ++turn)
  {
    ruled.turn();
    clear = fitWall(ruled, points, band, edge, spread)
              ? findHeight(ruled, points, start.Height, radius, edge)
              : 0.0;
    if (!(clear > 0.0))
    {
      return {start};
    }
    spread = std::max(0.6 * spread, LastSpread * edge);
  }
  for (int i = 0; i < Bins; ++i)
  {
    const double gone = std::max(std::abs(ruled.Rim.Radius[i] - start.Radius[i]),
      std::abs(ruled.Rim.Height[i] - start.Height[i]));
    if (!(gone < Reach * radius))
    {
      return {start};
    }
  }
  return {ruled.Rim, clear};
}
} // namespace bsr
