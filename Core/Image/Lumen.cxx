#include "Image/Lumen.h"

#include "Common/MonitoredLoop.h"
#include "Image/BallClosing.h"
#include "Image/DigitalTopology.h"
#include "Image/DistanceTransform.h"
#include "Image/LumenMouths.h"
#include "Image/MaskOperations.h"
#include "Image/Visibility.h"

#include <cmath>

namespace bsr
{
namespace
{
constexpr double SmallPore = 2.5;      ///< voxels: pores up to this radius are always sealed
constexpr std::uint8_t CoreOpen = 76;  ///< 0.30 of 255
constexpr std::uint8_t DeepOpen = 31;  ///< 0.12
constexpr std::uint8_t GrowOpen = 127; ///< 0.5
constexpr std::uint8_t GrowRing = 25;  ///< 0.1
constexpr double SmallestLumen = 3.5;  ///< voxels
constexpr double RidgeShare = 0.4;     ///< of the widest: lower ridges are the wall's roughness
constexpr double SealShare = 0.65;     ///< of the lumen's radius: the ball that seals holes
constexpr double GrowReach = 1.2;      ///< of the lumen's radius: towards the open ends
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

/// Median distance to the object over the ridge of the distance within a mask, where above
/// `least`.
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
} // namespace

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
  Mask lumen = maskWhere(near, [&](std::int64_t i)
    { return asked.Data[i] && near.Data[i] >= WithinObject && seen->Open.Data[i] < CoreOpen; });
  const auto widest = keepWideComponents(lumen, *seen, *distance, growing);
  if (!widest)
  {
    return widest.status();
  }
  result.LumenRadius = medianRidge(lumen, *distance, std::max(3.0, RidgeShare * *widest));
  result.Found = *widest >= SmallestLumen && result.LumenRadius > 0.0;
  result.PoreRadius =
    options.PoreRadius > 0.0 ? options.PoreRadius : std::max(small, SealShare * result.LumenRadius);
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
    const Status grown =
      grow(lumen, *wideSolid, asked, *seen, GrowReach * result.LumenRadius + CoreDepth, growing);
    if (!grown)
    {
      return grown;
    }
    const Mask faces = mouthFaces(lumen, *wideSolid);
    auto found = findMouths(lumen, *wideSolid, faces, result.LumenRadius, growing);
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
