#pragma once

#include "Common/Monitor.h"
#include "Common/Parallel.h"
#include "Common/Status.h"
#include "Image/DigitalTopology.h"
#include "Image/ImageView.h"

#include <cstdint>

namespace bsr
{
using Mask = Volume<std::uint8_t>;

/// A mask on the extent of `like`: 1 where predicate(voxel) holds.
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

/// Voxels within `radius` voxels of voxels nonzero in a mask, on its extent.
Result<Mask> dilated(const Mask& mask, double radius, Monitor& monitor);

/// closeByBall on the mask's own extent.
Result<Mask> closed(const Mask& mask, double radius, Monitor& monitor);
} // namespace bsr
