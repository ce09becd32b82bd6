#include "Image/Lumen.h"

#include "Common/MonitoredLoop.h"
#include "Image/BallClosing.h"
#include "Image/DigitalTopology.h"
#include "Image/DistanceTransform.h"
#include "Image/Visibility.h"

#include <cmath>

namespace bsr
{
namespace
{
using Mask = Volume<std::uint8_t>;

constexpr double SmallPore = 2.5;      ///< voxels: pores up to this radius are always sealed
constexpr std::uint8_t CoreOpen = 76;  ///< 0.30 of 255
constexpr std::uint8_t DeepOpen = 31;  ///< 0.12
constexpr std::uint8_t GrowOpen = 127; ///< 0.5
constexpr std::uint8_t GrowRing = 25;  ///< 0.1
constexpr double SmallestLumen = 3.5;  ///< voxels
constexpr double RidgeShare = 0.4;     ///< of the widest: lower ridges are the wall's roughness
constexpr double SmallestMouth = 0.6;  ///< of the lumen's radius
constexpr double MouthDepth = 10.0;    ///< voxels
constexpr double HoleMargin = 1.0;     ///< voxels: how far the lumen reaches into its holes

/// For short steps between those with progress: passes on the wish to cancel only.
class CancelOnly : public Monitor
{
public:
  explicit CancelOnly(Monitor& parent) : Parent(parent) {}
  bool cancelled() override { return this->Parent.cancelled(); }

private:
  Monitor& Parent;
};

template <class Predicate>
Mask maskWhere(const Mask& like, const Predicate& predicate)
{
  Mask m(like.Extent, like.Spacing);
  std::uint8_t* const data = m.Data.get();
  parallelFor(0, like.Extent.volume(), 65536,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        data[i] = predicate(i) ? 1 : 0;
      }
    });
  return m;
}

/// Calls f(i) for the voxels of a run.
template <class F>
void eachVoxel(const LabeledRun& run, std::int64_t width, const F& f)
{
  for (std::int64_t i = run.Begin; i < run.End; ++i)
  {
    f(run.Row * width + i);
  }
}

/// Clears the components (6) of `mask` for which keep(component) is false.
template <class Keep>
void keepComponents(Mask& mask, const Components& components, const Keep& keep)
{
  for (const LabeledRun& run : components.Runs)
  {
    if (!keep(run.Label))
    {
      eachVoxel(run, mask.Extent.Size[0], [&](std::int64_t i) { mask.Data[i] = 0; });
    }
  }
}

/// The components whose deep part is at least half as wide as the widest; returns that width.
Result<double> keepWideComponents(
  Mask& core, const Visibility& seen, const Volume<float>& distance, Monitor& monitor)
{
  const auto parts = connectedComponents(core.view(), true, Connectivity::Six, monitor);
  if (!parts)
  {
    return parts.status();
  }
  std::vector<float> width(parts->Voxels.size(), 0.0f);
  for (const LabeledRun& run : parts->Runs)
  {
    eachVoxel(run, core.Extent.Size[0],
      [&](std::int64_t i)
      {
        if (seen.Open.Data[i] < DeepOpen)
        {
          width[run.Label] = std::max(width[run.Label], distance.Data[i]);
        }
      });
  }
  const float widest = width.empty() ? 0.0f : *std::max_element(width.begin(), width.end());
  keepComponents(
    core, *parts, [&](std::int64_t c) { return width[c] > 0.0f && width[c] >= 0.5f * widest; });
  return static_cast<double>(widest);
}

/// Median distance to the object over the ridge of the distance within a mask, where above `least`.
double medianRidge(const Mask& mask, const Volume<float>& distance, double least)
{
  const auto m = mask.view();
  const auto d = distance.view();
  const Int3& n = mask.Extent.Size;
  std::vector<float> ridge;
  for (std::int64_t k = 1; k + 1 < n[2]; ++k)
  {
    for (std::int64_t j = 1; j + 1 < n[1]; ++j)
    {
      for (std::int64_t i = 1; i + 1 < n[0]; ++i)
      {
        const float here = d(i, j, k);
        if (!m(i, j, k) || here <= least)
        {
          continue;
        }
        bool highest = true;
        for (int q = 0; q < 27 && highest; ++q)
        {
          highest = d(i + q % 3 - 1, j + q / 3 % 3 - 1, k + q / 9 - 1) <= here + 1e-6f;
        }
        if (highest)
        {
          ridge.push_back(here);
        }
      }
    }
  }
  if (ridge.empty())
  {
    return 0.0;
  }
  std::nth_element(ridge.begin(), ridge.begin() + ridge.size() / 2, ridge.end());
  return ridge[ridge.size() / 2];
}

