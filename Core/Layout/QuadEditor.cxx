#include "Layout/QuadEditor.h"

#include <algorithm>

namespace bsr
{
namespace
{
bool sameCorners(QuadEditor::Quad a, QuadEditor::Quad b)
{
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}
} // namespace

QuadEditor::QuadEditor(const LayoutDraft& draft)
    : Points(draft.Mesh.Points),
      Kind(draft.Kind),
      Quads(draft.Mesh.Quads),
      Region(draft.Mesh.Region),
      Around(draft.Mesh.Points.size()),
      Rim(draft.Mesh.Points.size(), 0),
      Mark(draft.Mesh.Quads.size(), 0),
      Alive(static_cast<int>(draft.Mesh.Quads.size()))
{
  this->Region.resize(this->Quads.size(), 0);
  for (std::size_t q = 0; q < this->Quads.size(); ++q)
  {
    for (Index v : this->Quads[q])
    {
      this->Around[v].push_back(static_cast<Index>(q));
    }
  }
  for (std::size_t q = 0; q < this->Quads.size(); ++q)
  {
    for (int k = 0; k < 4; ++k)
    {
      const Index g = this->neighbor(static_cast<Index>(q), k);
      const Index a = this->Quads[q][k];
      const Index b = this->Quads[q][(k + 1) % 4];
      if (g < 0)
      {
        this->Rim[a] = this->Rim[b] = 1;
      }
      if (g < 0 || this->Region[g] != this->Region[q] ||
          std::binary_search(draft.Creases.begin(), draft.Creases.end(),
            std::array<Index, 2>{std::min(a, b), std::max(a, b)}))
      {
        this->Mark[q] = static_cast<std::uint8_t>(this->Mark[q] | 1U << k);
      }
    }
  }
}

int QuadEditor::corner(Index quad, Index v) const
{
  const Quad& q = this->Quads[quad];
  return static_cast<int>(std::find(q.begin(), q.end(), v) - q.begin());
}

Index QuadEditor::neighbor(Index quad, int k) const
{
  const Index a = this->Quads[quad][k];
  const Index b = this->Quads[quad][(k + 1) % 4];
  for (Index g : this->Around[a])
  {
    if (g == quad)
    {
      continue;
    }
    const int i = this->corner(g, a);
    if (this->Quads[g][(i + 1) % 4] == b || this->Quads[g][(i + 3) % 4] == b)
    {
      return g;
    }
  }
  return -1;
}

bool QuadEditor::creaseEdge(Index a, Index b) const
{
  for (Index g : this->Around[a])
  {
    const int i = this->corner(g, a);
    if ((this->Quads[g][(i + 1) % 4] == b && this->crease(g, i)) ||
        (this->Quads[g][(i + 3) % 4] == b && this->crease(g, (i + 3) % 4)))
    {
      return true;
    }
  }
  return false;
}

double QuadEditor::excess(Index v, int valence) const
{
  const int off = valence - (this->Rim[v] != 0 ? 3 : 4);
  const int tooMany = std::max(0, off - 2);
  return off * off + 3.0 * tooMany * tooMany;
}

double QuadEditor::collapseGain(Index quad, int k) const
{
  const Quad& q = this->Quads[quad];
  const Index a = q[k];
  const Index c = q[(k + 2) % 4];
  const Index keep = this->Kind[c] > this->Kind[a] ? c : a;
  const int merged = this->valence(a) + this->valence(c) - 2;
  double gain = this->excess(keep, merged) - this->excess(a, this->valence(a)) -
                this->excess(c, this->valence(c));
  for (int i : {1, 3})
  {
    const Index b = q[(k + i) % 4];
    gain += this->excess(b, this->valence(b) - 1) - this->excess(b, this->valence(b));
  }
  return gain;
}

double QuadEditor::rotateGain(Index quad, int k, int way) const
{
  const Index other = this->neighbor(quad, k);
  const Index a = this->Quads[quad][k];
  const Index b = this->Quads[quad][(k + 1) % 4];
  const int j = this->corner(other, b);
  const Quad& p = this->Quads[quad];
  const Quad& r = this->Quads[other];
  // Turned forward, the edge joins the corner before a in this quad to the one before b there.
  const Index x = way > 0 ? p[(k + 2) % 4] : p[(k + 3) % 4];
  const Index y = way > 0 ? r[(j + 2) % 4] : r[(j + 3) % 4];
  auto change = [this](Index v, int d)
  { return this->excess(v, this->valence(v) + d) - this->excess(v, this->valence(v)); };
  return change(a, -1) + change(b, -1) + change(x, 1) + change(y, 1);
}

void QuadEditor::begin()
{
  this->QuadJournal.clear();
  this->VertexJournal.clear();
  this->AliveBefore = this->Alive;
}

void QuadEditor::rollback()
{
  for (auto it = this->QuadJournal.rbegin(); it != this->QuadJournal.rend(); ++it)
  {
    this->Quads[it->Id] = it->Corners;
    this->Mark[it->Id] = it->Mark;
  }
  for (auto it = this->VertexJournal.rbegin(); it != this->VertexJournal.rend(); ++it)
  {
    this->Points[it->Id] = it->Point;
    this->Kind[it->Id] = it->Kind;
    this->Rim[it->Id] = it->Rim;
    this->Around[it->Id].swap(it->Around);
  }
  this->Alive = this->AliveBefore;
  this->begin();
}

void QuadEditor::keep(Index quad)
{
  this->QuadJournal.push_back({quad, this->Quads[quad], this->Mark[quad]});
}

void QuadEditor::keepVertex(Index v)
{
  this->VertexJournal.push_back({v, this->Points[v], this->Kind[v], this->Rim[v], this->Around[v]});
}

void QuadEditor::move(Index v, const Vec3& p)
{
  this->keepVertex(v);
  this->Points[v] = p;
}

void QuadEditor::unlink(Index quad, Index v)
{
  auto& list = this->Around[v];
  list.erase(std::remove(list.begin(), list.end(), quad), list.end());
}

void QuadEditor::remove(Index quad)
{
  this->keep(quad);
  for (Index v : this->Quads[quad])
  {
    this->keepVertex(v);
    this->unlink(quad, v);
  }
  this->Quads[quad].fill(-1);
  --this->Alive;
}

/// Makes the edge a crease in all its quads.
void QuadEditor::mark(Index a, Index b)
{
  for (Index g : this->Around[a])
  {
    const int i = this->corner(g, a);
    for (int k : {i, (i + 3) % 4})
    {
      if (this->Quads[g][k == i ? (i + 1) % 4 : k] == b && !this->crease(g, k))
      {
        this->keep(g);
        this->Mark[g] = static_cast<std::uint8_t>(this->Mark[g] | 1U << k);
      }
    }
  }
}

Index QuadEditor::collapse(Index quad, int k)
{
  const Quad q = this->Quads[quad];
  Index a = q[k];
  Index c = q[(k + 2) % 4];
  const std::array<Index, 2> sides = {q[(k + 1) % 4], q[(k + 3) % 4]};
  if (this->Kind[c] > this->Kind[a])
  {
    std::swap(a, c);
  }
  // Two vertices on creases may only fall together where the quad is an ear of the boundary.
  int ears = 0;
  for (Index b : sides)
  {
    ears += this->Rim[b] != 0 && this->Around[b].size() == 1 && this->Kind[b] == VertexKind::Crease;
  }
  if (this->Kind[c] != VertexKind::Free &&
      (ears != 1 || this->Rim[a] == 0 || this->Rim[c] == 0 || this->Kind[c] == VertexKind::Fixed))
  {
    return -1;
  }
  const int most = std::max({this->MostEdges, this->valence(a), this->valence(c)});
  int doublets = 0;
  for (Index b : sides)
  {
    doublets += this->Rim[b] == 0 && this->Around[b].size() == 3;
  }
  if (this->valence(a) + this->valence(c) - 2 - 2 * doublets > most + 1)
  {
    return -1; // hopeless; what is left is found below
  }
  std::array<bool, 2> crease{};
  for (int i = 0; i < 2; ++i)
  {
    crease[i] = this->creaseEdge(a, sides[i]) || this->creaseEdge(c, sides[i]);
  }
  this->remove(quad);
  this->keepVertex(a);
  this->keepVertex(c);
  for (Index g : this->Around[c])
  {
    this->keep(g);
    this->Quads[g][this->corner(g, c)] = a;
    this->Around[a].push_back(g);
  }
  if (this->Kind[a] == VertexKind::Free)
  {
    this->Points[a] = 0.5 * (this->Points[a] + this->Points[c]);
  }
  this->Rim[a] = this->Rim[a] != 0 || this->Rim[c] != 0;
  this->Around[c].clear();
  std::vector<Index> changed = {a};
  for (int i = 0; i < 2; ++i)
  {
    if (this->Around[sides[i]].empty())
    {
      continue; // the tip of an ear
    }
    changed.push_back(sides[i]);
    if (crease[i])
    {
      this->mark(a, sides[i]);
    }
  }
  if (this->Around[a].empty() || !this->closeDoublets(changed))
  {
    return -1;
  }
  for (Index v : changed)
  {
    if (!this->Around[v].empty() && !this->sound(v, most))
    {
      return -1;
    }
  }
  return this->Around[a].empty() ? -1 : a;
}

bool QuadEditor::closeDoublets(std::vector<Index> vertices)
{
  for (int guard = 0; guard < 20; ++guard)
  {
    Index doublet = -1;
    for (Index v : vertices)
    {
      if (this->Around[v].size() == 2 && this->Rim[v] == 0)
      {
        doublet = v;
      }
    }
    if (doublet < 0)
    {
      return true;
    }
    const Index first = this->Around[doublet][0];
    const Quad p = this->Quads[first];
    const Quad r = this->Quads[this->Around[doublet][1]];
    if (this->Kind[doublet] != VertexKind::Free || !this->closeDoublet(doublet))
    {
      return false;
    }
    vertices.insert(vertices.end(), p.begin(), p.end());
    vertices.insert(vertices.end(), r.begin(), r.end());
    for (Index v : this->Quads[first])
    {
      if (!this->sound(v, 100) && !(this->Around[v].size() == 2 && this->Rim[v] == 0))
      {
        return false;
      }
    }
  }
  return false;
}

bool QuadEditor::closeDoublet(Index v)
{
  const Index p = this->Around[v][0];
  const Index r = this->Around[v][1];
  const int i = this->corner(p, v);
  const int j = this->corner(r, v);
  const Quad& a = this->Quads[p];
  const Quad& b = this->Quads[r];
  // p = (v, x, y, z), r = (v, z, w, x) become (x, y, z, w).
  const Index x = a[(i + 1) % 4];
  const Index y = a[(i + 2) % 4];
  const Index z = a[(i + 3) % 4];
  const Index w = b[(j + 2) % 4];
  if (b[(j + 1) % 4] != z || b[(j + 3) % 4] != x || y == w)
  {
    return false;
  }
  const unsigned mark =
    (this->crease(p, (i + 1) % 4) ? 1U : 0U) | (this->crease(p, (i + 2) % 4) ? 2U : 0U) |
    (this->crease(r, (j + 1) % 4) ? 4U : 0U) | (this->crease(r, (j + 2) % 4) ? 8U : 0U);
  this->remove(r);
  this->keep(p);
  this->keepVertex(v);
  this->keepVertex(w);
  this->Around[v].clear();
  this->Around[w].push_back(p);
  this->Quads[p] = {x, y, z, w};
  this->Mark[p] = static_cast<std::uint8_t>(mark);
  return true;
}

bool QuadEditor::rotate(Index quad, int k, int way)
{
  const Index other = this->neighbor(quad, k);
  if (other < 0 || this->crease(quad, k))
  {
    return false;
  }
  const Quad p = this->Quads[quad];
  const int j = this->corner(other, p[(k + 1) % 4]);
  const Quad r = this->Quads[other];
  const Index a = p[k];
  const Index b = p[(k + 1) % 4];
  for (Index v : {a, b})
  {
    if (this->valence(v) <= (this->Rim[v] != 0 ? this->LeastRimEdges : 3))
    {
      return false;
    }
  }
  // The hexagon b, c, d, a, e, f; marks of its sides.
  const std::array<Index, 6> hex = {
    b, p[(k + 2) % 4], p[(k + 3) % 4], a, r[(j + 2) % 4], r[(j + 3) % 4]};
  const std::array<bool, 6> marks = {this->crease(quad, (k + 1) % 4),
    this->crease(quad, (k + 2) % 4), this->crease(quad, (k + 3) % 4),
    this->crease(other, (j + 1) % 4), this->crease(other, (j + 2) % 4),
    this->crease(other, (j + 3) % 4)};
  const int from = way > 0 ? 1 : 2;
  for (int i = 0; i < 6; ++i)
  {
    const int more = i == from || i == from + 3 ? 1 : 0;
    if (i % 3 != 0 && this->valence(hex[i]) + more > this->MostEdges)
    {
      return false;
    }
  }
  this->keep(quad);
  this->keep(other);
  for (Index v : hex)
  {
    this->keepVertex(v);
    this->unlink(quad, v);
    this->unlink(other, v);
  }
  for (int side = 0; side < 2; ++side)
  {
    const Index target = side == 0 ? quad : other;
    unsigned mark = 0;
    for (int i = 0; i < 4; ++i)
    {
      const int at = (from + 3 * side + i) % 6;
      this->Quads[target][i] = hex[at];
      this->Around[hex[at]].push_back(target);
      mark |= i < 3 && marks[at] ? 1U << i : 0U;
    }
    this->Mark[target] = static_cast<std::uint8_t>(mark);
  }
  return std::all_of(hex.begin(), hex.end(), [this](Index v) { return this->sound(v, 100); });
}

bool QuadEditor::sound(Index v, int mostEdges) const
{
  const auto& list = this->Around[v];
  const std::size_t n = list.size();
  if (n == 0 || this->valence(v) > mostEdges || (this->Rim[v] == 0 && n < 3))
  {
    return false;
  }
  std::vector<std::array<Index, 2>> arcs;
  arcs.reserve(n);
  for (Index g : list)
  {
    const int i = this->corner(g, v);
    const Quad& q = this->Quads[g];
    const std::array<Index, 4> sorted = {q[i], q[(i + 1) % 4], q[(i + 2) % 4], q[(i + 3) % 4]};
    if (sorted[1] == v || sorted[2] == v || sorted[3] == v || sorted[1] == sorted[3] ||
        sorted[1] == sorted[2] || sorted[2] == sorted[3])
    {
      return false;
    }
    arcs.push_back({sorted[1], sorted[3]});
  }
  // Every neighbor is entered and left at most once, and the arcs form one chain.
  std::size_t starts = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    bool follows = false;
    for (std::size_t j = 0; j < n; ++j)
    {
      follows = follows || arcs[j][1] == arcs[i][0];
      if (i != j && (arcs[j][0] == arcs[i][0] || arcs[j][1] == arcs[i][1] ||
                      sameCorners(this->Quads[list[i]], this->Quads[list[j]])))
      {
        return false;
      }
    }
    if (!follows)
    {
      ++starts;
      first = i;
    }
  }
  if (starts != (this->Rim[v] != 0 ? 1U : 0U))
  {
    return false;
  }
  std::size_t steps = 1;
  for (std::size_t at = first; steps < n; ++steps)
  {
    std::size_t onward = n;
    for (std::size_t j = 0; j < n; ++j)
    {
      onward = arcs[j][0] == arcs[at][1] && j != first ? j : onward;
    }
    if (onward == n)
    {
      return false;
    }
    at = onward;
  }
  return true;
}

