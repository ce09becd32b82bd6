#include "Mesh/Laplacian.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Triangles given by the lengths of their edges alone, flipped until they are Delaunay.
class IntrinsicTriangles
{
public:
  explicit IntrinsicTriangles(const TriangleSurface& s)
      : Vertex(s.Vertex), Opposite(s.Opposite), Length(s.Vertex.size(), 0.0), Hole(s.Region.size())
  {
    double sum = 0.0;
    for (std::size_t h = 0; h < this->Length.size(); ++h)
    {
      const auto i = static_cast<Index>(h);
      this->Length[h] = (s.Points[s.end(i)] - s.Points[s.start(i)]).norm();
      sum += this->Length[h];
    }
    for (std::size_t f = 0; f < this->Hole.size(); ++f)
    {
      this->Hole[f] = s.hole(static_cast<Index>(f));
    }
    this->mollify(1e-5 * sum / static_cast<double>(std::max<std::size_t>(1, this->Length.size())));
  }

  bool hole(Index h) const { return this->Hole[h / 3] != 0; }
  Index start(Index h) const { return this->Vertex[h]; }
  Index end(Index h) const { return this->Vertex[TriangleSurface::next(h)]; }
  Index opposite(Index h) const { return this->Opposite[h]; }
  Index halfEdges() const { return static_cast<Index>(this->Vertex.size()); }

  double area(Index face) const
  {
    std::array<double, 3> l = {
      this->Length[3 * face], this->Length[3 * face + 1], this->Length[3 * face + 2]};
    std::sort(l.begin(), l.end()); // Heron's formula in Kahan's stable order
    const double product = (l[2] + (l[1] + l[0])) * (l[0] - (l[2] - l[1])) *
                           (l[0] + (l[2] - l[1])) * (l[2] + (l[1] - l[0]));
    return 0.25 * std::sqrt(std::max(product, 0.0));
  }

  /// Cotangent of the angle opposite to h.
  double cotangent(Index h) const
  {
    const double a = this->Length[TriangleSurface::next(h)];
    const double b = this->Length[TriangleSurface::prev(h)];
    const double c = this->Length[h];
    return (a * a + b * b - c * c) / std::max(4.0 * this->area(h / 3), 1e-300);
  }

  void makeDelaunay()
  {
    std::vector<Index> stack;
    for (Index h = this->halfEdges(); h-- > 0;)
    {
      stack.push_back(h);
    }
    // Flips end (Bobenko and Springborn); the bound is against rounding alone.
    std::int64_t left = 100 * static_cast<std::int64_t>(stack.size());
    while (!stack.empty() && left-- > 0)
    {
      const Index h = stack.back();
      stack.pop_back();
      const Index o = this->Opposite[h];
      if (this->hole(h) || this->hole(o) || h / 3 == o / 3 ||
          this->cotangent(h) + this->cotangent(o) >= -1e-9)
      {
        continue;
      }
      this->flip(h);
      for (Index x : {h, o})
      {
        stack.push_back(TriangleSurface::next(x));
        stack.push_back(TriangleSurface::prev(x));
      }
    }
  }

private:
  /// Raises all lengths alike until each triangle satisfies its inequality by a margin.
  void mollify(double margin)
  {
    double raise = 0.0;
    for (Index h = 0; h < this->halfEdges(); ++h)
    {
      if (!this->hole(h))
      {
        raise = std::max(raise, this->Length[h] + margin - this->Length[TriangleSurface::next(h)] -
                                  this->Length[TriangleSurface::prev(h)]);
      }
    }
    for (double& l : this->Length)
    {
      l += raise;
    }
  }

  /// The apex over h, in the plane where h runs from 0 to its length on the x axis.
  std::array<double, 2> apex(Index h) const
  {
    const double c = this->Length[h];
    const double toEnd = this->Length[TriangleSurface::next(h)];
    const double toStart = this->Length[TriangleSurface::prev(h)];
    const double x = (toStart * toStart - toEnd * toEnd + c * c) / (2.0 * c);
    return {x, 2.0 * this->area(h / 3) / c};
  }

  void flip(Index h)
  {
    const Index o = this->Opposite[h];
    const Index hn = TriangleSurface::next(h);
    const Index hp = TriangleSurface::prev(h);
    const Index on = TriangleSurface::next(o);
    const Index op = TriangleSurface::prev(o);
    const auto p = this->apex(h);
    const auto q = this->apex(o); // its x axis runs the other way
    const double diagonal = std::hypot(p[0] - (this->Length[h] - q[0]), p[1] + q[1]);
    const Index a = this->Vertex[h];
    const Index b = this->Vertex[o];
    const Index c = this->Vertex[hp];
    const Index d = this->Vertex[op];
    struct Side
    {
      Index Twin;
      double Length;
    };
    const auto side = [this](Index x) { return Side{this->Opposite[x], this->Length[x]}; };
    const std::array<Side, 4> outer = {side(hn), side(hp), side(on), side(op)};
    // Outer edges may be twins of each other: their twins are looked up in the new places.
    const std::array<Index, 4> oldPlace = {hn, hp, on, op};
    const std::array<Index, 4> newPlace = {op, hn, hp, on}; // b-c, c-a, a-d, d-b
    const auto moved = [&](Index x)
    {
      for (int k = 0; k < 4; ++k)
      {
        if (oldPlace[k] == x)
        {
          return newPlace[k];
        }
      }
      return x;
    };
    this->Vertex[h] = d; // (d, c, a) and (c, d, b)
    this->Vertex[hn] = c;
    this->Vertex[hp] = a;
    this->Vertex[o] = c;
    this->Vertex[on] = d;
    this->Vertex[op] = b;
    for (int k = 0; k < 4; ++k)
    {
      const Index twin = moved(outer[k].Twin);
      this->Opposite[newPlace[k]] = twin;
      this->Opposite[twin] = newPlace[k];
      this->Length[newPlace[k]] = outer[k].Length;
    }
    this->Length[h] = this->Length[o] = diagonal;
  }

  std::vector<Index> Vertex;
  std::vector<Index> Opposite;
  std::vector<double> Length;
  std::vector<std::uint8_t> Hole;
};
} // namespace

Laplacian cotangentLaplacian(const TriangleSurface& s)
{
  IntrinsicTriangles t(s);
  t.makeDelaunay();
  Laplacian l;
  l.Row.assign(s.Points.size(), -1);
  Index rows = 0;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    l.Row[v] = s.Virtual[v] ? -1 : rows++;
  }
  l.Mass = Eigen::VectorXd::Zero(rows);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index h = 0; h < t.halfEdges(); ++h)
  {
    if (t.hole(h))
    {
      continue;
    }
    const Index a = l.Row[t.start(h)];
    const Index b = l.Row[t.end(h)];
    l.Mass[a] += t.area(h / 3) / 3.0;
    const double cotangent = 0.5 * t.cotangent(h);
    const double w = t.hole(t.opposite(h)) ? std::max(cotangent, 0.0) : cotangent;
    if (a != b)
    {
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
      entries.emplace_back(a, b, -w);
      entries.emplace_back(b, a, -w);
    }
  }
  l.Mass = l.Mass.cwiseMax(1e-12 * l.Mass.sum() / std::max<Index>(1, rows));
  l.Stiffness.resize(rows, rows);
  l.Stiffness.setFromTriplets(entries.begin(), entries.end());
  return l;
}
} // namespace bsr
