#include "Mesh/PointDistance.h"

#include "Common/MonitoredLoop.h"
#include "Mesh/PointTree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr std::size_t Neighbors = 10;
constexpr double Reach = 0.6; ///< of the weights, in spacings
constexpr double MostVoxels = 4e8;
constexpr std::size_t Wide = 48;
/// Distance of the center of a Gaussian's half from the middle, in standard deviations.
constexpr double HalfPlane = 0.79788456080286541;
} // namespace

PointDistance::PointDistance(const OrientedPoints& points)
    : Surface(&points), Tree(std::make_unique<PointTree>(points.Points))
{
}
PointDistance::~PointDistance() = default;
PointDistance::PointDistance(PointDistance&&) noexcept = default;
PointDistance& PointDistance::operator=(PointDistance&&) noexcept = default;

double PointDistance::at(const Vec3& p) const
{
  std::array<std::uint32_t, Neighbors> near{};
  std::array<double, Neighbors> d2{};
  const std::size_t n = this->Tree->nearest(p, Neighbors, near.data(), d2.data());
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t k = 0; k < n; ++k)
  {
    const Vec3& q = this->Surface->Points[near[k]];
    const double reach = Reach * this->Surface->Spacing[near[k]];
    // Relative to the nearest point, so that weights never all vanish.
    const double w = std::exp((d2[0] - d2[k]) / (reach * reach));
    sum += w * this->Surface->Normals[near[k]].dot(p - q);
    weights += w;
  }
  return sum / weights;
}

double PointDistance::remoteness(const Vec3& p) const
{
  std::array<std::uint32_t, Neighbors> near{};
  std::array<double, Neighbors> d2{};
  const std::size_t n = this->Tree->nearest(p, Neighbors, near.data(), d2.data());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k)
  {
    least = std::min(least, std::sqrt(d2[k]) / this->Surface->Spacing[near[k]]);
  }
  return least;
}

double PointDistance::overhang(const Vec3& p) const
{
  std::array<std::uint32_t, Wide> near{};
  std::array<double, Wide> d2{};
  const std::size_t n = this->Tree->nearest(p, Wide, near.data(), d2.data());
  const Vec3& normal = this->Surface->Normals[near[0]];
  const double reach = this->Surface->Spacing[near[0]];
  Vec3 shift = Vec3::Zero();
  double weights = 0.0;
  for (std::size_t k = 0; k < n; ++k)
  {
    if (this->Surface->Normals[near[k]].dot(normal) > 0.0)
    {
      // By the area that a point stands for, so that dense places count like others.
      const double spacing = this->Surface->Spacing[near[k]];
      const double w = spacing * spacing * std::exp(-0.5 * d2[k] / (reach * reach));
      shift += w * (this->Surface->Points[near[k]] - p);
      weights += w;
    }
  }
  shift /= std::max(weights, 1e-300);
  shift -= shift.dot(normal) * normal;
  return shift.norm() / (HalfPlane * reach);
}

namespace
{
/// Marks the voxels within `band` spacings of a point.
std::vector<std::int64_t> voxelsNear(const OrientedPoints& points, double band, DistanceGrid& grid)
{
  std::vector<char> marked(grid.Values.size(), 0);
  for (std::size_t i = 0; i < points.Points.size(); ++i)
  {
    const double radius = band * points.Spacing[i];
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    for (int a = 0; a < 3; ++a)
    {
      const double x = points.Points[i][a] - grid.Origin[a];
      low[a] = std::max(0, static_cast<int>(std::ceil((x - radius) / grid.Voxel)));
      high[a] = std::min(grid.Size[a] - 1, static_cast<int>((x + radius) / grid.Voxel));
    }
    for (int z = low[2]; z <= high[2]; ++z)
    {
      for (int y = low[1]; y <= high[1]; ++y)
      {
        char* row = &marked[(static_cast<std::size_t>(z) * grid.Size[1] + y) * grid.Size[0]];
        for (int x = low[0]; x <= high[0]; ++x)
        {
          const Vec3 d = grid.Origin + grid.Voxel * Vec3(x, y, z) - points.Points[i];
          row[x] = static_cast<char>(row[x] | (d.squaredNorm() <= radius * radius ? 1 : 0));
        }
      }
    }
  }
  std::vector<std::int64_t> near;
  for (std::size_t v = 0; v < marked.size(); ++v)
  {
    if (marked[v])
    {
      near.push_back(static_cast<std::int64_t>(v));
    }
  }
  return near;
}
} // namespace

Result<DistanceGrid> sampleDistance(const OrientedPoints& points, const PointDistance& distance,
  double voxel, double band, Monitor& monitor)
{
  const double reach = band * *std::max_element(points.Spacing.begin(), points.Spacing.end());
  Vec3 low = points.Points.front();
  Vec3 high = low;
  for (const Vec3& p : points.Points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  DistanceGrid grid;
  grid.Voxel = voxel;
  grid.Origin = low - Vec3::Constant(reach + voxel);
  double count = 1.0;
  for (int a = 0; a < 3; ++a)
  {
    const double cells = std::ceil((high[a] - low[a] + 2.0 * reach) / voxel + 3.0);
    count *= cells;
    grid.Size[a] = static_cast<int>(std::min(cells, 1e6));
  }
  if (!(voxel > 0.0) || !(count <= MostVoxels))
  {
    return Status::invalidParameter(
      "The grid for the surface of the points would be too large; use a lower resolution, or "
      "remove points far from the others.");
  }
  grid.Unknown = static_cast<float>(2.0 * reach + 4.0 * voxel);
  grid.Values.assign(static_cast<std::size_t>(count), grid.Unknown);
  const auto near = voxelsNear(points, band, grid);
  const bool done = monitoredFor(0, static_cast<std::int64_t>(near.size()), 1024, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t i = first; i < last; ++i)
      {
        const std::int64_t v = near[i];
        const std::int64_t row = v / grid.Size[0];
        const std::int64_t slice = row / grid.Size[1];
        const Vec3 at(static_cast<double>(v % grid.Size[0]),
          static_cast<double>(row % grid.Size[1]), static_cast<double>(slice));
        grid.Values[v] = static_cast<float>(distance.at(grid.Origin + grid.Voxel * at));
      }
    });
  if (!done)
  {
    return Status::cancelled();
  }
  return grid;
}
} // namespace bsr
