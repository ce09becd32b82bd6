#include "Image/ClosedDistance.h"

#include "Common/MonitoredLoop.h"
#include "Image/CrossingDistance.h"
#include "Image/DigitalTopology.h"
#include "Image/ScalarTypes.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Calls f(p, i) for the voxels of a box in parallel rows; p: absolute index, i: index in the box.
template <class F>
void forRows(const Box& box, const F& f)
{
  parallelFor(0, box.Size[1] * box.Size[2], 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t r = begin; r < end; ++r)
      {
        f(Int3{{box.Lo[0], box.Lo[1] + r % box.Size[1], box.Lo[2] + r / box.Size[1]}},
          r * box.Size[0]);
      }
    });
}

/// The row of `box` at (y, z), or -1: offset of its first element.
std::int64_t rowOffset(const Box& box, std::int64_t y, std::int64_t z)
{
  const std::int64_t j = y - box.Lo[1];
  const std::int64_t k = z - box.Lo[2];
  return j < 0 || k < 0 || j >= box.Size[1] || k >= box.Size[2]
           ? -1
           : (j + k * box.Size[1]) * box.Size[0];
}

/// Signed values of `magnitude` (in place): negative where `field` is.
void copySign(Volume<float>& magnitude, const Volume<float>& field)
{
  const Box& box = magnitude.Extent;
  const Box& inner = field.Extent;
  forRows(box,
    [&](const Int3& p, std::int64_t i)
    {
      const std::int64_t row = rowOffset(inner, p[1], p[2]);
      const std::int64_t shift = inner.Lo[0] - box.Lo[0];
      const std::int64_t begin = std::max<std::int64_t>(0, shift);
      const std::int64_t end = std::min(box.Size[0], shift + inner.Size[0]);
      for (std::int64_t x = begin; row >= 0 && x < end; ++x)
      {
        if (field.Data[row + x - shift] < 0.0f)
        {
          magnitude.Data[i + x] = -magnitude.Data[i + x];
        }
      }
    });
}

DistanceOptions within(const Box& field, const Box& wanted, double bound)
{
  DistanceOptions o;
  o.Bound = bound;
  o.Extent = wanted;
  for (int a = 0; a < 3; ++a)
  {
    o.Extent.Lo[a] -= field.Lo[a];
  }
  return o;
}

/// Unsigned distance to the zero level of `field` on a box of image indices, then signed.
Result<Volume<float>> signedCrossingDistance(
  const Volume<float>& field, const Box& extent, double bound, Monitor& monitor)
{
  auto d = crossingDistance(field.view(), within(field.Extent, extent, bound), monitor);
  if (d)
  {
    d->Extent = extent;
    copySign(*d, field);
  }
  return d;
}

/**
 * Next to the zero level of a field the distance to its crossing points is coarse; the plane
 * through the crossings along the three axes is better: 1 / sqrt(1/a^2 + 1/b^2 + 1/c^2).
 */
void planesNextToSurface(const Volume<float>& field, Volume<float>& distance)
{
  const ImageView<const float> f = field.view();
  const Box inner = field.Extent.padded({{-1, -1, -1}});
  const double unit = voxelLength(field.Spacing);
  const Int3 step{{1, f.Dims[0], f.Dims[0] * f.Dims[1]}};
  forRows(inner,
    [&](const Int3& p, std::int64_t)
    {
      const std::int64_t row = rowOffset(field.Extent, p[1], p[2]) + 1;
      const std::int64_t out =
        rowOffset(distance.Extent, p[1], p[2]) + p[0] - distance.Extent.Lo[0];
      for (std::int64_t x = 0; x < inner.Size[0]; ++x)
      {
        const float a = f.Data[row + x];
        double sum = 0.0;
        for (int axis = 0; axis < 3; ++axis)
        {
          double t = 2.0;
          for (const std::int64_t o : {-step[axis], step[axis]})
          {
            const float b = f.Data[row + x + o];
            t = (a < 0.0f) != (b < 0.0f) ? std::min(t, static_cast<double>(a / (a - b))) : t;
          }
          t = std::max(t, 1e-3) * field.Spacing[axis] / unit;
          sum += t < 1.5 * field.Spacing[axis] / unit ? 1.0 / (t * t) : 0.0;
        }
        if (sum > 0.0)
        {
          distance.Data[out + x] = std::copysign(static_cast<float>(1.0 / std::sqrt(sum)), a);
        }
      }
    });
}
} // namespace

