#include "Mesh/TriangleSurface.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace bsr
{
int TriangleSurface::valence(Index v) const
{
  int n = 0;
  this->around(v, [&](Index) { ++n; });
  return n;
}

int TriangleSurface::creaseDegree(Index v) const
{
  int n = 0;
  this->around(v, [&](Index h) { n += this->Crease[h]; });
  return n;
}

Vec3 TriangleSurface::areaNormal(Index face) const
{
  const auto c = this->corners(face);
  const Vec3& p = this->Points[c[0]];
  return 0.5 * (this->Points[c[1]] - p).cross(this->Points[c[2]] - p);
}

double TriangleSurface::area() const
{
  double sum = 0.0;
  for (Index f = 0; f < this->faces(); ++f)
  {
    if (this->alive(f) && !this->hole(f))
    {
      sum += this->areaNormal(f).norm();
    }
  }
  return sum;
}

Index TriangleSurface::aliveFaces() const
{
  Index n = 0;
  for (Index f = 0; f < this->faces(); ++f)
  {
    n += this->alive(f);
  }
  return n;
}

int TriangleSurface::commonNeighbors(Index a, Index b) const
{
  std::array<Index, 32> near;
  std::size_t n = 0;
  bool all = true;
  this->around(b,
    [&](Index h)
    {
      all = all && n < near.size();
      if (all)
      {
        near[n++] = this->end(h);
      }
    });
  int common = 0;
  this->around(a,
    [&](Index h)
    {
      const Index v = this->end(h);
      if (all)
      {
        common += static_cast<int>(std::count(near.begin(), near.begin() + n, v));
        return;
      }
      this->around(b, [&](Index x) { common += this->end(x) == v; });
    });
  return common;
}

bool TriangleSurface::canCollapse(Index h) const
{
  const Index a = this->start(h);
  const Index b = this->end(h);
  const Index o = this->Opposite[h];
  if (this->Virtual[a] || this->Virtual[b])
  {
    return false;
  }
  const int degree = this->creaseDegree(a);
  if (degree != 0 && (degree != 2 || !this->Crease[h]))
  {
    return false;
  }
  // Two creases that would fall together.
  if ((this->Crease[next(h)] && this->Crease[prev(h)]) ||
      (this->Crease[next(o)] && this->Crease[prev(o)]))
  {
    return false;
  }
  // Link condition: the ends share exactly the two apexes as neighbors.
  if (this->apex(h) == this->apex(o) || this->commonNeighbors(a, b) != 2)
  {
    return false;
  }
  // A tetrahedron satisfies the link condition but has nothing to lose.
  return this->valence(a) > 3 || this->valence(b) > 3;
}

void TriangleSurface::collapse(Index h, const Vec3& position)
{
  const Index a = this->start(h);
  const Index b = this->end(h);
  const Index o = this->Opposite[h];
  std::array<Index, 2> sides = {h, o};
  std::array<Index, 2> apexes = {this->apex(h), this->apex(o)};
  this->around(a, [&](Index ha) { this->Vertex[ha] = b; });
  for (int s = 0; s < 2; ++s)
  {
    const Index x = this->Opposite[next(sides[s])];
    const Index y = this->Opposite[prev(sides[s])];
    const bool crease = this->Crease[x] || this->Crease[y];
    this->Opposite[x] = y;
    this->Opposite[y] = x;
    this->Crease[x] = this->Crease[y] = crease;
    // x or y starts at the apex, the other one at b.
    const Index fromApex = this->Vertex[x] == apexes[s] ? x : y;
    this->Out[apexes[s]] = fromApex;
    this->Out[b] = fromApex == x ? y : x;
  }
  for (Index side : sides)
  {
    const Index f = side / 3;
    this->Vertex[3 * f] = this->Vertex[3 * f + 1] = this->Vertex[3 * f + 2] = -1;
  }
  this->Out[a] = -1;
  this->Points[b] = position;
}

bool TriangleSurface::canFlip(Index h) const
{
  if (this->Crease[h])
  {
    return false;
  }
  const Index o = this->Opposite[h];
  const Index c = this->apex(h);
  const Index d = this->apex(o);
  if (c == d || this->valence(this->start(h)) <= 3 || this->valence(this->end(h)) <= 3)
  {
    return false;
  }
  bool adjacent = false;
  this->around(c, [&](Index x) { adjacent = adjacent || this->end(x) == d; });
  return !adjacent;
}

void TriangleSurface::flip(Index h)
{
  const Index o = this->Opposite[h];
  const Index hn = next(h);
  const Index hp = prev(h);
  const Index on = next(o);
  const Index op = prev(o);
  const Index a = this->Vertex[h];
  const Index b = this->Vertex[o];
  const Index c = this->Vertex[hp];
  const Index d = this->Vertex[op];
  // Outer half-edges: b->c (hn), c->a (hp), a->d (on), d->b (op).
  const std::array<Index, 4> outer = {
    this->Opposite[hn], this->Opposite[hp], this->Opposite[on], this->Opposite[op]};
  const std::array<std::uint8_t, 4> crease = {
    this->Crease[hn], this->Crease[hp], this->Crease[on], this->Crease[op]};
  auto set = [this](Index at, Index v, Index twin, std::uint8_t isCrease)
  {
    this->Vertex[at] = v;
    this->Opposite[at] = twin;
    this->Opposite[twin] = at;
    this->Crease[at] = isCrease;
    this->Out[v] = at;
  };
  // New triangles: (d, c, a) in the place of h's, (c, d, b) in the place of o's.
  set(hn, c, outer[1], crease[1]);
  set(hp, a, outer[2], crease[2]);
  set(on, d, outer[3], crease[3]);
  set(op, b, outer[0], crease[0]);
  set(h, d, o, 0);
  set(o, c, h, 0);
}

Index TriangleSurface::split(Index h, const Vec3& position)
{
  const Index o = this->Opposite[h];
  const Index b = this->end(h);
  const Index c = this->apex(h);
  const Index d = this->apex(o);
  const Index m = this->vertices();
  this->Points.push_back(position);
  this->Out.push_back(-1);
  this->Virtual.push_back(0);
  const Index f = this->faces(); // (m, b, c) beside h
  const Index g = f + 1;         // (b, m, d) beside o
  const auto size = 3 * (static_cast<std::size_t>(g) + 1);
  this->Vertex.resize(size);
  this->Opposite.resize(size);
  this->Crease.resize(size, 0);
  this->Region.push_back(this->Region[h / 3]);
  this->Region.push_back(this->Region[o / 3]);
  auto link = [this](Index x, Index y)
  {
    this->Opposite[x] = y;
    this->Opposite[y] = x;
    this->Crease[x] = this->Crease[y];
  };
  const Index hn = next(h);
  const Index op = prev(o);
  const std::uint8_t crease = this->Crease[h];
  // f: 3f m->b, 3f+1 b->c, 3f+2 c->m; g: 3g b->m, 3g+1 m->d, 3g+2 d->b.
  this->Vertex[3 * f] = m;
  this->Vertex[3 * f + 1] = b;
  this->Vertex[3 * f + 2] = c;
  this->Vertex[3 * g] = b;
  this->Vertex[3 * g + 1] = m;
  this->Vertex[3 * g + 2] = d;
  link(3 * f + 1, this->Opposite[hn]);
  link(3 * g + 2, this->Opposite[op]);
  this->Vertex[hn] = m; // h: a->m, hn: m->c
  this->Vertex[o] = m;  // o: m->a, op: d->m
  this->Crease[hn] = this->Crease[op] = 0;
  link(3 * f + 2, hn);
  link(3 * g + 1, op);
  this->Opposite[3 * f] = 3 * g;
  this->Opposite[3 * g] = 3 * f;
  this->Crease[3 * f] = this->Crease[3 * g] = crease;
  this->Out[m] = hn;
  this->Out[b] = 3 * f + 1;
  this->Out[c] = 3 * f + 2;
  this->Out[d] = 3 * g + 2;
  this->Out[this->Vertex[h]] = h;
  return m;
}

std::vector<Index> TriangleSurface::compact()
{
  std::vector<Index> vertexMap(this->Points.size(), -1);
  std::vector<Index> faceMap(this->Region.size(), -1);
  Index nv = 0;
  Index nf = 0;
  for (Index v = 0; v < this->vertices(); ++v)
  {
    if (this->Out[v] >= 0)
    {
      vertexMap[v] = nv;
      this->Points[nv] = this->Points[v];
      this->Virtual[nv] = this->Virtual[v];
      this->Out[nv++] = this->Out[v];
    }
  }
  for (Index f = 0; f < this->faces(); ++f)
  {
    faceMap[f] = this->alive(f) ? nf++ : -1;
  }
  auto moved = [&](Index h) { return 3 * faceMap[h / 3] + h % 3; };
  for (Index f = 0; f < this->faces(); ++f)
  {
    if (faceMap[f] < 0)
    {
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      const Index to = 3 * faceMap[f] + k;
      this->Vertex[to] = vertexMap[this->Vertex[3 * f + k]];
      this->Opposite[to] = moved(this->Opposite[3 * f + k]);
      this->Crease[to] = this->Crease[3 * f + k];
    }
    this->Region[faceMap[f]] = this->Region[f];
  }
  for (Index v = 0; v < nv; ++v)
  {
    this->Out[v] = moved(this->Out[v]);
  }
  this->Points.resize(nv);
  this->Virtual.resize(nv);
  this->Out.resize(nv);
  this->Region.resize(nf);
  this->Vertex.resize(3 * static_cast<std::size_t>(nf));
  this->Opposite.resize(3 * static_cast<std::size_t>(nf));
  this->Crease.resize(3 * static_cast<std::size_t>(nf));
  return vertexMap;
}

TriangleMesh TriangleSurface::toMesh() const
{
  TriangleMesh mesh;
  std::vector<Index> map(this->Points.size(), -1);
  for (Index v = 0; v < this->vertices(); ++v)
  {
    if (this->Out[v] >= 0 && !this->Virtual[v])
    {
      map[v] = static_cast<Index>(mesh.Points.size());
      mesh.Points.push_back(this->Points[v]);
    }
  }
  for (Index f = 0; f < this->faces(); ++f)
  {
    if (this->alive(f) && !this->hole(f))
    {
      const auto c = this->corners(f);
      mesh.Triangles.push_back({map[c[0]], map[c[1]], map[c[2]]});
      mesh.Region.push_back(this->Region[f]);
    }
  }
  return mesh;
}

int TriangleSurface::eulerCharacteristic() const
{
  // The closed surface has E = 3 F / 2; each hole took away one vertex's open star: a disc.
  int v = 0;
  int holes = 0;
  for (Index i = 0; i < this->vertices(); ++i)
  {
    v += this->Out[i] >= 0;
    holes += this->Out[i] >= 0 && this->Virtual[i];
  }
  return v - this->aliveFaces() / 2 - holes;
}
} // namespace bsr