LayoutDraft QuadEditor::draft() const
{
  LayoutDraft out;
  std::vector<Index> number(this->Points.size(), -1);
  for (std::size_t q = 0; q < this->Quads.size(); ++q)
  {
    if (!this->alive(static_cast<Index>(q)))
    {
      continue;
    }
    Quad quad = this->Quads[q];
    for (Index& v : quad)
    {
      if (number[v] < 0)
      {
        number[v] = static_cast<Index>(out.Mesh.Points.size());
        out.Mesh.Points.push_back(this->Points[v]);
        out.Kind.push_back(this->Kind[v]);
      }
      v = number[v];
    }
    for (int k = 0; k < 4; ++k)
    {
      if (this->crease(static_cast<Index>(q), k))
      {
        out.Creases.push_back(
          {std::min(quad[k], quad[(k + 1) % 4]), std::max(quad[k], quad[(k + 1) % 4])});
      }
    }
    out.Mesh.Quads.push_back(quad);
    out.Mesh.Region.push_back(this->Region[q]);
  }
  std::sort(out.Creases.begin(), out.Creases.end());
  out.Creases.erase(std::unique(out.Creases.begin(), out.Creases.end()), out.Creases.end());
  return out;
}

std::vector<Index> QuadEditor::quadsAt(const std::vector<Index>& vertices) const
{
  std::vector<Index> quads;
  for (const Index v : vertices)
  {
    quads.insert(quads.end(), this->Around[v].begin(), this->Around[v].end());
  }
  sortUnique(quads);
  return quads;
}

void QuadEditor::sortUnique(std::vector<Index>& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}
} // namespace bsr
