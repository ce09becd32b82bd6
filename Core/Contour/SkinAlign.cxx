#include "Contour/SkinGrid.h"
#include "Contour/SkinMatch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
/// Of even steps against closeness, per square of an eighth of a ring.
constexpr double Stiffness = 0.1;
/// Least share of a leg's contour that faces other legs.
constexpr double LeastFace = 0.08;

/// A node of a ring and the share of its contour there.
struct Anchor
{
  double Node;
  double Share;
  bool End = false; ///< of a run
};

/// Shares of all nodes, linear between anchors (nodes increasing within one turn, shares too).
std::vector<double> sharesThrough(const std::vector<Anchor>& anchors, int size)
{
  std::vector<double> shares;
  std::vector<Anchor> ring = anchors;
  ring.push_back({anchors[0].Node + size, anchors[0].Share + 1.0});
  ring.insert(ring.begin(), {anchors.back().Node - size, anchors.back().Share - 1.0});
  std::size_t a = 0;
  for (int k = 0; k < size; ++k)
  {
    while (a + 2 < ring.size() && ring[a + 1].Node <= k)
    {
      ++a;
    }
    const double t = (k - ring[a].Node) / (ring[a + 1].Node - ring[a].Node);
    shares.push_back(ring[a].Share + t * (ring[a + 1].Share - ring[a].Share));
  }
  return shares;
}

/// Lays contours on rings.
class Aligner
{
public:
  Aligner(const ContourStack& stack, SkinGrid& grid) : Stack(stack), Grid(grid) {}

  void run()
  {
    const auto n = static_cast<Index>(this->Grid.Rings.size());
    this->Inner.assign(n, {});
    this->Done.assign(n, 0);
    for (Index r = 1; r < n; ++r)
    {
      this->Inner[this->Grid.Rings[r].Outer].push_back(r);
    }
    for (Index r = 0; r < n; ++r)
    {
      if (this->Inner[r].size() > 1)
      {
        this->divide(r);
      }
    }
    if (!this->Done[0] && n > 0)
    {
      this->fromBelow(0);
    }
    for (Index r = 1; r < n; ++r)
    {
      if (!this->Done[r])
      {
        this->follow(this->Grid.Rings[r].Outer, r);
      }
    }
  }

private:
  const Contour& contour(Index r) const
  {
    return this->Stack.Contours[this->Grid.Rings[r].Contour];
  }
  Vec2 flatAt(Index r, double share) const
  {
    return this->Stack.flat(this->Grid.Curves[r].at(share));
  }

  /// The chain from the outermost ring to the first split (or core).
  void fromBelow(Index head)
  {
    std::vector<Index> chain{head};
    while (!this->Done[chain.back()] && this->Inner[chain.back()].size() == 1)
    {
      chain.push_back(this->Inner[chain.back()][0]);
    }
    if (!this->Done[chain.back()]) // no split at all
    {
      this->face(chain.back());
    }
    for (std::size_t k = chain.size() - 1; k > 0; --k)
    {
      this->follow(chain[k], chain[k - 1]);
    }
  }

