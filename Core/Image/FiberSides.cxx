#include "Image/FiberSides.h"

#include "Common/MonitoredLoop.h"
#include "Image/DigitalTopology.h"
#include "Image/DistanceTransform.h"
#include "Image/Lumen.h"
#include "Image/MaskOperations.h"
#include "Image/SmoothWall.h"
#include "Image/SurfaceVoxels.h"

#include <cmath>

namespace bsr
{
namespace
{
constexpr double OuterSigma = 4.5; ///< voxels: of the smooth walls
constexpr double InnerSigma = 3.0;
constexpr double OuterTolerance = 1.7;  ///< voxels from the smooth outer wall
constexpr double InnerTolerance = 1.12; ///< voxels from the smooth inner wall
constexpr double OuterShare = 0.7;      ///< of the pore radius: closes the outer wall
constexpr double SmallOpening = 2.5;    ///< voxels: what of the lumen is narrower is not wall
constexpr double Margin = 12.0;         ///< voxels around the closed object
constexpr double NearObject = 3.0;      ///< voxels around it where the void is looked at

/// Parts (26) of the object smaller than this share of the largest are debris.
constexpr double DebrisShare = 0.1;

Status checkInput(const TriangleMesh& surface, const ClosedObject& object)
{
  if (surface.Triangles.empty())
  {
    return Status::invalidInput("The surface has no triangles. Contour the raw image first.");
  }
  if (object.Mask.size() <= 0 || object.Mask.Dims != object.SignedDistance.Dims)
  {
    return Status::invalidInput(
      "The closed image is empty. Connect the output of the Closing filter as Closed Image.");
  }
  for (const Vec3& p : surface.Points)
  {
    if (!p.allFinite())
    {
      return Status::invalidInput("The surface has a point that is not finite. Clean it first.");
    }
  }
  for (std::int64_t i = 0; i < object.SignedDistance.size(); ++i)
  {
    if (std::isnan(object.SignedDistance.Data[i]))
    {
      return Status::invalidInput(
        "SignedDistance has a value that is not a number. Run the Closing filter again.");
    }
  }
  return Status::ok();
}

/// Copies what `from` (Box indices) holds of the image; `value(i)` elsewhere.
template <class F>
Mask cropped(const ClosedObject& object, const Box& box, const F& value)
{
  Mask m(box, object.Mask.Spacing);
  const Box image{{0, 0, 0}, object.Mask.Dims};
  parallelFor(0, box.Size[1] * box.Size[2], 64,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t row = begin; row < end; ++row)
      {
        const std::int64_t j = box.Lo[1] + row % box.Size[1];
        const std::int64_t k = box.Lo[2] + row / box.Size[1];
        for (std::int64_t i = 0; i < box.Size[0]; ++i)
        {
          const Int3 p{box.Lo[0] + i, j, k};
          m.Data[row * box.Size[0] + i] =
            image.contains(p) && value(object.Mask.index(p[0], j, k)) ? 1 : 0;
        }
      }
    });
  return m;
}

/// Where the void is looked at, as findLumen wants it.
Mask nearMask(const ClosedObject& object, const Box& box)
{
  const auto below = [&](double limit)
  {
    return cropped(object, box,
      [&](std::int64_t i) { return object.SignedDistance.Data[i] <= static_cast<float>(limit); });
  };
  Mask near = below(NearObject);
  const Mask within = below(-CoreDepth);
  for (std::int64_t i = 0; i < box.volume(); ++i)
  {
    near.Data[i] = within.Data[i] ? WithinObject : near.Data[i];
  }
  return near;
}

/// The raw object: what the surface encloses, within the closed object, without small parts.
Result<Mask> rawObject(const TriangleMesh& surface, const Mask& closedMask, Monitor& monitor)
{
  auto raw = voxelizeSurface(surface, closedMask.Extent, closedMask.Spacing, monitor);
  if (!raw)
  {
    return raw;
  }
  for (std::int64_t i = 0; i < closedMask.Extent.volume(); ++i)
  {
    raw->Data[i] &= closedMask.Data[i];
  }
  const auto parts = connectedComponents(raw->view(), true, Connectivity::TwentySix, monitor);
  if (!parts)
  {
    return parts.status();
  }
  if (parts->Voxels.empty())
  {
    return Status::invalidInput("The surface and the closed image do not overlap. Contour the "
                                "image that the Closing filter has as input.");
  }
  const double largest =
    static_cast<double>(*std::max_element(parts->Voxels.begin(), parts->Voxels.end()));
  for (const LabeledRun& run : parts->Runs)
  {
    if (static_cast<double>(parts->Voxels[run.Label]) < DebrisShare * largest)
    {
      std::uint8_t* const row = raw->Data.get() + run.Row * closedMask.Extent.Size[0];
      std::fill(row + run.Begin, row + run.End, std::uint8_t{0});
    }
  }
  return raw;
}

