#include "Layout/MorseCut.h"

#include <algorithm>
#include <numeric>

namespace bsr
{
MorseCut::MorseCut(const TriangleSurface& s, const MorseGradient& g, PartitionedSurface& out)
    : S(s),
      G(g),
      Out(out),
      Crossed(s.Vertex.size(), 0),
      Walked(s.Vertex.size(), 0),
      Reached(s.Region.size(), 0),
      Middle(s.Vertex.size(), -1),
      Number(s.Points.size(), -1)
{
}

void MorseCut::run()
{
  this->trace();
  for (Index v = 0; v < this->S.vertices(); ++v)
  {
    if (!this->S.Virtual[v])
    {
      this->Number[v] = this->addPoint(this->S.Points[v], this->G.Value[v]);
    }
  }
  for (Index t = 0; t < this->S.faces(); ++t)
  {
    if (!this->S.hole(t))
    {
      this->cut(t);
    }
  }
  this->grow();
}

Index MorseCut::left(Index a, Index b) const
{
  const Index at = this->place(a, b);
  return at < 0 ? -1 : this->Left[at];
}

Index MorseCut::cellAt(Index a, Index b) const
{
  const Index t = this->left(a, b);
  return t < 0 ? -1 : this->Out.Cell[t];
}

Index MorseCut::middle(Index h)
{
  const Index e = std::min(h, this->S.Opposite[h]);
  if (this->Middle[e] < 0)
  {
    const Index a = this->S.start(h);
    const Index b = this->S.end(h);
    this->Middle[e] = this->addPoint(
      0.5 * (this->S.Points[a] + this->S.Points[b]), 0.5 * (this->G.Value[a] + this->G.Value[b]));
  }
  return this->Middle[e];
}

std::vector<std::pair<Index, Index>> MorseCut::extrema() const
{
  std::vector<Index> vertexOf; // points begin with the vertices
  for (Index v = 0; v < this->S.vertices(); ++v)
  {
    if (!this->S.Virtual[v])
    {
      vertexOf.push_back(v);
    }
  }
  std::vector<std::pair<Index, Index>> found(this->Cells, {-1, -1});
  for (std::size_t t = 0; t < this->Origin.size(); ++t)
  {
    auto& of = found[this->Out.Cell[t]];
    if (of.second >= 0)
    {
      continue;
    }
    const Index top = this->G.ascend(this->S, this->Origin[t]);
    for (Index p : this->Out.Mesh.Triangles[t])
    {
      // The maximum itself lies between cells.
      if (p < static_cast<Index>(vertexOf.size()) && vertexOf[p] != this->G.top(this->S, top))
      {
        of = {top, this->G.descend(this->S, vertexOf[p])};
      }
    }
  }
  return found;
}

Index MorseCut::addPoint(const Vec3& p, double value)
{
  this->Out.Mesh.Points.push_back(p);
  this->Out.Eigenfunction.push_back(value);
  this->Out.Critical.push_back(CriticalPoint::Regular);
  return static_cast<Index>(this->Out.Mesh.Points.size()) - 1;
}

void MorseCut::trace()
{
  for (Index h : this->G.Saddles)
  {
    const Index o = this->S.Opposite[h];
    this->walkDown(this->S.start(h));
    this->walkDown(this->S.end(h));
    this->Crossed[h] = this->Crossed[o] = 1;
    this->walkUp(h / 3);
    this->walkUp(o / 3);
  }
  for (Index v = 0; v < this->S.vertices(); ++v)
  {
    if (this->G.Boundary[v] == BoundaryNode::LowerSaddle)
    {
      this->walkDown(v);
    }
    else if (this->G.Boundary[v] == BoundaryNode::UpperSaddle)
    {
      const Index h = this->G.UpperEdge[v];
      this->Crossed[h] = this->Crossed[this->S.Opposite[h]] = 1;
      this->walkUp(h / 3);
    }
  }
}

void MorseCut::walkDown(Index v)
{
  for (Index h = this->G.Down[v]; h >= 0 && !this->Walked[h]; h = this->G.Down[this->S.end(h)])
  {
    this->Walked[h] = this->Walked[this->S.Opposite[h]] = 1;
  }
}

void MorseCut::walkUp(Index t)
{
  Index h = this->G.Up[t];
  for (; h >= 0 && !this->Crossed[h]; h = this->G.Up[t])
  {
    this->Crossed[h] = this->Crossed[this->S.Opposite[h]] = 1;
    t = this->S.Opposite[h] / 3;
  }
  if (h < 0)
  {
    this->Reached[t] = 1;
  }
}

void MorseCut::add(Index a, Index b, Index c)
{
  this->Out.Mesh.Triangles.push_back({a, b, c});
  this->Origin.push_back(this->Current);
}

void MorseCut::cut(Index t)
{
  this->Current = t;
  std::array<Index, 3> edges{};
  std::array<Index, 3> corner{};
  int crossings = 0;
  for (int k = 0; k < 3; ++k)
  {
    edges[k] = 3 * t + k;
    corner[k] = this->Number[this->S.start(edges[k])];
    crossings += this->Crossed[edges[k]];
  }
  for (int k = 0; k < 3; ++k)
  {
    if (this->Walked[edges[k]])
    {
      this->barrier(corner[k], corner[(k + 1) % 3]);
    }
  }
  if (crossings == 0)
  {
    this->add(corner[0], corner[1], corner[2]);
  }
  else if (this->Reached[t])
  {
    this->cutAtMaximum(t);
  }
  else if (crossings == 3)
  {
    this->cutAtMeeting(edges, corner);
  }
  else
  {
    this->cutThrough(edges, corner);
  }
}

void MorseCut::cutThrough(const std::array<Index, 3>& edges, const std::array<Index, 3>& corner)
{
  int k = 0; // the edge that is not crossed
  while (this->Crossed[edges[k]])
  {
    ++k;
  }
  const Index a = corner[k];
  const Index b = corner[(k + 1) % 3];
  const Index c = corner[(k + 2) % 3];
  const Index bc = this->middle(edges[(k + 1) % 3]);
  const Index ca = this->middle(edges[(k + 2) % 3]);
  this->add(c, ca, bc);
  this->add(a, b, bc);
  this->add(a, bc, ca);
  this->barrier(bc, ca);
}

void MorseCut::cutAtMeeting(const std::array<Index, 3>& edges, const std::array<Index, 3>& corner)
{
  Vec3 center = Vec3::Zero();
  double value = 0.0;
  for (Index c : corner)
  {
    center += this->Out.Mesh.Points[c] / 3.0;
    value += this->Out.Eigenfunction[c] / 3.0;
  }
  const Index m = this->addPoint(center, value);
  for (int k = 0; k < 3; ++k)
  {
    const Index e = this->middle(edges[k]);
    this->add(corner[k], e, m);
    this->add(e, corner[(k + 1) % 3], m);
    this->barrier(e, m);
  }
}

void MorseCut::cutAtMaximum(Index t)
{
  const Index top = this->G.top(this->S, t);
  Index h = 3 * t;
  while (this->S.start(h) != top)
  {
    ++h;
  }
  const Index v = this->Number[top];
  const Index a = this->Number[this->S.end(h)];
  const Index b = this->Number[this->S.apex(h)];
  const Index across = TriangleSurface::next(h);
  const Index va = this->Crossed[h] ? this->middle(h) : -1;
  const Index bv =
    this->Crossed[TriangleSurface::prev(h)] ? this->middle(TriangleSurface::prev(h)) : -1;
  for (Index side : {va, bv})
  {
    if (side >= 0)
    {
      this->barrier(side, v);
    }
  }
  if (this->Crossed[across])
  {
    const Index n = this->middle(across);
    this->barrier(n, v);
    va < 0 ? this->add(v, a, n) : (this->add(v, va, n), this->add(va, a, n));
    bv < 0 ? this->add(v, n, b) : (this->add(v, n, bv), this->add(bv, n, b));
  }
  else if (va >= 0 && bv >= 0)
  {
    this->add(v, va, bv);
    this->add(va, a, b);
    this->add(va, b, bv);
  }
  else if (va >= 0)
  {
    this->add(v, va, b);
    this->add(va, a, b);
  }
  else
  {
    this->add(v, a, bv);
    this->add(bv, a, b);
  }
}

void MorseCut::index()
{
  const auto& triangles = this->Out.Mesh.Triangles;
  this->First.assign(this->Out.Mesh.Points.size() + 1, 0);
  for (const auto& t : triangles)
  {
    for (Index v : t)
    {
      ++this->First[v + 1];
    }
  }
  std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
  std::vector<Index> at(this->First.begin(), this->First.end() - 1);
  this->End.resize(3 * triangles.size());
  this->Left.resize(3 * triangles.size());
  this->Fence.assign(3 * triangles.size(), 0);
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index i = at[triangles[t][k]]++;
      this->End[i] = triangles[t][(k + 1) % 3];
      this->Left[i] = static_cast<Index>(t);
    }
  }
  for (const auto& b : this->Barriers)
  {
    for (Index i : {this->place(b.first, b.second), this->place(b.second, b.first)})
    {
      if (i >= 0)
      {
        this->Fence[i] = 1;
      }
    }
  }
}