  /// As a rectangle of the contour's extent lies in the frame.
  void face(Index r)
  {
    SkinRing& ring = this->Grid.Rings[r];
    const Contour& c = this->contour(r);
    const Vec2 u = this->Grid.AxisU;
    const Vec2 v(-u.y(), u.x());
    Vec2 low = Vec2::Constant(Infinity);
    Vec2 high = -low;
    for (const Vec2& p : c.Flat)
    {
      const Vec2 q(u.dot(p), v.dot(p));
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    std::vector<Vec2> target;
    for (int k = 0; k < ring.size(); ++k)
    {
      const Vec2 g = ring.place(k) - Vec2(ring.Column, ring.Row);
      const Vec2 t(g.x() / (ring.Columns - 1), g.y() / (ring.Rows - 1));
      const Vec2 q = low + t.cwiseProduct(high - low);
      target.emplace_back(q.x() * u + q.y() * v);
    }
    this->setUniform(r, this->bestStart(r, target));
  }

  void setUniform(Index r, double start)
  {
    SkinRing& ring = this->Grid.Rings[r];
    ring.Shares.clear();
    for (int k = 0; k < ring.size(); ++k)
    {
      ring.Shares.push_back(start + static_cast<double>(k) / ring.size());
    }
    this->Done[r] = 1;
  }

  double mismatch(Index r, const std::vector<Vec2>& target, double start) const
  {
    Vec2 shift = Vec2::Zero();
    double sum = 0.0;
    const auto n = static_cast<double>(target.size());
    for (std::size_t k = 0; k < target.size(); ++k)
    {
      const Vec2 d = this->flatAt(r, start + static_cast<double>(k) / n) - target[k];
      shift += d;
      sum += d.squaredNorm();
    }
    return sum - shift.squaredNorm() / n;
  }

  double bestStart(Index r, const std::vector<Vec2>& target) const
  {
    constexpr int Tries = 96;
    double best = Infinity;
    double start = 0.0;
    for (int i = 0; i < Tries; ++i)
    {
      const double t = static_cast<double>(i) / Tries;
      const double m = this->mismatch(r, target, t);
      if (m < best)
      {
        best = m;
        start = t;
      }
    }
    return start;
  }

  /// Nodes close to those of a neighboring ring already in place.
  void follow(Index from, Index to)
  {
    const SkinRing& a = this->Grid.Rings[from];
    SkinRing& b = this->Grid.Rings[to];
    const bool inward = b.Rows < a.Rows;
    const double share = overlapShare(this->contour(from).Flat, this->contour(to).Flat);
    const Vec2 shift =
      share < 0.5 ? Vec2(this->contour(to).Center - this->contour(from).Center) : Vec2(0.0, 0.0);
    // where the neighbor's nodes are, spread a little so that nodes new at corners find room
    std::vector<double> near;
    for (int k = 0; k < b.size(); ++k)
    {
      const Vec2 g = b.place(k);
      const Vec2 q =
        inward ? Vec2(g.x() + side(g.x(), b.Column, b.Columns), g.y() + side(g.y(), b.Row, b.Rows))
               : Vec2(std::clamp<double>(g.x(), a.Column, a.Column + a.Columns - 1),
                   std::clamp<double>(g.y(), a.Row, a.Row + a.Rows - 1));
      near.push_back(a.shareAt(nodeAt(a, q)));
      near.back() += k > 0 ? std::ceil(near[k - 1] - near[k] - 1e-9) : 0.0;
    }
    spread(near);
    constexpr int Fine = 4;
    const int positions = Fine * b.size();
    std::vector<Vec2> target;
    std::vector<double> steps;
    for (int k = 0; k < b.size(); ++k)
    {
      target.push_back(this->flatAt(from, near[k]) + shift);
      const double next = k + 1 < b.size() ? near[k + 1] : near[0] + 1.0;
      steps.push_back(positions * (next - near[k]));
    }
    std::vector<Vec2> curve;
    for (int m = 0; m < positions; ++m)
    {
      curve.push_back(this->flatAt(to, static_cast<double>(m) / positions));
    }
    const double offset = this->bestTurn(to, target, near);
    const int start = static_cast<int>(std::lround((near[0] + offset) * positions));
    b.Shares.clear();
    for (const int m :
      matchNodes(curve, target, steps, Stiffness * b.size() * b.size() / 64.0, start))
    {
      b.Shares.push_back(static_cast<double>(m) / positions);
    }
    this->Done[to] = 1;
  }

  /// Evens out increasing shares around a contour.
  static void spread(std::vector<double>& shares)
  {
    constexpr int Rounds = 200;
    const std::size_t n = shares.size();
    for (int round = 0; round < Rounds; ++round)
    {
      std::vector<double> even(n);
      for (std::size_t k = 0; k < n; ++k)
      {
        const double before = k > 0 ? shares[k - 1] : shares[n - 1] - 1.0;
        const double after = k + 1 < n ? shares[k + 1] : shares[0] + 1.0;
        even[k] = 0.5 * shares[k] + 0.25 * (before + after);
      }
      shares.swap(even);
    }
  }

  /// The shift of shares at which the contour is closest to the targets.
  double bestTurn(Index r, const std::vector<Vec2>& target, const std::vector<double>& shares) const
  {
    constexpr int Tries = 96;
    double best = Infinity;
    double turn = 0.0;
    for (int i = 0; i < Tries; ++i)
    {
      const double t = static_cast<double>(i) / Tries;
      double sum = 0.0;
      Vec2 shift = Vec2::Zero();
      for (std::size_t k = 0; k < target.size(); ++k)
      {
        const Vec2 d = this->flatAt(r, shares[k] + t) - target[k];
        shift += d;
        sum += d.squaredNorm();
      }
      sum -= shift.squaredNorm() / static_cast<double>(target.size());
      if (sum < best)
      {
        best = sum;
        turn = t;
      }
    }
    return turn;
  }

  static double side(double x, int first, int count)
  {
    return x <= first ? -1.0 : x >= first + count - 1 ? 1.0 : 0.0;
  }

  /// Number of the node of a ring at a place on its outline.
  static double nodeAt(const SkinRing& r, const Vec2& q)
  {
    const double x = q.x() - r.Column;
    const double y = q.y() - r.Row;
    const int w = r.Columns - 1;
    const int h = r.Rows - 1;
    if (y <= 0.0)
    {
      return x;
    }
    if (x >= w)
    {
      return w + y;
    }
    return y >= h ? 2 * w + h - x : 2 * w + 2 * h - y;
  }

  /// A run of nodes of the outer ring along one leg.
  struct Run
  {
    Index Leg;
    int First; ///< node of the outer ring
    int Count;
  };

  /// The ring that a node's neighbor inside lies on.
  Index inside(Index r, int k) const
  {
    const SkinRing& ring = this->Grid.Rings[r];
    const Vec2 p = ring.place(k);
    const double x = std::clamp<double>(p.x(), ring.Column + 1, ring.Column + ring.Columns - 2);
    const double y = std::clamp<double>(p.y(), ring.Row + 1, ring.Row + ring.Rows - 2);
    for (const Index leg : this->Inner[r])
    {
      const SkinRing& l = this->Grid.Rings[leg];
      if (x >= l.Column && x < l.Column + l.Columns && y >= l.Row && y < l.Row + l.Rows)
      {
        return leg;
      }
    }
    return this->Inner[r][0];
  }

  std::vector<Run> runsAlong(Index r) const
  {
    std::vector<Run> runs;
    const int n = this->Grid.Rings[r].size();
    for (int k = 0; k < n; ++k)
    {
      const Index leg = this->inside(r, k);
      if (runs.empty() || runs.back().Leg != leg)
      {
        runs.push_back({leg, k, 0});
      }
      ++runs.back().Count;
    }
    if (runs.size() > 1 && runs.front().Leg == runs.back().Leg)
    {
      runs.front().First = runs.back().First - n;
      runs.front().Count += runs.back().Count;
      runs.pop_back();
    }
    return runs;
  }

  /// Divides ring r's contour among the legs inside it, and lays the legs' contours accordingly.
  void divide(Index r)
  {
    const std::vector<Run> runs = this->runsAlong(r);
    const std::vector<double> cuts = this->cutShares(r, runs);
    std::vector<Anchor> outer;
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
      outer.push_back({runs[i].First - 0.5, cuts[i]});
    }
    SkinRing& ring = this->Grid.Rings[r];
    ring.Shares = sharesThrough(outer, ring.size());
    this->Done[r] = 1;
    for (const Index leg : this->Inner[r])
    {
      this->layLeg(r, leg, runs, cuts);
    }
  }

