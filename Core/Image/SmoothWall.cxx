#include "Image/SmoothWall.h"

#include "Common/MonitoredLoop.h"

#include <cmath>

namespace bsr
{
namespace
{
/// Half a symmetric kernel, from the center on; the sum of the whole is 1.
std::vector<float> gaussianKernel(double sigma)
{
  const int radius = std::max(1, static_cast<int>(std::ceil(3.0 * sigma)));
  std::vector<float> kernel(static_cast<std::size_t>(radius) + 1);
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i)
  {
    const double x = i / sigma;
    kernel[i] = static_cast<float>(std::exp(-0.5 * x * x));
    sum += (i == 0 ? 1.0 : 2.0) * kernel[i];
  }
  for (float& k : kernel)
  {
    k = static_cast<float>(k / sum);
  }
  return kernel;
}

/// Rows of a plane of the volume: `count` rows of `width` values, `stride` values apart.
struct Plane
{
  float* Data;
  std::int64_t Width;
  std::int64_t Count;
  std::int64_t Stride;
};

/// Convolves a plane across its rows; the first and last rows are repeated.
void convolve(const Plane& plane, const std::vector<float>& kernel, std::vector<float>& copy)
{
  const auto radius = static_cast<std::int64_t>(kernel.size()) - 1;
  copy.resize(static_cast<std::size_t>(plane.Width * plane.Count));
  for (std::int64_t r = 0; r < plane.Count; ++r)
  {
    const float* const row = plane.Data + r * plane.Stride;
    std::copy(row, row + plane.Width, copy.data() + r * plane.Width);
  }
  const auto source = [&](std::int64_t r)
  { return copy.data() + std::min(std::max<std::int64_t>(r, 0), plane.Count - 1) * plane.Width; };
  for (std::int64_t r = 0; r < plane.Count; ++r)
  {
    float* const out = plane.Data + r * plane.Stride;
    const float* const here = source(r);
    for (std::int64_t i = 0; i < plane.Width; ++i)
    {
      out[i] = kernel[0] * here[i];
    }
    for (std::int64_t d = 1; d <= radius; ++d)
    {
      const float* const below = source(r - d);
      const float* const above = source(r + d);
      for (std::int64_t i = 0; i < plane.Width; ++i)
      {
        out[i] += kernel[d] * (below[i] + above[i]);
      }
    }
  }
}

/// Convolves one row along itself; its ends are repeated.
void convolveRow(
  float* row, std::int64_t n, const std::vector<float>& kernel, std::vector<float>& padded)
{
  const auto radius = static_cast<std::int64_t>(kernel.size()) - 1;
  padded.resize(static_cast<std::size_t>(n + 2 * radius));
  float* const p = padded.data() + radius;
  std::fill(p - radius, p, row[0]);
  std::copy(row, row + n, p);
  std::fill(p + n, p + n + radius, row[n - 1]);
  for (std::int64_t i = 0; i < n; ++i)
  {
    row[i] = kernel[0] * p[i];
  }
  for (std::int64_t d = 1; d <= radius; ++d)
  {
    for (std::int64_t i = 0; i < n; ++i)
    {
      row[i] += kernel[d] * (p[i - d] + p[i + d]);
    }
  }
}

/// Inverse of the normal distribution function (Acklam's rational approximation, 1e-9 relative).
double probit(double p)
{
  constexpr double low = 0.02425;
  const auto tail = [](double q)
  {
    return (((((-7.784894002430293e-03 * q - 3.223964580411365e-01) * q - 2.400758277161838) * q -
               2.549732539343734) *
                q +
              4.374664141464968) *
               q +
             2.938163982698783) /
           ((((7.784695709041462e-03 * q + 3.224671290700398e-01) * q + 2.445134137142996) * q +
              3.754408661907416) *
               q +
             1.0);
  };
  if (p < low)
  {
    return tail(std::sqrt(-2.0 * std::log(p)));
  }
  if (p > 1.0 - low)
  {
    return -tail(std::sqrt(-2.0 * std::log(1.0 - p)));
  }
  const double q = p - 0.5;
  const double r = q * q;
  return (((((-3.969683028665376e+01 * r + 2.209460984245205e+02) * r - 2.759285104469687e+02) * r +
             1.383577518672690e+02) *
              r -
            3.066479806614716e+01) *
             r +
           2.506628277459239) *
         q /
         (((((-5.447609879822406e+01 * r + 1.615858368580409e+02) * r - 1.556989798598866e+02) * r +
             6.680131188771972e+01) *
              r -
            1.328068155288572e+01) *
             r +
           1.0);
}

/// Share of object in the Gaussian neighborhood of each voxel.
template <class Inside>
Result<Volume<float>> share(const Volume<std::uint8_t>* known, const Volume<float>* weight,
  const Box& box, const Double3& spacing, double sigma, Monitor& monitor, const Inside& inside)
{
  Volume<float> g(box, spacing);
  float* const data = g.Data.get();
  parallelFor(0, box.volume(), 65536,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        data[i] = inside(i) && (!known || known->Data[i]) ? 1.0f : 0.0f;
      }
    });
  const Status filtered = gaussian(g, sigma, monitor);
  if (!filtered)
  {
    return filtered;
  }
  if (weight)
  {
    parallelFor(0, box.volume(), 65536,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          data[i] /= std::max(weight->Data[i], 1e-4f);
        }
      });
  }
  return g;
}

