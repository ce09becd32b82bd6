#include "Layout/LayoutDraft.h"

#include "Common/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
struct Edge
{
  Index Low;
  Index High;
  Index Quad;
  bool Forward;
  bool operator<(const Edge& o) const
  {
    return std::tie(this->Low, this->High, this->Quad, this->Forward) <
           std::tie(o.Low, o.High, o.Quad, o.Forward);
  }
};

Index root(std::vector<Index>& parent, Index i)
{
  while (parent[i] != i)
  {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

/// Collects what the checks need and notes the first problem.
class Checker
{
public:
  Checker(const QuadMesh& mesh, LayoutReport& report) : Mesh(mesh), Report(report) {}

  void run()
  {
    this->corners();
    if (this->Report.Problem.empty())
    {
      this->edges();
      this->vertices();
      this->duplicates();
      this->shapes();
    }
    this->Report.Valid = this->Report.Problem.empty();
  }

private:
  void problem(const std::string& text)
  {
    if (this->Report.Problem.empty())
    {
      this->Report.Problem = text;
    }
  }

  void corners()
  {
    if (this->Mesh.Quads.empty())
    {
      this->problem("there are no quads");
    }
    const auto n = static_cast<Index>(this->Mesh.Points.size());
    std::vector<std::uint8_t> used(this->Mesh.Points.size(), 0);
    for (const auto& q : this->Mesh.Quads)
    {
      auto sorted = q;
      std::sort(sorted.begin(), sorted.end());
      if (sorted[0] < 0 || sorted[3] >= n)
      {
        this->problem("a quad names a point that does not exist");
        return;
      }
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      {
        this->problem("a quad names a point twice");
      }
      for (Index v : q)
      {
        used[v] = 1;
      }
    }
    if (std::find(used.begin(), used.end(), 0) != used.end())
    {
      this->problem("a point belongs to no quad");
    }
    for (const Vec3& p : this->Mesh.Points)
    {
      if (!p.allFinite())
      {
        this->problem("a point is not finite");
      }
    }
  }

  void edges()
  {
    std::vector<Edge> all;
    for (std::size_t q = 0; q < this->Mesh.Quads.size(); ++q)
    {
      for (int k = 0; k < 4; ++k)
      {
        const Index a = this->Mesh.Quads[q][k];
        const Index b = this->Mesh.Quads[q][(k + 1) % 4];
        all.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(q), a < b});
      }
    }
    std::sort(all.begin(), all.end());
    this->Report.Valence.assign(this->Mesh.Points.size(), 0);
    this->Boundary.assign(this->Mesh.Points.size(), 0);
    std::vector<Index> quadParent(this->Mesh.Quads.size());
    std::iota(quadParent.begin(), quadParent.end(), 0);
    std::vector<Index> rim(this->Mesh.Points.size());
    std::iota(rim.begin(), rim.end(), 0);
    std::vector<std::pair<Index, Index>> neighbors;
    for (std::size_t i = 0; i < all.size();)
    {
      std::size_t j = i;
      while (j < all.size() && all[j].Low == all[i].Low && all[j].High == all[i].High)
      {
        ++j;
      }
      ++this->Edges;
      ++this->Report.Valence[all[i].Low];
      ++this->Report.Valence[all[i].High];
      if (j - i > 2)
      {
        this->problem("an edge has more than two quads");
      }
      else if (j - i == 1)
      {
        ++this->Boundary[all[i].Low];
        ++this->Boundary[all[i].High];
        rim[root(rim, all[i].Low)] = root(rim, all[i].High);
      }
      else
      {
        if (all[i].Forward == all[i + 1].Forward)
        {
          this->problem("two neighbors are oriented differently");
        }
        quadParent[root(quadParent, all[i].Quad)] = root(quadParent, all[i + 1].Quad);
        neighbors.emplace_back(all[i].Quad, all[i + 1].Quad);
      }
      i = j;
    }
    for (std::size_t q = 0; q < quadParent.size(); ++q)
    {
      this->Report.Components += root(quadParent, static_cast<Index>(q)) == static_cast<Index>(q);
    }
    for (std::size_t v = 0; v < rim.size(); ++v)
    {
      this->Report.BoundaryLoops +=
        this->Boundary[v] > 0 && root(rim, static_cast<Index>(v)) == static_cast<Index>(v);
    }
    for (auto& n : neighbors)
    {
      if (n.first > n.second)
      {
        std::swap(n.first, n.second);
      }
    }
    std::sort(neighbors.begin(), neighbors.end());
    if (std::adjacent_find(neighbors.begin(), neighbors.end()) != neighbors.end())
    {
      this->problem("two quads share two edges");
    }
    this->Report.Euler = static_cast<int>(this->Mesh.Points.size()) - this->Edges +
                         static_cast<int>(this->Mesh.Quads.size());
  }

  void vertices()
  {
    // One fan a vertex: as many quads as edges (closed), or one less (boundary), and connected.
    std::vector<int> quads(this->Mesh.Points.size(), 0);
    std::vector<std::array<Index, 3>> links; // vertex, and the two neighbors a quad joins there
    for (const auto& q : this->Mesh.Quads)
    {
      for (int k = 0; k < 4; ++k)
      {
        ++quads[q[k]];
        links.push_back({q[k], q[(k + 1) % 4], q[(k + 3) % 4]});
      }
    }
    std::sort(links.begin(), links.end());
    for (std::size_t i = 0; i < links.size();)
    {
      const Index v = links[i][0];
      std::vector<std::array<Index, 2>> arcs;
      for (; i < links.size() && links[i][0] == v; ++i)
      {
        arcs.push_back({links[i][1], links[i][2]});
      }
      const int fans = this->fans(arcs);
      const int edges = this->Report.Valence[v];
      if (fans != 1 || (this->Boundary[v] != 0 && this->Boundary[v] != 2))
      {
        this->problem("the quads at a vertex form more than one fan");
      }
      if (this->Boundary[v] == 0 && edges < 3)
      {
        this->problem("a vertex has only two quads");
      }
      this->Report.Irregular += this->Boundary[v] == 0 && edges != 4;
      auto& histogram = this->Report.ByValence;
      histogram[std::min<std::size_t>(edges, histogram.size() - 1)] += this->Boundary[v] == 0;
      this->Report.MaxValence = std::max(this->Report.MaxValence, edges);
    }
  }

  static int fans(const std::vector<std::array<Index, 2>>& arcs)
  {
    std::vector<Index> parent(arcs.size());
    std::iota(parent.begin(), parent.end(), 0);
    auto count = static_cast<int>(arcs.size());
    for (std::size_t i = 0; i < arcs.size(); ++i)
    {
      for (std::size_t j = 0; j < arcs.size(); ++j)
      {
        const Index a = root(parent, static_cast<Index>(i));
        const Index b = root(parent, static_cast<Index>(j));
        if (arcs[i][0] == arcs[j][1] && a != b)
        {
          parent[a] = b;
          --count;
        }
      }
    }
    return count;
  }

  void duplicates()
  {
    auto sorted = this->Mesh.Quads;
    for (auto& q : sorted)
    {
      std::sort(q.begin(), q.end());
    }
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    {
      this->problem("two quads have the same corners");
    }
  }

  void shapes()
  {
    LayoutReport& r = this->Report;
    r.MinJacobian = 1.0;
    for (std::size_t q = 0; q < this->Mesh.Quads.size(); ++q)
    {
      r.Jacobian.push_back(scaledJacobian(this->Mesh, static_cast<Index>(q)));
      r.MinJacobian = std::min(r.MinJacobian, r.Jacobian.back());
      r.MeanJacobian += r.Jacobian.back();
      r.Flipped += r.Jacobian.back() <= 0.0;
      for (int k = 0; k < 4; ++k)
      {
        const auto& c = this->Mesh.Quads[q];
        const Vec3 e = this->Mesh.Points[c[(k + 1) % 4]] - this->Mesh.Points[c[k]];
        const Vec3 f = this->Mesh.Points[c[(k + 3) % 4]] - this->Mesh.Points[c[k]];
        const double angle = std::atan2(e.cross(f).norm(), e.dot(f)) * 180.0 / M_PI;
        r.MeanAngleDeviation += std::abs(angle - 90.0);
        r.MaxAngleDeviation = std::max(r.MaxAngleDeviation, std::abs(angle - 90.0));
      }
    }
    const auto n = static_cast<double>(this->Mesh.Quads.size());
    r.MeanJacobian /= n;
    r.MeanAngleDeviation /= 4.0 * n;
  }

  const QuadMesh& Mesh;
  LayoutReport& Report;
  std::vector<int> Boundary; ///< boundary edges at each point
  int Edges = 0;
};
} // namespace

