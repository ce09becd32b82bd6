#include "Mesh/Decimate.h"

#include "Common/Parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <queue>

namespace bsr
{
namespace
{
/// x' A x - 2 b' x + c: squared distances to planes, weighted by area.
struct Quadric
{
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vec3 B = Vec3::Zero();
  double C = 0.0;

  void addPlane(const Vec3& n, const Vec3& p, double weight)
  {
    const double d = n.dot(p);
    this->A += weight * n * n.transpose();
    this->B += weight * d * n;
    this->C += weight * d * d;
  }
  void add(const Quadric& q)
  {
    this->A += q.A;
    this->B += q.B;
    this->C += q.C;
  }
  double at(const Vec3& x) const { return x.dot(this->A * x) - 2.0 * this->B.dot(x) + this->C; }
};

struct Candidate
{
  double Cost;
  Index HalfEdge;
  std::uint32_t Stamp;
  bool operator>(const Candidate& o) const
  {
    return this->Cost != o.Cost ? this->Cost > o.Cost : this->HalfEdge > o.HalfEdge;
  }
};

class Decimator
{
public:
  explicit Decimator(TriangleSurface& s) : S(s), Quadrics(s.Points.size()), Version(s.Points.size())
  {
    // Relative to a corner of the object, so that large coordinates cost no digits.
    this->Origin = s.Points.front();
    this->initialize();
  }

  Status run(Index target, Monitor& monitor)
  {
    std::vector<Candidate> heap(this->S.Vertex.size() / 2);
    this->fill(heap);
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue(
      std::greater<>(), std::move(heap));
    Index left = this->count();
    const double total = std::max<double>(left - target, 1.0);
    for (std::size_t step = 0; left > target && !queue.empty(); ++step)
    {
      if (step % 4096 == 0)
      {
        monitor.progress(1.0 - (left - target) / total);
        if (monitor.cancelled())
        {
          return Status::cancelled();
        }
      }
      const Candidate c = queue.top();
      queue.pop();
      if (this->S.Vertex[c.HalfEdge] < 0 || c.Stamp != this->stamp(c.HalfEdge))
      {
        continue;
      }
      const Index h = this->directed(c.HalfEdge);
      const Vec3 x = this->target(h);
      if (h < 0 || !this->S.canCollapse(h) || !this->shapesStay(h, x))
      {
        continue;
      }
      left -= !this->S.hole(h / 3);
      left -= !this->S.hole(this->S.Opposite[h] / 3);
      this->apply(h, x, queue);
    }
    this->S.compact();
    return Status::ok();
  }

private:
  Index count() const
  {
    Index n = 0;
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      n += this->S.alive(f) && !this->S.hole(f);
    }
    return n;
  }

