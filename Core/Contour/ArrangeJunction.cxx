#include "Contour/BranchedNetwork.h"

#include "Common/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace bsr
{
namespace
{
constexpr int StemSamples = 720;
constexpr double Infinity = std::numeric_limits<double>::infinity();

Vec3 lifted(const Vec2& p)
{
  return {p[0], p[1], 0.0};
}

/// A run of samples of the stem with one nearest branch.
struct Run
{
  int Label;
  double Start; ///< in samples
  double Length;
};

/// Cuts a stem's contour at places where the nearest branch changes.
class StemLabels
{
public:
  StemLabels(const ArcCurve& stem, const std::vector<ArcCurve>& branches) : Branches(branches)
  {
    for (int i = 0; i < StemSamples; ++i)
    {
      const Vec3 p = stem.at(static_cast<double>(i) / StemSamples);
      std::vector<double> away;
      away.reserve(branches.size());
      for (const ArcCurve& b : branches)
      {
        away.push_back((b.at(b.nearest(p)) - p).norm());
      }
      this->Labels.push_back(
        static_cast<int>(std::min_element(away.begin(), away.end()) - away.begin()));
      this->Away.push_back(std::move(away));
    }
  }

  std::vector<Run> run()
  {
    this->addMissing();
    std::vector<Run> runs = this->runsOf();
    this->dropSmall(runs, 0.03 * StemSamples);
    while (!nonCrossing(runs))
    {
      this->dropSmall(runs, Infinity);
    }
    return runs;
  }

private:
  /// A branch that is nowhere nearest gets a piece where it is least far behind.
  void addMissing()
  {
    for (int b = 0; b < static_cast<int>(this->Branches.size()); ++b)
    {
      if (std::count(this->Labels.begin(), this->Labels.end(), b) > 0)
      {
        continue;
      }
      int best = 0;
      double least = Infinity;
      for (int i = 0; i < StemSamples; ++i)
      {
        const double behind = this->Away[i][b] - this->Away[i][this->Labels[i]];
        if (behind < least)
        {
          least = behind;
          best = i;
        }
      }
      const int width = StemSamples / (4 * static_cast<int>(this->Branches.size()));
      for (int d = -width / 2; d <= width / 2; ++d)
      {
        this->Labels[(best + d + StemSamples) % StemSamples] = b;
      }
    }
  }

  std::vector<Run> runsOf() const
  {
    std::vector<Run> runs;
    int first = 0;
    while (first < StemSamples &&
           this->Labels[first] == this->Labels[(first + StemSamples - 1) % StemSamples])
    {
      ++first;
    }
    for (int i = 0; i < StemSamples; ++i)
    {
      const int s = (first + i) % StemSamples;
      if (runs.empty() || runs.back().Label != this->Labels[s])
      {
        runs.push_back({this->Labels[s], s - 0.5, 0.0});
      }
      runs.back().Length += 1.0;
    }
    return runs;
  }

  /// Removes runs of at most `limit` whose label has another one, shortest first; with an infinite
  /// limit only the shortest.
  void dropSmall(std::vector<Run>& runs, double limit) const
  {
    while (true)
    {
      std::map<int, int> uses;
      for (const Run& r : runs)
      {
        ++uses[r.Label];
      }
      auto shortest = runs.end();
      for (auto r = runs.begin(); r != runs.end(); ++r)
      {
        if (uses[r->Label] > 1 && r->Length <= limit &&
            (shortest == runs.end() || r->Length < shortest->Length))
        {
          shortest = r;
        }
      }
      if (shortest == runs.end())
      {
        return;
      }
      remove(runs, static_cast<std::size_t>(shortest - runs.begin()));
      if (limit == Infinity)
      {
        return;
      }
    }
  }

  /// Gives a run's two halves to its neighbors and joins equal ones.
  static void remove(std::vector<Run>& runs, std::size_t i)
  {
    const std::size_t n = runs.size();
    const double half = 0.5 * runs[i].Length;
    runs[(i + n - 1) % n].Length += half;
    runs[(i + 1) % n].Start -= half;
    runs[(i + 1) % n].Length += half;
    runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(i));
    for (std::size_t k = 0; k < runs.size() && runs.size() > 1;)
    {
      const std::size_t next = (k + 1) % runs.size();
      if (runs[k].Label != runs[next].Label)
      {
        ++k;
        continue;
      }
      runs[k].Length += runs[next].Length;
      runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(next));
      k = 0;
    }
  }

  /// No two labels alternate a b a b around the stem.
  static bool nonCrossing(const std::vector<Run>& runs)
  {
    const std::size_t n = runs.size();
    for (std::size_t i = 0; i < n; ++i)
    {
      for (std::size_t j = i + 1; j < n; ++j)
      {
        if (runs[i].Label != runs[j].Label)
        {
          continue;
        }
        for (std::size_t k = i + 1; k < j; ++k)
        {
          for (std::size_t o = j + 1; o < n + i; ++o)
          {
            if (runs[k].Label == runs[o % n].Label && runs[k].Label != runs[i].Label)
            {
              return false;
            }
          }
        }
      }
    }
    return true;
  }

  const std::vector<ArcCurve>& Branches;
  std::vector<int> Labels;
  std::vector<std::vector<double>> Away;
};

