// The gray values of the fiber phantom.
#include "Common/CounterRandom.h"
#include "Common/MonitoredLoop.h"
#include "Image/FiberPhantom.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
enum Stream : std::uint64_t
{
  OuterRoughness = 20,
  InnerRoughness = 21,
  VoxelNoise = 22,
  RingNoise = 23
};

/// A block of voxels with float values.
struct Block
{
  std::array<int, 6> Extent{};
  std::array<std::int64_t, 3> Size{};
  std::vector<float> Values;

  explicit Block(const std::array<int, 6>& extent) : Extent(extent)
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Size[a] = extent[2 * a + 1] - extent[2 * a] + 1;
    }
    this->Values.resize(static_cast<std::size_t>(this->Size[0] * this->Size[1] * this->Size[2]));
  }
  std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const
  {
    return (k * this->Size[1] + j) * this->Size[0] + i;
  }
};

/// Covered share of a voxel whose center is `distance` voxels outside of a surface.
double coverage(double distance)
{
  return std::clamp(0.5 - distance, 0.0, 1.0);
}

class Renderer
{
public:
  explicit Renderer(const FiberPhantom& phantom)
      : Phantom(phantom), Options(phantom.Options), H(phantom.Shape.voxel())
  {
    this->Rough = this->Options.Roughness > 0.0;
  }

  /// Material of the wall and the defects in slices [first, last) of the block.
  void material(Block& box, std::int64_t first, std::int64_t last) const
  {
    for (std::int64_t k = first; k < last; ++k)
    {
      for (std::int64_t j = 0; j < box.Size[1]; ++j)
      {
        for (std::int64_t i = 0; i < box.Size[0]; ++i)
        {
          box.Values[static_cast<std::size_t>(box.index(i, j, k))] =
            this->wall(this->world(box, i, j, k));
        }
      }
    }
    for (const FiberDefect& d : this->Phantom.Defects)
    {
      this->stamp(d, box, first, last);
    }
  }

  std::uint16_t gray(double material, int i, int j, int k) const
  {
    const FiberPhantomOptions& o = this->Options;
    const double contrast = o.WallValue - o.AirValue;
    const double y = (j - 0.5 * (o.Dimensions[1] - 1)) * o.Spacing[1] / this->H;
    const double z = (k - 0.5 * (o.Dimensions[2] - 1)) * o.Spacing[2] / this->H;
    const double radius = std::hypot(y, z);
    const double edge = 0.5 * std::hypot(o.Dimensions[1] * o.Spacing[1] / this->H,
                                o.Dimensions[2] * o.Spacing[2] / this->H);
    double value = material * (1.0 - o.Shading * (1.0 - radius / edge));
    if (o.Rings > 0.0)
    {
      const double rms = std::sqrt(1.0 / 3.0) * 26.0 / 35.0; // of the noise on a lattice plane
      value += o.Rings / rms *
               latticeNoise(this->RingKey, Vec3(i * o.Spacing[0] / this->H / 12.0, radius, 0.0));
    }
    if (o.Noise > 0.0)
    {
      value += o.Noise * this->noise(i, j, k);
    }
    return static_cast<std::uint16_t>(
      std::lround(std::clamp(o.AirValue + contrast * value, 0.0, 65535.0)));
  }

private:
  Vec3 world(const Block& box, std::int64_t i, std::int64_t j, std::int64_t k) const
  {
    return {static_cast<double>(box.Extent[0] + i) * this->Options.Spacing[0],
      static_cast<double>(box.Extent[2] + j) * this->Options.Spacing[1],
      static_cast<double>(box.Extent[4] + k) * this->Options.Spacing[2]};
  }

  /// Roughness of three scales with a root mean square of 1.
  static double roughness(std::uint64_t key, const Vec3& voxels)
  {
    const double f = 0.55 * latticeNoise(key, voxels / 2.2) +
                     0.60 * latticeNoise(key + 1, voxels / 5.0) +
                     0.50 * latticeNoise(key + 2, voxels / 13.0);
    return f / 0.353;
  }