Index MorseCut::place(Index a, Index b) const
{
  for (Index i = this->First[a]; i < this->First[a + 1]; ++i)
  {
    if (this->End[i] == b)
    {
      return i;
    }
  }
  return -1;
}

void MorseCut::grow()
{
  for (Index h : this->G.Saddles)
  {
    const Index m = this->middle(h);
    this->barrier(m, this->Number[this->S.start(h)]);
    this->barrier(m, this->Number[this->S.end(h)]);
  }
  this->index();
  const auto& triangles = this->Out.Mesh.Triangles;
  this->Out.Cell.assign(triangles.size(), -1);
  std::vector<Index> queue;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed)
  {
    if (this->Out.Cell[seed] >= 0)
    {
      continue;
    }
    this->Out.Cell[seed] = this->Cells;
    queue.assign(1, static_cast<Index>(seed));
    while (!queue.empty())
    {
      const auto& c = triangles[queue.back()];
      queue.pop_back();
      for (int k = 0; k < 3; ++k)
      {
        const Index i = this->place(c[(k + 1) % 3], c[k]);
        const Index other = i < 0 || this->Fence[i] ? -1 : this->Left[i];
        if (other >= 0 && this->Out.Cell[other] < 0)
        {
          this->Out.Cell[other] = this->Cells;
          queue.push_back(other);
        }
      }
    }
    ++this->Cells;
  }
}
} // namespace bsr
