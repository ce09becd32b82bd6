#include "Contour/SkinNetwork.h"

#include <algorithm>

namespace bsr
{
namespace
{
constexpr int Rounds = 3;
constexpr double Convex = 0.5; ///< height of convex ends, in slice distances
constexpr double Flat = 0.02;  ///< of flat ones: with none the patches there were singular

/// Which ends of the contours are closed: all but the bases of open pieces.
std::vector<std::array<bool, 2>> closedEnds(
  const ContourStack& stack, const std::vector<SkinPiece>& pieces)
{
  std::vector<std::array<bool, 2>> closed(stack.Contours.size(), {true, true});
  for (const SkinPiece& p : pieces)
  {
    if (!p.Closed)
    {
      closed[p.Legs.Nodes[0].Contour][p.Legs.Up ? 0 : 1] = false;
    }
  }
  return closed;
}

/// The patches of a tube at one of its ends, with those of its cap.
std::vector<Index> patchesAt(const BranchedSurface& surface, Index tube, int end)
{
  std::vector<Index> patches;
  for (std::size_t p = 0; p < surface.Origins.size(); ++p)
  {
    const PatchOrigin& o = surface.Origins[p];
    if (o.Tube == tube && (o.Cap == end || (o.Cap < 0 && o.End == end)))
    {
      patches.push_back(static_cast<Index>(p));
    }
  }
  return patches;
}

void findEnds(const ContourStack& stack, SkinNetwork& net)
{
  const auto last = static_cast<Index>(stack.Slices.size()) - 1;
  const auto& tubes = net.Surface.Network.Tubes;
  for (std::size_t n = 0; n < tubes.size(); ++n)
  {
    const Tube& t = tubes[n];
    net.Contours.insert(net.Contours.end(), t.Contours.begin(), t.Contours.end());
    for (const int e : {0, 1})
    {
      const Index c = e == 1 ? t.Contours.back() : t.Contours.front();
      net.Closed = net.Closed && (t.Junctions[e] >= 0 || t.Capped[e]);
      if (t.Capped[e])
      {
        const double sign = e == 1 ? 1.0 : -1.0;
        const Index own = stack.Contours[c].Slice;
        const Index next = std::clamp<Index>(own + (e == 1 ? 1 : -1), 0, last);
        const double gap = std::abs(stack.Slices[next].Position - stack.Slices[own].Position);
        net.Ends.push_back({c, sign * stack.Slices[own].Normal, gap > 0.0 ? gap : stack.spacing(),
          patchesAt(net.Surface, static_cast<Index>(n), e)});
      }
    }
  }
}
} // namespace

Result<SkinNetwork> fitNetwork(const ContourStack& stack, const std::vector<SkinPiece>& pieces,
  const std::vector<Index>& components, const SkinNetworkOptions& options, Monitor& monitor)
{
  BranchedOptions branched;
  branched.Components = components;
  branched.ClosedEnds = closedEnds(stack, pieces);
  branched.CapHeight = options.ConvexEnds ? Convex : Flat;
  branched.SectionTolerance = std::clamp(options.Tolerance / options.PointSpacing, 0.01, 0.1);
  SkinNetwork best;
  for (int round = 0; round < Rounds; ++round)
  {
    const auto share = [](int r) { return r < Rounds ? 1.0 - 1.0 / (1 << r) : 1.0; };
    SubMonitor part(monitor, share(round), share(round + 1));
    SubMonitor make(part, 0.0, 0.9);
    auto surface = makeBranchedSurface(stack, branched, make);
    if (!surface)
    {
      return surface.status();
    }
    SkinNetwork next;
    next.Surface = std::move(*surface);
    findEnds(stack, next);
    SubMonitor measure(part, 0.9, 1.0);
    auto input = inputError(next.Surface.Model, stack, next.Contours, measure);
    if (!input)
    {
      return input.status();
    }
    next.Input = std::move(*input);
    const auto score = [&](const SkinNetwork& n)
    { return 10.0 * n.Surface.FoldedPatches + n.Input.TotalRMS / options.Tolerance; };
    if (round == 0 || score(next) < score(best))
    {
      best = std::move(next);
    }
    if (best.Input.TotalRMS <= options.Tolerance)
    {
      break;
    }
    branched.SectionTolerance *= 0.6;
  }
  for (const SideJumps& j : normalJumps(best.Surface.Model))
  {
    best.MaxNormalJump = std::max(best.MaxNormalJump, *std::max_element(j.begin(), j.end()));
  }
  monitor.progress(1.0);
  return best;
}
} // namespace bsr
