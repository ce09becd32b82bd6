#include "Image/MaskOperations.h"

#include "Image/BallClosing.h"
#include "Image/DistanceTransform.h"

#include <algorithm>

namespace bsr
{
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

} // namespace bsr