  float wall(const Vec3& p) const
  {
    const FiberPhantomOptions& o = this->Options;
    const double margin = (1.0 + 4.0 * o.Roughness) * this->H;
    const FiberShape::Local at = this->Phantom.Shape.at(p, margin);
    if (!at.Near || at.CutDistance > margin)
    {
      return 0.0F;
    }
    double out = at.OuterDistance / this->H;
    double in = at.InnerDistance / this->H;
    double cut = at.CutDistance / this->H;
    if (this->Rough && (std::abs(out) < margin / this->H || cut > -margin / this->H))
    {
      const double r = o.Roughness * roughness(this->OuterKey, p / this->H);
      out += r;
      cut += r;
    }
    if (this->Rough && std::abs(in) < margin / this->H)
    {
      in += o.Roughness * roughness(this->InnerKey, p / this->H);
    }
    return static_cast<float>(coverage(std::max({out, -in, cut})));
  }

  void stamp(const FiberDefect& d, Block& box, std::int64_t first, std::int64_t last) const
  {
    const Vec3 middle = d.middle();
    const double reach = d.reach() + this->H;
    std::int64_t low[3];
    std::int64_t high[3];
    for (int a = 0; a < 3; ++a)
    {
      const double h = this->Options.Spacing[a];
      const std::int64_t from = a == 2 ? first : 0;
      const std::int64_t to = a == 2 ? last : box.Size[a];
      low[a] = std::clamp<std::int64_t>(
        std::llround(std::floor((middle[a] - reach) / h)) - box.Extent[2 * a], from, to);
      high[a] = std::clamp<std::int64_t>(
        std::llround(std::ceil((middle[a] + reach) / h)) + 1 - box.Extent[2 * a], from, to);
    }
    for (std::int64_t k = low[2]; k < high[2]; ++k)
    {
      for (std::int64_t j = low[1]; j < high[1]; ++j)
      {
        for (std::int64_t i = low[0]; i < high[0]; ++i)
        {
          const double c = coverage(d.distance(this->world(box, i, j, k)) / this->H);
          float& v = box.Values[static_cast<std::size_t>(box.index(i, j, k))];
          v = d.Solid ? std::max(v, static_cast<float>(c * d.Value))
                      : static_cast<float>(v * (1.0 - c));
        }
      }
    }
  }

  /// Slightly correlated within the slice, as reconstruction leaves it; variance 1.
  double noise(int i, int j, int k) const
  {
    const auto at = [&](int di, int dj)
    { return normalOf(latticeBits(this->NoiseKey, i + di, j + dj, k)); };
    constexpr double side = 0.25;
    const double sum = at(0, 0) + side * (at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1));
    return sum / std::sqrt(1.0 + 4.0 * side * side);
  }

  std::uint64_t key(Stream stream) const
  {
    return CounterRandom(static_cast<std::uint64_t>(this->Options.Seed), stream).key();
  }

  const FiberPhantom& Phantom;
  const FiberPhantomOptions& Options;
  double H;
  bool Rough;
  std::uint64_t OuterKey = this->key(OuterRoughness);
  std::uint64_t InnerKey = this->key(InnerRoughness);
  std::uint64_t NoiseKey = this->key(VoxelNoise);
  std::uint64_t RingKey = this->key(RingNoise);
};

/// The blur's weights at offsets 0..n along an axis.
std::vector<float> gaussian(double sigma)
{
  std::vector<float> w(1, 1.0F);
  if (sigma > 0.0)
  {
    const int n = static_cast<int>(std::ceil(3.5 * sigma));
    std::vector<double> g;
    double total = 0.0;
    for (int i = 0; i <= n; ++i)
    {
      g.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
      total += (i == 0 ? 1.0 : 2.0) * g.back();
    }
    w.clear();
    for (const double v : g)
    {
      w.push_back(static_cast<float>(v / total));
    }
  }
  return w;
}