std::vector<float> distances(
  const Volume<float>& shares, const std::vector<Vec3>& points, double sigma)
{
  std::vector<float> d(points.size());
  parallelFor(0, static_cast<std::int64_t>(points.size()), 1024,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        const double g = interpolate(shares.view(), points[i]);
        d[i] = static_cast<float>(sigma * probit(std::min(std::max(g, 1e-4), 1.0 - 1e-4)));
      }
    });
  return d;
}
} // namespace

Status gaussian(Volume<float>& image, double sigma, Monitor& monitor)
{
  const Int3& n = image.Extent.Size;
  const double unit = voxelLength(image.Spacing);
  float* const data = image.Data.get();
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto kernel = gaussianKernel(sigma * unit / image.Spacing[axis]);
    const auto body = [&](std::int64_t begin, std::int64_t end)
    {
      std::vector<float> buffer;
      for (std::int64_t k = begin; k < end; ++k)
      {
        if (axis == 0)
        {
          convolveRow(data + k * n[0], n[0], kernel, buffer);
        }
        else if (axis == 1)
        {
          convolve({data + k * n[0] * n[1], n[0], n[1], n[0]}, kernel, buffer);
        }
        else
        {
          convolve({data + k * n[0], n[0], n[2], n[0] * n[1]}, kernel, buffer);
        }
      }
    };
    SubMonitor part(monitor, axis / 3.0, (axis + 1) / 3.0);
    const std::int64_t tasks = axis == 0 ? n[1] * n[2] : axis == 1 ? n[2] : n[1];
    if (!monitoredFor(0, tasks, axis == 0 ? 16 : 1, part, body))
    {
      return Status::cancelled();
    }
  }
  return Status::ok();
}

double interpolate(const ImageView<const float>& image, const Vec3& at)
{
  std::int64_t low[3];
  double t[3];
  for (int a = 0; a < 3; ++a)
  {
    const double x = std::min(std::max(at[a], 0.0), static_cast<double>(image.Dims[a] - 1));
    low[a] = std::min(static_cast<std::int64_t>(x), std::max<std::int64_t>(image.Dims[a] - 2, 0));
    t[a] = x - static_cast<double>(low[a]);
  }
  double sum = 0.0;
  for (int c = 0; c < 8; ++c)
  {
    double w = 1.0;
    std::int64_t p[3];
    for (int a = 0; a < 3; ++a)
    {
      const int up = (c >> a) & 1;
      w *= up ? t[a] : 1.0 - t[a];
      p[a] = std::min(low[a] + up, image.Dims[a] - 1);
    }
    sum += w * image(p[0], p[1], p[2]);
  }
  return sum;
}

Result<std::vector<float>> smoothWallDistance(const Volume<std::uint8_t>& object,
  const Volume<std::uint8_t>* known, const std::vector<Vec3>& points, double sigma,
  Monitor& monitor)
{
  const Box& box = object.Extent;
  const Double3& spacing = object.Spacing;
  SubMonitor weighing(monitor, 0.0, 0.2);
  Result<Volume<float>> weight = Volume<float>();
  if (known)
  {
    weight =
      share(known, nullptr, box, spacing, sigma, weighing, [](std::int64_t) { return true; });
    if (!weight)
    {
      return weight.status();
    }
  }
  const Volume<float>* const w = known ? &*weight : nullptr;
  SubMonitor first(monitor, 0.2, 0.6);
  const auto rough = share(
    known, w, box, spacing, sigma, first, [&](std::int64_t i) { return object.Data[i] != 0; });
  if (!rough)
  {
    return rough.status();
  }
  std::vector<float> d = distances(*rough, points, sigma);
  SubMonitor second(monitor, 0.6, 1.0);
  const auto smooth = share(
    known, w, box, spacing, sigma, second, [&](std::int64_t i) { return rough->Data[i] > 0.5f; });
  if (!smooth)
  {
    return smooth.status();
  }
  const std::vector<float> again = distances(*smooth, points, sigma);
  for (std::size_t i = 0; i < d.size(); ++i)
  {
    d[i] -= std::min(std::max(again[i] - d[i], -2.0f), 2.0f);
  }
  return d;
}
} // namespace bsr
