#include "Common/UnionFind.h"
#include "Contour/BranchedNetwork.h"
#include "Contour/ColumnMap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bsr
{
namespace
{
constexpr int MaximumColumns = 160; ///< of a tube that starts freely
constexpr int MaximumRounds = 8;
constexpr double HubColumns = 96.0; ///< of a branch, at most, for the sake of a narrow crotch
constexpr double Relaxation = 0.15; ///< a slice, of the columns towards equal spacing
constexpr double Infinity = std::numeric_limits<double>::infinity();

/**
 * Columns go upward: tubes that start freely choose their number; at the upper end of a tube the
 * columns next to the crotches become its corners, and all columns go on into the tubes above at
 * the places that the match of the contours gives. Where a tube gets too few, the free ones below
 * are given more and all is done again. Numbers are even, so that caps can be made of them.
 */
class Assigner
{
public:
  Assigner(const ContourStack& stack, const NetworkOptions& options, BranchedNetwork& net)
      : Stack(stack),
        Options(options),
        Net(net),
        MinimumArc(2 * ((options.Order + 3) / 2)),
        Parts(static_cast<std::int64_t>(net.Tubes.size()))
  {
    for (const Tube& t : net.Tubes)
    {
      this->Layouts.push_back(this->layoutOf(t));
    }
    for (const Junction& j : net.Junctions)
    {
      for (const Index b : j.Branches)
      {
        this->Parts.join(j.Stem, b);
      }
    }
    this->findLeast();
    for (std::size_t t = 0; t < net.Tubes.size(); ++t)
    {
      this->Need.push_back(this->needed(static_cast<Index>(t)));
      this->Wanted.push_back(this->Need.back());
    }
  }

  void run()
  {
    for (int round = 0; round < MaximumRounds; ++round)
    {
      this->pass();
      if (!this->raise())
      {
        break;
      }
    }
    for (std::size_t t = 0; t < this->Net.Tubes.size(); ++t)
    {
      this->placeCaps(static_cast<Index>(t));
      this->fillShares(static_cast<Index>(t));
    }
  }

private:
  ColumnLayout layoutOf(const Tube& t) const
  {
    ColumnLayout l;
    for (const Index c : t.Contours)
    {
      const std::size_t k = l.Start.size();
      l.Curves.push_back(tubeCurve(this->Stack.Contours[c]));
      if (k == 0)
      {
        l.Start.push_back(0.0);
        continue;
      }
      l.Start.push_back(alignedStart(l.Curves[k - 1], l.Start[k - 1], l.Curves[k]));
      MatchOptions even;
      even.Evenness = Relaxation;
      even.Center = true;
      l.Next.push_back(
        matchArcs({&l.Curves[k - 1], l.Start[k - 1], 1.0}, {&l.Curves[k], l.Start[k], 1.0}, even));
    }
    return l;
  }

  /// The arcs of a tube at its lower or upper end, in their order.
  std::vector<ArcEnd> arcsAt(Index t, int end) const
  {
    std::vector<ArcEnd> arcs;
    if (this->Net.Tubes[t].Junctions[end] >= 0)
    {
      Junction& j = this->Net.Junctions[this->Net.Tubes[t].Junctions[end]];
      for (JunctionArc& a : j.Arcs)
      {
        if (j.Stem == t || j.Branches[a.Branch] == t)
        {
          arcs.push_back({&a, j.Stem == t});
        }
      }
    }
    return arcs;
  }

  /// Columns that a tube needs: for its shape, and for the arcs at its ends.
  int needed(Index t) const
  {
    const Tube& tube = this->Net.Tubes[t];
    int need = this->Options.PointsPerSection;
    if (need == 0)
    {
      const std::size_t step = std::max<std::size_t>(1, tube.Contours.size() / 8);
      for (std::size_t k = 0; k < tube.Contours.size(); k += step)
      {
        const Contour& c = this->Stack.Contours[tube.Contours[k]];
        const double spacing = c.Length / static_cast<double>(c.Points.size());
        need = std::max(
          need, columnsNeeded(c, this->Options.Order, this->Options.SectionTolerance * spacing));
      }
    }
    need = std::max({need, this->Least[t], this->neededAtHubs(t)});
    need = static_cast<int>(std::lround(this->Options.Refinement * need));
    return need + need % 2;
  }

  /// Least columns that a tube can do with: enough for each arc at its ends, for caps, and for the
  /// branches that it carries.
  void findLeast()
  {
    const int capArc = 2 * ((this->Options.Order + 2) / 2);
    for (std::size_t t = 0; t < this->Net.Tubes.size(); ++t)
    {
      int least = 8;
      for (int e = 0; e < 2; ++e)
      {
        const auto arcs = static_cast<int>(this->arcsAt(static_cast<Index>(t), e).size());
        least =
          std::max(least, this->Net.Tubes[t].Capped[e] ? 4 * capArc : arcs * this->MinimumArc);
      }
      this->Least.push_back(least);
    }
    for (std::size_t round = 0; round <= this->Net.Junctions.size(); ++round)
    {
      for (const Junction& j : this->Net.Junctions)
      {
        int sum = 0;
        for (const JunctionArc& a : j.Arcs)
        {
          sum += this->leastSpans(j, a);
        }
        this->Least[j.Stem] = std::max(this->Least[j.Stem], sum);
      }
    }
  }

  /// Least spans of an arc of a junction.
  int leastSpans(const Junction& j, const JunctionArc& arc) const
  {
    int arcs = 0;
    for (const JunctionArc& a : j.Arcs)
    {
      arcs += a.Branch == arc.Branch ? 1 : 0;
    }
    const int each = (this->Least[j.Branches[arc.Branch]] + arcs - 1) / arcs;
    return std::max(this->MinimumArc, each + each % 2);
  }

  int leastSpans(Index t, int end, const ArcEnd& a) const
  {
    return this->leastSpans(this->Net.Junctions[this->Net.Tubes[t].Junctions[end]], *a.Arc);
  }

  /// Columns so that their distance is no more than the room about the crotches.
  int neededAtHubs(Index t) const
  {
    int need = 0;
    for (int e = 0; e < 2; ++e)
    {
      for (const ArcEnd& a : this->arcsAt(t, e))
      {
        const Junction& j = this->Net.Junctions[this->Net.Tubes[t].Junctions[e]];
        if (a.Stem)
        {
          continue; // the branches see to it
        }
        const auto& mine = this->Net.Tubes[t].Contours;
        const Contour& own = this->Stack.Contours[e ? mine.back() : mine.front()];
        const ArcCurve curve = tubeCurve(own, true);
        const auto& theirs = this->Net.Tubes[j.Stem].Contours;
        const ArcCurve stem =
          tubeCurve(this->Stack.Contours[e ? theirs.front() : theirs.back()], true);
        const Vec2& c = j.Hubs[a.Arc->StartHub].Flat;
        const Vec3 center(c.x(), c.y(), 0.0);
        const double across = (curve.at(a.share()) - center).norm();
        const double room = j.Hubs[a.Arc->StartHub].Seams.size() > 2
                              ? 0.7 * across
                              : across + (stem.at(a.Arc->StemShare) - center).norm();
        need = std::max(
          need, static_cast<int>(std::min(own.Length / std::max(0.7 * room, 1e-300), HubColumns)));
      }
    }
    return need + need % 2;
  }

  void pass()
  {
    for (std::size_t t = 0; t < this->Net.Tubes.size(); ++t)
    {
      Tube& tube = this->Net.Tubes[t];
      tube.Columns = this->Wanted[t];
      tube.Corners = {};
      this->Layouts[t].Bottom.clear();
    }
    for (Junction& j : this->Net.Junctions)
    {
      const std::vector<Index> stem(1, j.Stem);
      const std::vector<Index>& lower = j.StemAbove ? j.Branches : stem;
      for (const Index t : lower)
      {
        this->endBelow(t);
      }
      for (const Index t : j.StemAbove ? stem : j.Branches)
      {
        this->startAbove(t);
      }
    }
  }

  /// More columns for the free tubes of each part in which some tube has too few. False: none has.
  bool raise()
  {
    std::vector<double> factor(this->Net.Tubes.size(), 1.0);
    bool any = false;
    for (std::size_t t = 0; t < this->Net.Tubes.size(); ++t)
    {
      double& f = factor[this->Parts.find(static_cast<std::int64_t>(t))];
      f = std::max(f, static_cast<double>(this->Need[t]) / this->Net.Tubes[t].Columns);
    }
    for (std::size_t t = 0; t < this->Net.Tubes.size(); ++t)
    {
      const double f = factor[this->Parts.find(static_cast<std::int64_t>(t))];
      const int most = std::min(2 * this->Need[t], std::max(MaximumColumns, this->Need[t]));
      if (f > 1.0 && this->Wanted[t] < most)
      {
        const int more = static_cast<int>(std::ceil(this->Wanted[t] * std::min(f, 1.5)));
        this->Wanted[t] = std::min(most, std::max(more + more % 2, this->Wanted[t] + 2));
        any = true;
      }
    }
    return any;
  }

  static double wrapped(double d) { return d - std::round(d); }

  /// Where arc k may end so that it and those after it have their least spans.
  int bounded(
    Index t, const std::vector<ArcEnd>& arcs, std::size_t k, int to, int used, int n) const
  {
    int rest = 0;
    for (std::size_t i = k + 1; i < arcs.size(); ++i)
    {
      rest += this->leastSpans(t, 1, arcs[i]);
    }
    return std::max(std::min(to, n - rest), used + this->leastSpans(t, 1, arcs[k]));
  }

  /// Spans of arcs that sum up to n, by their lengths, even, none below the minimum.
  std::vector<int> spansByLength(Index t, const std::vector<ArcEnd>& arcs, int n) const
  {
    std::vector<int> spans;
    double reached = 0.0;
    int used = 0;
    double total = 0.0;
    for (const ArcEnd& a : arcs)
    {
      total += a.length();
    }
    for (std::size_t k = 0; k < arcs.size(); ++k)
    {
      reached += arcs[k].length() / total;
      int to = 2 * static_cast<int>(std::lround(0.5 * reached * n));
      to = this->bounded(t, arcs, k, to, used, n);
      spans.push_back(to - used);
      used = to;
    }
    return spans;
  }

  /// Corners of a tube at its upper end.
  void endBelow(Index t)
  {
    Tube& tube = this->Net.Tubes[t];
    const std::vector<ArcEnd> arcs = this->arcsAt(t, 1);
    const int n = std::max(tube.Columns, static_cast<int>(arcs.size()) * this->MinimumArc);
    if (this->Layouts[t].Bottom.empty())
    {
      tube.Columns = n;
    }
    std::vector<int> spans = this->spansByLength(t, arcs, tube.Columns);
    int first = 0;
    if (!this->Layouts[t].Bottom.empty())
    {
      const std::vector<double> shares = this->carriedUp(t).back();
      spans = this->spansByPlace(t, arcs, shares);
      first = this->bestFirst(t, arcs, shares, spans);
    }
    for (std::size_t k = 0; k < arcs.size(); ++k)
    {
      arcs[k].column() = first % tube.Columns;
      arcs[k].Arc->Spans = spans[k];
      tube.Corners[1].push_back(first % tube.Columns);
      first += spans[k];
    }
    std::sort(tube.Corners[1].begin(), tube.Corners[1].end());
  }

  /// Spans of arcs by the columns that come to lie on them.
  std::vector<int> spansByPlace(
    Index t, const std::vector<ArcEnd>& arcs, const std::vector<double>& shares) const
  {
    const auto n = static_cast<int>(shares.size());
    std::vector<int> spans;
    int used = 0;
    double reached = 0.0;
    for (std::size_t k = 0; k < arcs.size(); ++k)
    {
      double inside = 0.0;
      for (const double s : shares)
      {
        inside += fraction(s - arcs[k].share()) < arcs[k].length() ? 1.0 : 0.0;
      }
      reached += inside;
      int to = 2 * static_cast<int>(std::lround(0.5 * reached));
      to = k + 1 == arcs.size() ? n : this->bounded(t, arcs, k, to, used, n);
      spans.push_back(to - used);
      used = to;
    }
    return spans;
  }

  /// The column with which the first arc starts best; corners of the two ends coincide or keep
  /// away from each other.
  int bestFirst(Index t, const std::vector<ArcEnd>& arcs, const std::vector<double>& shares,
    const std::vector<int>& spans) const
  {
    const Tube& tube = this->Net.Tubes[t];
    int best = 0;
    double least = Infinity;
    for (int first = 0; first < tube.Columns; ++first)
    {
      double cost = 0.0;
      int u = first;
      for (std::size_t k = 0; k < arcs.size(); ++k)
      {
        const double d = wrapped(shares[u % tube.Columns] - arcs[k].share());
        cost += d * d;
        for (const int below : tube.Corners[0])
        {
          const int gap = std::abs(u % tube.Columns - below);
          const int apart = std::min(gap, tube.Columns - gap);
          cost += apart > 0 && apart < this->Options.Order + 1 ? 1.0 : 0.0;
        }
        u += spans[k];
      }
      if (cost < least)
      {
        least = cost;
        best = first;
      }
    }
    return best;
  }

  /// Columns of a tube that starts at a junction: those of its arcs, where the other side's are.
  void startAbove(Index t)
  {
    Tube& tube = this->Net.Tubes[t];
    ColumnLayout& l = this->Layouts[t];
    int column = 0;
    for (const ArcEnd& a : this->arcsAt(t, 0))
    {
      a.column() = column;
      tube.Corners[0].push_back(column);
      column += a.Arc->Spans;
      const Junction& j = this->Net.Junctions[tube.Junctions[0]];
      const ArcEnd other{a.Arc, !a.Stem};
      const Index below = a.Stem ? j.Branches[a.Arc->Branch] : j.Stem;
      const std::vector<double> shares = this->sharesOn(below).back();
      const auto n = static_cast<int>(shares.size());
      const double turn = std::floor(a.share());
      for (int k = 0; k < a.Arc->Spans; ++k)
      {
        double along = fraction(shares[(other.column() + k) % n] - other.share() + 1e-9);
        along = k == 0 ? 0.0 : along / other.length();
        const double place = interpolated(other.places(), a.places(), std::min(along, 1.0));
        double share = a.share() - turn + place * a.length();
        if (!l.Bottom.empty())
        {
          share += std::ceil(l.Bottom.back() - share);
        }
        l.Bottom.push_back(share);
      }
    }
    tube.Columns = column;
  }

  /// Corners of caps: a quarter of the columns apart, away from corners at the other end.
  void placeCaps(Index t)
  {
    Tube& tube = this->Net.Tubes[t];
    const int n = tube.Columns;
    const int quarter = n / 4;
    const int corner[4] = {0, quarter, n / 2, n / 2 + quarter};
    const std::vector<int> others = tube.Corners[tube.Capped[0] ? 1 : 0];
    int best = 0;
    int widest = -1;
    for (int first = 0; first < n; ++first)
    {
      int nearest = n;
      for (const int c : corner)
      {
        for (const int o : others)
        {
          const int gap = std::abs((first + c) % n - o);
          nearest = std::min(nearest, std::min(gap, n - gap));
        }
      }
      if (nearest > widest)
      {
        widest = nearest;
        best = first;
      }
    }
    for (int e = 0; e < 2; ++e)
    {
      for (int k = 0; k < 4 && tube.Capped[e]; ++k)
      {
        tube.Corners[e].push_back((best + corner[k]) % n);
      }
      std::sort(tube.Corners[e].begin(), tube.Corners[e].end());
    }
  }

  /// A place on a contour carried to a neighboring one of its tube (forward: the next).
  double carry(const ColumnLayout& l, std::size_t contour, bool forward, double share) const
  {
    const ArcMatch& m = forward ? l.Next[contour] : l.Next[contour - 1];
    const double x = share - l.Start[contour];
    const double turn = std::floor(x);
    const double place = forward ? interpolated(m.First, m.Second, x - turn)
                                 : interpolated(m.Second, m.First, x - turn);
    return turn + place + l.Start[forward ? contour + 1 : contour - 1];
  }

  /// All columns carried one contour on, and relaxed towards equal spacing.
  std::vector<double> carriedAll(
    const ColumnLayout& l, std::size_t contour, bool forward, const std::vector<double>& from) const
  {
    const auto n = static_cast<double>(from.size());
    std::vector<double> shares;
    double offset = 0.0;
    for (std::size_t u = 0; u < from.size(); ++u)
    {
      shares.push_back(this->carry(l, contour, forward, from[u]));
      offset += (shares.back() - static_cast<double>(u) / n) / n;
    }
    for (std::size_t u = 0; u < from.size(); ++u)
    {
      shares[u] += Relaxation * (offset + static_cast<double>(u) / n - shares[u]);
    }
    return shares;
  }

  /// Shares of all columns on all contours of a tube, from its lower end.
  std::vector<std::vector<double>> carriedUp(Index t) const
  {
    const ColumnLayout& l = this->Layouts[t];
    std::vector<std::vector<double>> out(1, l.Bottom);
    for (std::size_t k = 1; k < l.Curves.size(); ++k)
    {
      out.push_back(this->carriedAll(l, k - 1, true, out.back()));
    }
    return out;
  }

  /// Share of column k of an arc: at equal steps of its match, so that what is long on either of
  /// the two contours (a bay that opens between them) gets its columns.
  static double placeOn(const ArcEnd& a, int k)
  {
    const double x =
      static_cast<double>(k) / a.Arc->Spans * static_cast<double>(a.places().size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), a.places().size() - 2);
    const double r = x - static_cast<double>(i);
    return a.share() + a.length() * ((1.0 - r) * a.places()[i] + r * a.places()[i + 1]);
  }

  /// The same for a tube that starts freely: from its upper end, or evenly.
  std::vector<std::vector<double>> carriedDown(Index t) const
  {
    const ColumnLayout& l = this->Layouts[t];
    const int n = this->Net.Tubes[t].Columns;
    const std::vector<ArcEnd> arcs = this->arcsAt(t, 1);
    std::vector<Anchor> anchors;
    for (const ArcEnd& a : arcs)
    {
      for (int k = 0; k < a.Arc->Spans; ++k)
      {
        anchors.push_back({(a.column() + k) % n, placeOn(a, k)});
      }
    }
    std::vector<std::vector<double>> out(1);
    std::vector<double>& top = out[0];
    top.reserve(static_cast<std::size_t>(n));
    for (int u = 0; u < n; ++u)
    {
      top.push_back(anchors.empty() ? l.Start.back() + static_cast<double>(u) / n
                                    : ColumnMap(anchors, n).at(u));
    }
    for (std::size_t k = l.Curves.size() - 1; k > 0; --k)
    {
      out.push_back(this->carriedAll(l, k, false, out.back()));
    }
    std::reverse(out.begin(), out.end());
    return out;
  }

  /// Shares on all contours, corners of the upper end at their places.
  std::vector<std::vector<double>> sharesOn(Index t) const
  {
    if (this->Layouts[t].Bottom.empty())
    {
      return this->carriedDown(t);
    }
    std::vector<std::vector<double>> shares = this->carriedUp(t);
    const std::vector<ArcEnd> arcs = this->arcsAt(t, 1);
    if (arcs.empty())
    {
      return shares;
    }
    const int n = this->Net.Tubes[t].Columns;
    std::vector<double> shift(static_cast<std::size_t>(n), 0.0);
    for (std::size_t i = 0; i < arcs.size(); ++i)
    {
      const ArcEnd& a = arcs[i];
      const ArcEnd& next = arcs[(i + 1) % arcs.size()];
      const double from = wrapped(a.share() - shares.back()[a.column()]);
      const double to = wrapped(next.share() - shares.back()[next.column()]);
      for (int k = 0; k < a.Arc->Spans; ++k)
      {
        const int u = (a.column() + k) % n;
        const double r = static_cast<double>(k) / a.Arc->Spans;
        shift[u] = this->Options.FollowMatch ? wrapped(placeOn(a, k) - shares.back()[u])
                                             : (1.0 - r) * from + r * to;
      }
    }
    const std::size_t m = shares.size();
    for (std::size_t k = 0; k < m; ++k)
    {
      const double s = m > 1 ? static_cast<double>(k) / static_cast<double>(m - 1) : 1.0;
      for (int u = 0; u < n; ++u)
      {
        shares[k][u] += s * shift[u];
      }
    }
    return shares;
  }

  void fillShares(Index t) { this->Net.Tubes[t].Shares = this->sharesOn(t); }

  const ContourStack& Stack;
  const NetworkOptions& Options;
  BranchedNetwork& Net;
  const int MinimumArc;
  UnionFind Parts;
  std::vector<ColumnLayout> Layouts;
  std::vector<int> Least;
  std::vector<int> Need;
  std::vector<int> Wanted; ///< columns of tubes that start freely
};
} // namespace

void assignColumns(const ContourStack& stack, const NetworkOptions& options, BranchedNetwork& net)
{
  Assigner(stack, options, net).run();
}
} // namespace bsr
