#include "Contour/JunctionRows.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

double fade(double x)
{
  x = std::clamp(x, 0.0, 1.0);
  return (1.0 - x) * (1.0 - x) * (1.0 + 2.0 * x);
}

/// A point of the flat coordinates on the plane of a slice.
Vec3 onSlice(const ContourStack& stack, const Slice& slice, const Vec2& p)
{
  const Vec3 base = stack.Origin + p[0] * stack.AxisX + p[1] * stack.AxisY;
  return base + slice.Normal.dot(slice.Origin - base) / slice.Normal.dot(stack.Axis) * stack.Axis;
}

/// What one arc needs: rows of both sides, clamped, and their neighbors away from the junction.
struct Side
{
  ControlRow Last;
  ControlRow Before;  ///< empty where there is none
  double Ratio = 1.0; ///< distance of Last and Before over the gap
};

class JunctionMaker
{
public:
  JunctionMaker(const ContourStack& stack, const BranchedNetwork& net, const Junction& junction,
    const std::vector<EndRows>& branches, const EndRows& stem, const RowOptions& options)
      : Stack(stack),
        Net(net),
        J(junction),
        Options(options),
        Sites(rowSites(options)),
        Rows(options.fixedRows())
  {
    this->Gap = std::abs(this->sliceOf(junction.Stem, false).Position -
                         this->sliceOf(junction.Branches[0], true).Position);
    for (const JunctionArc& a : junction.Arcs)
    {
      this->Branch.push_back(this->sideOf(branches[a.Branch], a.BranchColumn, a.Spans));
      this->Stem.push_back(this->sideOf(stem, a.StemColumn, a.Spans));
      this->SitesU.push_back(grevilleSites(clampedKnots(options.OrderU, a.Spans), options.OrderU));
    }
  }

  JunctionRows run()
  {
    this->Out.Arcs.resize(this->J.Arcs.size());
    for (std::size_t h = 0; h < this->J.Hubs.size(); ++h)
    {
      this->makeStar(this->J.Hubs[h]);
    }
    this->makeReach();
    for (std::size_t a = 0; a < this->J.Arcs.size(); ++a)
    {
      this->makeArc(a);
    }
    for (std::size_t h = 0; h < this->J.Hubs.size(); ++h)
    {
      this->joinHub(h);
    }
    return std::move(this->Out);
  }

private:
  /// Axis about which the arms of a star turn in their order.
  Vec3 turnAxis() const { return this->J.Clockwise ? Vec3(-this->Stack.Axis) : this->Stack.Axis; }
  bool smooth() const { return this->Options.Kind != JunctionKind::Superimposed; }
  bool inSpace() const
  {
    return this->smooth() && this->Options.Tangency == JunctionTangency::Space;
  }

  const Slice& sliceOf(Index tube, bool branch) const
  {
    const auto& c = this->Net.Tubes[tube].Contours;
    const bool upper = branch == this->J.StemAbove;
    return this->Stack.Slices[this->Stack.Contours[upper ? c.back() : c.front()].Slice];
  }

  Side sideOf(const EndRows& end, int column, int spans) const
  {
    Side s;
    s.Last = periodicPiece(*end.Last, this->Options.OrderU, column, spans);
    if (end.Before)
    {
      s.Before = periodicPiece(*end.Before, this->Options.OrderU, column, spans);
      s.Ratio = end.Distance / this->Gap;
    }
    return s;
  }

  std::size_t arcs() const { return this->J.Arcs.size(); }
  std::size_t after(Index seam) const
  {
    return (static_cast<std::size_t>(seam) + 1) % this->arcs();
  }

  /// Spacing of columns on the branches next to a hub.
  double spacingAt(const JunctionHub& hub) const
  {
    double least = 1e300;
    for (const Index s : hub.Seams)
    {
      const std::size_t a = this->after(s);
      least = std::min(least, this->spacingOf(a));
    }
    return least;
  }

  double spacingOf(std::size_t a) const
  {
    double length = 0.0;
    for (std::size_t i = 1; i < this->Branch[a].Last.size(); ++i)
    {
      length += (this->Branch[a].Last[i] - this->Branch[a].Last[i - 1]).norm();
    }
    return length / this->J.Arcs[a].Spans;
  }

  Vec3 horizontal(const Vec3& v) const { return v - this->Stack.Axis.dot(v) * this->Stack.Axis; }

