#include "Mesh/QuadricCollapse.h"

#include "Common/Parallel.h"
#include "Mesh/SpatialOrder.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr double Infinite = std::numeric_limits<double>::infinity();
constexpr std::array<CollapseLimits, 3> Levels = {{{0.34, 0.12}, {0.34, 0.03}, {-0.2, 0.01}}};

template <class T>
void permute(std::vector<T>& values, const std::vector<Index>& order)
{
  std::vector<T> moved(order.size());
  parallelFor(0, static_cast<std::int64_t>(order.size()), 8192,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t i = first; i < last; ++i)
      {
        moved[i] = values[order[i]];
      }
    });
  values.swap(moved);
}
} // namespace

QuadricCollapse::QuadricCollapse(TriangleSurface& s, Monitor& monitor)
    : S(s),
      Quadrics(s.Points.size()),
      Version(s.Points.size(), 0),
      Degree(s.Points.size(), 0),
      Movable(s.Points.size(), 0)
{
  // Relative to a corner of the object, so that large coordinates cost no digits.
  this->Origin = s.Points.front();
  parallelForUntilCancelled(0, s.vertices(), 1024, monitor,
    [&](std::int64_t first, std::int64_t last)
    { this->buildQuadrics(static_cast<Index>(first), static_cast<Index>(last)); });
}

Index QuadricCollapse::faces() const
{
  Index n = 0;
  for (Index f = 0; f < this->S.faces(); ++f)
  {
    n += this->S.alive(f) && !this->S.hole(f);
  }
  return n;
}

void QuadricCollapse::buildQuadrics(Index first, Index last)
{
  const TriangleSurface& s = this->S;
  for (Index v = first; v < last; ++v)
  {
    if (s.Virtual[v])
    {
      continue;
    }
    this->Degree[v] = static_cast<std::uint8_t>(std::min(s.creaseDegree(v), 3));
    Quadric& q = this->Quadrics[v];
    const Vec3 p = s.Points[v] - this->Origin;
    s.around(v,
      [&](Index h)
      {
        const Vec3 normal = s.areaNormal(h / 3);
        const double area = normal.norm();
        if (!s.hole(h / 3) && area > 0.0)
        {
          q.addPlane(normal / area, p, area / 3.0);
        }
        if (s.Crease[h])
        {
          this->addCrease(q, h);
        }
        if (s.Crease[TriangleSurface::prev(h)])
        {
          this->addCrease(q, TriangleSurface::prev(h));
        }
      });
    // A little regularization pulls towards the vertex where the planes leave a direction open.
    q.addPoint(p, 1e-5 * q.weight() + 1e-300);
  }
}

/// A plane through the crease, perpendicular to the triangle, keeps the crease in place.
void QuadricCollapse::addCrease(Quadric& q, Index h) const
{
  const TriangleSurface& s = this->S;
  const Vec3& p = s.Points[s.start(h)];
  const Vec3 d = s.Points[s.end(h)] - p;
  const Vec3 n = d.cross(s.areaNormal(s.hole(h / 3) ? s.Opposite[h] / 3 : h / 3));
  const double length = n.norm();
  if (length > 0.0)
  {
    q.addPlane(n / length, p - this->Origin, d.squaredNorm());
  }
}

bool QuadricCollapse::sort(double shift, Monitor& monitor)
{
  const std::vector<Index> order = sortAlongCurve(this->S, shift, monitor);
  if (monitor.cancelled())
  {
    return false;
  }
  permute(this->Quadrics, order);
  permute(this->Degree, order);
  std::fill(this->Version.begin(), this->Version.end(), 0);
  return true;
}

void QuadricCollapse::compact()
{
  const std::vector<Index> map = this->S.compact();
  for (std::size_t v = 0; v < map.size(); ++v)
  {
    if (map[v] >= 0)
    {
      this->Quadrics[map[v]] = this->Quadrics[v];
      this->Degree[map[v]] = this->Degree[v];
    }
  }
  this->Quadrics.resize(this->S.Points.size());
  this->Degree.resize(this->S.Points.size());
  this->Version.assign(this->S.Points.size(), 0);
  this->Movable.assign(this->S.Points.size(), 0);
}

