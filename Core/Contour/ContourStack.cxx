#include "Contour/ContourStack.h"

#include "Common/UnionFind.h"
#include "Contour/StackPlanes.h"

#include <algorithm>
#include <limits>

namespace bsr
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Proper crossings within a contour and between two contours of one slice.
Status checkCrossings(const ContourStack& stack, const Slice& slice)
{
  std::vector<const Curve2*> curves;
  std::vector<char> closed;
  for (const Index c : slice.Contours)
  {
    curves.push_back(&stack.Contours[c].Flat);
    closed.push_back(stack.Contours[c].Closed ? 1 : 0);
  }
  const CurveCrossing x = findCrossing(curves, closed);
  if (x.Curve[0] < 0)
  {
    return Status::ok();
  }
  const Contour& a = stack.Contours[slice.Contours[x.Curve[0]]];
  const Contour& b = stack.Contours[slice.Contours[x.Curve[1]]];
  const std::string where = " in slice " + std::to_string(a.Slice);
  return a.Source == b.Source
           ? Status::invalidInput("Polyline " + std::to_string(a.Source) + where +
                                  " crosses itself near its point " + std::to_string(x.Segment[0]) +
                                  "; repair or remove it.")
           : Status::invalidInput("Polylines " + std::to_string(a.Source) + " and " +
                                  std::to_string(b.Source) + where +
                                  " cross each other; repair or remove one of them.");
}

bool encloses(const Contour& outer, const Contour& inner)
{
  if (!outer.Closed || outer.Area <= inner.Area)
  {
    return false;
  }
  int votes = 0; // of three points: contours may touch
  const std::size_t n = inner.Flat.size();
  for (const std::size_t i : {std::size_t{0}, n / 3, 2 * n / 3})
  {
    votes += insideCurve(outer.Flat, inner.Flat[i]) ? 1 : 0;
  }
  return votes >= 2;
}

void nest(ContourStack& stack, const Slice& slice)
{
  for (const Index c : slice.Contours)
  {
    Contour& inner = stack.Contours[c];
    double smallest = Infinity;
    for (const Index o : slice.Contours)
    {
      const Contour& outer = stack.Contours[o];
      if (o != c && inner.Closed && encloses(outer, inner))
      {
        ++inner.Level;
        if (outer.Area < smallest)
        {
          smallest = outer.Area;
          inner.Parent = o;
        }
      }
    }
  }
}

/// Smallest distance of the points of a from b, both flat.
double gapBetween(const Contour& a, const Contour& b)
{
  double gap = Infinity;
  for (const Vec2& p : a.Flat)
  {
    gap = std::min(gap, curveDistance(b.Flat, b.Closed, p));
  }
  return gap;
}

/// Links the contours of two consecutive slices.
class Linker
{
public:
  Linker(ContourStack& stack, const StackOptions& options, const Slice& low, const Slice& high)
      : Stack(stack), Options(options), Low(low), High(high)
  {
    for (const Index a : low.Contours)
    {
      for (const Index b : high.Contours)
      {
        this->Pairs.push_back(this->compare(a, b));
      }
    }
  }

  void run()
  {
    this->byOverlap(true);
    this->byOverlap(false);
    this->byDistance();
  }

private:
  struct Pair
  {
    Index A, B;
    bool Allowed;  ///< same kind, not kept apart by hand
    bool Forced;   ///< same component by hand
    double Share;  ///< common area over the smaller one
    double Common; ///< common area
    double Away;   ///< distance of the centers
  };

  int byHand(Index c) const
  {
    return this->Options.ComponentOf.empty()
             ? -1
             : this->Options.ComponentOf[this->Stack.Contours[c].Source];
  }

  Pair compare(Index ia, Index ib) const
  {
    const Contour& a = this->Stack.Contours[ia];
    const Contour& b = this->Stack.Contours[ib];
    const int hand = this->byHand(ia);
    Pair p{ia, ib, a.Closed == b.Closed && a.hole() == b.hole() && hand == this->byHand(ib),
      hand >= 0, 0.0, 0.0, (a.Center - b.Center).norm()};
    if (p.Allowed && a.Closed)
    {
      p.Share = overlapShare(a.Flat, b.Flat);
      p.Common = p.Share * std::min(a.Area, b.Area);
    }
    return p;
  }

  bool linked(Index a, Index b) const
  {
    const auto& above = this->Stack.Contours[a].Above;
    return std::find(above.begin(), above.end(), b) != above.end();
  }

  void link(const Pair& p)
  {
    if (!this->linked(p.A, p.B))
    {
      this->Stack.Links.push_back({p.A, p.B, p.Share});
      this->Stack.Contours[p.A].Above.push_back(p.B);
      this->Stack.Contours[p.B].Below.push_back(p.A);
    }
  }

  /// Each contour with the one it shares most area with; first among those of its own level.
  void byOverlap(bool sameLevel)
  {
    const auto bare = [&](Index c, bool up)
    { return up ? this->Stack.Contours[c].Above.empty() : this->Stack.Contours[c].Below.empty(); };
    std::vector<const Pair*> chosen;
    for (const bool up : {true, false})
    {
      for (const Index c : up ? this->Low.Contours : this->High.Contours)
      {
        const Pair* best = nullptr;
        for (const Pair& p : this->Pairs)
        {
          const bool level = this->Stack.Contours[p.A].Level == this->Stack.Contours[p.B].Level;
          const bool fits = sameLevel ? level : bare(p.A, true) && bare(p.B, false);
          if ((up ? p.A : p.B) == c && p.Allowed && fits &&
              p.Share >= this->Options.MinimumOverlap && (!best || p.Common > best->Common))
          {
            best = &p;
          }
        }
        if (best)
        {
          chosen.push_back(best);
        }
      }
    }
    for (const Pair* p : chosen)
    {
      this->link(*p);
    }
  }

