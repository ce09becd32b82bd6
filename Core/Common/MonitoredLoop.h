#pragma once

#include "Common/Monitor.h"
#include "Common/Parallel.h"

#include <algorithm>
#include <cstdint>

namespace bsr
{
/**
 * parallelFor in portions, with progress (from..to of the monitor) and a look at the cancel flag
 * between them. Returns false when cancelled; the work is then incomplete.
 */
template <class Body>
bool monitoredFor(
  std::int64_t begin, std::int64_t end, std::int64_t grain, Monitor& monitor, const Body& body)
{
  const std::int64_t portion =
    std::max<std::int64_t>({(end - begin + 63) / 64, 4 * grain, std::int64_t{1}});
  for (std::int64_t at = begin; at < end; at += portion)
  {
    if (monitor.cancelled())
    {
      return false;
    }
    const std::int64_t stop = std::min(end, at + portion);
    parallelFor(at, stop, grain, body);
    monitor.progress(static_cast<double>(stop - begin) / static_cast<double>(end - begin));
  }
  return true;
}
} // namespace bsr
