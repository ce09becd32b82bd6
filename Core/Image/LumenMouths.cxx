#include "Image/LumenMouths.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double SmallestMouth = 0.6;  ///< of the lumen's radius
constexpr double Behind = 3.0;         ///< radii: of the lumen that is looked at
constexpr double LeastDepth = 1.15;    ///< of the lumen's middle there, in its spread across
constexpr double LeastCosine = 0.5;    ///< between mouth and the direction from there
constexpr double SmallestOfEnds = 0.5; ///< of the widest end's radius

/// Calls f(voxel, neighbor, axis, direction) where a voxel of the lumen touches one of the outside.
template <class F>
void eachMouthFace(const Mask& lumen, const Mask& solid, const F& f)
{
  const Int3& n = lumen.Extent.Size;
  const Int3 stride{1, n[0], n[0] * n[1]};
  const auto inner = [&](std::int64_t i) { return lumen.Data[i] && !solid.Data[i]; };
  const auto outer = [&](std::int64_t i) { return !lumen.Data[i] && !solid.Data[i]; };
  for (std::int64_t k = 1; k + 1 < n[2]; ++k)
  {
    for (std::int64_t j = 1; j + 1 < n[1]; ++j)
    {
      for (std::int64_t i = 1; i + 1 < n[0]; ++i)
      {
        const std::int64_t at = lumen.view().index(i, j, k);
        for (int s = 0; s < 6 && inner(at); ++s)
        {
          const int way = s < 3 ? 1 : -1;
          const std::int64_t next = at + way * stride[s % 3];
          if (outer(next))
          {
            f(Int3{i, j, k}, next, s % 3, way);
          }
        }
      }
    }
  }
}

/// Calls f(offset) for the lumen's voxels within `distance` voxels of a mouth; offsets in voxels.
template <class F>
void eachBehind(const Mask& lumen, const LumenMouth& mouth, double distance, const F& f)
{
  const Int3& n = lumen.Extent.Size;
  const Int3 r = reach(distance, lumen.Spacing);
  const double unit = voxelLength(lumen.Spacing);
  const Vec3 scale(lumen.Spacing[0] / unit, lumen.Spacing[1] / unit, lumen.Spacing[2] / unit);
  Int3 lo{};
  Int3 hi{};
  for (int a = 0; a < 3; ++a)
  {
    const auto c = static_cast<std::int64_t>(std::lround(mouth.Center[a]));
    lo[a] = std::max<std::int64_t>(0, c - r[a]);
    hi[a] = std::min(n[a], c + r[a] + 1);
  }
  for (std::int64_t k = lo[2]; k < hi[2]; ++k)
  {
    for (std::int64_t j = lo[1]; j < hi[1]; ++j)
    {
      for (std::int64_t i = lo[0]; i < hi[0]; ++i)
      {
        const Vec3 p(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const Vec3 d = (p - mouth.Center).cwiseProduct(scale);
        if (lumen.view()(i, j, k) && d.squaredNorm() <= distance * distance)
        {
          f(d);
        }
      }
    }
  }
}

/// Whether the lumen lies behind a mouth, rather than passes by.
bool isEnd(const Mask& lumen, const LumenMouth& mouth, double distance)
{
  double count = 0.0;
  double square = 0.0;
  Vec3 mean = Vec3::Zero();
  eachBehind(lumen, mouth, distance,
    [&](const Vec3& d)
    {
      count += 1.0;
      mean += d;
      square += d.squaredNorm();
    });
  mean /= std::max(count, 1.0);
  const double depth = mean.norm();
  if (count == 0.0 || -mean.dot(mouth.Direction) < LeastCosine * depth)
  {
    return false;
  }
  double along = 0.0;
  eachBehind(
    lumen, mouth, distance, [&](const Vec3& d) { along += std::pow(d.dot(mean) / depth, 2.0); });
  const double spread = std::sqrt(std::max((square - along) / count, 1.0));
  return depth >= LeastDepth * spread;
}
} // namespace

Mask mouthFaces(const Mask& lumen, const Mask& solid)
{
  Mask faces = maskWhere(lumen, [](std::int64_t) { return false; });
  eachMouthFace(
    lumen, solid, [&](const Int3&, std::int64_t next, int, int) { faces.Data[next] = 1; });
  return faces;
}

Result<std::vector<LumenMouth>> findMouths(
  const Mask& lumen, const Mask& solid, const Mask& faces, double radius, Monitor& monitor)
{
  const auto wider = dilated(faces, 2.0, monitor);
  if (!wider)
  {
    return wider.status();
  }
  const auto parts = connectedComponents(wider->view(), true, Connectivity::TwentySix, monitor);
  if (!parts)
  {
    return parts.status();
  }
  std::vector<std::int32_t> part(static_cast<std::size_t>(lumen.Extent.volume()), -1);
  for (const LabeledRun& run : parts->Runs)
  {
    eachVoxel(run, lumen.Extent.Size[0],
      [&](std::int64_t i) { part[i] = static_cast<std::int32_t>(run.Label); });
  }
  struct Sum
  {
    Vec3 Area = Vec3::Zero();
    Vec3 Center = Vec3::Zero();
    double Weight = 0.0;
  };
  std::vector<Sum> sums(parts->Voxels.size());
  const Double3& h = lumen.Spacing;
  const double unit = voxelLength(h);
  eachMouthFace(lumen, solid,
    [&](const Int3& at, std::int64_t next, int axis, int way)
    {
      Sum& sum = sums[part[next]];
      const double area = h[(axis + 1) % 3] * h[(axis + 2) % 3] / (unit * unit);
      Vec3 p(static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2]));
      p[axis] += 0.5 * way;
      sum.Area[axis] += way * area;
      sum.Center += area * p;
      sum.Weight += area;
    });
  std::vector<LumenMouth> mouths;
  for (const Sum& sum : sums)
  {
    const double area = sum.Area.norm();
    const double mouthRadius = std::sqrt(area / 3.14159265358979323846);
    const LumenMouth mouth{sum.Center / sum.Weight, sum.Area / area, mouthRadius};
    if (area > 0.0 && mouthRadius >= SmallestMouth * radius &&
        isEnd(lumen, mouth, Behind * std::max(mouthRadius, radius)))
    {
      mouths.push_back(mouth);
    }
  }
  double widest = 0.0;
  for (const LumenMouth& m : mouths)
  {
    widest = std::max(widest, m.Radius);
  }
  mouths.erase(std::remove_if(mouths.begin(), mouths.end(),
                 [&](const LumenMouth& m) { return m.Radius < SmallestOfEnds * widest; }),
    mouths.end());
  return mouths;
}
} // namespace bsr