/// What of the lumen a small ball reaches, its open ends not counted as walls.
Result<Mask> smoothLumen(const Mask& label, Monitor& monitor)
{
  const std::int64_t n = label.Extent.volume();
  Mask m(label.Extent, label.Spacing);
  for (std::int64_t i = 0; i < n; ++i)
  {
    const auto l = static_cast<VoidLabel>(label.Data[i]);
    m.Data[i] = l == VoidLabel::Lumen || l == VoidLabel::Mouth;
  }
  Mask rest(label.Extent, label.Spacing);
  for (std::int64_t i = 0; i < n; ++i)
  {
    rest.Data[i] = !m.Data[i];
  }
  const auto eaten = dilated(rest, SmallOpening, monitor);
  if (!eaten)
  {
    return eaten.status();
  }
  for (std::int64_t i = 0; i < n; ++i)
  {
    rest.Data[i] = !eaten->Data[i];
  }
  auto opened = dilated(rest, SmallOpening, monitor);
  if (opened)
  {
    for (std::int64_t i = 0; i < n; ++i)
    {
      opened->Data[i] &= label.Data[i] == static_cast<std::uint8_t>(VoidLabel::Lumen);
    }
  }
  return opened;
}

/// The object with its lumen filled and its outer pits and holes closed by a ball.
Result<Mask> filledObject(const Mask& label, double radius, Monitor& monitor)
{
  Mask m(label.Extent, label.Spacing);
  for (std::int64_t i = 0; i < label.Extent.volume(); ++i)
  {
    const auto l = static_cast<VoidLabel>(label.Data[i]);
    m.Data[i] = l != VoidLabel::Outside && l != VoidLabel::Mouth;
  }
  return closed(m, radius, monitor);
}

/// Takes off the median of the small distances: the wall runs through the middle of its points.
void center(std::vector<float>& distance)
{
  for (int round = 0; round < 2; ++round)
  {
    std::vector<float> small;
    for (float d : distance)
    {
      if (std::abs(d) < 2.0f)
      {
        small.push_back(d);
      }
    }
    if (small.empty())
    {
      return;
    }
    std::nth_element(small.begin(), small.begin() + small.size() / 2, small.end());
    const float median = small[small.size() / 2];
    for (float& d : distance)
    {
      d -= median;
    }
  }
}

void assignSides(const std::vector<float>& outer, const std::vector<float>& inner, bool lumen,
  std::vector<std::uint8_t>& side)
{
  for (std::size_t i = 0; i < side.size(); ++i)
  {
    const double o = std::abs(outer[i]);
    const double n = lumen ? std::abs(inner[i]) : 1e9;
    FiberSide s = FiberSide::Neither;
    if (o < OuterTolerance && (n >= InnerTolerance || o <= n))
    {
      s = FiberSide::Outer;
    }
    else if (n < InnerTolerance)
    {
      s = FiberSide::Inner;
    }
    side[i] = static_cast<std::uint8_t>(s);
  }
}

