#include "Image/BallClosing.h"

#include "Common/MonitoredLoop.h"
#include "Image/DistanceTransform.h"

#include <cmath>

namespace bsr
{
namespace
{
/// Mask of the distances up to (or beyond) a limit.
Volume<std::uint8_t> compare(const Volume<float>& squared, float limit, bool within)
{
  Volume<std::uint8_t> mask(squared.Extent, squared.Spacing);
  parallelFor(0, squared.Extent.volume(), std::int64_t{1} << 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        mask.Data[i] = (squared.Data[i] <= limit) == within ? 1 : 0;
      }
    });
  return mask;
}
} // namespace

Result<Volume<std::uint8_t>> closeByBall(
  const ImageView<const std::uint8_t>& mask, double radius, Monitor& monitor)
{
  if (!(radius >= 0.0) || !std::isfinite(radius))
  {
    return Status::invalidParameter("The closing radius must be a number >= 0 (in voxels).");
  }
  if (mask.size() <= 0)
  {
    return Status::invalidInput("The image is empty.");
  }
  const Box object = boundingBox(mask);
  if (object.empty())
  {
    return Status::invalidInput("There is no object to close: the mask has no voxel set.");
  }
  const float limit = squaredLimit(radius);
  SubMonitor dilation(monitor, 0.0, 0.5);
  SubMonitor erosion(monitor, 0.5, 1.0);

  DistanceOptions out;
  out.Bound = radius;
  out.Extent = object.padded(reach(radius, mask.Spacing));
  Volume<std::uint8_t> dilated;
  {
    auto distance = squaredDistance(mask, out, dilation);
    if (!distance)
    {
      return distance.status();
    }
    dilated = compare(*distance, limit, true);
  }
  DistanceOptions back;
  back.ToZeros = true;
  back.Bound = radius;
  back.Extent = object;
  for (int a = 0; a < 3; ++a)
  {
    back.Extent.Lo[a] -= dilated.Extent.Lo[a];
  }
  auto distance = squaredDistance(dilated.view(), back, erosion);
  if (!distance)
  {
    return distance.status();
  }
  dilated = Volume<std::uint8_t>();
  Volume<std::uint8_t> closed = compare(*distance, limit, false);
  closed.Extent = object;
  return closed;
}
} // namespace bsr
