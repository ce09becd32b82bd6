#include "Spline/CoverageEnds.h"

#include "Spline/LayoutEnds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
constexpr double Uncovered = 0.45; ///< of the median density
/// Cosines to the end's direction: still the end's face. The first that gives a sound end counts.
constexpr std::array<double, 4> Facing{0.7, 0.6, 0.8, 0.5};
constexpr double LeastShare = 0.35;     ///< uncovered area of an end
constexpr double LargestEnd = 0.3;      ///< of the layout's area
constexpr double TurnedAway = 0.42;     ///< mean cosine of the quads around an end
constexpr double FewestPoints = 8.0;    ///< a quad, to judge coverage at all
constexpr std::size_t Ends = 2;         ///< of a tube
constexpr int Sectors = 16;             ///< around a rim
constexpr double LevelQuantile = 0.95;  ///< of the heights of a sector's points
constexpr std::size_t SectorPoints = 6; ///< fewer say nothing

template <class T>
T quantile(std::vector<T> v, double q)
{
  const auto k = static_cast<std::ptrdiff_t>(q * static_cast<double>(v.size() - 1));
  std::nth_element(v.begin(), v.begin() + k, v.end());
  return v[k];
}

struct EndCandidate
{
  std::vector<Index> Faces;
  Vec3 Direction = Vec3::Zero();
  double Uncovered = 0.0; ///< area
};

class EndFinder
{
public:
  EndFinder(const PartitionedPoints& points, const QuadMesh& quads, const QuadComplex& complex)
      : Points(points), Quads(quads), Complex(complex)
  {
  }

  QuadMesh run()
  {
    QuadMesh marked = this->Quads;
    if (!this->measure())
    {
      return marked;
    }
    std::vector<Index> region(this->Complex.faces(), 0);
    std::vector<EndCandidate> ends;
    for (const EndCandidate& c : this->candidates())
    {
      std::vector<Index> attempt = region;
      for (const Index f : c.Faces)
      {
        attempt[f] = static_cast<Index>(ends.size()) + 1;
      }
      if (ends.size() < Ends &&
          cutEnds(this->Quads, attempt).Ends == static_cast<int>(ends.size()) + 1)
      {
        region = std::move(attempt);
        ends.push_back(c);
      }
    }
    if (!ends.empty())
    {
      marked.Region = region;
      this->moveRims(ends, marked);
    }
    return marked;
  }

private:
  /// Areas, normals and which quads the outer points do not cover; false where that says nothing.
  bool measure()
  {
    const Index n = this->Complex.faces();
    std::vector<double> count(n, 0.0);
    for (std::size_t i = 0; i < this->Points.Points.size(); ++i)
    {
      const Index q = this->Points.QuadId[i];
      if (q >= 0 && (this->Points.Side.empty() || this->Points.Side[i] == 0))
      {
        count[q] += 1.0;
      }
    }
    const auto& p = this->Quads.Points;
    std::vector<double> density;
    for (Index f = 0; f < n; ++f)
    {
      const auto& q = this->Complex.quad(f);
      const Vec3 a = 0.5 * (p[q[2]] - p[q[0]]).cross(p[q[3]] - p[q[1]]);
      this->Area.push_back(a.norm());
      this->Normal.push_back(a.norm() > 0.0 ? Vec3(a.normalized()) : Vec3(Vec3::Zero()));
      density.push_back(a.norm() > 0.0 ? count[f] / a.norm() : 0.0);
    }
    const double typical = quantile(density, 0.5);
    for (Index f = 0; f < n; ++f)
    {
      this->Empty.push_back(density[f] < Uncovered * typical);
    }
    this->Total = std::accumulate(this->Area.begin(), this->Area.end(), 0.0);
    return quantile(count, 0.5) >= FewestPoints;
  }

  /// Quads joined with f by edges through quads that `take`.
  template <class F>
  std::vector<Index> joined(std::vector<Index> group, const F& take) const
  {
    std::vector<char> seen(this->Complex.faces(), 0);
    for (const Index f : group)
    {
      seen[f] = 1;
    }
    for (std::size_t i = 0; i < group.size(); ++i)
    {
      for (int k = 0; k < 4; ++k)
      {
        const Index t = this->Complex.twin(4 * group[i] + k);
        if (t >= 0 && !seen[t / 4] && take(t / 4))
        {
          seen[t / 4] = 1;
          group.push_back(t / 4);
        }
      }
    }
    return group;
  }

  Vec3 directionOf(const std::vector<Index>& group) const
  {
    Vec3 sum = Vec3::Zero();
    for (const Index f : group)
    {
      sum += this->Area[f] * this->Normal[f];
    }
    return sum.norm() > 0.0 ? Vec3(sum.normalized()) : sum;
  }

