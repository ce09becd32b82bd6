#include "Mesh/Decimate.h"

#include "Mesh/QuadricCollapse.h"

namespace bsr
{
namespace
{
constexpr Index BlockVertices = 8192;
constexpr Index SerialFaces = 100000; ///< no blocks for less
constexpr int MostRounds = 3;
constexpr double Shift = 0.37; ///< of the curve between two rounds
} // namespace

Status decimate(TriangleSurface& s, const DecimateOptions& options, Monitor& monitor)
{
  QuadricCollapse work(s, monitor);
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  Index left = work.faces();
  double done = 0.0;
  for (int round = 0; round < MostRounds; ++round)
  {
    if (left <= SerialFaces || left <= 1.5 * options.Most)
    {
      break;
    }
    SubMonitor part(monitor, done, done + 0.6 * (1.0 - done));
    const double keep = static_cast<double>(options.Most) / left;
    if (!work.sort(Shift * round, part) || !work.collapseInBlocks(BlockVertices, keep, part))
    {
      return Status::cancelled();
    }
    work.compact();
    left = work.faces();
    done += 0.6 * (1.0 - done);
    part.progress(1.0);
  }
  SubMonitor rest(monitor, done, 1.0);
  if (left > options.Target && !work.collapseAll(options, rest))
  {
    return Status::cancelled();
  }
  s.compact();
  return Status::ok();
}
} // namespace bsr
