#include "Layout/PairTriangles.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace bsr
{
namespace
{
class Pairing
{
public:
  explicit Pairing(const TriangleSurface& s) : S(s), Over(s.Region.size(), -1)
  {
    this->Left.assign(s.Points.size(), 0);
    this->Minimum.assign(s.Points.size(), 3);
    for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
    {
      this->Left[s.start(h)] += !s.Virtual[s.end(h)];
      if (s.Virtual[s.end(h)])
      {
        this->Minimum[s.start(h)] = 2;
      }
    }
  }

  /// The half-edge over which each triangle is paired, -1: alone.
  std::vector<Index> run()
  {
    std::vector<std::pair<double, Index>> order;
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (h < this->S.Opposite[h] && this->allowed(h))
      {
        order.emplace_back(-this->shape(h), h);
      }
    }
    std::sort(order.begin(), order.end());
    for (const auto& o : order)
    {
      if (this->free(o.second) && this->room(o.second))
      {
        this->join(o.second);
      }
    }
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      if (!this->S.hole(f) && this->Over[f] < 0)
      {
        this->augment(f);
      }
    }
    return this->Over;
  }

private:
  bool allowed(Index h) const
  {
    return !this->S.Crease[h] && !this->S.hole(h / 3) && !this->S.hole(this->S.Opposite[h] / 3) &&
           this->quarters(h) > 0.1;
  }
  /// The worst scaled Jacobian of the four quads that a pair is split into.
  double quarters(Index h) const
  {
    const TriangleSurface& s = this->S;
    const std::array<Vec3, 4> p = {s.Points[s.start(h)], s.Points[s.apex(s.Opposite[h])],
      s.Points[s.end(h)], s.Points[s.apex(h)]};
    const Vec3 center = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    double worst = 1.0;
    for (int k = 0; k < 4; ++k)
    {
      worst = std::min(worst,
        scaledJacobian(p[k], 0.5 * (p[k] + p[(k + 1) % 4]), center, 0.5 * (p[k] + p[(k + 3) % 4])));
    }
    return worst;
  }
  bool free(Index h) const
  {
    return this->Over[h / 3] < 0 && this->Over[this->S.Opposite[h] / 3] < 0;
  }
  bool room(Index h) const
  {
    const Index a = this->S.start(h);
    const Index b = this->S.end(h);
    return this->Left[a] > this->Minimum[a] && this->Left[b] > this->Minimum[b];
  }
  double shape(Index h) const
  {
    const TriangleSurface& s = this->S;
    return scaledJacobian(s.Points[s.start(h)], s.Points[s.apex(s.Opposite[h])], s.Points[s.end(h)],
      s.Points[s.apex(h)]);
  }
  void change(Index h, int d)
  {
    this->Left[this->S.start(h)] += d;
    this->Left[this->S.end(h)] += d;
  }
  void join(Index h)
  {
    this->Over[h / 3] = h;
    this->Over[this->S.Opposite[h] / 3] = this->S.Opposite[h];
    this->change(h, -1);
  }
  void part(Index h)
  {
    this->Over[h / 3] = -1;
    this->Over[this->S.Opposite[h] / 3] = -1;
    this->change(h, 1);
  }

  /// Looks for another triangle left over, reached by exchanging pairs along the way.
  void augment(Index first)
  {
    std::vector<Index> queue(1, first);
    std::vector<std::pair<Index, Index>> via(this->S.Region.size(), {-1, -1});
    std::vector<std::uint8_t> seen(this->S.Region.size(), 0);
    seen[first] = 1;
    for (std::size_t i = 0; i < queue.size() && i < 200; ++i)
    {
      const Index f = queue[i];
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Index g = this->S.Opposite[h] / 3;
        if (!this->allowed(h) || seen[g] || this->shape(h) < 0.1)
        {
          continue;
        }
        if (this->Over[g] < 0)
        {
          if (this->exchange(h, via))
          {
            return;
          }
          continue;
        }
        const Index mate = this->S.Opposite[this->Over[g]] / 3;
        if (!seen[mate] && mate != f)
        {
          seen[g] = seen[mate] = 1;
          via[mate] = {h, this->Over[g]};
          queue.push_back(mate);
        }
      }
    }
  }

  /// Parts and joins pairs along the path that ends with joining over h; undone if no room.
  bool exchange(Index h, const std::vector<std::pair<Index, Index>>& via)
  {
    std::vector<Index> joins(1, h);
    std::vector<Index> parts;
    for (Index f = h / 3; via[f].first >= 0; f = via[f].first / 3)
    {
      parts.push_back(via[f].second);
      joins.push_back(via[f].first);
    }
    for (Index p : parts)
    {
      this->part(p);
    }
    std::size_t done = 0;
    while (done < joins.size() && this->free(joins[done]) && this->room(joins[done]))
    {
      this->join(joins[done++]);
    }
    if (done == joins.size())
    {
      return true;
    }
    while (done > 0)
    {
      this->part(joins[--done]);
    }
    for (Index p : parts)
    {
      this->join(p);
    }
    return false;
  }

  const TriangleSurface& S;
  std::vector<Index> Over;
  std::vector<int> Left;    ///< edges left at each vertex
  std::vector<int> Minimum; ///< edges a vertex must keep
};

