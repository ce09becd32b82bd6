#include "Mesh/OrientedPoints.h"

#include "Common/MonitoredLoop.h"
#include "Common/UnionFind.h"
#include "Mesh/PointTree.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr std::size_t SpacingNeighbor = 6;
constexpr double MostSpacing = 6.0; ///< of a point, in spacings of its neighbors
constexpr int Directions = 26;      ///< in which the outermost point is asked where outside is

/// The points without repetitions, in their order.
std::vector<Vec3> distinct(const std::vector<Vec3>& points)
{
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = static_cast<Index>(i);
  }
  const auto key = [&](Index i)
  { return std::make_tuple(points[i][0], points[i][1], points[i][2]); };
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
  std::vector<char> keep(points.size(), 1);
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    keep[order[i]] = points[order[i]] != points[order[i - 1]];
  }
  std::vector<Vec3> left;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (keep[i])
    {
      left.push_back(points[i]);
    }
  }
  return left;
}

/// Normal `n` of a point mirrored at the plane halfway to another one, `along` away.
Vec3 mirrored(const Vec3& n, const Vec3& along)
{
  return n - 2.0 * n.dot(along) / along.squaredNorm() * along;
}

struct Link
{
  double Doubt; ///< 0: both normals agree for certain, 1: nothing is known
  Index A;
  Index B;
  bool operator<(const Link& o) const
  {
    return std::tie(this->Doubt, this->A, this->B) < std::tie(o.Doubt, o.A, o.B);
  }
};

class Orientation
{
public:
  Orientation(OrientedPoints& out, std::size_t neighbors)
      : Out(out), Tree(out.Points), Count(std::min(neighbors + 1, out.Points.size()))
  {
  }

  bool run(Monitor& monitor)
  {
    SubMonitor near(monitor, 0.0, 0.8);
    if (!this->estimate(near))
    {
      return false;
    }
    this->makeAgree(this->spanningLinks());
    monitor.progress(1.0);
    return !monitor.cancelled();
  }

private:
  std::int64_t size() const { return static_cast<std::int64_t>(this->Out.Points.size()); }
  const std::uint32_t* near(std::int64_t i) const { return &this->Near[i * this->Count]; }

  bool estimate(Monitor& monitor)
  {
    const std::int64_t n = this->size();
    this->Near.resize(n * this->Count);
    this->Out.Normals.resize(n);
    std::vector<double> sixth(n);
    const bool done = monitoredFor(0, n, 256, monitor,
      [&](std::int64_t first, std::int64_t last)
      {
        std::vector<double> d2(this->Count);
        for (std::int64_t i = first; i < last; ++i)
        {
          this->Tree.nearest(
            this->Out.Points[i], this->Count, &this->Near[i * this->Count], d2.data());
          sixth[i] = std::sqrt(d2[std::min(SpacingNeighbor, this->Count - 1)]);
          this->Out.Normals[i] = this->principal(i, d2);
        }
      });
    this->smoothSpacing(sixth);
    return done;
  }

  /// The axis along which the neighbors, weighed down with their distance, extend least.
  Vec3 principal(std::int64_t i, const std::vector<double>& d2) const
  {
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Vec3 mean = Vec3::Zero();
    double sum = 0.0;
    const double scale = 1.0 / std::max(1.4 * d2.back(), 1e-300);
    for (std::size_t k = 0; k < this->Count; ++k)
    {
      const double w = std::exp(-d2[k] * scale);
      const Vec3 x = this->Out.Points[this->near(i)[k]] - this->Out.Points[i];
      moments += w * x * x.transpose();
      mean += w * x;
      sum += w;
    }
    moments -= mean * mean.transpose() / sum;
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  }

  void smoothSpacing(const std::vector<double>& sixth)
  {
    this->Out.Spacing.resize(sixth.size());
    std::vector<double> around(this->Count);
    for (std::size_t i = 0; i < sixth.size(); ++i)
    {
      for (std::size_t k = 0; k < this->Count; ++k)
      {
        around[k] = sixth[this->near(static_cast<std::int64_t>(i))[k]];
      }
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(this->Count / 2);
      std::nth_element(around.begin(), middle, around.end());
      // Coarse points beside dense ones keep their own; a stray point does not get any.
      this->Out.Spacing[i] = std::clamp(sixth[i], *middle, MostSpacing * *middle);
    }
  }

