#include "Image/Visibility.h"

#include "Common/MonitoredLoop.h"

#include <array>
#include <bitset>
#include <cmath>

namespace bsr
{
namespace
{
constexpr int Rays = 64;
constexpr int Planes = 64;
constexpr double GoldenAngle = 2.399963229728653;
/// Directions belong to a plane when their sine with it is below this.
constexpr double PlaneSine = 0.25;
/// Steps of a stored free distance to a voxel.
constexpr int FreeUnit = 4;

Double3 spiral(double z, int k)
{
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(k * GoldenAngle), r * std::sin(k * GoldenAngle), z};
}

/// 32 directions of a half sphere and their opposites.
std::array<Double3, Rays> rayDirections()
{
  std::array<Double3, Rays> d;
  for (int k = 0; k < Rays / 2; ++k)
  {
    d[k] = spiral(1.0 - (2 * k + 1.0) / Rays, k);
    d[k + Rays / 2] = {-d[k][0], -d[k][1], -d[k][2]};
  }
  return d;
}

int count(std::uint64_t bits)
{
  return static_cast<int>(std::bitset<64>(bits).count());
}

class RayCaster
{
public:
  explicit RayCaster(const Volume<float>& distance)
      : Distance(distance.view()), Free(distance.Extent, distance.Spacing)
  {
    parallelFor(0, distance.Extent.volume(), 65536,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          this->Free.Data[i] =
            static_cast<std::uint8_t>(std::min(distance.Data[i] * FreeUnit, 255.0f));
        }
      });
    for (int d = 0; d < 256; ++d)
    {
      this->Advance[d] = std::max(0.6f, static_cast<float>(d) / FreeUnit - 0.7f);
    }
    for (int a = 0; a < 3; ++a)
    {
      this->Size[a] = static_cast<float>(distance.Extent.Size[a]);
    }
    this->StrideY = distance.Extent.Size[0];
    this->StrideZ = distance.Extent.Size[0] * distance.Extent.Size[1];
    const auto directions = rayDirections();
    const double unit = voxelLength(distance.Spacing);
    for (int k = 0; k < Rays; ++k)
    {
      for (int a = 0; a < 3; ++a)
      {
        this->Steps[k][a] = static_cast<float>(directions[k][a] * unit / distance.Spacing[a]);
      }
    }
    for (int p = 0; p < Planes; ++p)
    {
      const Double3 n = spiral(1.0 - (p + 0.5) / Planes, p);
      for (int k = 0; k < Rays; ++k)
      {
        const Double3& d = directions[k];
        if (std::abs(n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) < PlaneSine)
        {
          this->Masks[p] |= std::uint64_t{1} << k;
        }
      }
      this->Sizes[p] = count(this->Masks[p]);
    }
  }

  /// Bits of the rays that leave the image.
  std::uint64_t escaping(const Int3& from) const
  {
    std::uint64_t bits = 0;
    const float start =
      std::max(0.6f, this->Distance(from[0], from[1], from[2]) - 0.5f); // free of the object
    for (int k = 0; k < Rays; ++k)
    {
      bits |= std::uint64_t{this->escapes(from, this->Steps[k], start)} << k;
    }
    return bits;
  }

  std::uint8_t ring(std::uint64_t bits) const
  {
    int least = 255;
    for (int p = 0; p < Planes; ++p)
    {
      least = std::min(least, count(bits & this->Masks[p]) * 255 / this->Sizes[p]);
    }
    return static_cast<std::uint8_t>(least);
  }

private:
  bool escapes(const Int3& from, const std::array<float, 3>& step, float t) const
  {
    const float x0 = static_cast<float>(from[0]) + 0.5f;
    const float y0 = static_cast<float>(from[1]) + 0.5f;
    const float z0 = static_cast<float>(from[2]) + 0.5f;
    for (;;)
    {
      const float x = x0 + t * step[0];
      const float y = y0 + t * step[1];
      const float z = z0 + t * step[2];
      if (!(x >= 0.0f && y >= 0.0f && z >= 0.0f && x < this->Size[0] && y < this->Size[1] &&
            z < this->Size[2]))
      {
        return true;
      }
      const std::uint8_t d =
        this->Free.Data[static_cast<int>(x) + this->StrideY * static_cast<int>(y) +
                        this->StrideZ * static_cast<int>(z)];
      if (d < FreeUnit / 2)
      {
        return false;
      }
      t += this->Advance[d];
    }
  }

  ImageView<const float> Distance;
  Volume<std::uint8_t> Free; ///< Distance in quarters of a voxel, rounded down: fits the cache
  std::array<float, 256> Advance{};
  std::array<float, 3> Size{};
  std::int64_t StrideY = 0;
  std::int64_t StrideZ = 0;
  std::array<std::array<float, 3>, Rays> Steps{};
  std::array<std::uint64_t, Planes> Masks{};
  std::array<int, Planes> Sizes{};
};
} // namespace

Result<Visibility> visibility(
  const Volume<float>& distance, const Volume<std::uint8_t>& where, Monitor& monitor)
{
  const Box& box = distance.Extent;
  Visibility v{{box, distance.Spacing}, {box, distance.Spacing}};
  std::fill(v.Open.Data.get(), v.Open.Data.get() + box.volume(), std::uint8_t{255});
  std::fill(v.Ring.Data.get(), v.Ring.Data.get() + box.volume(), std::uint8_t{255});
  const RayCaster caster(distance);
  const auto d = distance.view();
  const auto asked = where.view();
  const auto open = v.Open.view();
  const auto ring = v.Ring.view();
  const Int3& n = box.Size;
  const Int3 cells{(n[0] + 1) / 2, (n[1] + 1) / 2, (n[2] + 1) / 2};
  const auto cell = [&](std::int64_t ci, std::int64_t cj, std::int64_t ck)
  {
    Int3 best{-1, 0, 0};
    float deepest = -1.0f;
    const auto each = [&](const auto& f)
    {
      for (std::int64_t k = 2 * ck; k < std::min(2 * ck + 2, n[2]); ++k)
      {
        for (std::int64_t j = 2 * cj; j < std::min(2 * cj + 2, n[1]); ++j)
        {
          for (std::int64_t i = 2 * ci; i < std::min(2 * ci + 2, n[0]); ++i)
          {
            if (asked(i, j, k))
            {
              f(i, j, k);
            }
          }
        }
      }
    };
    each(
      [&](std::int64_t i, std::int64_t j, std::int64_t k)
      {
        if (d(i, j, k) > deepest)
        {
          deepest = d(i, j, k);
          best = {i, j, k};
        }
      });
    if (best[0] < 0)
    {
      return;
    }
    const std::uint64_t bits = caster.escaping(best);
    const auto share = static_cast<std::uint8_t>(count(bits) * 255 / Rays);
    const std::uint8_t least = caster.ring(bits);
    each(
      [&](std::int64_t i, std::int64_t j, std::int64_t k)
      {
        open(i, j, k) = share;
        ring(i, j, k) = least;
      });
  };
  const bool done = monitoredFor(0, cells[1] * cells[2], 4, monitor,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t row = begin; row < end; ++row)
      {
        for (std::int64_t ci = 0; ci < cells[0]; ++ci)
        {
          cell(ci, row % cells[1], row / cells[1]);
        }
      }
    });
  if (!done)
  {
    return Status::cancelled();
  }
  return v;
}
} // namespace bsr