  void makeStar(const JunctionHub& hub)
  {
    const std::size_t m = hub.Seams.size();
    const Vec3 low = onSlice(this->Stack, this->sliceOf(this->J.Branches[0], true), hub.Flat);
    const Vec3 high = onSlice(this->Stack, this->sliceOf(this->J.Stem, false), hub.Flat);
    double across = 0.0;
    double along = 0.0;
    std::vector<Vec3> seam;
    std::vector<Vec3> touch;
    for (const Index s : hub.Seams)
    {
      seam.push_back(this->horizontal(this->Stem[this->after(s)].Last.front() - high));
      touch.push_back(this->horizontal(this->Branch[this->after(s)].Last.front() - low));
      along += seam.back().norm() / static_cast<double>(m);
      across += touch.back().norm() / static_cast<double>(m);
    }
    HubStar star;
    star.Kind = this->Options.Kind;
    Vec3 shift = Vec3::Zero();
    if (m == 2)
    {
      // Middle of the shared edge: half-way between the seams, as far as that stays between.
      const Vec3 axis = (seam[0] - seam[1]).normalized();
      const double off = 0.5 * axis.dot(seam[0] + seam[1]);
      if (star.Kind == JunctionKind::Automatic)
      {
        star.Kind = std::abs(off) <= 0.1 * (seam[0] - seam[1]).norm() ? JunctionKind::SharedEdge
                                                                      : JunctionKind::Asymmetric;
      }
      shift = star.Kind == JunctionKind::SharedEdge ? Vec3(off * axis) : Vec3(Vec3::Zero());
    }
    else if (star.Kind == JunctionKind::Automatic)
    {
      star.Kind = JunctionKind::Asymmetric;
    }
    double position = this->Options.Position;
    if (!(position > 0.0))
    {
      position = std::clamp(across / std::max(across + along, 1e-300), 0.2, 0.8);
    }
    star.Center = (1.0 - position) * low + position * high + shift;
    const double step = 1.0 / (this->Options.OrderU - 1);
    const double spacing = this->spacingAt(hub);
    const double first = this->Sites.share(1);
    const double size = this->Options.StarSize;
    // Lengths of the first legs along the seams of the stem and of the branches.
    const double legA = size * std::min(0.9 * step * spacing, 1.2 * first * along);
    double legB =
      size * std::min(0.9 * step * spacing, std::max(1.2 * first * across, 0.2 * step * spacing));
    if (m > 2) // one length for all arms
    {
      const double room =
        std::min(across, along) * this->Sites.Rows[1] / this->Sites.Rows[this->Options.OrderV - 1];
      legB = size * std::min(0.9 * step * spacing, std::max(0.8 * room, 0.2 * step * spacing));
    }
    this->orient(star, seam, touch, m > 2 ? legB : legA, legB);
    this->Out.Hubs.push_back(star);
  }

  void orient(HubStar& star, const std::vector<Vec3>& seam, const std::vector<Vec3>& touch,
    double legA, double legB) const
  {
    const std::size_t m = seam.size();
    const Vec3 up = this->turnAxis();
    if (m == 2)
    {
      const Vec3 a = (seam[0] - seam[1]).normalized();
      const Vec3 square = up.cross(a);
      Vec3 b = (touch[0] - touch[1]).normalized();
      if (!(b.dot(square) > 0.7))
      {
        b = square;
      }
      star.A = legA * a;
      star.B = legB * b;
      return;
    }
    // Rotation of the regular star that comes nearest to the seams.
    double x = 0.0;
    double y = 0.0;
    for (std::size_t k = 0; k < m; ++k)
    {
      const double angle =
        std::atan2(up.cross(this->Stack.AxisX).dot(seam[k]), this->Stack.AxisX.dot(seam[k])) -
        2.0 * Pi * static_cast<double>(k) / static_cast<double>(m);
      x += std::cos(angle);
      y += std::sin(angle);
    }
    const double turn = std::atan2(y, x);
    const Vec3 a =
      std::cos(turn) * this->Stack.AxisX + std::sin(turn) * up.cross(this->Stack.AxisX);
    star.A = std::min(legA, legB) * a;
    star.B = std::min(legA, legB) * up.cross(a);
  }