std::vector<PointFrame> pointFrames(const QuadMesh& mesh)
{
  std::vector<PointFrame> frames(mesh.Points.size());
  for (const auto& q : mesh.Quads)
  {
    for (int k = 0; k < 4; ++k)
    {
      const Vec3& p = mesh.Points[q[k]];
      const Vec3 e = mesh.Points[q[(k + 1) % 4]] - p;
      PointFrame& frame = frames[q[k]];
      frame.Normal += e.cross(mesh.Points[q[(k + 3) % 4]] - p);
      frame.Longest = std::max(frame.Longest, e.norm());
    }
  }
  return frames;
}

void LayoutDraft::project(const ReferenceSurface& reference)
{
  std::vector<Index> triangles;
  this->project(reference, triangles);
}

void LayoutDraft::project(const ReferenceSurface& reference, std::vector<Index>& triangles)
{
  triangles.resize(this->Mesh.Points.size(), -1);
  const std::vector<PointFrame> frames = pointFrames(this->Mesh);
  parallelFor(0, static_cast<std::int64_t>(this->Mesh.Points.size()), 64,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t v = first; v < last; ++v)
      {
        Vec3& p = this->Mesh.Points[v];
        if (this->Kind[v] == VertexKind::Crease)
        {
          p = reference.Creases.nearest(p).Point;
        }
        else if (this->Kind[v] == VertexKind::Free)
        {
          const auto hit =
            reference.Faces.nearestFacing(p, frames[v].Normal, frames[v].Longest, triangles[v]);
          triangles[v] = hit.Triangle;
          p = hit.Point;
        }
      }
    });
}

