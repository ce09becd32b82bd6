#pragma once

#include "Common/UnionFind.h"
#include "Mesh/Meshes.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

namespace bsrtest
{
/// Topology of one component of a polygon mesh.
struct ComponentTopology
{
  int Euler = 0;
  int Loops = 0; ///< boundary loops
  int Faces = 0;
  bool operator<(const ComponentTopology& o) const
  {
    return std::tie(this->Euler, this->Loops) < std::tie(o.Euler, o.Loops);
  }
};

/**
 * Topology of triangles or quads, told from the faces alone and with nothing of Core: corners of
 * faces are glued along edges of exactly two faces, so a vertex with several fans counts as
 * several. `Problem` says what keeps the faces from being an oriented 2-manifold, if anything.
 */
template <std::size_t N>
class PolygonTopology
{
public:
  using Faces = std::vector<std::array<bsr::Index, N>>;

  explicit PolygonTopology(const Faces& faces)
      : Corner(static_cast<std::int64_t>(N * faces.size())),
        Body(static_cast<std::int64_t>(faces.size()))
  {
    this->glue(faces);
    this->count(faces);
  }

  std::vector<ComponentTopology> Components;
  int Fans = 0; ///< vertices, those of several fans repeated
  std::string Problem;

private:
  void say(const std::string& text)
  {
    if (this->Problem.empty())
    {
      this->Problem = text;
    }
  }

  void glue(const Faces& faces)
  {
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      for (std::size_t k = 0; k < N; ++k)
      {
        const bsr::Index a = faces[f][k];
        const bsr::Index b = faces[f][(k + 1) % N];
        this->Edges[std::minmax(a, b)].push_back({f, k});
        if (a == b)
        {
          this->say("a face names a vertex twice");
        }
      }
    }
    for (const auto& e : this->Edges)
    {
      const auto& uses = e.second;
      if (uses.size() > 2)
      {
        this->say("an edge has three or more faces");
      }
      if (uses.size() == 2)
      {
        const auto [f, i] = uses[0];
        const auto [g, j] = uses[1];
        const bool against = faces[f][i] != faces[g][j];
        if (!against)
        {
          this->say("two neighbors are oriented differently");
        }
        this->Body.join(static_cast<std::int64_t>(f), static_cast<std::int64_t>(g));
        const std::size_t i1 = (i + 1) % N;
        const std::size_t j1 = (j + 1) % N;
        this->join(f, i, g, against ? j1 : j);
        this->join(f, i1, g, against ? j : j1);
      }
    }
  }

  void join(std::size_t f, std::size_t i, std::size_t g, std::size_t j)
  {
    this->Corner.join(static_cast<std::int64_t>(N * f + i), static_cast<std::int64_t>(N * g + j));
  }

  void count(const Faces& faces)
  {
    std::map<std::int64_t, ComponentTopology> of;
    std::map<bsr::Index, std::set<std::int64_t>> fansOf;
    bsr::UnionFind rim(static_cast<std::int64_t>(N * faces.size()));
    std::set<std::int64_t> onRim;
    for (std::size_t f = 0; f < faces.size(); ++f)
    {
      ComponentTopology& c = of[this->Body.find(static_cast<std::int64_t>(f))];
      ++c.Euler;
      ++c.Faces;
      for (std::size_t k = 0; k < N; ++k)
      {
        const auto corner = static_cast<std::int64_t>(N * f + k);
        c.Euler += this->Corner.find(corner) == corner;
        this->Fans += this->Corner.find(corner) == corner;
        fansOf[faces[f][k]].insert(this->Corner.find(corner));
      }
    }
    for (const auto& e : this->Edges)
    {
      const auto [f, k] = e.second.front();
      of[this->Body.find(static_cast<std::int64_t>(f))].Euler -= 1;
      if (e.second.size() == 1)
      {
        const auto a = this->Corner.find(static_cast<std::int64_t>(N * f + k));
        const auto b = this->Corner.find(static_cast<std::int64_t>(N * f + (k + 1) % N));
        rim.join(a, b);
        onRim.insert(a);
        onRim.insert(b);
      }
    }
    for (const std::int64_t corner : onRim)
    {
      of[this->Body.find(corner / static_cast<std::int64_t>(N))].Loops +=
        rim.find(corner) == corner;
    }
    for (const auto& v : fansOf)
    {
      if (v.second.size() > 1)
      {
        this->say("the faces at a vertex form several fans");
      }
    }
    for (const auto& c : of)
    {
      this->Components.push_back(c.second);
    }
    std::sort(this->Components.begin(), this->Components.end());
  }