  Vec3 arm(std::size_t hub, int k) const
  {
    const HubStar& s = this->Out.Hubs[hub];
    const double angle = 2.0 * Pi * k / (4.0 * static_cast<double>(this->J.Hubs[hub].Seams.size()));
    return std::cos(angle) * s.A + std::sin(angle) * s.B;
  }

  /// Position of a seam (by arc) among those of its hub.
  int seamIndex(std::size_t hub, Index seam) const
  {
    const auto& s = this->J.Hubs[hub].Seams;
    return static_cast<int>(std::find(s.begin(), s.end(), seam) - s.begin());
  }

  void makeReach()
  {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t a = 0; a < this->arcs(); ++a)
    {
      for (std::size_t i = 0; i < this->Stem[a].Last.size(); ++i)
      {
        sum += 0.5 * (this->Stem[a].Last[i] - this->Branch[a].Last[i]).norm();
        count += 1.0;
      }
    }
    this->Out.Reach = sum / count;
  }

  /// How a column goes on beyond the last row of a side, away from the junction, over the gap.
  Vec3 onward(const Side& side, std::size_t i) const
  {
    return side.Before.empty() ? Vec3(Vec3::Zero())
                               : Vec3((side.Before[i] - side.Last[i]) / side.Ratio);
  }

  /// Tangent with which a path arrives at the last row of a side, having come by `chord`: across
  /// the axis the harmonic mean of what comes and what follows, so that it does not overshoot.
  Vec3 arrival(const Side& side, std::size_t i, const Vec3& chord) const
  {
    const Vec3 next = this->onward(side, i);
    const Vec3 a = this->horizontal(chord);
    const Vec3 b = this->horizontal(next);
    Vec3 level = side.Before.empty() ? Vec3(0.5 * a) : Vec3(Vec3::Zero());
    const double along = a.dot(b);
    if (along > 0.0)
    {
      const double la = a.norm();
      const double lb = b.norm();
      level = 2.0 * la * lb / (la + lb) * (a / la + b / lb).normalized() * (along / (la * lb));
    }
    return level + (chord - a);
  }

  /// Tangent, over the whole way, of the undisturbed path of a column at the branch or the stem.
  Vec3 naturalTangent(std::size_t a, std::size_t i, bool stem) const
  {
    const Vec3 chord = this->Stem[a].Last[i] - this->Branch[a].Last[i];
    return stem ? this->arrival(this->Stem[a], i, chord)
                : Vec3(-this->arrival(this->Branch[a], i, -chord));
  }

  static Vec3 hermite(const Vec3& p, const Vec3& m, const Vec3& q, const Vec3& n, double t)
  {
    const double u = 1.0 - t;
    return p + t * t * (3.0 - 2.0 * t) * (q - p) + t * u * u * m - t * t * u * n;
  }

  /// The undisturbed path of a column from the branch (f = 0) to the stem (f = 1).
  Vec3 natural(std::size_t a, std::size_t i, double f) const
  {
    return hermite(this->Branch[a].Last[i], this->naturalTangent(a, i, false),
      this->Stem[a].Last[i], this->naturalTangent(a, i, true), f);
  }

  /// The same at any place among the columns.
  Vec3 naturalAt(std::size_t a, double place, double f) const
  {
    const std::vector<double>& g = this->SitesU[a];
    const auto next = std::upper_bound(g.begin() + 1, g.end() - 1, place);
    const auto i = static_cast<std::size_t>(next - g.begin());
    const double r = (place - g[i - 1]) / (g[i] - g[i - 1]);
    return (1.0 - r) * this->natural(a, i - 1, f) + r * this->natural(a, i, f);
  }

  /// Row j of the seam of the stem (stem) or of a branch at one end of an arc.
  Vec3 seamPoint(std::size_t a, bool end, bool stem, int j) const
  {
    const JunctionArc& arc = this->J.Arcs[a];
    const auto hub = static_cast<std::size_t>(end ? arc.EndHub : arc.StartHub);
    const HubStar& star = this->Out.Hubs[hub];
    const Side& side = stem ? this->Stem[a] : this->Branch[a];
    const Vec3 target = end ? side.Last.back() : side.Last.front();
    const auto n = static_cast<Index>(this->arcs());
    const Index seam = end ? static_cast<Index>(a) : static_cast<Index>((a + n - 1) % n);
    // Of a branch the arm lies between the seams before and after its touching point.
    const int k = this->seamIndex(hub, seam);
    const Vec3 leg = this->arm(hub, stem ? 4 * k : end ? 4 * k - 2 : 4 * k + 2);
    if (this->inSpace() && j < this->Options.OrderV)
    {
      return star.Center + this->Sites.Rows[j] / this->Sites.Rows[1] * leg;
    }
    const double t = this->Sites.share(j);
    const Vec3 chord = target - star.Center;
    const Vec3 m0 = leg / this->Sites.share(1);
    const Vec3 rise = this->Stack.Axis.dot(chord) * this->Stack.Axis;
    return hermite(star.Center, m0, target,
      this->arrival(side, end ? side.Last.size() - 1 : 0, chord) + rise, t);
  }

  Vec3 loopLeg(std::size_t a, bool end) const
  {
    const JunctionArc& arc = this->J.Arcs[a];
    const auto hub = static_cast<std::size_t>(end ? arc.EndHub : arc.StartHub);
    const auto n = static_cast<Index>(this->arcs());
    const Index seam = end ? static_cast<Index>(a) : static_cast<Index>((a + n - 1) % n);
    const int k = this->seamIndex(hub, seam);
    if (this->smooth() && !this->inSpace())
    {
      // As published: the loop passes the crotch along the shared edge, or in a corner (repeated
      // control points).
      return this->Out.Hubs[hub].Kind == JunctionKind::Asymmetric ? Vec3(Vec3::Zero())
                                                                  : Vec3(this->arm(hub, 4 * k));
    }
    return this->arm(hub, end ? 4 * k - 1 : 4 * k + 1);
  }

  /// Where the straight line from branch to stem at an end of an arc passes the crotch.
  double hubShare(std::size_t a, bool end) const
  {
    const JunctionArc& arc = this->J.Arcs[a];
    const Vec3& from = end ? this->Branch[a].Last.back() : this->Branch[a].Last.front();
    const Vec3& to = end ? this->Stem[a].Last.back() : this->Stem[a].Last.front();
    const Vec3& c = this->Out.Hubs[end ? arc.EndHub : arc.StartHub].Center;
    const double length = std::max((to - from).squaredNorm(), 1e-300);
    return std::clamp((c - from).dot(to - from) / length, 0.05, 0.5);
  }

  /// What is fixed of a column of an arc before its rows are made.
  struct Column
  {
    double Weight; ///< 1 next to a crotch, 0 far from it
    double Share;  ///< of its natural path at which the end row lies
    const HubStar* Star;
  };

  std::vector<Column> placeLoop(std::size_t a, ControlRow& loop) const
  {
    const JunctionArc& arc = this->J.Arcs[a];
    const std::vector<double>& g = this->SitesU[a];
    const std::size_t count = g.size();
    const double straight = g[this->Options.OrderU - 1];
    const double reach = std::max(0.5 * arc.Spans - straight, 0.5);
    const double hubShare[2] = {this->hubShare(a, false), this->hubShare(a, true)};
    const double spacing = this->spacingOf(a);
    std::vector<Column> columns;
    for (std::size_t i = 0; i < count; ++i)
    {
      const bool end = arc.Spans - g[i] < g[i];
      const double from = end ? arc.Spans - g[i] : g[i];
      const HubStar& star = this->Out.Hubs[end ? arc.EndHub : arc.StartHub];
      const double w = fade((from - straight) / reach);
      const double share = (1.0 - w) * 0.5 + w * hubShare[end ? 1 : 0];
      // The loop is shifted as a whole to the crotch, and bent into the star's leg next to it.
      const Vec3 shift = star.Center - this->natural(a, end ? count - 1 : 0, hubShare[end ? 1 : 0]);
      const double width = std::clamp(
        1.0 + 3.0 * shift.norm() / spacing, std::min(this->Options.BendSpans, reach), reach);
      // With Follow its columns are as close as the star's next to it.
      const Vec3 leg = this->loopLeg(a, end);
      const double pace =
        !this->Options.Follow ? 1.0 : std::clamp(leg.norm() / (g[1] * spacing), 0.2, 1.0);
      const double place = from <= straight
                             ? pace * from
                             : from - straight * (1.0 - pace) * fade((from - straight) / reach);
      const Vec3 moved = this->naturalAt(a, end ? arc.Spans - place : place, share) +
                         fade((from - straight) / width) * shift;
      const Vec3 line = star.Center + from / g[1] * leg;
      const double bent = fade((from - straight) / std::min(reach, this->Options.BendSpans));
      loop.emplace_back(moved + bent * (line - moved));
      columns.push_back({w, share, &star});
    }
    return columns;
  }

  /// Step of a column across the end row, from the branch to the stem: outward from the loop next
  /// to a crotch, along the natural path elsewhere.
  Vec3 stepAcross(std::size_t a, std::size_t i, const Column& c, const ControlRow& loop) const
  {
    const double t = this->Sites.share(1);
    Vec3 natural = 0.5 * (this->natural(a, i, c.Share + (1.0 - c.Share) * t) -
                           this->natural(a, i, c.Share * (1.0 - t)));
    if (!this->inSpace() || c.Weight == 0.0 || i == 0 || i + 1 == loop.size())
    {
      return natural;
    }
    const Vec3 along = (loop[i + 1] - loop[i - 1]).normalized();
    const Vec3 outward = this->horizontal(along).cross(this->turnAxis()).normalized();
    const double size = 0.3 * std::hypot(c.Star->A.norm(), c.Star->B.norm());
    const Vec3 step = (1.0 - c.Weight) * natural + c.Weight * size * outward;
    return step - c.Weight * along.dot(step) * along;
  }

  void makeArc(std::size_t a)
  {
    ControlRow loop;
    const std::vector<Column> columns = this->placeLoop(a, loop);
    ArcRows& out = this->Out.Arcs[a];
    out.Branch.assign(static_cast<std::size_t>(this->Rows), ControlRow(loop.size()));
    out.Stem = out.Branch;
    const double first = this->Sites.share(1);
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const Column& c = columns[i];
      const Vec3 across = this->stepAcross(a, i, c, loop);
      for (const bool stem : {false, true})
      {
        const Vec3& target = (stem ? this->Stem[a] : this->Branch[a]).Last[i];
        const Vec3 chord = target - loop[i];
        const Vec3 rise = this->Stack.Axis.dot(chord) * this->Stack.Axis;
        const Side& side = stem ? this->Stem[a] : this->Branch[a];
        const Vec3 step = this->smooth() ? Vec3(stem ? across : -across) : Vec3(first * chord);
        const Vec3 end =
          (1.0 - c.Weight) * (stem ? 1.0 - c.Share : -c.Share) * this->naturalTangent(a, i, stem) +
          c.Weight * (this->arrival(side, i, chord) + rise);
        for (int j = 0; j < this->Rows; ++j)
        {
          (stem ? out.Stem : out.Branch)[j][i] =
            j == 0   ? loop[i]
            : j == 1 ? Vec3(loop[i] + step)
                     : hermite(loop[i], step / first, target, end, this->Sites.share(j));
        }
      }
    }
  }

  /// Moves the columns beside a seam so that their mean is the seam, from a row on.
  void center(ControlRow& a, std::size_t ia, ControlRow& b, std::size_t ib, const Vec3& seam)
  {
    const Vec3 shift = seam - 0.5 * (a[ia] + b[ib]);
    a[ia] += shift;
    b[ib] += shift;
  }

  void joinHub(std::size_t h)
  {
    const JunctionHub& hub = this->J.Hubs[h];
    const auto m = static_cast<int>(hub.Seams.size());
    std::vector<Vec3> arms;
    arms.reserve(4 * static_cast<std::size_t>(m));
    for (int k = 0; k < 4 * m; ++k)
    {
      arms.push_back(this->arm(h, k));
    }
    const std::vector<Vec3> sectors = starSectors(this->Out.Hubs[h].Center, arms);
    for (const bool corners : {false, true})
    {
      for (int k = 0; k < m; ++k)
      {
        this->joinSheets(hub, k, corners ? &sectors : nullptr);
      }
    }
  }

  /// Around seam k of a hub: either the columns beside the seams, or (with sectors) the corners.
  void joinSheets(const JunctionHub& hub, int k, const std::vector<Vec3>* sectors)
  {
    // Arc `before` ends at the stem's seam, arc `next` starts there. The branch of `next` touches
    // between the end of `last`, its own arc before, and `next`.
    const auto m = static_cast<int>(hub.Seams.size());
    const auto before = static_cast<std::size_t>(hub.Seams[k]);
    const std::size_t next = this->after(hub.Seams[k]);
    const auto last = static_cast<std::size_t>(hub.Seams[(k + 1) % m]);
    ArcRows& n = this->Out.Arcs[next];
    ArcRows& b = this->Out.Arcs[before];
    ArcRows& l = this->Out.Arcs[last];
    const std::size_t endB = b.Stem[0].size() - 1;
    const std::size_t endL = l.Stem[0].size() - 1;
    if (sectors && this->inSpace())
    {
      n.Stem[1][1] = (*sectors)[4 * k];
      n.Branch[1][1] = (*sectors)[4 * k + 1];
      l.Branch[1][endL - 1] = (*sectors)[4 * k + 2];
      l.Stem[1][endL - 1] = (*sectors)[4 * k + 3];
    }
    else if (sectors && this->smooth())
    {
      this->publishedRow(n, b, endB, l, endL);
    }
    for (int j = 0; !sectors && j < this->Rows; ++j)
    {
      if (this->inSpace() || !this->smooth() || j != 1) // else as published
      {
        this->setSeams(j, n, b, endB, l, endL, before, next);
      }
    }
  }

  void setSeams(int j, ArcRows& n, ArcRows& b, std::size_t endB, ArcRows& l, std::size_t endL,
    std::size_t before, std::size_t next)
  {
    const Vec3 seam = this->seamPoint(next, false, true, j);
    const Vec3 other = this->seamPoint(before, true, true, j);
    const Vec3 stem = j == 0 ? n.Stem[0][0] : Vec3(0.5 * (seam + other));
    const Vec3 touch = j == 0 ? n.Stem[0][0] : this->seamPoint(next, false, false, j);
    n.Stem[j][0] = stem;
    b.Stem[j][endB] = stem;
    n.Branch[j][0] = touch;
    l.Branch[j][endL] = touch;
    if (j > 0)
    {
      this->center(n.Stem[j], 1, b.Stem[j], endB - 1, stem);
      this->center(n.Branch[j], 1, l.Branch[j], endL - 1, touch);
    }
  }

  /// Rows 1 as published: symmetric about the end row, at the crotch too.
  void publishedRow(ArcRows& n, ArcRows& b, std::size_t endB, ArcRows& l, std::size_t endL) const
  {
    const Vec3 center = n.Stem[0][0];
    const double t = this->Sites.share(1);
    const Vec3 v = // the same for all sheets: along the axis
      t * this->Stack.Axis.dot(n.Stem.back()[0] - center) * this->Stack.Axis;
    n.Stem[1][0] = center + v;
    b.Stem[1][endB] = center + v;
    n.Branch[1][0] = center - v;
    l.Branch[1][endL] = center - v;
  }

  const ContourStack& Stack;
  const BranchedNetwork& Net;
  const Junction& J;
  const RowOptions& Options;
  const RowSites Sites;
  const int Rows;
  double Gap = 1.0;
  std::vector<Side> Branch; ///< of each arc
  std::vector<Side> Stem;
  std::vector<std::vector<double>> SitesU;
  JunctionRows Out;
};
} // namespace

RowSites rowSites(const RowOptions& options)
{
  const int rows = options.fixedRows();
  const std::vector<double> g =
    grevilleSites(clampedKnots(options.OrderV, rows + options.OrderV), options.OrderV);
  RowSites s;
  s.Rows.assign(g.begin(), g.begin() + rows);
  s.Data = rows - 0.5 * options.OrderV + 1.0;
  return s;
}

std::vector<Vec3> starSectors(const Vec3& center, const std::vector<Vec3>& arms)
{
  const std::size_t n = arms.size();
  const double c = 2.0 / (2.0 + 2.0 * std::cos(2.0 * Pi / static_cast<double>(n)));
  std::vector<Vec3> w;
  for (std::size_t k = 0; k < n; ++k)
  {
    w.emplace_back(center + c * (arms[k] + arms[(k + 1) % n]));
  }
  return w;
}

JunctionRows makeJunctionRows(const ContourStack& stack, const BranchedNetwork& net,
  const Junction& junction, const std::vector<EndRows>& branches, const EndRows& stem,
  const RowOptions& options)
{
  return JunctionMaker(stack, net, junction, branches, stem, options).run();
}
} // namespace bsr