  /// The leg's corners that face the ends of its runs lie where the contour is nearest to them.
  void layLeg(Index r, Index leg, const std::vector<Run>& runs, const std::vector<double>& cuts)
  {
    SkinRing& inner = this->Grid.Rings[leg];
    const SkinRing& ring = this->Grid.Rings[r];
    std::vector<Anchor> anchors;
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
      if (runs[i].Leg != leg)
      {
        continue;
      }
      for (const bool end : {false, true})
      {
        const int k = end ? runs[i].First + runs[i].Count - 1 : runs[i].First;
        const Vec2 p = ring.place(k);
        const Vec2 q(std::clamp<double>(p.x(), inner.Column, inner.Column + inner.Columns - 1),
          std::clamp<double>(p.y(), inner.Row, inner.Row + inner.Rows - 1));
        const double cut = end ? (i + 1 < cuts.size() ? cuts[i + 1] : cuts[0] + 1.0) : cuts[i];
        anchors.push_back({nodeAt(inner, q), this->nearestShare(leg, this->flatAt(r, cut))});
      }
    }
    std::stable_sort(anchors.begin(), anchors.end(),
      [](const Anchor& a, const Anchor& b) { return a.Node < b.Node; });
    if (!putInOrder(anchors))
    {
      this->face(leg);
      return;
    }
    inner.Shares = sharesThrough(anchors, inner.size());
    this->Done[leg] = 1;
  }

  /**
   * Anchors come in pairs, the ends of a run along the outer contour; between two runs a leg faces
   * other legs. Makes shares increase around, faces at least LeastFace wide; false where the runs
   * overlap.
   */
  static bool putInOrder(std::vector<Anchor>& anchors)
  {
    std::stable_sort(anchors.begin(), anchors.end(),
      [](const Anchor& a, const Anchor& b) { return a.Node < b.Node; });
    const std::size_t n = anchors.size();
    // a pair that wraps around the first node: the first anchor is a run's end
    const bool wraps = n > 1 && anchors[0].End;
    double total = 0.0;
    std::vector<double> gap(n);
    for (std::size_t i = 0; i < n; ++i)
    {
      const std::size_t j = (i + 1) % n;
      const double d = anchors[j].Share - anchors[i].Share;
      const bool run = (i % 2 == 0) != wraps;
      gap[i] = run ? d - std::floor(d) : d - std::round(d);
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      const bool run = (i % 2 == 0) != wraps;
      if (!run && gap[i] < LeastFace)
      {
        const double more = 0.5 * (LeastFace - gap[i]);
        gap[i] = LeastFace;
        gap[(i + n - 1) % n] -= more;
        gap[(i + 1) % n] -= more;
        anchors[i].Share -= more;
        anchors[(i + 1) % n].Share += more;
      }
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      total += gap[i];
      const double nodes = i + 1 < n ? anchors[i + 1].Node - anchors[i].Node : 1.0;
      if (gap[i] < 0.02 || nodes < 0.5)
      {
        return false;
      }
      if (i + 1 < n)
      {
        anchors[i + 1].Share = anchors[i].Share + gap[i];
      }
    }
    return n > 1 && std::abs(total - 1.0) < 1e-9;
  }

  double nearestShare(Index r, const Vec2& p) const
  {
    constexpr int Tries = 512;
    double best = Infinity;
    double share = 0.0;
    for (int i = 0; i < Tries; ++i)
    {
      const double t = static_cast<double>(i) / Tries;
      const double d = (this->flatAt(r, t) - p).squaredNorm();
      if (d < best)
      {
        best = d;
        share = t;
      }
    }
    return share;
  }

  /// Where along ring r's contour the runs begin: each run's part is as close to its leg as can be.
  std::vector<double> cutShares(Index r, const std::vector<Run>& runs) const
  {
    constexpr int Tries = 192;
    const auto segments = static_cast<int>(runs.size());
    std::vector<std::vector<double>> sums(runs.size()); // prefix sums of squared distances, twice
    std::vector<Vec2> points;
    for (int i = 0; i < Tries; ++i)
    {
      points.push_back(this->flatAt(r, static_cast<double>(i) / Tries));
    }
    for (int s = 0; s < segments; ++s)
    {
      const Contour& leg = this->contour(runs[s].Leg);
      sums[s].push_back(0.0);
      for (int i = 0; i < 2 * Tries; ++i)
      {
        const double d = i < Tries ? curveDistance(leg.Flat, true, points[i])
                                   : std::sqrt(sums[s][i - Tries + 1] - sums[s][i - Tries]);
        sums[s].push_back(sums[s].back() + d * d);
      }
    }
    const int least = std::max(1, Tries / (12 * segments));
    double best = Infinity;
    std::vector<int> cuts(runs.size(), 0);
    for (int start = 0; start < Tries; ++start)
    {
      // cost[i]: of the segments so far, ending before sample start + i
      std::vector<double> cost(Tries + 1, Infinity);
      std::vector<std::vector<int>> from(runs.size(), std::vector<int>(Tries + 1, 0));
      cost[0] = 0.0;
      for (int s = 0; s < segments; ++s)
      {
        std::vector<double> next(Tries + 1, Infinity);
        double low = Infinity; // of cost[j] - sum up to j
        int lowAt = 0;
        for (int i = least; i <= Tries; ++i)
        {
          const int j = i - least;
          const double c = cost[j] - sums[s][start + j];
          if (c < low)
          {
            low = c;
            lowAt = j;
          }
          next[i] = low + sums[s][start + i];
          from[s][i] = lowAt;
        }
        cost.swap(next);
      }
      if (cost[Tries] < best)
      {
        best = cost[Tries];
        int i = Tries;
        for (int s = segments - 1; s >= 0; --s)
        {
          i = from[s][i];
          cuts[s] = start + i;
        }
      }
    }
    std::vector<double> shares;
    for (const int c : cuts)
    {
      shares.push_back(static_cast<double>(c) / Tries);
    }
    return shares;
  }

  const ContourStack& Stack;
  SkinGrid& Grid;
  std::vector<std::vector<Index>> Inner;
  std::vector<char> Done;
};

