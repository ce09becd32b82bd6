#include "Layout/ExtractQuads.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
GridPoint minus(const GridPoint& a, const GridPoint& b)
{
  return {a[0] - b[0], a[1] - b[1]};
}
GridPoint plus(const GridPoint& a, const GridPoint& b)
{
  return {a[0] + b[0], a[1] + b[1]};
}
std::int64_t reach(const GridPoint& d)
{
  return std::max(std::abs(d[0]), std::abs(d[1]));
}

class Extractor
{
public:
  Extractor(GridMap& map, Monitor& monitor) : M(map), S(map.Surface), Watch(monitor) {}

  bool prepare()
  {
    for (int pass = 0; pass < 8; ++pass)
    {
      if (this->Watch.cancelled() || !this->round())
      {
        return false;
      }
      if (!this->Watch.cancelled() && !this->splitLong())
      {
        return this->unfold();
      }
    }
    return false;
  }

  LayoutDraft quads(std::vector<std::vector<Index>>& borders, std::vector<Index>& regions)
  {
    LayoutDraft draft;
    this->cluster();
    std::vector<Index> number(this->S.Points.size(), -1);
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      const Index h = this->M.Inside[f] && this->area(f) > 0 ? this->diagonal(f) : -1;
      const Index o = h < 0 ? -1 : this->across(h);
      if (o < 0 || o / 3 < f)
      {
        continue;
      }
      std::array<Index, 4> quad = {
        this->S.start(h), this->S.apex(o), this->S.end(h), this->S.apex(h)};
      for (Index& v : quad)
      {
        v = this->root(v);
        if (number[v] < 0)
        {
          number[v] = static_cast<Index>(draft.Mesh.Points.size());
          draft.Mesh.Points.push_back(this->place(v));
          draft.Kind.push_back(this->Kind[v]);
        }
        v = number[v];
      }
      draft.Mesh.Quads.push_back(quad);
      draft.Mesh.Region.push_back(this->S.Region[f]);
    }
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (this->inside(h) && this->S.Crease[h])
      {
        const Index a = number[this->root(this->S.start(h))];
        const Index b = number[this->root(this->S.end(h))];
        if (a >= 0 && b >= 0 && a != b)
        {
          draft.Creases.push_back({std::min(a, b), std::max(a, b)});
        }
      }
    }
    this->borders(number, borders, regions);
    return draft;
  }

