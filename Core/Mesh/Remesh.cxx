#include "Mesh/Remesh.h"

#include "Common/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace bsr
{
namespace
{
constexpr int Regular = 6; ///< edges at a vertex
/// Relative length of an edge beyond which the longest edges are split first.
constexpr double Coarse = 6.0;
constexpr Index MostSplits = 300000; ///< a round, however long and many needles are

class Remesher
{
  using LongEdge = std::pair<double, Index>; ///< length; half-edge, negative: the first comes first

public:
  Remesher(TriangleSurface& s, const ReferenceSurface& reference, Monitor& monitor)
      : S(s), Reference(reference), Ask(monitor), Wanted(s.Points.size())
  {
  }

  /// One round; false when cancelled.
  bool run(const EdgeLength& length)
  {
    const bool go = parallelForUntilCancelled(0, this->S.vertices(), 256, this->Ask,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t v = first; v < last; ++v)
        {
          this->Wanted[v] = length(this->S.Points[v]);
        }
      });
    return go && this->splitLong() && this->collapseShort() && this->flipToRegular() &&
           this->relax() && this->relax();
  }

private:
  bool splitLong()
  {
    bool coarse = false;
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      coarse = coarse || (this->S.Vertex[h] >= 0 && this->real(h) && this->relative(h) > Coarse);
    }
    return coarse ? this->splitLongestFirst() : this->splitInPasses();
  }

  bool splitInPasses()
  {
    for (int pass = 0; pass < 12; ++pass)
    {
      bool any = false;
      const auto count = static_cast<Index>(this->S.Vertex.size());
      for (Index h = 0; h < count; ++h)
      {
        if (this->stopped(h))
        {
          return false;
        }
        if (this->S.Vertex[h] >= 0 && h < this->S.Opposite[h] && this->real(h) &&
            this->relative(h) > 4.0 / 3.0 && this->longestAround(h))
        {
          const Vec3 middle =
            0.5 * (this->S.Points[this->S.start(h)] + this->S.Points[this->S.end(h)]);
          const double wanted = this->wanted(h);
          this->S.split(h, middle);
          this->Wanted.push_back(wanted);
          any = true;
        }
      }
      if (!any)
      {
        return true;
      }
      // Fans of needles would grow vertices of ever more edges.
      if (!this->flipToRegular())
      {
        return false;
      }
    }
    return true;
  }

  /// The longest edge first: it is the longest of both its triangles, so that angles are no worse
  /// than halved (Rivara 1984) and no vertex grows a fan of needles.
  bool splitLongestFirst()
  {
    std::vector<LongEdge> heap;
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      this->addIfLong(h, heap);
    }
    std::make_heap(heap.begin(), heap.end());
    const bool any = !heap.empty();
    for (Index step = 0; !heap.empty() && step < MostSplits; ++step)
    {
      if (this->stopped(step))
      {
        return false;
      }
      std::pop_heap(heap.begin(), heap.end());
      const auto [length, negative] = heap.back();
      const Index h = -negative;
      heap.pop_back();
      if (this->length(h) != length)
      {
        continue; // another edge since
      }
      const double wanted = this->wanted(h);
      const Index middle =
        this->S.split(h, 0.5 * (this->S.Points[this->S.start(h)] + this->S.Points[this->S.end(h)]));
      this->Wanted.push_back(wanted);
      this->S.around(middle,
        [&](Index x)
        {
          for (Index y : {x, TriangleSurface::next(x)}) // splits renumber the edges around
          {
            if (this->addIfLong(std::min(y, this->S.Opposite[y]), heap))
            {
              std::push_heap(heap.begin(), heap.end());
            }
          }
        });
    }
    // Fans of needles have vertices of many edges.
    return !any || this->flipToRegular();
  }

  bool addIfLong(Index h, std::vector<LongEdge>& heap) const
  {
    const bool any = this->S.Vertex[h] >= 0 && h < this->S.Opposite[h] && this->real(h) &&
                     this->relative(h) > 4.0 / 3.0;
    if (any)
    {
      heap.emplace_back(this->length(h), -h);
    }
    return any;
  }

  bool collapseShort()
  {
    const auto count = static_cast<Index>(this->S.Vertex.size());
    for (Index e = 0; e < count; ++e)
    {
      if (this->stopped(e))
      {
        return false;
      }
      if (this->S.Vertex[e] < 0 || !this->real(e) || this->relative(e) >= 0.8)
      {
        continue;
      }
      const int degree = this->S.creaseDegree(this->S.start(e));
      const int endDegree = this->S.creaseDegree(this->S.end(e));
      if (degree != 0 && endDegree == 0)
      {
        continue; // the other half-edge of the edge serves
      }
      const Vec3 x =
        degree == endDegree && (degree == 0 || degree == 2)
          ? Vec3(0.5 * (this->S.Points[this->S.start(e)] + this->S.Points[this->S.end(e)]))
          : this->S.Points[this->S.end(e)];
      if (this->S.canCollapse(e) && this->fits(e, x))
      {
        this->S.collapse(e, x);
      }
    }
    return true;
  }

  bool flipToRegular()
  {
    const auto count = static_cast<Index>(this->S.Vertex.size());
    std::vector<int> valence(this->S.Points.size(), 0);
    for (Index h = 0; h < count; ++h)
    {
      if (this->S.Vertex[h] >= 0)
      {
        ++valence[this->S.start(h)];
      }
    }
    const auto excess = [&](Index v, int d)
    { return std::abs(valence[v] + d - Regular) * std::abs(valence[v] + d - Regular); };
    for (Index h = 0; h < count; ++h)
    {
      if (this->stopped(h))
      {
        return false;
      }
      if (this->S.Vertex[h] < 0 || h > this->S.Opposite[h] || !this->real(h))
      {
        continue;
      }
      const std::array<Index, 4> at = {
        this->S.start(h), this->S.end(h), this->S.apex(h), this->S.apex(this->S.Opposite[h])};
      int gain = 0;
      for (int k = 0; k < 4; ++k)
      {
        gain += excess(at[k], k < 2 ? -1 : 1) - excess(at[k], 0);
      }
      if (gain < 0 && this->S.canFlip(h) && this->flipSound(h))
      {
        this->S.flip(h);
        for (int k = 0; k < 4; ++k)
        {
          valence[at[k]] += k < 2 ? -1 : 1;
        }
      }
    }
    return true;
  }

  bool relax()
  {
    TriangleSurface& s = this->S;
    std::vector<Vec3> moved = s.Points;
    const bool go = parallelForUntilCancelled(0, s.vertices(), 256, this->Ask,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t v = first; v < last; ++v)
        {
          moved[v] = this->relaxed(static_cast<Index>(v));
        }
      });
    s.Points.swap(moved);
    return go;
  }

  /// Asked now and then in loops.
  bool stopped(Index step) { return step % 8192 == 8191 && this->Ask.cancelled(); }
  bool real(Index h) const
  {
    return !this->S.Virtual[this->S.start(h)] && !this->S.Virtual[this->S.end(h)];
  }
  double length(Index h) const
  {
    return (this->S.Points[this->S.start(h)] - this->S.Points[this->S.end(h)]).norm();
  }
  double wanted(Index h) const
  {
    return 0.5 * (this->Wanted[this->S.start(h)] + this->Wanted[this->S.end(h)]);
  }
  double relative(Index h) const { return this->length(h) / this->wanted(h); }
  /// The longest edge of one of its triangles: splitting only those keeps angles sound.
  bool longestAround(Index h) const
  {
    for (Index x : {h, this->S.Opposite[h]})
    {
      if (this->S.hole(x / 3) || (this->length(TriangleSurface::next(x)) <= this->length(x) &&
                                   this->length(TriangleSurface::prev(x)) <= this->length(x)))
      {
        return true;
      }
    }
    return false;
  }
  static double quality(const Vec3& a, const Vec3& b, const Vec3& c)
  {
    const double l =
      std::max({(a - b).squaredNorm(), (b - c).squaredNorm(), (c - a).squaredNorm()});
    return l > 0.0 ? (b - a).cross(c - a).norm() / l : 0.0;
  }
  bool fits(Index h, const Vec3& x) const
  {
    return this->fanFits(this->S.start(h), this->S.end(h), x) &&
           this->fanFits(this->S.end(h), this->S.start(h), x) && this->valenceFits(h);
  }
  bool valenceFits(Index h) const
  {
    const int merged = this->S.valence(this->S.start(h)) + this->S.valence(this->S.end(h)) - 4;
    return merged <= 9 && this->S.valence(this->S.apex(h)) > 4 &&
           this->S.valence(this->S.apex(this->S.Opposite[h])) > 4;
  }
  bool fanFits(Index v, Index other, const Vec3& x) const
  {
    const TriangleSurface& s = this->S;
    const double limit = 4.0 / 3.0 * std::min(this->Wanted[v], this->Wanted[other]);
    bool fits = true;
    s.around(v,
      [&](Index h)
      {
        const Index b = s.end(h);
        const Index c = s.apex(h);
        if (!fits || b == other || c == other || s.hole(h / 3))
        {
          return;
        }
        const Vec3 before = (s.Points[b] - s.Points[v]).cross(s.Points[c] - s.Points[v]);
        const Vec3 after = (s.Points[b] - x).cross(s.Points[c] - x);
        fits = (s.Points[b] - x).norm() <= limit &&
               before.dot(after) >= 0.5 * before.norm() * after.norm();
      });
    return fits;
  }
  bool flipSound(Index h) const
  {
    const TriangleSurface& s = this->S;
    const Vec3& a = s.Points[s.start(h)];
    const Vec3& b = s.Points[s.end(h)];
    const Vec3& c = s.Points[s.apex(h)];
    const Vec3& d = s.Points[s.apex(s.Opposite[h])];
    const Vec3 n = (b - a).cross(c - a).normalized() + (d - a).cross(b - a).normalized();
    const Vec3 n0 = (d - a).cross(c - a);
    const Vec3 n1 = (c - b).cross(d - b);
    const double worst = std::min(quality(a, d, c), quality(b, c, d));
    return n0.dot(n) > 0.7 * n0.norm() * n.norm() && n1.dot(n) > 0.7 * n1.norm() * n.norm() &&
           worst > std::min(0.35, 0.9 * std::min(quality(a, b, c), quality(a, d, b)));
  }
  Vec3 relaxed(Index v) const
  {
    const TriangleSurface& s = this->S;
    const int degree = s.Out[v] < 0 ? 0 : s.creaseDegree(v);
    if (s.Out[v] < 0 || s.Virtual[v] || (degree != 0 && degree != 2))
    {
      return s.Points[v];
    }
    Vec3 sum = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double weight = 0.0;
    s.around(v,
      [&](Index h)
      {
        if (degree == 2)
        {
          sum += s.Crease[h] * s.Points[s.end(h)];
          weight += s.Crease[h];
          return;
        }
        const Vec3 n = s.areaNormal(h / 3);
        const double area = n.norm();
        sum += area * (s.Points[s.start(h)] + s.Points[s.end(h)] + s.Points[s.apex(h)]) / 3.0;
        weight += area;
        normal += n;
      });
    if (weight <= 0.0)
    {
      return s.Points[v];
    }
    const Vec3 target = sum / weight;
    if (degree == 2)
    {
      return this->Reference.Creases.nearest(target).Point;
    }
    const Vec3 n = normal.normalized();
    const Vec3 step = target - s.Points[v];
    return this->Reference.Faces.nearest(s.Points[v] + step - n.dot(step) * n).Point;
  }

  TriangleSurface& S;
  const ReferenceSurface& Reference;
  Monitor& Ask;
  std::vector<double> Wanted; ///< edge length at each vertex
};
} // namespace

