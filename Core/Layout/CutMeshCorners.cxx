// Places of the layout's corners on the cut mesh.
#include "Common/UnionFind.h"
#include "Layout/CutMesh.h"
#include "Mesh/TriangleTree.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>

namespace bsr
{
namespace
{
struct Placement
{
  std::vector<std::size_t> At;
  double Cost = std::numeric_limits<double>::infinity();
};

/// The least sum of squared distances, by dynamic programming; the nearest point of all is fixed.
Placement placeInOrder(const std::vector<Vec3>& wanted, const std::vector<Vec3>& loop)
{
  const std::size_t m = wanted.size();
  const std::size_t n = loop.size();
  Placement p;
  if (n < m)
  {
    return p;
  }
  std::size_t first = 0;
  std::size_t start = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < m; ++i)
  {
    for (std::size_t j = 0; j < n; ++j)
    {
      const double d = (wanted[i] - loop[j]).squaredNorm();
      if (d < nearest)
      {
        nearest = d;
        first = i;
        start = j;
      }
    }
  }
  const auto cost = [&](std::size_t i, std::size_t j)
  { return (wanted[(first + i) % m] - loop[(start + j) % n]).squaredNorm(); };
  // best[i][j]: the first i + 1 points placed, the last at j.
  std::vector<std::vector<double>> best(
    m, std::vector<double>(n, std::numeric_limits<double>::infinity()));
  std::vector<std::vector<std::size_t>> from(m, std::vector<std::size_t>(n, 0));
  best[0][0] = cost(0, 0);
  for (std::size_t i = 1; i < m; ++i)
  {
    std::size_t least = i - 1;
    for (std::size_t j = i; j < n; ++j)
    {
      least = best[i - 1][j - 1] < best[i - 1][least] ? j - 1 : least;
      best[i][j] = best[i - 1][least] + cost(i, j);
      from[i][j] = least;
    }
  }
  const auto end = std::min_element(best[m - 1].begin(), best[m - 1].end());
  p.Cost = *end;
  p.At.resize(m);
  auto j = static_cast<std::size_t>(end - best[m - 1].begin());
  for (std::size_t i = m; i-- > 0; j = from[i][j])
  {
    p.At[(first + i) % m] = (start + j) % n;
  }
  return p;
}
/// The component of each vertex that is on a triangle: a vertex of it.
std::vector<std::int64_t> componentsOf(
  std::size_t vertices, const std::vector<std::array<Index, 3>>& faces)
{
  UnionFind parts(static_cast<std::int64_t>(vertices));
  for (const auto& f : faces)
  {
    parts.join(f[0], f[1]);
    parts.join(f[0], f[2]);
  }
  std::vector<std::int64_t> out(vertices);
  for (std::size_t v = 0; v < vertices; ++v)
  {
    out[v] = parts.find(static_cast<std::int64_t>(v));
  }
  return out;
}

/// The triangles that a component of the layout belongs to: those of the component of the mesh that
/// is nearest to most of its corners, as components may touch.
class NearComponents
{
public:
  NearComponents(
    const QuadMesh& layout, const TriangleSurface& s, std::vector<std::array<Index, 3>> faces)
      : Faces(std::move(faces))
  {
    const auto part = componentsOf(s.Points.size(), this->Faces);
    std::vector<std::array<Index, 3>> halves;
    for (const auto& q : layout.Quads)
    {
      halves.push_back({q[0], q[1], q[2]});
      halves.push_back({q[0], q[2], q[3]});
    }
    this->Part = componentsOf(layout.Points.size(), halves);
    this->All = std::make_unique<TriangleTree>(s.Points, this->Faces);
    const bool one = std::all_of(this->Faces.begin(), this->Faces.end(),
      [&](const auto& f) { return part[f[0]] == part[this->Faces[0][0]]; });
    if (one)
    {
      return;
    }
    std::map<std::int64_t, std::map<std::int64_t, int>> votes;
    for (const auto& q : layout.Quads)
    {
      for (const Index c : q)
      {
        const auto& f = this->Faces[this->All->nearest(layout.Points[c]).Triangle];
        ++votes[this->Part[c]][part[f[0]]];
      }
    }
    for (const auto& [component, counts] : votes)
    {
      const auto most = std::max_element(counts.begin(), counts.end(),
        [](const auto& a, const auto& b) { return a.second < b.second; });
      Own& own = this->Owned[component];
      for (const auto& f : this->Faces)
      {
        if (part[f[0]] == most->first)
        {
          own.Faces.push_back(f);
        }
      }
      own.Tree = std::make_unique<TriangleTree>(s.Points, own.Faces);
    }
  }

