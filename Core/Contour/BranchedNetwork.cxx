#include "Contour/BranchedNetwork.h"

#include "Common/UnionFind.h"

#include <algorithm>
#include <limits>
#include <map>

namespace bsr
{
namespace
{
std::string polylineName(const Contour& c)
{
  return "polyline " + std::to_string(c.Source);
}

/// Splits the stack's graph into tubes and junctions.
class NetworkBuilder
{
public:
  NetworkBuilder(const ContourStack& stack, const NetworkOptions& options)
      : Stack(stack), Options(options), Above(stack.Contours.size()), Below(stack.Contours.size())
  {
  }

  BranchedNetwork run()
  {
    this->takeLinks();
    this->thinLinks();
    this->linkBays();
    this->makeTubes();
    this->makeJunctions();
    this->closeEnds();
    return std::move(this->Net);
  }

private:
  bool wanted(Index c) const
  {
    const auto& of = this->Options.Components;
    return of.empty() ||
           std::binary_search(of.begin(), of.end(), this->Stack.Contours[c].Component);
  }
  bool usable(Index c) const { return this->Stack.Contours[c].Closed && this->wanted(c); }

  void takeLinks()
  {
    for (std::size_t c = 0; c < this->Stack.Contours.size(); ++c)
    {
      if (!this->Stack.Contours[c].Closed && this->wanted(static_cast<Index>(c)))
      {
        this->Net.Notes.push_back({this->Stack.Contours[c].Source,
          "open contour left out: branched surfaces are made of closed ones; use ContourSkin"});
      }
    }
    for (const ContourLink& l : this->Stack.Links)
    {
      if (this->usable(l.Lower) && this->usable(l.Upper))
      {
        this->Links.push_back(l);
      }
    }
  }

  void countEnds()
  {
    for (std::size_t c = 0; c < this->Above.size(); ++c)
    {
      this->Above[c].clear();
      this->Below[c].clear();
    }
    for (const ContourLink& l : this->Links)
    {
      this->Above[l.Lower].push_back(l.Upper);
      this->Below[l.Upper].push_back(l.Lower);
    }
  }

  /// Several contours on both sides at once: the weakest link between two contours that both have
  /// others is taken out, until every junction has one stem.
  void thinLinks()
  {
    this->countEnds();
    while (true)
    {
      auto weakest = this->Links.end();
      for (auto l = this->Links.begin(); l != this->Links.end(); ++l)
      {
        if (this->Above[l->Lower].size() > 1 && this->Below[l->Upper].size() > 1 &&
            (weakest == this->Links.end() || l->Overlap < weakest->Overlap))
        {
          weakest = l;
        }
      }
      if (weakest == this->Links.end())
      {
        return;
      }
      const Contour& upper = this->Stack.Contours[weakest->Upper];
      this->Net.Notes.push_back({this->Stack.Contours[weakest->Lower].Source,
        "link to " + polylineName(upper) +
          " left out: several contours go over into several others at once; add a slice between"});
      this->Links.erase(weakest);
      this->countEnds();
    }
  }

  /// A hole without a link on one side, where the contour around it has exactly one, outside of it:
  /// there a bay of that contour closes to the hole.
  void linkBays()
  {
    for (std::size_t c = 0; c < this->Stack.Contours.size(); ++c)
    {
      const Contour& h = this->Stack.Contours[c];
      if (!this->usable(static_cast<Index>(c)) || !h.hole() || h.Parent < 0 ||
          !this->usable(h.Parent))
      {
        continue;
      }
      for (const bool up : {false, true})
      {
        const auto& own = up ? this->Above[c] : this->Below[c];
        const auto& around = up ? this->Above[h.Parent] : this->Below[h.Parent];
        if (own.empty() && around.size() == 1 && this->isBay(h, around[0], up))
        {
          const auto hole = static_cast<Index>(c);
          this->Links.push_back(up ? ContourLink{hole, around[0]} : ContourLink{around[0], hole});
        }
      }
    }
    this->countEnds();
  }

  bool isBay(const Contour& hole, Index stem, bool up) const
  {
    const Contour& s = this->Stack.Contours[stem];
    const auto& back = up ? this->Below[stem] : this->Above[stem];
    if (back.size() != 1 || s.hole())
    {
      return false;
    }
    std::size_t inside = 0;
    for (const Vec2& p : hole.Flat)
    {
      inside += insideCurve(s.Flat, p) ? 1 : 0;
    }
    return 2 * inside < hole.Flat.size();
  }

  void makeTubes()
  {
    this->TubeOf.assign(this->Stack.Contours.size(), -1);
    for (std::size_t i = 0; i < this->Stack.Contours.size(); ++i)
    {
      const auto c = static_cast<Index>(i);
      if (!this->usable(c) || this->TubeOf[c] >= 0)
      {
        continue;
      }
      Tube t;
      t.Hole = this->Stack.Contours[c].hole();
      Index k = c; // contours are in the order of their slices: c is a lowest one
      while (true)
      {
        this->TubeOf[k] = static_cast<Index>(this->Net.Tubes.size());
        t.Contours.push_back(k);
        if (this->Above[k].size() != 1 || this->Below[this->Above[k][0]].size() != 1)
        {
          break;
        }
        k = this->Above[k][0];
      }
      this->Net.Tubes.push_back(std::move(t));
    }
  }