std::vector<SurfaceSample> surfaceSamples(const TriangleSurface& s, int count)
{
  double total = 0.0;
  for (Index f = 0; f < s.faces(); ++f)
  {
    total += s.alive(f) && !s.hole(f) ? s.areaNormal(f).norm() : 0.0;
  }
  std::vector<SurfaceSample> samples;
  double area = 0.0;
  for (Index f = 0; f < s.faces() && total > 0.0; ++f)
  {
    if (!s.alive(f) || s.hole(f))
    {
      continue;
    }
    const Vec3 n = s.areaNormal(f);
    const double own = n.norm();
    area += own;
    const auto c = s.corners(f);
    while (own > 0.0 && static_cast<double>(samples.size()) + 0.5 < count * area / total)
    {
      // A sequence of low discrepancy, folded into the triangle (Roberts 2018).
      const auto i = static_cast<double>(samples.size() + 1);
      double x = std::fmod(0.7548776662466927 * i, 1.0);
      double y = std::fmod(0.5698402909980532 * i, 1.0);
      if (x + y > 1.0)
      {
        x = 1.0 - x;
        y = 1.0 - y;
      }
      const Vec3& a = s.Points[c[0]];
      samples.push_back({a + x * (s.Points[c[1]] - a) + y * (s.Points[c[2]] - a), n / own});
    }
  }
  return samples;
}

