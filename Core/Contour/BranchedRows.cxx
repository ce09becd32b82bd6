#include "Contour/BranchedSurface.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bsr
{
std::vector<std::vector<ControlRow>> sectionRows(
  const ContourStack& stack, const BranchedNetwork& net, const BranchedOptions& options)
{
  const double offset = siteOffset(options.OrderU);
  std::map<int, PeriodicInterpolation> solvers;
  std::vector<std::vector<ControlRow>> out;
  for (const Tube& t : net.Tubes)
  {
    const auto n = static_cast<std::size_t>(t.Columns);
    std::vector<ControlRow> rows;
    for (std::size_t k = 0; k < t.Contours.size(); ++k)
    {
      const ArcCurve curve = tubeCurve(stack.Contours[t.Contours[k]]);
      ControlRow points;
      for (std::size_t u = 0; u < n; ++u)
      {
        const double a = t.Shares[k][u];
        const double b = u + 1 < n ? t.Shares[k][u + 1] : t.Shares[k][0] + 1.0;
        points.push_back(curve.at(a + offset * (b - a)));
      }
      if (options.Interpolate)
      {
        const auto solver = solvers.try_emplace(t.Columns, options.OrderU, t.Columns).first;
        points = solver->second.solve(points);
      }
      rows.push_back(std::move(points));
    }
    out.push_back(std::move(rows));
  }
  return out;
}

InsertedRows insertRows(const ContourStack& stack, const BranchedNetwork& net,
  const std::vector<std::vector<ControlRow>>& sections, const RowChoices& choices, double capHeight)
{
  InsertedRows out;
  const auto position = [&](Index contour)
  { return stack.Slices[stack.Contours[contour].Slice].Position; };
  const auto endOf = [&](Index t, bool upper)
  {
    const auto& s = sections[t];
    const auto& c = net.Tubes[t].Contours;
    EndRows e;
    e.Last = upper ? &s.back() : &s.front();
    if (s.size() > 1)
    {
      e.Before = upper ? &s[s.size() - 2] : &s[1];
      e.Distance = std::abs(
        upper ? position(c.back()) - position(c[c.size() - 2]) : position(c[1]) - position(c[0]));
    }
    return e;
  };
  for (std::size_t n = 0; n < net.Junctions.size(); ++n)
  {
    const Junction& j = net.Junctions[n];
    std::vector<EndRows> branches;
    for (const Index b : j.Branches)
    {
      branches.push_back(endOf(b, j.StemAbove));
    }
    out.Junctions.push_back(
      makeJunctionRows(stack, net, j, branches, endOf(j.Stem, !j.StemAbove), choices.Junctions[n]));
  }
  const auto slices = static_cast<Index>(stack.Slices.size());
  for (std::size_t t = 0; t < net.Tubes.size(); ++t)
  {
    std::array<CapRows, 2> caps;
    for (int e = 0; e < 2; ++e)
    {
      const Tube& tube = net.Tubes[t];
      if (tube.Capped[e])
      {
        const Index own = stack.Contours[e ? tube.Contours.back() : tube.Contours.front()].Slice;
        const Index next = std::clamp<Index>(own + (e ? 1 : -1), 0, slices - 1);
        const double gap = next == own
                             ? stack.spacing()
                             : std::abs(stack.Slices[next].Position - stack.Slices[own].Position);
        const Vec3 tip =
          (e ? capHeight : -capHeight) * std::min(gap, stack.spacing() * 1.5) * stack.Axis;
        caps[e] = makeCapRows(
          endOf(static_cast<Index>(t), e == 1), tube.Corners[e], tip, choices.Caps[t][e]);
      }
    }
    out.Caps.push_back(std::move(caps));
  }
  return out;
}
} // namespace bsr