bool QuadricCollapse::collapseInBlocks(Index blockVertices, double keep, Monitor& monitor)
{
  const Index blocks = (this->S.vertices() + blockVertices - 1) / blockVertices;
  return parallelForUntilCancelled(0, blocks, 1, monitor,
    [&](std::int64_t b, std::int64_t)
    {
      const auto first = static_cast<Index>(b * blockVertices);
      this->collapseBlock(first, std::min(first + blockVertices, this->S.vertices()), keep);
    });
}

/// Works on triangles of three vertices of the block only, which no other block reads or writes:
/// both ends of a collapsed edge have all their neighbors in the block.
void QuadricCollapse::collapseBlock(Index first, Index last, double keep)
{
  const TriangleSurface& s = this->S;
  const auto inside = [&](Index v) { return v >= first && v < last && !s.Virtual[v]; };
  for (Index v = first; v < last; ++v)
  {
    bool inner = inside(v);
    s.around(v, [&](Index h) { inner = inner && inside(s.end(h)); });
    this->Movable[v] = inner;
  }
  Index corners = 0; // of triangles, at vertices that may move
  Heap heap;
  for (Index v = first; v < last; ++v)
  {
    if (this->Movable[v])
    {
      s.around(v,
        [&](Index h)
        {
          ++corners;
          if (s.end(h) > v && this->Movable[s.end(h)])
          {
            heap.push_back(this->candidate(std::min(h, s.Opposite[h])));
          }
        });
    }
  }
  std::make_heap(heap.begin(), heap.end(), std::greater<>());
  auto surplus = static_cast<Index>((1.0 - keep) * corners / 3.0);
  while (surplus > 0 && !heap.empty())
  {
    surplus -= this->collapseCheapest(heap, Infinite, Levels[1]);
  }
}

bool QuadricCollapse::fillHeap(Heap& heap, Monitor& monitor) const
{
  heap.clear();
  for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
  {
    if (this->S.Vertex[h] >= 0 && h < this->S.Opposite[h])
    {
      heap.push_back({0.0, h, 0});
    }
  }
  const bool go =
    parallelForUntilCancelled(0, static_cast<std::int64_t>(heap.size()), 4096, monitor,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t i = first; i < last; ++i)
        {
          heap[i] = this->candidate(heap[i].HalfEdge);
        }
      });
  std::make_heap(heap.begin(), heap.end(), std::greater<>());
  return go;
}

bool QuadricCollapse::collapseAll(const DecimateOptions& options, Monitor& monitor)
{
  Index left = this->faces();
  const double total = std::max<double>(left - options.Target, 1.0);
  std::fill(this->Movable.begin(), this->Movable.end(), 1);
  Heap heap;
  std::size_t step = 0;
  for (const CollapseLimits& limits : Levels)
  {
    if (left <= options.Target || (&limits != &Levels[0] && left <= 1.5 * options.Target))
    {
      break;
    }
    if (!this->fillHeap(heap, monitor))
    {
      return false;
    }
    while (left > options.Target && !heap.empty())
    {
      if (++step % 4096 == 0)
      {
        monitor.progress(1.0 - (left - options.Target) / total);
        if (monitor.cancelled())
        {
          return false;
        }
      }
      const double limit = left > options.Most ? Infinite : options.MaximumError;
      left -= this->collapseCheapest(heap, limit, limits);
    }
  }
  return true;
}

Index QuadricCollapse::collapseCheapest(
  Heap& heap, double maximumError, const CollapseLimits& limits)
{
  std::pop_heap(heap.begin(), heap.end(), std::greater<>());
  const Candidate c = heap.back();
  heap.pop_back();
  if (this->S.Vertex[c.HalfEdge] < 0 || c.Stamp != this->stamp(c.HalfEdge))
  {
    return 0;
  }
  const Index h = this->directed(c.HalfEdge);
  if (h < 0)
  {
    return 0;
  }
  const double weight =
    this->Quadrics[this->S.start(h)].weight() + this->Quadrics[this->S.end(h)].weight();
  const Vec3 x = this->place(h);
  if (c.Cost > maximumError * maximumError * weight || !this->S.canCollapse(h) ||
      !this->shapesStay(h, x, limits))
  {
    return 0;
  }
  return this->apply(h, x, heap);
}

