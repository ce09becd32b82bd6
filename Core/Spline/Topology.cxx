#include "Spline/Topology.h"

#include "Common/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
/// Control points and knots along one side of a patch.
struct SideCurve
{
  int Degree = 0;
  std::int64_t Count = 0;
  const double* Knots = nullptr;
  const Vec4* First = nullptr;
  std::int64_t Stride = 0;

  const Vec4& point(std::int64_t k) const { return this->First[k * this->Stride]; }
  double knot(std::int64_t k) const
  {
    const double a = this->Knots[this->Degree];
    const double b = this->Knots[this->Count];
    return (this->Knots[k] - a) / (b - a);
  }
};

SideCurve sideCurve(const SplineModel& model, std::int64_t patch, int side)
{
  const SplinePatch& p = model.Patches[patch];
  const bool alongU = side == 0 || side == 2;
  SideCurve c;
  c.Degree = alongU ? p.DegreeU : p.DegreeV;
  c.Count = alongU ? p.CountU : p.CountV;
  c.Knots = model.Knots.data() + (alongU ? p.FirstKnotU : p.FirstKnotV);
  c.Stride = alongU ? 1 : p.CountU;
  c.First =
    model.ControlPoints.data() + p.FirstControlPoint + gridSideIndex({p.CountU, p.CountV}, side, 0);
  return c;
}

bool knotsMatch(const SideCurve& a, const SideCurve& b, bool reversed)
{
  const std::int64_t n = a.Count + a.Degree + 1;
  for (std::int64_t k = 0; k < n; ++k)
  {
    const double other = reversed ? 1.0 - b.knot(n - 1 - k) : b.knot(k);
    if (std::abs(a.knot(k) - other) > 1e-12)
    {
      return false;
    }
  }
  return true;
}

/// Largest difference between the control points; weights count relative to the curve's size.
double difference(const SideCurve& a, const SideCurve& b, bool reversed, double size)
{
  double worst = 0.0;
  for (std::int64_t k = 0; k < a.Count; ++k)
  {
    const Vec4& p = a.point(k);
    const Vec4& q = b.point(reversed ? b.Count - 1 - k : k);
    worst = std::max(worst, (p - q).head<3>().norm());
    worst = std::max(worst, size * std::abs(p[3] - q[3]) / std::max(p[3], q[3]));
  }
  return worst;
}

double extent(const SideCurve& c)
{
  double size = 0.0;
  for (std::int64_t k = 1; k < c.Count; ++k)
  {
    size = std::max(size, (c.point(k) - c.point(0)).head<3>().norm());
  }
  return size;
}

std::int64_t sideLength(const GridSize& g, int side)
{
  return side == 0 || side == 2 ? g[0] : g[1];
}

void joinSide(const SplineModel& model, const std::vector<GridSize>& sizes,
  const std::vector<std::int64_t>& first, std::int64_t p, int s, bool joinPoles, UnionFind& sets)
{
  const std::int64_t n = sideLength(sizes[p], s);
  if (joinPoles && sideCollapsed(model, p, s))
  {
    for (std::int64_t k = 1; k < n; ++k)
    {
      sets.join(first[p] + gridSideIndex(sizes[p], s, 0), first[p] + gridSideIndex(sizes[p], s, k));
    }
  }
  const SideMatch m = matchSide(model, p, s);
  if (m.Patch < 0 || !m.Same || sideLength(sizes[m.Patch], m.Side) != n)
  {
    return;
  }
  for (std::int64_t k = 0; k < n; ++k)
  {
    const std::int64_t other = m.Reversed ? n - 1 - k : k;
    sets.join(first[p] + gridSideIndex(sizes[p], s, k),
      first[m.Patch] + gridSideIndex(sizes[m.Patch], m.Side, other));
  }
}
} // namespace

bool sideCollapsed(const SplineModel& model, std::int64_t patch, int side)
{
  const SideCurve c = sideCurve(model, patch, side);
  const SideCurve across = sideCurve(model, patch, (side + 1) % 4);
  return extent(c) <= 1e-12 * extent(across);
}