private:
  bool inside(Index h) const { return this->M.Inside[h / 3] != 0; }
  bool inner(Index h) const { return this->inside(h) && this->inside(this->S.Opposite[h]); }
  GridPoint over(Index h, const GridPoint& p) const
  {
    return plus(turned(p, this->M.Turn[h]), this->M.Shift[h]);
  }
  GridPoint step(Index h) const
  {
    return minus(this->Grid[TriangleSurface::next(h)], this->Grid[h]);
  }
  std::int64_t area(Index f) const
  {
    const GridPoint a = this->step(3 * f);
    const GridPoint b = minus(this->Grid[3 * f + 2], this->Grid[3 * f]);
    return a[0] * b[1] - a[1] * b[0];
  }

  /// Grid points of all corners, alike in all charts around a vertex.
  bool round()
  {
    this->Grid.assign(this->S.Vertex.size(), GridPoint{0, 0});
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      Index first = -1;
      bool fan = false;
      this->S.around(v,
        [&](Index h)
        {
          if (this->inside(h) && (first < 0 || !this->inside(this->S.Opposite[h])) && !fan)
          {
            first = h;
            fan = !this->inside(this->S.Opposite[h]);
          }
        });
      if (first < 0)
      {
        continue;
      }
      const Vec2& uv = this->M.UV[first];
      GridPoint p{static_cast<std::int64_t>(std::floor(uv[0] + 0.5)),
        static_cast<std::int64_t>(std::floor(uv[1] + 0.5))};
      Index h = first;
      do
      {
        this->Grid[h] = p;
        const Index in = TriangleSurface::prev(h);
        h = this->S.Opposite[in];
        if (!this->inside(h))
        {
          break;
        }
        p = this->over(in, p);
      } while (h != first);
      if (h == first && this->inside(h) && p != this->Grid[first])
      {
        return false;
      }
    }
    return true;
  }

  bool splitLong()
  {
    bool any = false;
    const auto count = static_cast<Index>(this->S.Vertex.size());
    for (Index h = 0; h < count; ++h)
    {
      if (this->inside(h) && reach(this->step(h)) > 1)
      {
        // Steps of split edges are unknown until the next rounding.
        this->split(h);
        any = true;
      }
    }
    return any;
  }

  void split(Index h)
  {
    const Index o = this->S.Opposite[h];
    const std::array<Index, 2> sides = {h, o};
    std::array<Vec2, 2> middle;
    for (int i = 0; i < 2; ++i)
    {
      middle[i] = 0.5 * (this->M.UV[sides[i]] + this->M.UV[TriangleSurface::next(sides[i])]);
    }
    const Vec3 p = 0.5 * (this->S.Points[this->S.start(h)] + this->S.Points[this->S.end(h)]);
    this->S.split(h, p);
    const Index f = this->S.faces() - 2;
    const Index g = f + 1;
    for (Index face : {f, g})
    {
      this->M.Inside.push_back(this->M.Inside[(face == f ? h : o) / 3]);
      for (int k = 0; k < 3; ++k)
      {
        this->M.UV.emplace_back(0, 0);
        this->M.Turn.push_back(0);
        this->M.Shift.push_back({0, 0});
        this->Grid.push_back({0, 0});
      }
    }
    const Index hn = TriangleSurface::next(h);
    const Index op = TriangleSurface::prev(o);
    auto copy = [this](Index to, Index from)
    {
      this->M.Turn[to] = this->M.Turn[from];
      this->M.Shift[to] = this->M.Shift[from];
    };
    // f = (m, b, c): coordinates of b and c are those of the old corners hn and prev(h).
    this->M.UV[3 * f] = middle[0];
    this->M.UV[3 * f + 1] = this->M.UV[hn];
    this->M.UV[3 * f + 2] = this->M.UV[TriangleSurface::prev(h)];
    this->M.UV[3 * g] = this->M.UV[o];
    this->M.UV[3 * g + 1] = middle[1];
    this->M.UV[3 * g + 2] = this->M.UV[op];
    this->M.UV[hn] = middle[0];
    this->M.UV[o] = middle[1];
    copy(3 * f, h);
    copy(3 * f + 1, hn);
    copy(3 * g, o);
    copy(3 * g + 2, op);
    for (Index inner : {hn, op})
    {
      this->M.Turn[inner] = 0;
      this->M.Shift[inner] = {0, 0};
    }
    // No further split of these triangles in this pass: their grid points are made equal.
    for (Index face : {h / 3, o / 3})
    {
      for (int k = 0; k < 3; ++k)
      {
        this->Grid[3 * face + k] = {0, 0};
      }
    }
  }

  /// Writes the triangle of g in the chart beyond half-edge `in` of its neighbor.
  void rechart(Index g, Index in)
  {
    const int t = this->M.Turn[in];
    const GridPoint s = this->M.Shift[in];
    // p (old chart) = turned(q) + s, so q = turned(p - s, -t).
    for (Index h = 3 * g; h < 3 * g + 3; ++h)
    {
      this->Grid[h] = turned(minus(this->Grid[h], s), 4 - t);
    }
    for (Index h = 3 * g; h < 3 * g + 3; ++h)
    {
      const Index o = this->S.Opposite[h];
      // New transition: first back to the old chart, then on.
      this->M.Shift[h] = plus(turned(s, this->M.Turn[h]), this->M.Shift[h]);
      this->M.Turn[h] = static_cast<std::uint8_t>((this->M.Turn[h] + t) & 3);
      this->M.Turn[o] = static_cast<std::uint8_t>((4 - this->M.Turn[h]) & 3);
      const GridPoint back = turned(this->M.Shift[h], this->M.Turn[o]);
      this->M.Shift[o] = {-back[0], -back[1]};
    }
  }

  /// Flips edges until no triangle is turned over; false: that did not help.
  bool unfold()
  {
    for (int pass = 0; pass < 20 && !this->Watch.cancelled(); ++pass)
    {
      bool any = false;
      bool flipped = false;
      for (Index f = 0; f < this->S.faces(); ++f)
      {
        if (!this->M.Inside[f] || this->area(f) >= 0)
        {
          continue;
        }
        any = true;
        for (Index h = 3 * f; h < 3 * f + 3 && this->area(f) < 0; ++h)
        {
          flipped = this->tryFlip(h) || flipped;
        }
      }
      if (!any)
      {
        return true;
      }
      if (!flipped)
      {
        return false;
      }
    }
    return false;
  }

  bool tryFlip(Index h)
  {
    if (!this->inner(h) || !this->S.canFlip(h))
    {
      return false;
    }
    const Index o = this->S.Opposite[h];
    if (o / 3 == h / 3)
    {
      return false;
    }
    for (Index x = 3 * (o / 3); x < 3 * (o / 3) + 3; ++x)
    {
      if (this->S.Opposite[x] / 3 == h / 3 && x != o)
      {
        return false;
      }
    }
    this->rechart(o / 3, h);
    const Index hp = TriangleSurface::prev(h);
    const Index op = TriangleSurface::prev(o);
    const GridPoint a = this->Grid[h];
    const GridPoint b = this->Grid[TriangleSurface::next(h)];
    const GridPoint c = this->Grid[hp];
    const GridPoint d = this->Grid[op];
    auto twice = [](const GridPoint& p, const GridPoint& q, const GridPoint& r)
    { return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]); };
    auto negative = [](std::int64_t x) { return std::max<std::int64_t>(-x, 0); };
    const std::int64_t before = negative(twice(a, b, c)) + negative(twice(a, d, b));
    const std::int64_t after = negative(twice(a, d, c)) + negative(twice(b, c, d));
    if (after >= before || reach(minus(c, d)) > 1)
    {
      return false;
    }
    this->flip(h, a, b, c, d);
    return true;
  }

  void flip(Index h, const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d)
  {
    const Index o = this->S.Opposite[h];
    const Index hn = TriangleSurface::next(h);
    const Index hp = TriangleSurface::prev(h);
    const Index on = TriangleSurface::next(o);
    const Index op = TriangleSurface::prev(o);
    const std::array<std::uint8_t, 4> turn = {
      this->M.Turn[hn], this->M.Turn[hp], this->M.Turn[on], this->M.Turn[op]};
    const std::array<GridPoint, 4> shift = {
      this->M.Shift[hn], this->M.Shift[hp], this->M.Shift[on], this->M.Shift[op]};
    const Vec2 uvA = this->M.UV[h];
    const Vec2 uvB = this->M.UV[hn];
    const Vec2 uvC = this->M.UV[hp];
    const Vec2 uvD = this->M.UV[op];
    this->S.flip(h);
    // From now on only the distance of UV to its grid point matters, which no chart changes.
    this->M.UV[h] = this->M.UV[on] = uvD;
    this->M.UV[hn] = this->M.UV[o] = uvC;
    this->M.UV[hp] = uvA;
    this->M.UV[op] = uvB;
    // As in TriangleSurface::flip: (d, c, a) and (c, d, b).
    this->Grid[h] = d;
    this->Grid[hn] = c;
    this->Grid[hp] = a;
    this->Grid[o] = c;
    this->Grid[on] = d;
    this->Grid[op] = b;
    const std::array<Index, 4> to = {op, hn, hp, on};
    for (int i = 0; i < 4; ++i)
    {
      this->M.Turn[to[i]] = turn[i];
      this->M.Shift[to[i]] = shift[i];
    }
    this->M.Turn[h] = this->M.Turn[o] = 0;
    this->M.Shift[h] = this->M.Shift[o] = {0, 0};
  }

  Index root(Index v)
  {
    while (this->Parent[v] != v)
    {
      this->Parent[v] = this->Parent[this->Parent[v]];
      v = this->Parent[v];
    }
    return v;
  }

  /// Joins vertices at the same grid point and notes how each cluster may move.
  void cluster()
  {
    this->Parent.resize(this->S.Points.size());
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (this->inside(h) && reach(this->step(h)) == 0)
      {
        this->Parent[this->root(this->S.start(h))] = this->root(this->S.end(h));
      }
    }
    this->Kind.assign(this->S.Points.size(), VertexKind::Free);
    this->Sum.assign(this->S.Points.size(), Vec3::Zero());
    this->Weight.assign(this->S.Points.size(), 0.0);
    std::vector<VertexKind> own(this->S.Points.size(), VertexKind::Free);
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      const int degree = this->S.creaseDegree(v);
      own[v] = degree == 0   ? VertexKind::Free
               : degree == 2 ? VertexKind::Crease
                             : VertexKind::Fixed;
      VertexKind& kind = this->Kind[this->root(v)];
      kind = std::max(kind, own[v]);
    }
    std::vector<std::uint8_t> seen(this->S.Points.size(), 0);
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      const Index v = this->S.start(h);
      const Index r = this->root(v);
      if (!this->inside(h) || seen[v] || own[v] != this->Kind[r])
      {
        continue;
      }
      seen[v] = 1;
      const double off = std::hypot(this->M.UV[h][0] - std::floor(this->M.UV[h][0] + 0.5),
        this->M.UV[h][1] - std::floor(this->M.UV[h][1] + 0.5));
      const double weight = 1.0 / (1e-6 + std::pow(off, 4));
      this->Sum[r] += weight * this->S.Points[v];
      this->Weight[r] += weight;
    }
  }

  Vec3 place(Index r) const { return this->Sum[r] / std::max(this->Weight[r], 1e-300); }

  Index diagonal(Index f) const
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const GridPoint d = this->step(h);
      if (d[0] != 0 && d[1] != 0)
      {
        return h;
      }
    }
    return -1;
  }

  /// The diagonal of the other half of the cell, through triangles without area.
  Index across(Index h) const
  {
    for (std::size_t guard = 0; guard < this->S.Region.size(); ++guard)
    {
      if (!this->inner(h))
      {
        return -1;
      }
      const Index o = this->S.Opposite[h];
      if (this->area(o / 3) != 0)
      {
        return this->area(o / 3) > 0 ? o : -1;
      }
      Index onward = -1;
      for (Index x : {TriangleSurface::next(o), TriangleSurface::prev(o)})
      {
        const GridPoint d = this->step(x);
        onward = d[0] != 0 && d[1] != 0 ? x : onward;
      }
      if (onward < 0)
      {
        return -1;
      }
      h = onward;
    }
    return -1;
  }

  void borders(const std::vector<Index>& number, std::vector<std::vector<Index>>& loops,
    std::vector<Index>& regions)
  {
    std::vector<std::uint8_t> done(this->S.Vertex.size(), 0);
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (done[h] || !this->inside(h) || this->inside(this->S.Opposite[h]))
      {
        continue;
      }
      std::vector<Index> loop;
      for (Index x = h; !done[x];)
      {
        done[x] = 1;
        const Index v = number[this->root(this->S.start(x))];
        if (loop.empty() || (loop.back() != v))
        {
          loop.push_back(v);
        }
        Index y = TriangleSurface::next(x);
        while (this->inner(y))
        {
          y = TriangleSurface::next(this->S.Opposite[y]);
        }
        x = y;
      }
      while (loop.size() > 1 && loop.front() == loop.back())
      {
        loop.pop_back();
      }
      loops.push_back(loop);
      regions.push_back(this->S.Region[this->S.Opposite[h] / 3]);
    }
  }

  GridMap& M;
  TriangleSurface& S;
  Monitor& Watch;
  std::vector<GridPoint> Grid;
  std::vector<Index> Parent;
  std::vector<VertexKind> Kind;
  std::vector<Vec3> Sum;
  std::vector<double> Weight;
};
} // namespace

LayoutDraft extractQuads(GridMap map, std::vector<std::vector<Index>>& borders,
  std::vector<Index>& borderRegions, Monitor& monitor)
{
  borders.clear();
  borderRegions.clear();
  Extractor extractor(map, monitor);
  if (map.UV.empty() || !extractor.prepare() || monitor.cancelled())
  {
    return {};
  }
  return extractor.quads(borders, borderRegions);
}
} // namespace bsr