  void addJunction(Index stem, const std::vector<Index>& branches, bool stemAbove)
  {
    Junction j;
    j.Stem = this->TubeOf[stem];
    j.StemAbove = stemAbove;
    const auto number = static_cast<Index>(this->Net.Junctions.size());
    this->Net.Tubes[j.Stem].Junctions[stemAbove ? 0 : 1] = number;
    for (const Index b : branches)
    {
      j.Branches.push_back(this->TubeOf[b]);
      this->Net.Tubes[this->TubeOf[b]].Junctions[stemAbove ? 1 : 0] = number;
    }
    arrangeJunction(this->Stack, this->Net.Tubes, j);
    this->Net.Junctions.push_back(std::move(j));
  }

  void makeJunctions()
  {
    for (std::size_t c = 0; c < this->Stack.Contours.size(); ++c)
    {
      const auto i = static_cast<Index>(c);
      if (this->Below[c].size() > 1)
      {
        this->addJunction(i, this->Below[c], true);
      }
      if (this->Above[c].size() > 1)
      {
        this->addJunction(i, this->Above[c], false);
      }
    }
    std::stable_sort(this->Net.Junctions.begin(), this->Net.Junctions.end(),
      [this](const Junction& a, const Junction& b) { return this->height(a) < this->height(b); });
    for (std::size_t n = 0; n < this->Net.Junctions.size(); ++n)
    {
      const Junction& j = this->Net.Junctions[n];
      this->Net.Tubes[j.Stem].Junctions[j.StemAbove ? 0 : 1] = static_cast<Index>(n);
      for (const Index b : j.Branches)
      {
        this->Net.Tubes[b].Junctions[j.StemAbove ? 1 : 0] = static_cast<Index>(n);
      }
    }
  }

  /// Slice of the stem's end, in halves: a junction lies above or below it.
  int height(const Junction& j) const
  {
    const auto& c = this->Net.Tubes[j.Stem].Contours;
    return j.StemAbove ? 2 * this->Stack.Contours[c.front()].Slice - 1
                       : 2 * this->Stack.Contours[c.back()].Slice + 1;
  }

  void closeEnds()
  {
    const auto last = static_cast<Index>(this->Stack.Slices.size()) - 1;
    for (Tube& t : this->Net.Tubes)
    {
      const bool inside[2] = {this->Stack.Contours[t.Contours.front()].Slice > 0,
        this->Stack.Contours[t.Contours.back()].Slice < last};
      for (int e = 0; e < 2; ++e)
      {
        const Index c = e == 1 ? t.Contours.back() : t.Contours.front();
        const bool closed = !this->Options.ClosedEnds.empty()
                              ? this->Options.ClosedEnds[c][e]
                              : this->Options.Caps == EndCaps::All ||
                                  (this->Options.Caps == EndCaps::Inside && inside[e]);
        t.Capped[e] = t.Junctions[e] < 0 && closed;
      }
    }
  }

  const ContourStack& Stack;
  const NetworkOptions& Options;
  BranchedNetwork Net;
  std::vector<ContourLink> Links;
  std::vector<std::vector<Index>> Above;
  std::vector<std::vector<Index>> Below;
  std::vector<Index> TubeOf;
};

/// A tube of one contour with an open end and no junction is no surface.
void dropSingles(const ContourStack& stack, BranchedNetwork& net)
{
  std::vector<Index> moved(net.Tubes.size(), -1);
  std::vector<Tube> kept;
  for (std::size_t t = 0; t < net.Tubes.size(); ++t)
  {
    const Tube& tube = net.Tubes[t];
    const bool alone = tube.Contours.size() == 1 && tube.Junctions[0] < 0 && tube.Junctions[1] < 0;
    if (alone && !(tube.Capped[0] && tube.Capped[1]))
    {
      net.Notes.push_back({stack.Contours[tube.Contours[0]].Source,
        "single contour left out: no contour of another slice is linked to it"});
      continue;
    }
    moved[t] = static_cast<Index>(kept.size());
    kept.push_back(tube);
  }
  net.Tubes.swap(kept);
  for (Junction& j : net.Junctions)
  {
    j.Stem = moved[j.Stem];
    for (Index& b : j.Branches)
    {
      b = moved[b];
    }
  }
}
} // namespace

Result<BranchedNetwork> makeNetwork(
  const ContourStack& stack, const NetworkOptions& options, Monitor& monitor)
{
  BranchedNetwork net = NetworkBuilder(stack, options).run();
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  dropSingles(stack, net);
  if (net.Tubes.empty())
  {
    return Status::invalidInput(
      "No surface can be made: no two closed contours of neighboring slices are linked; check the "
      "slices' order and distance, or link them by hand (ComponentArray).");
  }
  assignColumns(stack, options, net);
  return net;
}
} // namespace bsr