  std::map<std::pair<bsr::Index, bsr::Index>, std::vector<std::array<std::size_t, 2>>> Edges;
  bsr::UnionFind Corner;
  bsr::UnionFind Body;
};

/// Euler characteristic / boundary loops of each.
inline std::string text(const std::vector<ComponentTopology>& components)
{
  std::ostringstream out;
  for (const ComponentTopology& c : components)
  {
    out << ' ' << c.Euler << '/' << c.Loops;
  }
  return out.str();
}

/// Why a quad mesh is no layout, or nothing: topology, doublets, vertices of more than eight edges,
/// repeated quads, unused or non-finite points, quads that share two edges.
inline std::string layoutProblem(const bsr::QuadMesh& mesh)
{
  const PolygonTopology<4> topology(mesh.Quads);
  std::string why = topology.Problem;
  std::map<bsr::Index, std::vector<bsr::Index>> quadsAt;
  std::map<std::pair<bsr::Index, bsr::Index>, std::vector<bsr::Index>> quadsOf;
  std::set<std::set<bsr::Index>> corners;
  std::set<bsr::Index> border;
  for (std::size_t q = 0; q < mesh.Quads.size(); ++q)
  {
    const auto& c = mesh.Quads[q];
    corners.insert(std::set<bsr::Index>(c.begin(), c.end()));
    for (int k = 0; k < 4; ++k)
    {
      quadsAt[c[k]].push_back(static_cast<bsr::Index>(q));
      quadsOf[std::minmax(c[k], c[(k + 1) % 4])].push_back(static_cast<bsr::Index>(q));
    }
  }
  if (corners.size() != mesh.Quads.size())
  {
    why = "repeated quads";
  }
  std::set<std::vector<bsr::Index>> pairs;
  for (const auto& e : quadsOf)
  {
    if (e.second.size() == 1)
    {
      border.insert(e.first.first);
      border.insert(e.first.second);
    }
    else if (!pairs.insert(e.second).second)
    {
      why = "two quads share two edges";
    }
  }
  for (const auto& v : quadsAt)
  {
    if (v.second.size() < 3 && border.count(v.first) == 0)
    {
      why = "a doublet";
    }
    if (v.second.size() + border.count(v.first) > 8)
    {
      why = "a vertex of more than eight edges";
    }
  }
  if (quadsAt.size() != mesh.Points.size())
  {
    why = "unused points";
  }
  for (const bsr::Vec3& p : mesh.Points)
  {
    if (!p.allFinite())
    {
      why = "a point is not finite";
    }
  }
  return why;
}

/// Quads that turn over in a corner against the quad's mean normal.
inline int flippedQuads(const bsr::QuadMesh& mesh)
{
  int flipped = 0;
  for (const auto& q : mesh.Quads)
  {
    const bsr::Vec3 normal =
      (mesh.Points[q[2]] - mesh.Points[q[0]]).cross(mesh.Points[q[3]] - mesh.Points[q[1]]);
    bool bad = false;
    for (int k = 0; k < 4; ++k)
    {
      const bsr::Vec3& p = mesh.Points[q[k]];
      const bsr::Vec3 corner =
        (mesh.Points[q[(k + 1) % 4]] - p).cross(mesh.Points[q[(k + 3) % 4]] - p);
      bad = bad || !(corner.dot(normal) > 0.0);
    }
    flipped += bad;
  }
  return flipped;
}
} // namespace bsrtest