/// Blurs along an axis; the result is smaller by the kernel's reach at both ends of that axis.
bool blur(const Block& in, int axis, const std::vector<float>& kernel, Block& out, Monitor& monitor)
{
  const auto reach = static_cast<std::int64_t>(kernel.size()) - 1;
  const std::int64_t strides[3] = {1, in.Size[0], in.Size[0] * in.Size[1]};
  const std::int64_t stride = strides[axis];
  return monitoredFor(0, out.Size[2], 1, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t k = first; k < last; ++k)
      {
        for (std::int64_t j = 0; j < out.Size[1]; ++j)
        {
          const std::int64_t at = in.index(0, j, k) + reach * stride;
          float* const to = &out.Values[static_cast<std::size_t>(out.index(0, j, k))];
          const float* const from = &in.Values[static_cast<std::size_t>(at)];
          for (std::int64_t i = 0; i < out.Size[0]; ++i)
          {
            float sum = kernel[0] * from[i];
            for (std::int64_t r = 1; r <= reach; ++r)
            {
              sum +=
                kernel[static_cast<std::size_t>(r)] * (from[i - r * stride] + from[i + r * stride]);
            }
            to[i] = sum;
          }
        }
      }
    });
}
} // namespace

Result<std::vector<std::uint16_t>> fiberImage(
  const FiberPhantom& phantom, const std::array<int, 6>& extent, Monitor& monitor)
{
  const FiberPhantomOptions& o = phantom.Options;
  std::array<std::vector<float>, 3> kernels;
  std::array<int, 6> wide = extent;
  for (int a = 0; a < 3; ++a)
  {
    if (extent[2 * a] < 0 || extent[2 * a + 1] >= o.Dimensions[a] ||
        extent[2 * a] > extent[2 * a + 1])
    {
      return Status::invalidParameter("The requested extent is empty or outside of the image.");
    }
    kernels[a] = gaussian(o.Blur * phantom.Shape.voxel() / o.Spacing[a]);
    wide[2 * a] -= static_cast<int>(kernels[a].size()) - 1;
    wide[2 * a + 1] += static_cast<int>(kernels[a].size()) - 1;
  }
  const Renderer renderer(phantom);
  Block box(wide);
  SubMonitor drawing(monitor, 0.0, 0.8);
  bool going = monitoredFor(0, box.Size[2], 1, drawing,
    [&](std::int64_t first, std::int64_t last) { renderer.material(box, first, last); });
  for (int a = 0; going && a < 3; ++a)
  {
    wide[2 * a] = extent[2 * a];
    wide[2 * a + 1] = extent[2 * a + 1];
    Block next(wide);
    SubMonitor blurring(monitor, 0.8 + 0.04 * a, 0.84 + 0.04 * a);
    going = blur(box, a, kernels[a], next, blurring);
    box = std::move(next);
  }
  std::vector<std::uint16_t> values(going ? box.Values.size() : 0);
  SubMonitor graying(monitor, 0.92, 1.0);
  going = going && monitoredFor(0, box.Size[2], 1, graying,
                     [&](std::int64_t first, std::int64_t last)
                     {
                       for (std::int64_t n = first * box.Size[0] * box.Size[1];
                            n < last * box.Size[0] * box.Size[1]; ++n)
                       {
                         const std::int64_t row = n / box.Size[0];
                         values[static_cast<std::size_t>(n)] =
                           renderer.gray(box.Values[static_cast<std::size_t>(n)],
                             static_cast<int>(extent[0] + n % box.Size[0]),
                             static_cast<int>(extent[2] + row % box.Size[1]),
                             static_cast<int>(extent[4] + row / box.Size[1]));
                       }
                     });
  if (!going)
  {
    return Status::cancelled();
  }
  return values;
}
} // namespace bsr