/// Distance in voxels of the voxels that are zero in a mask; `bound` as in squaredDistance.
Result<Volume<float>> distanceTo(const Mask& mask, double bound, Monitor& monitor)
{
  DistanceOptions options;
  options.Bound = bound;
  options.Extent = Box{{0, 0, 0}, mask.Extent.Size};
  auto d = squaredDistance(mask.view(), options, monitor);
  if (d)
  {
    float* const data = d->Data.get();
    parallelFor(0, mask.Extent.volume(), 65536,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t i = begin; i < end; ++i)
        {
          data[i] = std::sqrt(data[i]);
        }
      });
    d->Extent = mask.Extent;
  }
  return d;
}

/// Adds to the lumen what can be reached towards its open ends.
Status grow(Mask& lumen, const Mask& wideSolid, const Mask& near, const Visibility& seen,
  double reachable, Monitor& monitor)
{
  const auto wide =
    maskWhere(lumen, [&](std::int64_t i) { return lumen.Data[i] != 0 && wideSolid.Data[i] == 0; });
  const auto within = dilated(wide, reachable, monitor);
  if (!within)
  {
    return within.status();
  }
  Mask grown = maskWhere(lumen,
    [&](std::int64_t i)
    {
      return wide.Data[i] || (within->Data[i] && near.Data[i] && !wideSolid.Data[i] &&
                               seen.Open.Data[i] < GrowOpen && seen.Ring.Data[i] <= GrowRing);
    });
  const auto parts = connectedComponents(grown.view(), true, Connectivity::Six, monitor);
  if (!parts)
  {
    return parts.status();
  }
  std::vector<char> touches(parts->Voxels.size(), 0);
  const std::int64_t width = lumen.Extent.Size[0];
  for (const LabeledRun& run : parts->Runs)
  {
    eachVoxel(run, width, [&](std::int64_t i) { touches[run.Label] |= wide.Data[i]; });
  }
  for (const LabeledRun& run : parts->Runs)
  {
    if (touches[run.Label])
    {
      eachVoxel(run, width, [&](std::int64_t i) { lumen.Data[i] = 1; });
    }
  }
  return Status::ok();
}

/// The parts (6) of the lumen that the sealing ball does not come near to and that touch the
/// outside.
Result<Mask> findHoles(
  const Mask& lumen, const Mask& solid, const Mask& wideSolid, Monitor& monitor)
{
  const auto wide =
    maskWhere(lumen, [&](std::int64_t i) { return lumen.Data[i] != 0 && wideSolid.Data[i] == 0; });
  const auto reached = dilated(wide, HoleMargin, monitor);
  if (!reached)
  {
    return reached.status();
  }
  Mask narrow =
    maskWhere(lumen, [&](std::int64_t i) { return lumen.Data[i] && !reached->Data[i]; });
  const auto parts = connectedComponents(narrow.view(), true, Connectivity::Six, monitor);
  if (!parts)
  {
    return parts.status();
  }
  const Int3& n = lumen.Extent.Size;
  const Int3 stride{1, n[0], n[0] * n[1]};
  const std::int64_t last = lumen.Extent.volume();
  const auto outside = [&](std::int64_t i)
  { return i >= 0 && i < last && !lumen.Data[i] && !solid.Data[i]; };
  std::vector<char> open(parts->Voxels.size(), 0);
  for (const LabeledRun& run : parts->Runs)
  {
    eachVoxel(run, n[0],
      [&](std::int64_t i)
      {
        for (int s = 0; s < 6; ++s)
        {
          open[run.Label] |= outside(i + (s < 3 ? stride[s] : -stride[s - 3]));
        }
      });
  }
  keepComponents(narrow, *parts, [&](std::int64_t c) { return open[c] != 0; });
  return narrow;
}

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

/// Outside voxels that touch the lumen at its open ends.
Mask mouthFaces(const Mask& lumen, const Mask& solid)
{
  Mask faces = maskWhere(lumen, [](std::int64_t) { return false; });
  eachMouthFace(
    lumen, solid, [&](const Int3&, std::int64_t next, int, int) { faces.Data[next] = 1; });
  return faces;
}

/// The open ends: parts of the interface of lumen and outside, by their vector area.
Result<std::vector<LumenMouth>> findMouths(
  const Mask& lumen, const Mask& solid, const Mask& faces, double smallest, Monitor& monitor)
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
    const double radius = std::sqrt(area / 3.14159265358979323846);
    if (area > 0.0 && radius >= smallest)
    {
      mouths.push_back({sum.Center / sum.Weight, sum.Area / area, radius});
    }
  }
  return mouths;
}
} // namespace