  /// Edges of the minimum spanning forest of the graph of neighbors (Kruskal).
  std::vector<Link> spanningLinks() const
  {
    std::vector<Link> links;
    links.reserve(this->Near.size());
    for (Index i = 0; i < this->size(); ++i)
    {
      for (std::size_t k = 0; k < this->Count; ++k)
      {
        const auto j = static_cast<Index>(this->near(i)[k]);
        if (j != i)
        {
          const Vec3 along = this->Out.Points[j] - this->Out.Points[i];
          const double agree =
            std::abs(mirrored(this->Out.Normals[i], along).dot(this->Out.Normals[j]));
          links.push_back({1.0 - agree, std::min(i, j), std::max(i, j)});
        }
      }
    }
    std::sort(links.begin(), links.end());
    UnionFind sets(this->size());
    std::vector<Link> tree;
    for (const Link& l : links)
    {
      if (sets.find(l.A) != sets.find(l.B))
      {
        sets.join(l.A, l.B);
        tree.push_back(l);
      }
    }
    return tree;
  }

  void makeAgree(const std::vector<Link>& tree)
  {
    std::vector<std::vector<Index>> linked(this->Out.Points.size());
    for (const Link& l : tree)
    {
      linked[l.A].push_back(l.B);
      linked[l.B].push_back(l.A);
    }
    std::vector<char> done(this->Out.Points.size(), 0);
    for (Index root = 0; root < this->size(); ++root)
    {
      if (!done[root])
      {
        this->turnOutward(this->spread(root, linked, done));
      }
    }
  }

  /// Carries the sign of a normal through its tree; the points reached.
  std::vector<Index> spread(
    Index root, const std::vector<std::vector<Index>>& linked, std::vector<char>& done)
  {
    std::vector<Index> reached{root};
    done[root] = 1;
    for (std::size_t at = 0; at < reached.size(); ++at)
    {
      const Index i = reached[at];
      for (const Index j : linked[i])
      {
        if (!done[j])
        {
          done[j] = 1;
          const Vec3 along = this->Out.Points[j] - this->Out.Points[i];
          if (mirrored(this->Out.Normals[i], along).dot(this->Out.Normals[j]) < 0.0)
          {
            this->Out.Normals[j] = -this->Out.Normals[j];
          }
          reached.push_back(j);
        }
      }
    }
    return reached;
  }

  void turnOutward(const std::vector<Index>& part)
  {
    double outward = 0.0;
    for (int k = 0; k <= Directions; ++k)
    {
      const Eigen::Vector3i step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const Vec3 d = step.cast<double>();
      const Index outermost = *std::max_element(part.begin(), part.end(),
        [&](Index a, Index b) { return d.dot(this->Out.Points[a]) < d.dot(this->Out.Points[b]); });
      outward += d.norm() > 0.0 ? d.normalized().dot(this->Out.Normals[outermost]) : 0.0;
    }
    for (const Index i : part)
    {
      this->Out.Normals[i] = outward < 0.0 ? Vec3(-this->Out.Normals[i]) : this->Out.Normals[i];
    }
  }

  OrientedPoints& Out;
  PointTree Tree;
  std::size_t Count; ///< neighbors of a point, itself included
  std::vector<std::uint32_t> Near;
};
} // namespace

Result<OrientedPoints> orientPoints(
  const std::vector<Vec3>& points, int neighbors, Monitor& monitor)
{
  if (neighbors < 4 || neighbors > 200)
  {
    return Status::invalidParameter(
      "The number of neighbors is " + std::to_string(neighbors) + "; choose 4 to 200.");
  }
  if (!std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); }))
  {
    return Status::invalidInput("A point is NaN or infinite; remove such points.");
  }
  OrientedPoints out;
  out.Points = distinct(points);
  if (out.Points.size() < 8)
  {
    return Status::invalidInput("There are fewer than 8 different points; give more.");
  }
  if (!Orientation(out, static_cast<std::size_t>(neighbors)).run(monitor))
  {
    return Status::cancelled();
  }
  return out;
}
} // namespace bsr