void fillPoints(SkinGrid& grid)
{
  const std::size_t count = static_cast<std::size_t>(grid.Rows) * grid.Columns;
  grid.Points.assign(count, Vec3::Zero());
  grid.RingOf.assign(count, -1);
  grid.OwnerOf.assign(count, 0);
  for (std::size_t r = 0; r < grid.Rings.size(); ++r)
  {
    const SkinRing& ring = grid.Rings[r];
    for (int row = ring.Row; ring.Core && row < ring.Row + ring.Rows; ++row)
    {
      for (int c = ring.Column; c < ring.Column + ring.Columns; ++c)
      {
        grid.OwnerOf[grid.node(row, c)] = static_cast<Index>(r);
      }
    }
    for (int k = 0; k < ring.size(); ++k)
    {
      const Vec2 p = ring.place(k);
      const Index node = grid.node(static_cast<int>(p.y()), static_cast<int>(p.x()));
      grid.Points[node] = grid.at(static_cast<Index>(r), k);
      grid.RingOf[node] = static_cast<Index>(r);
      grid.OwnerOf[node] = static_cast<Index>(r);
    }
  }
}
} // namespace

void alignGrid(const ContourStack& stack, SkinGrid& grid)
{
  Aligner(stack, grid).run();
  fillPoints(grid);
}
} // namespace bsr