void LayoutDraft::completeCreases()
{
  std::vector<std::array<Index, 3>> all; // low, high, region
  for (std::size_t q = 0; q < this->Mesh.Quads.size(); ++q)
  {
    const auto& c = this->Mesh.Quads[q];
    for (int k = 0; k < 4; ++k)
    {
      const Index a = c[k];
      const Index b = c[(k + 1) % 4];
      all.push_back({std::min(a, b), std::max(a, b), this->Mesh.Region[q]});
    }
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size();)
  {
    std::size_t j = i;
    while (j < all.size() && all[j][0] == all[i][0] && all[j][1] == all[i][1])
    {
      ++j;
    }
    if (j - i == 1 || all[j - 1][2] != all[i][2])
    {
      this->Creases.push_back({all[i][0], all[i][1]});
    }
    i = j;
  }
  std::sort(this->Creases.begin(), this->Creases.end());
  this->Creases.erase(std::unique(this->Creases.begin(), this->Creases.end()), this->Creases.end());
}

LayoutReport checkLayout(const QuadMesh& mesh)
{
  LayoutReport report;
  Checker(mesh, report).run();
  return report;
}

double scaledJacobian(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const std::array<Vec3, 4> edge = {b - a, c - b, d - c, a - d};
  std::array<double, 4> side;
  std::array<Vec3, 4> cross;
  Vec3 normal = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
  {
    side[k] = edge[k].norm();
    cross[k] = edge[(k + 3) % 4].cross(edge[k]);
    normal += cross[k];
  }
  const double length = normal.norm();
  if (length <= 0.0)
  {
    return -1.0;
  }
  double worst = 1.0;
  for (int k = 0; k < 4; ++k)
  {
    const double scale = side[k] * side[(k + 3) % 4];
    worst = std::min(worst, scale > 0.0 ? cross[k].dot(normal) / (length * scale) : -1.0);
  }
  return worst;
}