  /// The nearest triangle for a corner of the layout.
  std::array<Index, 3> nearest(Index corner, const Vec3& p) const
  {
    const auto own = this->Owned.find(this->Part[corner]);
    return own == this->Owned.end() ? this->Faces[this->All->nearest(p).Triangle]
                                    : own->second.Faces[own->second.Tree->nearest(p).Triangle];
  }

private:
  struct Own
  {
    std::vector<std::array<Index, 3>> Faces;
    std::unique_ptr<TriangleTree> Tree;
  };
  std::vector<std::array<Index, 3>> Faces;
  std::unique_ptr<TriangleTree> All;
  std::vector<std::int64_t> Part;    ///< of the layout's corners
  std::map<std::int64_t, Own> Owned; ///< per component of the layout; empty: the mesh is one
};
} // namespace

/// Gives the corners of a boundary of the layout places in their order on one of the mesh.
bool CutMesh::placeOnBoundary(
  const QuadMesh& layout, const std::vector<Index>& corners, std::vector<std::vector<Index>>& loops)
{
  const TriangleSurface& s = this->Surface;
  std::vector<Index>* best = nullptr;
  Placement placed;
  for (auto& loop : loops)
  {
    std::vector<Vec3> places;
    places.reserve(loop.size());
    for (const Index v : loop)
    {
      places.push_back(s.Points[v]);
    }
    std::vector<Vec3> wanted;
    wanted.reserve(corners.size());
    for (const Index c : corners)
    {
      wanted.push_back(layout.Points[c]);
    }
    Placement p = placeInOrder(wanted, places);
    if (p.Cost < placed.Cost)
    {
      placed = std::move(p);
      best = &loop;
    }
  }
  if (!best)
  {
    return false;
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    this->Corner[corners[i]] = (*best)[placed.At[i]];
    this->Wall[this->Corner[corners[i]]] = 2;
  }
  best->clear();
  return true;
}

/// Corners inside at the nearest vertex that is free, those of boundaries in order along them.
bool CutMesh::placeCorners(const QuadMesh& layout, const LayoutGraph& graph)
{
  const TriangleSurface& s = this->Surface;
  this->Corner.assign(layout.Points.size(), -1);
  auto loops = this->boundaries();
  for (const auto& corners : graph.boundaries())
  {
    if (!this->placeOnBoundary(layout, corners, loops))
    {
      return false;
    }
  }
  std::vector<std::array<Index, 3>> faces;
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (!s.hole(f))
    {
      faces.push_back(s.corners(f));
    }
  }
  const NearComponents components(layout, s, std::move(faces));
  for (std::size_t c = 0; c < layout.Points.size(); ++c)
  {
    if (graph.Spokes[c].empty() || graph.Boundary[c])
    {
      continue;
    }
    const Vec3& p = layout.Points[c];
    Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    const auto offer = [&](Index v)
    {
      const double d = (s.Points[v] - p).squaredNorm();
      if (!s.Virtual[v] && this->Wall[v] == 0 && d < least)
      {
        least = d;
        best = v;
      }
    };
    const auto near = components.nearest(static_cast<Index>(c), p);
    std::for_each(near.begin(), near.end(), offer);
    for (int k = 0; k < 3 && best < 0; ++k)
    {
      s.around(near[k], [&](Index h) { offer(s.end(h)); });
    }
    if (best < 0)
    {
      return false;
    }
    this->Corner[c] = best;
    this->Wall[best] = 2;
  }
  return true;
}
} // namespace bsr