  double emptyArea(const std::vector<Index>& group) const
  {
    double sum = 0.0;
    for (const Index f : group)
    {
      sum += this->Empty[f] ? this->Area[f] : 0.0;
    }
    return sum;
  }

  /// The end around a group of uncovered quads, the neighbors that face its way included.
  EndCandidate widened(const std::vector<Index>& seed, double facing) const
  {
    EndCandidate c;
    c.Faces = seed;
    for (int round = 0; round < 3; ++round)
    {
      c.Direction = this->directionOf(c.Faces);
      c.Faces =
        this->joined(seed, [&](Index f) { return this->Normal[f].dot(c.Direction) > facing; });
    }
    this->tidy(c.Faces);
    c.Uncovered = this->emptyArea(c.Faces);
    return c;
  }

  int neighborsIn(const std::vector<char>& in, Index f) const
  {
    int n = 0;
    for (int k = 0; k < 4; ++k)
    {
      const Index t = this->Complex.twin(4 * f + k);
      n += t >= 0 && in[t / 4];
    }
    return n;
  }

  /// Fills what is enclosed, takes off spikes: three of four neighbors decide.
  void tidy(std::vector<Index>& group) const
  {
    std::vector<char> in(this->Complex.faces(), 0);
    for (const Index f : group)
    {
      in[f] = 1;
    }
    this->fillEnclosed(in);
    for (int round = 0; round < 4; ++round)
    {
      const std::vector<char> before = in;
      for (Index f = 0; f < this->Complex.faces(); ++f)
      {
        const int n = this->neighborsIn(before, f);
        in[f] = before[f] ? n >= 2 || group.size() <= 2 : n >= 3;
      }
    }
    group.clear();
    for (Index f = 0; f < this->Complex.faces(); ++f)
    {
      if (in[f])
      {
        group.push_back(f);
      }
    }
  }

  /// Of what is not in the group only the largest part stays out.
  void fillEnclosed(std::vector<char>& in) const
  {
    std::vector<char> out(in.size(), 0);
    std::vector<char> done = in;
    std::vector<Index> largest;
    for (Index f = 0; f < this->Complex.faces(); ++f)
    {
      if (!done[f])
      {
        const auto part = this->joined({f}, [&](Index g) { return !in[g]; });
        for (const Index g : part)
        {
          done[g] = 1;
        }
        largest = part.size() > largest.size() ? part : largest;
      }
    }
    std::fill(in.begin(), in.end(), char{1});
    for (const Index f : largest)
    {
      in[f] = 0;
    }
  }

  /// Mean cosine between the end's direction and the quads around it.
  double turn(const EndCandidate& c) const
  {
    std::vector<char> in(this->Complex.faces(), 0);
    for (const Index f : c.Faces)
    {
      in[f] = 1;
    }
    double sum = 0.0;
    double weight = 0.0;
    for (const Index f : c.Faces)
    {
      for (int k = 0; k < 4; ++k)
      {
        const Index t = this->Complex.twin(4 * f + k);
        if (t >= 0 && !in[t / 4])
        {
          const double length =
            (this->Quads.Points[this->Complex.from(t)] - this->Quads.Points[this->Complex.to(t)])
              .norm();
          sum += length * this->Normal[t / 4].dot(c.Direction);
          weight += length;
        }
      }
    }
    return weight > 0.0 ? sum / weight : 1.0;
  }

  bool isEnd(const EndCandidate& c) const
  {
    double area = 0.0;
    for (const Index f : c.Faces)
    {
      area += this->Area[f];
    }
    return !c.Faces.empty() && c.Uncovered >= LeastShare * area &&
           area <= LargestEnd * this->Total && this->turn(c) <= TurnedAway;
  }

  /// A disc whose removal leaves a sound surface.
  bool isSound(const EndCandidate& c) const
  {
    std::vector<Index> region(this->Complex.faces(), 0);
    for (const Index f : c.Faces)
    {
      region[f] = 1;
    }
    return cutEnds(this->Quads, region).Ends == 1;
  }

  std::vector<EndCandidate> candidates() const
  {
    std::vector<EndCandidate> found;
    std::vector<char> used(this->Complex.faces(), 0);
    for (Index f = 0; f < this->Complex.faces(); ++f)
    {
      if (!this->Empty[f] || used[f])
      {
        continue;
      }
      const auto seed = this->joined({f}, [&](Index g) { return this->Empty[g] != 0; });
      for (const Index g : seed)
      {
        used[g] = 1;
      }
      for (const double facing : Facing)
      {
        EndCandidate c = this->widened(seed, facing);
        if (this->isEnd(c) && this->isSound(c))
        {
          found.push_back(std::move(c));
          break;
        }
      }
    }
    std::stable_sort(found.begin(), found.end(),
      [](const EndCandidate& a, const EndCandidate& b) { return a.Uncovered > b.Uncovered; });
    return found;
  }

