#include "Image/SampleDistance.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// The cell of a coordinate along one axis: its first voxel and the share of the second.
struct Cell
{
  std::int64_t First;
  std::int64_t Second;
  double Share;
};

Cell cellAt(double x, std::int64_t n)
{
  const double top = static_cast<double>(n - 1);
  const double inside = x > 0.0 ? std::min(x, top) : 0.0; // NaN goes to the border
  const auto i = std::min(static_cast<std::int64_t>(inside), std::max<std::int64_t>(n - 2, 0));
  return {i, std::min(i + 1, n - 1), inside - static_cast<double>(i)};
}
} // namespace

double sampleVolume(
  const ImageView<const float>& volume, const ImageFrame& frame, const Vec3& point, Vec3* gradient)
{
  const Vec3 local = frame.Direction.inverse() * (point - frame.Origin);
  const Cell x = cellAt(local[0] / volume.Spacing[0], volume.Dims[0]);
  const Cell y = cellAt(local[1] / volume.Spacing[1], volume.Dims[1]);
  const Cell z = cellAt(local[2] / volume.Spacing[2], volume.Dims[2]);
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  // Values and x differences on the four edges of the cell along x.
  std::array<double, 4> value{};
  std::array<double, 4> slope{};
  for (int e = 0; e < 4; ++e)
  {
    const float* row = volume.row(e % 2 ? y.Second : y.First, e / 2 ? z.Second : z.First);
    slope[e] = static_cast<double>(row[x.Second]) - static_cast<double>(row[x.First]);
    value[e] = static_cast<double>(row[x.First]) + x.Share * slope[e];
  }
  if (gradient)
  {
    const Vec3 g(mix(mix(slope[0], slope[1], y.Share), mix(slope[2], slope[3], y.Share), z.Share) /
                   volume.Spacing[0],
      mix(value[1] - value[0], value[3] - value[2], z.Share) / volume.Spacing[1],
      (mix(value[2], value[3], y.Share) - mix(value[0], value[1], y.Share)) / volume.Spacing[2]);
    *gradient = frame.Direction.inverse().transpose() * g;
  }
  return mix(mix(value[0], value[1], y.Share), mix(value[2], value[3], y.Share), z.Share);
}
} // namespace bsr