  bool near(const Pair& p) const
  {
    const Contour& a = this->Stack.Contours[p.A];
    const Contour& b = this->Stack.Contours[p.B];
    const double reach = this->Options.MatchDistance * 0.5 * (a.diameter() + b.diameter());
    return p.Forced || (a.Level == b.Level && reach > 0.0 && gapBetween(a, b) <= reach);
  }

  /// Those without any partner, nearest first.
  void byDistance()
  {
    std::vector<const Pair*> order;
    for (const Pair& p : this->Pairs)
    {
      if (p.Allowed)
      {
        order.push_back(&p);
      }
    }
    std::stable_sort(
      order.begin(), order.end(), [](const Pair* a, const Pair* b) { return a->Away < b->Away; });
    for (const Pair* p : order)
    {
      const bool bareA = this->Stack.Contours[p->A].Above.empty();
      const bool bareB = this->Stack.Contours[p->B].Below.empty();
      if ((p->Forced ? bareA || bareB : bareA && bareB) && this->near(*p))
      {
        this->link(*p);
      }
    }
  }

  ContourStack& Stack;
  const StackOptions& Options;
  const Slice& Low;
  const Slice& High;
  std::vector<Pair> Pairs;
};

/// Lets open contours run the same way as what they are linked to.
void orientOpen(ContourStack& stack)
{
  for (Contour& c : stack.Contours)
  {
    if (c.Closed || c.Below.empty())
    {
      continue;
    }
    const std::vector<Vec2>& below = stack.Contours[c.Below[0]].Flat;
    const double same =
      (c.Flat.front() - below.front()).norm() + (c.Flat.back() - below.back()).norm();
    const double turned =
      (c.Flat.front() - below.back()).norm() + (c.Flat.back() - below.front()).norm();
    if (turned < same)
    {
      std::reverse(c.Points.begin(), c.Points.end());
      std::reverse(c.Flat.begin(), c.Flat.end());
    }
  }
}

void number(ContourStack& stack)
{
  const auto n = static_cast<std::int64_t>(stack.Contours.size());
  UnionFind components(n);
  UnionFind branches(n);
  for (const ContourLink& l : stack.Links)
  {
    components.join(l.Lower, l.Upper);
    if (stack.Contours[l.Lower].Above.size() == 1 && stack.Contours[l.Upper].Below.size() == 1)
    {
      branches.join(l.Lower, l.Upper);
    }
  }
  for (std::int64_t i = 0; i < n; ++i)
  {
    const std::int64_t c = components.find(i);
    const std::int64_t b = branches.find(i);
    stack.Contours[i].Component = c == i ? stack.Components++ : stack.Contours[c].Component;
    stack.Contours[i].Branch = b == i ? stack.Branches++ : stack.Contours[b].Branch;
  }
}
} // namespace

double ContourStack::spacing() const
{
  std::vector<double> gaps;
  for (std::size_t s = 1; s < this->Slices.size(); ++s)
  {
    gaps.push_back(this->Slices[s].Position - this->Slices[s - 1].Position);
  }
  std::sort(gaps.begin(), gaps.end());
  return gaps.empty() ? 0.0 : gaps[gaps.size() / 2];
}

double ContourStack::meanDiameter() const
{
  double sum = 0.0;
  for (const Contour& c : this->Contours)
  {
    sum += c.diameter();
  }
  return this->Contours.empty() ? 0.0 : sum / static_cast<double>(this->Contours.size());
}

Status linkStack(ContourStack& stack, const StackOptions& options, Monitor& monitor)
{
  for (const Slice& slice : stack.Slices)
  {
    if (Status s = checkCrossings(stack, slice); !s)
    {
      return s;
    }
    nest(stack, slice);
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
  }
  const double widest = options.MaximumGap * stack.spacing();
  for (std::size_t s = 1; s < stack.Slices.size(); ++s)
  {
    if (stack.Slices[s].Position - stack.Slices[s - 1].Position <= widest)
    {
      Linker(stack, options, stack.Slices[s - 1], stack.Slices[s]).run();
    }
    monitor.progress(static_cast<double>(s) / static_cast<double>(stack.Slices.size()));
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
  }
  orientOpen(stack);
  number(stack);
  return Status::ok();
}

Result<ContourStack> buildStack(
  const std::vector<Polyline>& polylines, const StackOptions& options, Monitor& monitor)
{
  const auto wrong = [&](const std::vector<int>& a)
  { return !a.empty() && a.size() != polylines.size(); };
  if (wrong(options.SliceOf) || wrong(options.ComponentOf))
  {
    return Status::invalidParameter(
      "The arrays that override slices and components must have one value a polyline.");
  }
  if (!(options.PlaneTolerance >= 0.0) || !(options.MinimumOverlap > 0.0) ||
      !(options.MinimumOverlap <= 1.0) || !(options.MatchDistance >= 0.0) ||
      !(options.MaximumGap > 0.0) || !(options.SpeckShare >= 0.0))
  {
    return Status::invalidParameter(
      "PlaneTolerance, MatchDistance and SpeckShare must not be negative, MaximumGap must be "
      "positive and MinimumOverlap in 0 to 1.");
  }
  Result<ContourStack> stack = sliceContours(polylines, options, monitor);
  if (!stack)
  {
    return stack;
  }
  if (Status s = linkStack(*stack, options, monitor); !s)
  {
    return s;
  }
  return stack;
}
} // namespace bsr