double scaledJacobian(const QuadMesh& mesh, Index quad)
{
  const auto& q = mesh.Quads[quad];
  return scaledJacobian(mesh.Points[q[0]], mesh.Points[q[1]], mesh.Points[q[2]], mesh.Points[q[3]]);
}

LayoutDistance layoutDistance(const QuadMesh& mesh, const TriangleSurface& s,
  const ReferenceSurface& reference, const std::vector<Vec3>& samples, Monitor& monitor)
{
  // The quads as a grid of n x n bilinear cells, two triangles each.
  constexpr int n = 4;
  std::vector<Vec3> points;
  std::vector<std::array<Index, 3>> triangles;
  for (const auto& q : mesh.Quads)
  {
    const auto base = static_cast<Index>(points.size());
    for (int j = 0; j <= n; ++j)
    {
      for (int i = 0; i <= n; ++i)
      {
        const double u = static_cast<double>(i) / n;
        const double v = static_cast<double>(j) / n;
        points.emplace_back((1 - v) * ((1 - u) * mesh.Points[q[0]] + u * mesh.Points[q[1]]) +
                            v * ((1 - u) * mesh.Points[q[3]] + u * mesh.Points[q[2]]));
        if (i < n && j < n)
        {
          const Index c = base + j * (n + 1) + i;
          triangles.push_back({c, c + 1, c + n + 2});
          triangles.push_back({c, c + n + 2, c + n + 1});
        }
      }
    }
  }
  std::vector<double> there(points.size(), 0.0);
  parallelForUntilCancelled(0, static_cast<std::int64_t>(points.size()), 256, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t i = first; i < last; ++i)
      {
        there[i] = std::sqrt(reference.Faces.nearest(points[i]).SquaredDistance);
      }
    });
  if (monitor.cancelled())
  {
    return {};
  }
  const TriangleTree tree(std::move(points), std::move(triangles));
  std::vector<double> back(s.Points.size(), 0.0);
  std::vector<double> weight(s.Points.size(), 0.0);
  for (Index f = 0; f < s.faces(); ++f)
  {
    for (Index v : s.corners(f))
    {
      weight[v] += s.hole(f) ? 0.0 : s.areaNormal(f).norm();
    }
  }
  parallelForUntilCancelled(0, s.vertices(), 256, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t v = first; v < last; ++v)
      {
        back[v] = s.Virtual[v] ? 0.0 : std::sqrt(tree.nearest(s.Points[v]).SquaredDistance);
      }
    });
  std::vector<double> more(samples.size(), 0.0);
  parallelForUntilCancelled(0, static_cast<std::int64_t>(samples.size()), 256, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t i = first; i < last; ++i)
      {
        more[i] = tree.nearest(samples[i]).SquaredDistance;
      }
    });
  LayoutDistance d;
  for (double squared : more)
  {
    d.Maximum = std::max(d.Maximum, std::sqrt(squared));
  }
  double total = 0.0;
  for (std::size_t v = 0; v < back.size(); ++v)
  {
    d.Maximum = std::max(d.Maximum, back[v]);
    d.Mean += weight[v] * back[v];
    total += weight[v];
  }
  d.Mean /= std::max(total, 1e-300);
  if (!samples.empty() && !reference.Samples.empty())
  {
    // Points of large triangles tell little of what lies between them.
    d.Mean = 0.0;
    for (const SurfaceSample& sample : reference.Samples)
    {
      const double off = std::sqrt(tree.nearest(sample.Point).SquaredDistance);
      d.Mean += off / static_cast<double>(reference.Samples.size());
      d.Maximum = std::max(d.Maximum, off);
    }
  }
  d.Maximum = std::max(d.Maximum, *std::max_element(there.begin(), there.end()));
  return d;
}
} // namespace bsr
