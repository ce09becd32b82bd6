#include "Contour/BranchedReport.h"

#include "Spline/Topology.h"

#include <algorithm>
#include <numeric>

namespace bsr
{
Result<BranchedReport> reportBranched(
  const BranchedSurface& surface, const ContourStack& stack, Monitor& monitor)
{
  BranchedReport r;
  for (const DroppedContour& d : stack.Dropped)
  {
    r.LeftOut.push_back({d.Source, d.Reason});
  }
  const auto& notes = surface.Network.Notes;
  r.LeftOut.insert(r.LeftOut.end(), notes.begin(), notes.end());
  std::vector<Index> contours;
  for (const Tube& t : surface.Network.Tubes)
  {
    contours.insert(contours.end(), t.Contours.begin(), t.Contours.end());
  }
  SubMonitor first(monitor, 0.0, 0.5);
  auto input = inputError(surface.Model, stack, contours, first);
  if (!input)
  {
    return input.status();
  }
  r.Input = std::move(*input);
  SubMonitor second(monitor, 0.5, 0.9);
  const auto reslice = resliceError(surface.Model, stack, contours, second);
  if (!reslice)
  {
    return reslice.status();
  }
  r.Reslice = *reslice;
  const std::vector<SideJumps> jumps = normalJumps(surface.Model);
  for (std::size_t p = 0; p < jumps.size(); ++p)
  {
    const PatchOrigin& own = surface.Origins[p];
    const Tube& tube = surface.Network.Tubes[own.Tube];
    const bool atJunction = own.Cap < 0 && (tube.Junctions[0] >= 0 || tube.Junctions[1] >= 0);
    const double worst = *std::max_element(jumps[p].begin(), jumps[p].end());
    r.NormalJump.push_back(std::max(worst, 0.0));
    r.MaxNormalJump = std::max(r.MaxNormalJump, worst);
    r.JunctionNormalJump = std::max(r.JunctionNormalJump, atJunction ? worst : 0.0);
  }
  const auto [component, count] = patchComponents(surface.Model);
  const auto open = openSides(surface.Model, component, count);
  r.OpenSides = std::accumulate(open.begin(), open.end(), std::int64_t{0});
  monitor.progress(1.0);
  return r;
}
} // namespace bsr