ReferenceSurface::ReferenceSurface(const TriangleSurface& s)
{
  Monitor quiet;
  *this = ReferenceSurface(s, quiet);
}

ReferenceSurface::ReferenceSurface(const TriangleSurface& s, Monitor& monitor)
{
  std::vector<std::array<Index, 3>> faces;
  std::vector<std::array<Index, 3>> creases;
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (s.alive(f) && !s.hole(f))
    {
      faces.push_back(s.corners(f));
    }
  }
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    if (s.Vertex[h] >= 0 && s.Crease[h] && h < s.Opposite[h])
    {
      creases.push_back({s.start(h), s.end(h), s.end(h)});
    }
  }
  this->Faces = TriangleTree(s.Points, std::move(faces), monitor);
  this->Creases = TriangleTree(s.Points, std::move(creases), monitor);
}

Status remesh(TriangleSurface& s, const ReferenceSurface& reference, const EdgeLength& edgeLength,
  int iterations, Monitor& monitor)
{
  for (int i = 0; i < iterations; ++i)
  {
    if (!Remesher(s, reference, monitor).run(edgeLength))
    {
      return Status::cancelled();
    }
    s.compact();
    monitor.progress((i + 1.0) / iterations);
  }
  return Status::ok();
}
} // namespace bsr