/// The arc before arc i of the same branch (i itself where it is the only one).
Index previousOfBranch(const Junction& j, Index i)
{
  const auto n = static_cast<Index>(j.Arcs.size());
  Index k = (i + n - 1) % n;
  while (j.Arcs[k].Branch != j.Arcs[i].Branch)
  {
    k = (k + n - 1) % n;
  }
  return k;
}

/// Hubs: seams joined by the branches that touch between them (the complement of a non-crossing
/// partition, G. Kreweras, Discrete Math. 1, 1972).
void findHubs(Junction& j)
{
  const auto n = static_cast<Index>(j.Arcs.size());
  std::vector<char> done(static_cast<std::size_t>(n), 0);
  for (Index s = 0; s < n; ++s)
  {
    if (done[s])
    {
      continue;
    }
    JunctionHub hub;
    const auto number = static_cast<Index>(j.Hubs.size());
    for (Index k = s; !done[k]; k = previousOfBranch(j, (k + 1) % n))
    {
      done[k] = 1;
      hub.Seams.push_back(k);
      j.Arcs[k].EndHub = number;
      j.Arcs[(k + 1) % n].StartHub = number;
    }
    j.Hubs.push_back(std::move(hub));
  }
}

/// The middle between the branches of a hub: the mean of the points of them nearest to it.
Vec2 middleOf(const std::vector<ArcCurve>& branches, const std::vector<Index>& of, Vec3 c)
{
  for (int round = 0; round < 40; ++round)
  {
    Vec3 sum = Vec3::Zero();
    for (const Index b : of)
    {
      sum += branches[b].at(branches[b].nearest(c)) / static_cast<double>(of.size());
    }
    c = sum;
  }
  return c.head<2>();
}

/// Middle of the shortest line between two curves.
Vec3 betweenCurves(const ArcCurve& a, const ArcCurve& b)
{
  double best = Infinity;
  Vec3 middle = Vec3::Zero();
  for (int i = 0; i < 360; ++i)
  {
    const Vec3 p = a.at(i / 360.0);
    const Vec3 q = b.at(b.nearest(p));
    if ((p - q).norm() < best)
    {
      best = (p - q).norm();
      middle = 0.5 * (p + q);
    }
  }
  return middle;
}

void placeHub(const Junction& j, const Contour& stem, const ArcCurve& stemCurve,
  const std::vector<ArcCurve>& branches, JunctionHub& hub)
{
  const auto n = static_cast<Index>(j.Arcs.size());
  std::vector<Index> of;
  Vec3 seams = Vec3::Zero();
  for (const Index s : hub.Seams)
  {
    of.push_back(j.Arcs[(s + 1) % n].Branch);
    seams += stemCurve.at(j.Arcs[(s + 1) % n].StemShare) / static_cast<double>(hub.Seams.size());
  }
  Vec3 start = Vec3::Zero();
  for (std::size_t k = 0; k < of.size(); ++k)
  {
    start += betweenCurves(branches[of[k]], branches[of[(k + 1) % of.size()]]) /
             static_cast<double>(of.size());
  }
  hub.Flat = middleOf(branches, of, start);
  if (j.Mixed || !insideCurve(stem.Flat, hub.Flat)) // a bay closes between its two lips
  {
    hub.Flat = seams.head<2>();
  }
}