  void initialize()
  {
    TriangleSurface& s = this->S;
    std::vector<Vec3> normals(s.Region.size());
    parallelFor(0, s.faces(), 4096,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t f = first; f < last; ++f)
        {
          normals[f] = s.areaNormal(static_cast<Index>(f));
        }
      });
    parallelFor(0, s.vertices(), 2048,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t v = first; v < last; ++v)
        {
          this->vertexQuadric(static_cast<Index>(v), normals);
        }
      });
  }

  void vertexQuadric(Index v, const std::vector<Vec3>& normals)
  {
    const TriangleSurface& s = this->S;
    if (s.Virtual[v])
    {
      return;
    }
    Quadric& q = this->Quadrics[v];
    s.around(v,
      [&](Index h)
      {
        const double area = normals[h / 3].norm();
        if (!s.hole(h / 3) && area > 0.0)
        {
          q.addPlane(normals[h / 3] / area, s.Points[v] - this->Origin, area / 3.0);
        }
        if (s.Crease[h])
        {
          this->addCrease(q, h, normals);
        }
        if (s.Crease[TriangleSurface::prev(h)])
        {
          this->addCrease(q, TriangleSurface::prev(h), normals);
        }
      });
    // A little regularization pulls towards the vertex where the planes leave a direction open.
    const double small = 1e-5 * q.A.trace() + 1e-300;
    const Vec3 p = s.Points[v] - this->Origin;
    q.A += small * Eigen::Matrix3d::Identity();
    q.B += small * p;
    q.C += small * p.squaredNorm();
  }

  /// A plane through the crease, perpendicular to the triangle, keeps the crease in place.
  void addCrease(Quadric& q, Index h, const std::vector<Vec3>& normals) const
  {
    const TriangleSurface& s = this->S;
    const Vec3& p = s.Points[s.start(h)];
    const Vec3 d = s.Points[s.end(h)] - p;
    const Index face = s.hole(h / 3) ? s.Opposite[h] / 3 : h / 3;
    const Vec3 n = d.cross(normals[face]);
    const double length = n.norm();
    if (length > 0.0)
    {
      q.addPlane(n / length, p - this->Origin, d.squaredNorm());
    }
  }

  std::uint32_t stamp(Index h) const
  {
    return this->Version[this->S.start(h)] + this->Version[this->S.end(h)];
  }

  void fill(std::vector<Candidate>& heap)
  {
    std::vector<Index> edges;
    edges.reserve(heap.size());
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (h < this->S.Opposite[h])
      {
        edges.push_back(h);
      }
    }
    heap.resize(edges.size());
    parallelFor(0, static_cast<std::int64_t>(edges.size()), 2048,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t i = first; i < last; ++i)
        {
          heap[i] = this->candidate(edges[i]);
        }
      });
  }

  /// The half-edge of the edge whose start may go, or -1.
  Index directed(Index h) const
  {
    const TriangleSurface& s = this->S;
    const Index a = s.start(h);
    const Index b = s.end(h);
    if (s.Virtual[a] || s.Virtual[b])
    {
      return -1;
    }
    const int da = s.creaseDegree(a);
    const int db = s.creaseDegree(b);
    if (da == 0 && db != 0)
    {
      return h;
    }
    if (db == 0 && da != 0)
    {
      return s.Opposite[h];
    }
    if (da == 0)
    {
      return h;
    }
    return !s.Crease[h] ? -1 : da == 2 ? h : db == 2 ? s.Opposite[h] : -1;
  }

  /// Where the merged vertex goes.
  Vec3 target(Index h) const
  {
    if (h < 0)
    {
      return Vec3::Zero();
    }
    const TriangleSurface& s = this->S;
    const Index a = s.start(h);
    const Index b = s.end(h);
    const int da = s.creaseDegree(a);
    const int db = s.creaseDegree(b);
    if (db != da && db != 0)
    {
      return s.Points[b]; // b lies on a crease or is a corner, and stays
    }
    Quadric q = this->Quadrics[a];
    q.add(this->Quadrics[b]);
    const Vec3 x = q.A.ldlt().solve(q.B) + this->Origin;
    const double length = (s.Points[a] - s.Points[b]).norm();
    const Vec3 middle = 0.5 * (s.Points[a] + s.Points[b]);
    return x.allFinite() && (x - middle).norm() <= length ? x : middle;
  }

  Candidate candidate(Index e) const
  {
    const Index h = this->directed(e);
    if (h < 0)
    {
      return {std::numeric_limits<double>::infinity(), e, this->stamp(e)};
    }
    const Vec3 x = this->target(h) - this->Origin;
    const Index a = this->S.start(h);
    const Index b = this->S.end(h);
    const double error = this->Quadrics[a].at(x) + this->Quadrics[b].at(x);
    return {std::max(error, 0.0), e, this->stamp(e)};
  }

  /// Do all triangles that stay keep their side and a sound shape?
  bool shapesStay(Index h, const Vec3& x) const
  {
    return this->fanStays(this->S.start(h), this->S.end(h), x) &&
           this->fanStays(this->S.end(h), this->S.start(h), x);
  }

  bool fanStays(Index v, Index other, const Vec3& x) const
  {
    const TriangleSurface& s = this->S;
    bool stays = true;
    s.around(v,
      [&](Index h)
      {
        const Index b = s.end(h);
        const Index c = s.apex(h);
        if (!stays || b == other || c == other || s.hole(h / 3))
        {
          return;
        }
        const Vec3& p = s.Points[b];
        const Vec3& q = s.Points[c];
        const Vec3 before = (p - s.Points[v]).cross(q - s.Points[v]);
        const Vec3 after = (p - x).cross(q - x);
        const double beforeNorm = before.norm();
        const double afterNorm = after.norm();
        const double longest2 =
          std::max({(p - x).squaredNorm(), (q - x).squaredNorm(), (p - q).squaredNorm()});
        const double longestBefore2 = std::max({(p - s.Points[v]).squaredNorm(),
          (q - s.Points[v]).squaredNorm(), (p - q).squaredNorm()});
        const bool turned = before.dot(after) < 0.34 * beforeNorm * afterNorm;
        const bool sliver =
          afterNorm < 0.12 * longest2 && afterNorm * longestBefore2 < beforeNorm * longest2;
        stays = !turned && !sliver;
      });
    return stays;
  }

  template <class Queue>
  void apply(Index h, const Vec3& x, Queue& queue)
  {
    TriangleSurface& s = this->S;
    const Index a = s.start(h);
    const Index b = s.end(h);
    this->Quadrics[b].add(this->Quadrics[a]);
    this->Version[b] += this->Version[a] + 1;
    s.collapse(h, x);
    s.around(b, [&](Index e) { queue.push(this->candidate(std::min(e, s.Opposite[e]))); });
  }

  TriangleSurface& S;
  Vec3 Origin;
  std::vector<Quadric> Quadrics;
  std::vector<std::uint32_t> Version;
};
} // namespace

Status decimate(TriangleSurface& s, Index target, Monitor& monitor)
{
  return Decimator(s).run(target, monitor);
}
} // namespace bsr