SideMatch matchSide(const SplineModel& model, std::int64_t patch, int side)
{
  SideMatch m;
  const std::int64_t code = model.Neighbors[patch][side];
  if (code < 0)
  {
    return m;
  }
  m.Patch = code / 4;
  m.Side = static_cast<int>(code % 4);
  const SideCurve a = sideCurve(model, patch, side);
  const SideCurve b = sideCurve(model, m.Patch, m.Side);
  const double size = extent(a);
  // The usual case of two coherent patches decides where both directions fit (closed curves).
  const bool ccwA = side < 2;
  const bool ccwB = m.Side < 2;
  const bool usual = ccwA == ccwB;
  if (a.Count == b.Count)
  {
    const double asUsual = difference(a, b, usual, size);
    const double against = difference(a, b, !usual, size);
    m.Reversed = asUsual <= against ? usual : !usual;
    m.Same = a.Degree == b.Degree && std::min(asUsual, against) <= 1e-9 * size &&
             knotsMatch(a, b, m.Reversed);
  }
  else
  {
    const auto gap = [&](bool reversed)
    {
      return (a.point(0) - b.point(reversed ? b.Count - 1 : 0)).head<3>().norm() +
             (a.point(a.Count - 1) - b.point(reversed ? 0 : b.Count - 1)).head<3>().norm();
    };
    m.Reversed = gap(usual) <= gap(!usual) ? usual : !usual;
  }
  m.Coherent = m.Reversed == usual;
  return m;
}

StitchedGrids stitchGrids(
  const SplineModel& model, const std::vector<GridSize>& sizes, bool joinPoles)
{
  StitchedGrids g;
  std::int64_t total = 0;
  for (const GridSize& s : sizes)
  {
    g.First.push_back(total);
    total += s[0] * s[1];
  }
  UnionFind sets(total);
  for (std::int64_t p = 0; p < static_cast<std::int64_t>(sizes.size()); ++p)
  {
    for (int s = 0; s < 4; ++s)
    {
      joinSide(model, sizes, g.First, p, s, joinPoles, sets);
    }
  }
  g.Id.resize(static_cast<std::size_t>(total));
  for (std::int64_t i = 0; i < total; ++i)
  {
    const std::int64_t root = sets.find(i);
    if (root == i)
    {
      g.Id[i] = static_cast<Index>(g.Owner.size());
      g.Owner.push_back(i);
    }
    else
    {
      g.Id[i] = g.Id[root];
    }
  }
  return g;
}

std::pair<std::vector<Index>, Index> patchComponents(const SplineModel& model)
{
  std::vector<Index> component(model.Patches.size(), -1);
  Index count = 0;
  std::vector<std::int64_t> stack;
  for (std::size_t start = 0; start < component.size(); ++start)
  {
    if (component[start] >= 0)
    {
      continue;
    }
    component[start] = count;
    stack.assign(1, static_cast<std::int64_t>(start));
    while (!stack.empty())
    {
      const std::int64_t p = stack.back();
      stack.pop_back();
      for (const std::int64_t code : model.Neighbors[p])
      {
        if (code >= 0 && component[code / 4] < 0)
        {
          component[code / 4] = count;
          stack.push_back(code / 4);
        }
      }
    }
    ++count;
  }
  return {component, count};
}

std::vector<char> orientationFlips(const SplineModel& model)
{
  std::vector<char> flip(model.Patches.size(), 0);
  std::vector<char> seen(model.Patches.size(), 0);
  for (std::size_t start = 0; start < flip.size(); ++start)
  {
    if (seen[start])
    {
      continue;
    }
    seen[start] = 1;
    std::vector<std::int64_t> members(1, static_cast<std::int64_t>(start));
    std::int64_t votes = 0;
    for (std::size_t i = 0; i < members.size(); ++i)
    {
      const std::int64_t p = members[i];
      votes += (model.Patches[p].Side == Shell::Outer ? 1000000 : 1) * (flip[p] ? 1 : -1);
      for (int s = 0; s < 4; ++s)
      {
        const SideMatch m = matchSide(model, p, s);
        if (m.Patch >= 0 && !seen[m.Patch])
        {
          seen[m.Patch] = 1;
          flip[m.Patch] = m.Coherent ? flip[p] : !flip[p];
          members.push_back(m.Patch);
        }
      }
    }
    if (votes > 0)
    {
      for (const std::int64_t p : members)
      {
        flip[p] = !flip[p];
      }
    }
  }
  return flip;
}

std::vector<std::int64_t> openSides(
  const SplineModel& model, const std::vector<Index>& component, Index count)
{
  std::vector<std::int64_t> open(static_cast<std::size_t>(count), 0);
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    for (int s = 0; s < 4; ++s)
    {
      const auto patch = static_cast<std::int64_t>(p);
      if (model.Neighbors[p][s] < 0 && !sideCollapsed(model, patch, s))
      {
        ++open[component[p]];
      }
    }
  }
  return open;
}
} // namespace bsr