/// The default method: label the void, smooth its walls, take the wall a point lies on.
Status sidesByVoid(const TriangleMesh& surface, const ClosedObject& object,
  const FiberSidesOptions& options, FiberSides& sides, Monitor& monitor)
{
  const Int3 margin = reach(Margin, object.Mask.Spacing);
  const Box box = boundingBox(object.Mask).padded({margin[0] + 1, margin[1] + 1, margin[2] + 1});
  Result<LumenResult> lumen = Status::ok();
  {
    const Mask closedMask =
      cropped(object, box, [&](std::int64_t i) { return object.Mask.Data[i] != 0; });
    SubMonitor voxelizing(monitor, 0.0, 0.1);
    const auto raw = rawObject(surface, closedMask, voxelizing);
    if (!raw)
    {
      return raw.status();
    }
    const Mask near = nearMask(object, box);
    SubMonitor finding(monitor, 0.1, 0.6);
    lumen = findLumen(*raw, near, LumenOptions{options.PoreRadius}, finding);
  }
  if (!lumen)
  {
    return lumen.status();
  }
  sides.Lumen = lumen->Found;
  sides.LumenRadius = lumen->Found ? lumen->LumenRadius : 0.0;
  sides.PoreRadius = lumen->PoreRadius;
  const Vec3 shift(
    static_cast<double>(box.Lo[0]), static_cast<double>(box.Lo[1]), static_cast<double>(box.Lo[2]));
  sides.Mouths = lumen->Mouths;
  for (LumenMouth& m : sides.Mouths)
  {
    m.Center += shift;
  }
  std::vector<Vec3> points(surface.Points.size());
  std::transform(surface.Points.begin(), surface.Points.end(), points.begin(),
    [&](const Vec3& p) { return Vec3(p - shift); });
  SubMonitor outerPart(monitor, 0.6, 0.75);
  const auto filled =
    filledObject(lumen->Label, std::max(SmallOpening, OuterShare * lumen->PoreRadius), outerPart);
  if (!filled)
  {
    return filled.status();
  }
  auto outer = smoothWallDistance(*filled, nullptr, points, OuterSigma, outerPart);
  if (!outer)
  {
    return outer.status();
  }
  center(*outer);
  std::vector<float> inner;
  if (lumen->Found)
  {
    SubMonitor innerPart(monitor, 0.75, 1.0);
    const auto opened = smoothLumen(lumen->Label, innerPart);
    if (!opened)
    {
      return opened.status();
    }
    for (std::int64_t i = 0; i < box.volume(); ++i) // from here on: the mask of known voxels
    {
      lumen->Label.Data[i] = lumen->Label.Data[i] != static_cast<std::uint8_t>(VoidLabel::Mouth);
    }
    auto wall = smoothWallDistance(*opened, &lumen->Label, points, InnerSigma, innerPart);
    if (!wall)
    {
      return wall.status();
    }
    inner = std::move(*wall);
    center(inner);
  }
  assignSides(*outer, inner, lumen->Found, sides.Side);
  return Status::ok();
}
} // namespace

double depthValley(const std::vector<float>& depth, double fallback)
{
  constexpr int bins = 400;
  constexpr double width = 0.25;
  std::vector<double> histogram(bins, 0.0);
  for (float d : depth)
  {
    const double b = std::min(std::max((d + 2.0) / width, 0.0), bins - 1.0);
    histogram[static_cast<int>(b)] += 1.0;
  }
  std::vector<double> smooth(bins, 0.0);
  for (int i = 0; i < bins; ++i)
  {
    for (int q = -4; q <= 4; ++q)
    {
      smooth[i] += histogram[std::min(std::max(i + q, 0), bins - 1)] * (5 - std::abs(q));
    }
  }
  const auto first =
    std::max_element(smooth.begin(), smooth.begin() + static_cast<int>(6.0 / width));
  double best = 0.0;
  int valley = -1;
  double lowest = *first;
  int at = static_cast<int>(first - smooth.begin());
  for (int i = at + 1; i < bins; ++i)
  {
    if (smooth[i] < lowest)
    {
      lowest = smooth[i];
      at = i;
    }
    if (smooth[i] - lowest > best)
    {
      best = smooth[i] - lowest;
      valley = at;
    }
  }
  const bool two = valley >= 0 && best > 0.02 * *first;
  return two ? (valley + 0.5) * width - 2.0 : fallback;
}

Result<FiberSides> classifySides(const TriangleMesh& surface, const ClosedObject& object,
  const FiberSidesOptions& options, Monitor& monitor)
{
  if (!(options.DepthThreshold >= 0.0) || !(options.PoreRadius >= 0.0) ||
      options.PoreRadius > 1e4 || options.DepthThreshold > 1e6)
  {
    return Status::invalidParameter(
      "Depth threshold and pore radius must be lengths in voxels, not negative.");
  }
  const Status checked = checkInput(surface, object);
  if (!checked)
  {
    return checked;
  }
  FiberSides sides;
  sides.Depth.resize(surface.Points.size());
  sides.Side.assign(surface.Points.size(), static_cast<std::uint8_t>(FiberSide::Neither));
  parallelFor(0, static_cast<std::int64_t>(surface.Points.size()), 4096,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        sides.Depth[i] = static_cast<float>(-interpolate(object.SignedDistance, surface.Points[i]));
      }
    });
  sides.DepthThreshold = options.AutoDepthThreshold
                           ? depthValley(sides.Depth, options.DepthThreshold)
                           : options.DepthThreshold;
  if (boundingBox(object.Mask).empty())
  {
    return Status::invalidInput("The closed image has no object. Check the threshold of Closing.");
  }
  if (options.ByDepth)
  {
    for (std::size_t i = 0; i < sides.Side.size(); ++i)
    {
      sides.Side[i] = sides.Depth[i] > sides.DepthThreshold ? 1 : 0;
      sides.Lumen = sides.Lumen || sides.Side[i] == 1;
    }
    return sides;
  }
  const Status done = sidesByVoid(surface, object, options, sides, monitor);
  if (!done)
  {
    return done;
  }
  monitor.progress(1.0);
  return sides;
}
} // namespace bsr