template <class T>
Volume<float> objectField(
  const ImageView<const T>& image, double iso, const Volume<std::uint8_t>& object)
{
  Volume<float> field(object.Extent.padded({{1, 1, 1}}), image.Spacing);
  const float tiny = static_cast<float>(std::max(1e-3, 1e-6 * std::abs(iso)));
  const auto clamp = [&image](std::int64_t i, int a)
  { return std::min(std::max<std::int64_t>(i, 0), image.Dims[a] - 1); };
  forRows(field.Extent,
    [&](const Int3& p, std::int64_t i)
    {
      const T* const gray = image.row(clamp(p[1], 1), clamp(p[2], 2));
      const std::int64_t row = rowOffset(object.Extent, p[1], p[2]);
      for (std::int64_t x = 0; x < field.Extent.Size[0]; ++x)
      {
        const bool edge = x == 0 || x + 1 == field.Extent.Size[0] || row < 0;
        const bool inside = !edge && object.Data[row + x - 1] != 0;
        const double v = iso - static_cast<double>(gray[clamp(p[0] + x, 0)]);
        const float size = static_cast<float>(std::abs(v)) + tiny;
        field.Data[i + x] = inside ? -size : size;
      }
    });
  return field;
}

Result<Volume<float>> closedDistance(
  Volume<float> field, double radius, const Box& extent, Monitor& monitor)
{
  if (!(radius >= 0.0) || !std::isfinite(radius))
  {
    return Status::invalidParameter("The closing radius must be a number >= 0 (in voxels).");
  }
  if (radius < 1.0)
  {
    auto d =
      signedCrossingDistance(field, extent, std::numeric_limits<double>::infinity(), monitor);
    if (d)
    {
      planesNextToSurface(field, *d);
    }
    return d;
  }
  SubMonitor first(monitor, 0.0, 0.4);
  SubMonitor second(monitor, 0.4, 1.0);
  Int3 halo = reach(radius, field.Spacing);
  for (auto& h : halo)
  {
    h += 2;
  }
  auto dilation = signedCrossingDistance(field, field.Extent.padded(halo), radius + 2.0, first);
  if (!dilation)
  {
    return dilation.status();
  }
  field = Volume<float>(); // memory for the second transform
  const auto r = static_cast<float>(radius);
  parallelFor(0, dilation->Extent.volume(), std::int64_t{1} << 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        dilation->Data[i] = std::min(dilation->Data[i] - r, 2.0f);
      }
    });
  auto d =
    signedCrossingDistance(*dilation, extent, std::numeric_limits<double>::infinity(), second);
  if (d)
  {
    parallelFor(0, d->Extent.volume(), std::int64_t{1} << 16,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          d->Data[i] += r;
        }
      });
  }
  return d;
}

namespace
{
/// Changes the sign of the components of the inside (outside) whose runs never satisfy `keep`.
template <class Keep>
std::int64_t flip(Volume<float>& distance, const Components& parts, const Keep& keep)
{
  std::vector<char> kept(parts.Voxels.size(), 0);
  const std::int64_t nx = distance.Extent.Size[0];
  for (const LabeledRun& r : parts.Runs)
  {
    for (std::int64_t x = r.Begin; x < r.End && !kept[r.Label]; ++x)
    {
      kept[r.Label] = keep(r.Row * nx + x) ? 1 : 0;
    }
  }
  for (const LabeledRun& r : parts.Runs)
  {
    for (std::int64_t x = r.Begin; x < r.End && !kept[r.Label]; ++x)
    {
      float& d = distance.Data[r.Row * nx + x];
      d = d < 0.0f ? std::max(-d, 1e-3f) : std::min(-d, -1e-3f);
    }
  }
  return std::count(kept.begin(), kept.end(), 0);
}
} // namespace

Result<std::int64_t> removeStrayParts(
  Volume<float>& distance, const Volume<std::uint8_t>& closed, Monitor& monitor)
{
  std::int64_t changed = 0;
  for (const bool inside : {true, false})
  {
    Volume<std::uint8_t> mask(distance.Extent, distance.Spacing);
    parallelFor(0, distance.Extent.volume(), std::int64_t{1} << 16,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          mask.Data[i] = distance.Data[i] < 0.0f ? 1 : 0;
        }
      });
    const auto parts = connectedComponents(
      mask.view(), inside, inside ? Connectivity::TwentySix : Connectivity::Six, monitor);
    if (!parts)
    {
      return parts.status();
    }
    changed +=
      flip(distance, *parts, [&](std::int64_t i) { return (closed.Data[i] != 0) == inside; });
  }
  return changed;
}

#define BSR_INSTANTIATE(T)                                                                         \
  template Volume<float> objectField<T>(                                                           \
    const ImageView<const T>&, double, const Volume<std::uint8_t>&);
BSR_FOR_EACH_SCALAR_TYPE(BSR_INSTANTIATE)
#undef BSR_INSTANTIATE
} // namespace bsr