Index QuadricCollapse::apply(Index h, const Vec3& x, Heap& heap)
{
  TriangleSurface& s = this->S;
  const Index a = s.start(h);
  const Index b = s.end(h);
  const Index removed = !s.hole(h / 3) + !s.hole(s.Opposite[h] / 3);
  this->Quadrics[b].add(this->Quadrics[a]);
  this->Version[b] += this->Version[a] + 1;
  s.collapse(h, x);
  s.around(b,
    [&](Index e)
    {
      if (this->Movable[s.end(e)])
      {
        heap.push_back(this->candidate(std::min(e, s.Opposite[e])));
        std::push_heap(heap.begin(), heap.end(), std::greater<>());
      }
    });
  return removed;
}

std::uint32_t QuadricCollapse::stamp(Index h) const
{
  return this->Version[this->S.start(h)] + this->Version[this->S.end(h)];
}

/// The half-edge of the edge whose start may go, or -1.
Index QuadricCollapse::directed(Index h) const
{
  const TriangleSurface& s = this->S;
  const Index a = s.start(h);
  const Index b = s.end(h);
  if (s.Virtual[a] || s.Virtual[b])
  {
    return -1;
  }
  const int da = this->Degree[a];
  const int db = this->Degree[b];
  if (da == 0 || db == 0)
  {
    return da == 0 ? h : s.Opposite[h];
  }
  return !s.Crease[h] ? -1 : da == 2 ? h : db == 2 ? s.Opposite[h] : -1;
}

/// Where the merged vertex goes.
Vec3 QuadricCollapse::place(Index h) const
{
  const TriangleSurface& s = this->S;
  const Index a = s.start(h);
  const Index b = s.end(h);
  const int db = this->Degree[b];
  if (db != 0 && db != this->Degree[a])
  {
    return s.Points[b]; // b lies on a crease or is a corner, and stays
  }
  Quadric q = this->Quadrics[a];
  q.add(this->Quadrics[b]);
  const Vec3 x = q.minimum() + this->Origin;
  const double length = (s.Points[a] - s.Points[b]).norm();
  const Vec3 middle = 0.5 * (s.Points[a] + s.Points[b]);
  return (x - middle).norm() <= length ? x : middle;
}

QuadricCollapse::Candidate QuadricCollapse::candidate(Index edge) const
{
  const Index h = this->directed(edge);
  if (h < 0)
  {
    return {Infinite, edge, this->stamp(edge)};
  }
  const Vec3 x = this->place(h) - this->Origin;
  const double error =
    this->Quadrics[this->S.start(h)].at(x) + this->Quadrics[this->S.end(h)].at(x);
  return {std::max(error, 0.0), edge, this->stamp(edge)};
}

/// Do all triangles that stay keep their side and a sound shape?
bool QuadricCollapse::shapesStay(Index h, const Vec3& x, const CollapseLimits& limits) const
{
  return this->fanStays(this->S.start(h), this->S.end(h), x, limits) &&
         this->fanStays(this->S.end(h), this->S.start(h), x, limits);
}

bool QuadricCollapse::fanStays(
  Index v, Index other, const Vec3& x, const CollapseLimits& limits) const
{
  const TriangleSurface& s = this->S;
  const Vec3& o = s.Points[v];
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
      const Vec3 before = (p - o).cross(q - o);
      const Vec3 after = (p - x).cross(q - x);
      const double beforeNorm = before.norm();
      const double afterNorm = after.norm();
      const double pq = (p - q).squaredNorm();
      const double longest = std::max({(p - x).squaredNorm(), (q - x).squaredNorm(), pq});
      const double longestBefore = std::max({(p - o).squaredNorm(), (q - o).squaredNorm(), pq});
      const bool turned = before.dot(after) < limits.Turn * beforeNorm * afterNorm;
      const bool sliver =
        afterNorm < limits.Sliver * longest && afterNorm * longestBefore < beforeNorm * longest;
      stays = !turned && !sliver;
    });
  return stays;
}
} // namespace bsr