  /// Heights where the outer wall's points end around a rim, a sector each.
  struct Rim
  {
    Vec3 Center = Vec3::Zero();
    Vec3 U = Vec3::Zero();
    Vec3 V = Vec3::Zero();
    Vec3 W = Vec3::Zero(); ///< out of the fiber
    double Radius = 0.0;
    double Side = 0.0; ///< mean length of its sides

    double height(const Vec3& p) const { return (p - this->Center).dot(this->W); }
    double sector(const Vec3& p) const
    {
      const Vec3 d = p - this->Center;
      const double turn = std::atan2(d.dot(this->V), d.dot(this->U)) / (2.0 * M_PI);
      return (turn < 0.0 ? turn + 1.0 : turn) * Sectors;
    }
    double radius(const Vec3& p) const
    {
      const Vec3 d = p - this->Center;
      return (d - d.dot(this->W) * this->W).norm();
    }
  };

  Rim rimOf(const std::vector<Index>& vertices, const Vec3& direction) const
  {
    const auto& p = this->Quads.Points;
    Rim r;
    r.W = direction;
    r.U = direction.unitOrthogonal();
    r.V = direction.cross(r.U);
    const auto n = static_cast<double>(vertices.size());
    for (const Index v : vertices)
    {
      r.Center += p[v] / n;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      r.Radius += r.radius(p[vertices[i]]) / n;
      r.Side += (p[vertices[(i + 1) % vertices.size()]] - p[vertices[i]]).norm() / n;
    }
    return r;
  }

  /// NaN where a sector's points say nothing.
  std::vector<double> levels(const Rim& rim) const
  {
    std::vector<std::vector<double>> heights(Sectors);
    for (std::size_t i = 0; i < this->Points.Points.size(); ++i)
    {
      const Vec3& p = this->Points.Points[i];
      if ((this->Points.Side.empty() || this->Points.Side[i] == 0) &&
          std::abs(rim.height(p)) <= 1.5 * rim.Side &&
          std::abs(rim.radius(p) - rim.Radius) <= 0.5 * rim.Radius)
      {
        heights[std::min(Sectors - 1, static_cast<int>(rim.sector(p)))].push_back(rim.height(p));
      }
    }
    std::vector<double> level;
    level.reserve(heights.size());
    for (auto& h : heights)
    {
      level.push_back(h.size() < SectorPoints ? std::nan("") : quantile(h, LevelQuantile));
    }
    return level;
  }

  void moveRims(const std::vector<EndCandidate>& ends, QuadMesh& marked) const
  {
    const CutLayout cut = cutEnds(this->Quads, marked.Region);
    const auto open =
      QuadComplex::build(cut.Quads.Quads, static_cast<Index>(this->Quads.Points.size()));
    if (!open)
    {
      return;
    }
    for (const auto& loop : open->borderLoops())
    {
      std::vector<Index> vertices;
      vertices.reserve(loop.size());
      for (const Index h : loop)
      {
        vertices.push_back(open->from(h));
      }
      const Index f = cut.Kept[loop.front() / 4];
      const Index cap = this->Complex.twin(4 * f + loop.front() % 4) / 4;
      const Rim rim = this->rimOf(vertices, ends[marked.Region[cap] - 1].Direction);
      const auto level = this->levels(rim);
      for (const Index v : vertices)
      {
        marked.Points[v] += rim.W * this->shift(rim, level, this->Quads.Points[v]);
      }
    }
  }

  /// From a rim's vertex to the level of the sectors around it, half a side at most.
  double shift(const Rim& rim, const std::vector<double>& level, const Vec3& p) const
  {
    const int s = std::min(Sectors - 1, static_cast<int>(rim.sector(p)));
    double sum = 0.0;
    double weight = 0.0;
    for (int d = -1; d <= 1; ++d)
    {
      const double l = level[(s + d + Sectors) % Sectors];
      sum += std::isnan(l) ? 0.0 : (2 - std::abs(d)) * l;
      weight += std::isnan(l) ? 0.0 : 2 - std::abs(d);
    }
    return weight > 0.0 ? std::clamp(sum / weight - rim.height(p), -0.5 * rim.Side, 0.5 * rim.Side)
                        : 0.0;
  }

  const PartitionedPoints& Points;
  const QuadMesh& Quads;
  const QuadComplex& Complex;
  std::vector<double> Area;
  std::vector<Vec3> Normal;
  std::vector<char> Empty;
  double Total = 0.0;
};
} // namespace

QuadMesh markOpenEnds(const PartitionedPoints& points, const QuadMesh& quads)
{
  const auto complex = QuadComplex::build(quads.Quads, static_cast<Index>(quads.Points.size()));
  return complex && complex->closed() ? EndFinder(points, quads, *complex).run() : quads;
}
} // namespace bsr
