#include "Spline/QuadComplex.h"

#include <algorithm>
#include <tuple>

namespace bsr
{
namespace
{
constexpr const char* Cure = " Use a layout as QuadRemesh makes it, or repair this one.";

std::string edgeName(Index a, Index b)
{
  return "between points " + std::to_string(a) + " and " + std::to_string(b);
}

struct DirectedEdge
{
  Index Low;
  Index High;
  Index HalfEdge;
  bool operator<(const DirectedEdge& o) const
  {
    return std::tie(this->Low, this->High, this->HalfEdge) < std::tie(o.Low, o.High, o.HalfEdge);
  }
};

Status checkCorners(const std::vector<std::array<Index, 4>>& quads, Index vertices)
{
  for (std::size_t f = 0; f < quads.size(); ++f)
  {
    auto q = quads[f];
    std::sort(q.begin(), q.end());
    if (q[0] < 0 || q[3] >= vertices)
    {
      return Status::invalidInput(
        "Quad " + std::to_string(f) + " refers to a point that does not exist." + Cure);
    }
    if (std::adjacent_find(q.begin(), q.end()) != q.end())
    {
      return Status::invalidInput(
        "Quad " + std::to_string(f) + " has the same point at two corners." + Cure);
    }
  }
  return Status::ok();
}
} // namespace

Result<QuadComplex> QuadComplex::build(std::vector<std::array<Index, 4>> quads, Index vertices)
{
  if (quads.empty())
  {
    return Status::invalidInput("The layout has no quads; give it at least one.");
  }
  if (Status s = checkCorners(quads, vertices); !s)
  {
    return s;
  }
  QuadComplex c;
  c.Quads = std::move(quads);
  if (Status s = c.linkTwins(); !s)
  {
    return s;
  }
  if (Status s = c.buildFans(vertices); !s)
  {
    return s;
  }
  c.listEdges();
  return c;
}

Status QuadComplex::linkTwins()
{
  const Index halfEdges = 4 * this->faces();
  std::vector<DirectedEdge> list;
  list.reserve(halfEdges);
  for (Index h = 0; h < halfEdges; ++h)
  {
    const Index a = this->from(h);
    const Index b = this->to(h);
    list.push_back({std::min(a, b), std::max(a, b), h});
  }
  std::sort(list.begin(), list.end());
  this->Twins.assign(halfEdges, -1);
  for (std::size_t i = 0; i < list.size();)
  {
    std::size_t j = i + 1;
    while (j < list.size() && list[j].Low == list[i].Low && list[j].High == list[i].High)
    {
      ++j;
    }
    const std::string name = edgeName(list[i].Low, list[i].High);
    if (j - i > 2)
    {
      return Status::invalidInput("The layout is not a manifold: " + std::to_string(j - i) +
                                  " quads meet at the edge " + name + "." + Cure);
    }
    if (j - i == 2)
    {
      const Index g = list[i].HalfEdge;
      const Index h = list[i + 1].HalfEdge;
      if (this->from(g) == this->from(h))
      {
        return Status::invalidInput("The quads at the edge " + name +
                                    " are oriented against each other; make the orientation "
                                    "consistent (Surface Normals filter with Consistency).");
      }
      this->Twins[g] = h;
      this->Twins[h] = g;
    }
    i = j;
  }
  return Status::ok();
}

Status QuadComplex::buildFans(Index vertices)
{
  std::vector<Index> start(vertices, -1);
  std::vector<int> count(vertices, 0);
  for (Index h = 0; h < 4 * this->faces(); ++h)
  {
    const Index v = this->from(h);
    ++count[v];
    if (start[v] < 0 || this->Twins[h] < 0)
    {
      start[v] = h;
    }
  }
  this->Fans.assign(vertices, {});
  for (Index v = 0; v < vertices; ++v)
  {
    if (count[v] == 0)
    {
      continue;
    }
    VertexFan& fan = this->Fans[v];
    for (Index h = start[v]; h >= 0;)
    {
      fan.HalfEdges.push_back(h);
      h = this->Twins[h / 4 * 4 + (h + 3) % 4];
      if (h == start[v] || fan.faces() > count[v])
      {
        break;
      }
    }
    fan.Closed = this->Twins[start[v]] >= 0;
    if (fan.faces() != count[v])
    {
      return Status::invalidInput(
        "The layout is not a manifold: several fans of quads touch only at "
        "point " +
        std::to_string(v) + "." + Cure);
    }
    if (fan.Closed && fan.faces() < 3)
    {
      return Status::invalidInput("Only " + std::to_string(fan.faces()) +
                                  " quads surround the inner point " + std::to_string(v) +
                                  " (a doublet); at least 3 are needed." + Cure);
    }
  }
  return Status::ok();
}

void QuadComplex::listEdges()
{
  this->EdgeOf.assign(this->Twins.size(), -1);
  for (Index h = 0; h < static_cast<Index>(this->Twins.size()); ++h)
  {
    const Index t = this->Twins[h];
    if (t >= 0 && t < h)
    {
      this->EdgeOf[h] = this->EdgeOf[t];
      continue;
    }
    this->EdgeOf[h] = this->edges();
    this->Edges.push_back({h, t});
    this->BorderEdges += t < 0 ? 1 : 0;
  }
}

int QuadComplex::eulerCharacteristic() const
{
  const auto used = std::count_if(
    this->Fans.begin(), this->Fans.end(), [](const VertexFan& f) { return f.faces() > 0; });
  return static_cast<int>(used) - this->edges() + this->faces();
}

std::vector<std::vector<Index>> QuadComplex::borderLoops() const
{
  std::vector<std::vector<Index>> loops;
  std::vector<char> done(this->Twins.size(), 0);
  for (Index h = 0; h < static_cast<Index>(this->Twins.size()); ++h)
  {
    if (this->Twins[h] >= 0 || done[h])
    {
      continue;
    }
    loops.emplace_back();
    // A border vertex has one fan; its first half-edge is the next one of the border.
    for (Index g = h; !done[g]; g = this->Fans[this->to(g)].HalfEdges.front())
    {
      done[g] = 1;
      loops.back().push_back(g);
    }
  }
  return loops;
}
} // namespace bsr