/// Points of the layout: those of the surface, of its edges and of its faces.
struct Splitter
{
  const TriangleSurface& S;
  const std::vector<Index>& Over;
  LayoutDraft Draft;
  std::vector<Index> OfVertex;
  std::vector<Index> OfEdge;

  Index add(const Vec3& p, VertexKind kind)
  {
    this->Draft.Mesh.Points.push_back(p);
    this->Draft.Kind.push_back(kind);
    return static_cast<Index>(this->Draft.Mesh.Points.size()) - 1;
  }
  Index vertex(Index v)
  {
    if (this->OfVertex[v] < 0)
    {
      const int degree = this->S.creaseDegree(v);
      this->OfVertex[v] = this->add(this->S.Points[v], degree == 0   ? VertexKind::Free
                                                       : degree == 2 ? VertexKind::Crease
                                                                     : VertexKind::Fixed);
    }
    return this->OfVertex[v];
  }
  Index edge(Index h)
  {
    const Index e = std::min(h, this->S.Opposite[h]);
    if (this->OfEdge[e] < 0)
    {
      this->OfEdge[e] =
        this->add(0.5 * (this->S.Points[this->S.start(h)] + this->S.Points[this->S.end(h)]),
          this->S.Crease[h] ? VertexKind::Crease : VertexKind::Free);
    }
    return this->OfEdge[e];
  }
  /// Splits the polygon of these half-edges around its middle.
  void face(const std::vector<Index>& border)
  {
    Vec3 center = Vec3::Zero();
    for (Index h : border)
    {
      center += this->S.Points[this->S.start(h)] / static_cast<double>(border.size());
    }
    const Index middle = this->add(center, VertexKind::Free);
    for (std::size_t i = 0; i < border.size(); ++i)
    {
      const Index h = border[i];
      const Index before = border[(i + border.size() - 1) % border.size()];
      if (this->S.Crease[h])
      {
        this->Draft.Creases.push_back({this->vertex(this->S.start(h)), this->edge(h)});
        this->Draft.Creases.push_back({this->vertex(this->S.end(h)), this->edge(h)});
      }
      this->Draft.Mesh.Quads.push_back(
        {this->vertex(this->S.start(h)), this->edge(h), middle, this->edge(before)});
      this->Draft.Mesh.Region.push_back(this->S.Region[h / 3]);
    }
  }
};

LayoutDraft splitFaces(const TriangleSurface& s, const std::vector<Index>& over)
{
  Splitter split{
    s, over, {}, std::vector<Index>(s.Points.size(), -1), std::vector<Index>(s.Vertex.size(), -1)};
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (s.hole(f))
    {
      continue;
    }
    const Index h = over[f];
    if (h < 0)
    {
      split.face({3 * f, 3 * f + 1, 3 * f + 2});
    }
    else if (h < s.Opposite[h])
    {
      const Index o = s.Opposite[h];
      split.face({TriangleSurface::next(h), TriangleSurface::prev(h), TriangleSurface::next(o),
        TriangleSurface::prev(o)});
    }
  }
  for (auto& c : split.Draft.Creases)
  {
    std::sort(c.begin(), c.end());
  }
  split.Draft.completeCreases();
  return std::move(split.Draft);
}
} // namespace

LayoutDraft pairTriangles(const TriangleSurface& s)
{
  return splitFaces(s, Pairing(s).run());
}

LayoutDraft splitTriangles(const TriangleSurface& s)
{
  return splitFaces(s, std::vector<Index>(s.Region.size(), -1));
}
} // namespace bsr