Result<Mask> dilated(const Mask& mask, double radius, Monitor& monitor)
{
  DistanceOptions options;
  options.Bound = radius;
  options.Extent = Box{{0, 0, 0}, mask.Extent.Size};
  const auto d = squaredDistance(mask.view(), options, monitor);
  if (!d)
  {
    return d.status();
  }
  const float limit = squaredLimit(radius);
  const float* const data = d->Data.get();
  return maskWhere(mask, [=](std::int64_t i) { return data[i] <= limit; });
}

Result<Mask> closed(const Mask& mask, double radius, Monitor& monitor)
{
  const auto box = closeByBall(mask.view(), radius, monitor);
  if (!box)
  {
    return box.status();
  }
  Mask out = maskWhere(mask, [](std::int64_t) { return false; });
  const Box& e = box->Extent;
  for (std::int64_t k = 0; k < e.Size[2]; ++k)
  {
    for (std::int64_t j = 0; j < e.Size[1]; ++j)
    {
      const std::uint8_t* const row = box->view().row(j, k);
      std::copy(row, row + e.Size[0], &out.view()(e.Lo[0], e.Lo[1] + j, e.Lo[2] + k));
    }
  }
  return out;
}

Result<LumenResult> findLumen(
  const Mask& object, const Mask& near, const LumenOptions& options, Monitor& monitor)
{
  SubMonitor sealing(monitor, 0.0, 0.15);
  const double small =
    options.PoreRadius > 0.0 ? std::min(SmallPore, options.PoreRadius) : SmallPore;
  const auto solid = closed(object, small, sealing);
  if (!solid)
  {
    return solid.status();
  }
  SubMonitor measuring(monitor, 0.15, 0.3);
  const auto distance = distanceTo(*solid, std::numeric_limits<double>::infinity(), measuring);
  if (!distance)
  {
    return distance.status();
  }
  const Mask asked =
    maskWhere(near, [&](std::int64_t i) { return near.Data[i] && !solid->Data[i]; });
  SubMonitor seeing(monitor, 0.3, 0.8);
  const auto seen = visibility(*distance, asked, seeing);
  if (!seen)
  {
    return seen.status();
  }
  CancelOnly growing(monitor);
  LumenResult result;
  Mask lumen =
    maskWhere(near, [&](std::int64_t i) { return asked.Data[i] && seen->Open.Data[i] < CoreOpen; });
  const auto widest = keepWideComponents(lumen, *seen, *distance, growing);
  if (!widest)
  {
    return widest.status();
  }
  result.LumenRadius = medianRidge(lumen, *distance, std::max(3.0, RidgeShare * *widest));
  result.Found = *widest >= SmallestLumen && result.LumenRadius > 0.0;
  result.PoreRadius =
    options.PoreRadius > 0.0 ? options.PoreRadius : std::max(small, 0.45 * result.LumenRadius);
  Mask mouth = maskWhere(near, [](std::int64_t) { return false; });
  Mask hole = maskWhere(near, [](std::int64_t) { return false; });
  if (result.Found)
  {
    SubMonitor wider(monitor, 0.8, 0.9);
    const auto wideSolid = closed(object, result.PoreRadius, wider);
    if (!wideSolid)
    {
      return wideSolid.status();
    }
    const Status grown = grow(lumen, *wideSolid, asked, *seen, result.LumenRadius, growing);
    if (!grown)
    {
      return grown;
    }
    const Mask faces = mouthFaces(lumen, *wideSolid);
    auto found = findMouths(lumen, *wideSolid, faces, SmallestMouth * result.LumenRadius, growing);
    if (!found)
    {
      return found.status();
    }
    result.Mouths = std::move(*found);
    auto before = dilated(faces, MouthDepth, growing);
    if (!before)
    {
      return before.status();
    }
    mouth = std::move(*before);
    auto holes = findHoles(lumen, *solid, *wideSolid, growing);
    if (!holes)
    {
      return holes.status();
    }
    hole = std::move(*holes);
  }
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  result.Label = Mask(object.Extent, object.Spacing);
  for (std::int64_t i = 0; i < object.Extent.volume(); ++i)
  {
    const VoidLabel label = object.Data[i]                  ? VoidLabel::Object
                            : solid->Data[i]                ? VoidLabel::Sealed
                            : hole.Data[i]                  ? VoidLabel::Hole
                            : result.Found && lumen.Data[i] ? VoidLabel::Lumen
                            : mouth.Data[i]                 ? VoidLabel::Mouth
                                                            : VoidLabel::Outside;
    result.Label.Data[i] = static_cast<std::uint8_t>(label);
  }
  monitor.progress(1.0);
  return result;
}
} // namespace bsr