/// Where each arc starts on its branch: at the point nearest to the hub, in the arcs' order.
bool placeStarts(Junction& j, const std::vector<ArcCurve>& branches)
{
  for (JunctionArc& a : j.Arcs)
  {
    a.BranchShare = branches[a.Branch].nearest(lifted(j.Hubs[a.StartHub].Flat));
  }
  for (Index b = 0; b < static_cast<Index>(branches.size()); ++b)
  {
    std::vector<double> shares;
    for (const JunctionArc& a : j.Arcs)
    {
      if (a.Branch == b)
      {
        shares.push_back(a.BranchShare);
      }
    }
    double turn = 0.0;
    double least = 1.0;
    for (std::size_t k = 0; k < shares.size(); ++k)
    {
      const double d = shares[(k + 1) % shares.size()] - shares[k];
      turn += d - std::floor(d);
      least = std::min(least, d - std::floor(d));
    }
    if (shares.size() > 1 && (std::abs(turn - 1.0) > 1e-6 || least < 0.05))
    {
      return false;
    }
  }
  return true;
}

/// Lengths of the arcs and the correspondence between stem and branch along them.
void matchAll(Junction& j, const ArcCurve& stem, const std::vector<ArcCurve>& branches)
{
  const auto n = static_cast<Index>(j.Arcs.size());
  for (Index a = 0; a < n; ++a)
  {
    JunctionArc& arc = j.Arcs[a];
    const double onStem = j.Arcs[(a + 1) % n].StemShare - arc.StemShare;
    Index next = (a + 1) % n; // the next arc of the same branch
    while (j.Arcs[next].Branch != arc.Branch)
    {
      next = (next + 1) % n;
    }
    const double onBranch = j.Arcs[next].BranchShare - arc.BranchShare;
    arc.StemLength = onStem - std::floor(onStem);
    arc.BranchLength = next == a ? 1.0 : onBranch - std::floor(onBranch);
    arc.Match = matchArcs({&branches[arc.Branch], arc.BranchShare, arc.BranchLength},
      {&stem, arc.StemShare, arc.StemLength});
  }
}

/// One arc a branch, in the order of the longest ones: one hub for all.
std::vector<Run> longestOnly(const std::vector<Run>& runs)
{
  std::map<int, double> longest;
  for (const Run& r : runs)
  {
    longest[r.Label] = std::max(longest[r.Label], r.Length);
  }
  std::vector<Run> kept;
  for (const Run& r : runs)
  {
    if (r.Length == longest[r.Label])
    {
      longest[r.Label] = Infinity;
      kept.push_back(r);
    }
  }
  // Seams half-way between the kept runs.
  const std::size_t n = kept.size();
  std::vector<Run> out = kept;
  for (std::size_t i = 0; i < n; ++i)
  {
    const Run& before = kept[(i + n - 1) % n];
    double gap = kept[i].Start - (before.Start + before.Length);
    gap -= StemSamples * std::floor(gap / StemSamples + 1e-9);
    out[i].Start = kept[i].Start - 0.5 * gap;
  }
  return out;
}
} // namespace

ArcCurve tubeCurve(const Contour& contour, bool flat)
{
  std::vector<Vec3> points = contour.Points;
  for (std::size_t i = 0; flat && i < points.size(); ++i)
  {
    points[i] = lifted(contour.Flat[i]);
  }
  if (contour.hole())
  {
    std::reverse(points.begin(), points.end());
  }
  return {points, true};
}

void arrangeJunction(const ContourStack& stack, const std::vector<Tube>& tubes, Junction& j)
{
  const auto endOf = [&](Index tube, bool upper) -> const Contour&
  {
    const auto& c = tubes[tube].Contours;
    return stack.Contours[upper ? c.back() : c.front()];
  };
  const Contour& stem = endOf(j.Stem, !j.StemAbove);
  for (const Index b : j.Branches)
  {
    j.Clockwise = j.Clockwise || stem.hole() || tubes[b].Hole;
    j.Mixed = j.Mixed || stem.hole() != tubes[b].Hole;
  }
  const ArcCurve stemCurve = tubeCurve(stem, true);
  std::vector<ArcCurve> branches;
  for (const Index b : j.Branches)
  {
    branches.push_back(tubeCurve(endOf(b, j.StemAbove), true));
  }
  std::vector<Run> runs = StemLabels(stemCurve, branches).run();
  for (const bool again : {true, false})
  {
    j.Arcs.clear();
    j.Hubs.clear();
    for (const Run& r : runs)
    {
      JunctionArc a;
      a.Branch = r.Label;
      a.StemShare = r.Start / StemSamples - std::floor(r.Start / StemSamples);
      j.Arcs.push_back(a);
    }
    findHubs(j);
    for (JunctionHub& h : j.Hubs)
    {
      placeHub(j, stem, stemCurve, branches, h);
    }
    if (placeStarts(j, branches) || !again)
    {
      break;
    }
    runs = longestOnly(runs);
  }
  matchAll(j, stemCurve, branches);
}
} // namespace bsr
