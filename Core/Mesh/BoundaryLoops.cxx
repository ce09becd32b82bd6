#include "Mesh/BoundaryLoops.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
Index nextOf(Index h)
{
  return h % 3 == 2 ? h - 2 : h + 1;
}

Status checkMesh(const TriangleMesh& mesh)
{
  if (mesh.Triangles.empty())
  {
    return Status::invalidInput(
      "The surface has no triangles; make some from points first (e.g. Delaunay or a surface "
      "reconstruction).");
  }
  const auto n = static_cast<Index>(mesh.Points.size());
  for (const auto& t : mesh.Triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      if (t[k] < 0 || t[k] >= n)
      {
        return Status::invalidInput("A triangle names a point that does not exist.");
      }
      if (t[k] == t[(k + 1) % 3])
      {
        return Status::invalidInput(
          "A triangle names a point twice; remove such triangles first (Clean).");
      }
      if (!mesh.Points[t[k]].allFinite())
      {
        return Status::invalidInput("A point has a NaN or infinite coordinate; remove it first.");
      }
    }
  }
  return Status::ok();
}

/// Follows boundaries from hole edge to hole edge.
class LoopFinder
{
public:
  LoopFinder(const TriangleMesh& mesh, const std::vector<Index>& twin) : Mesh(mesh), Twin(twin) {}

  std::vector<BoundaryLoop> find()
  {
    this->link();
    std::vector<BoundaryLoop> loops;
    std::vector<std::uint8_t> done(this->Twin.size(), 0);
    for (Index h = 0; h < static_cast<Index>(this->Twin.size()); ++h)
    {
      if (this->Twin[h] >= 0 || done[h])
      {
        continue;
      }
      std::vector<Index> round;
      for (Index x = h; !done[x]; x = this->Previous[x])
      {
        done[x] = 1;
        round.push_back(x);
      }
      this->splitSimple(round, loops);
    }
    return loops;
  }

private:
  Index start(Index h) const { return this->Mesh.Triangles[h / 3][h % 3]; }
  Index end(Index h) const { return this->start(nextOf(h)); }

  /// For each boundary half-edge the one that ends where it starts, across the same gap.
  void link()
  {
    const auto n = static_cast<Index>(this->Twin.size());
    std::vector<std::vector<Index>> in(this->Mesh.Points.size());
    std::vector<Index> out;
    for (Index h = 0; h < n; ++h)
    {
      if (this->Twin[h] < 0)
      {
        in[this->end(h)].push_back(h);
        out.push_back(h);
      }
    }
    this->Previous.assign(this->Twin.size(), -1);
    for (const Index h : out)
    {
      auto& candidates = in[this->start(h)];
      auto best = candidates.begin();
      if (candidates.size() > 1)
      {
        const Vec3 normal = this->normalAt(this->start(h), candidates);
        best = std::min_element(candidates.begin(), candidates.end(),
          [&](Index a, Index b) { return this->turn(h, a, normal) < this->turn(h, b, normal); });
      }
      this->Previous[h] = *best;
      candidates.erase(best);
    }
  }

  Vec3 normalAt(Index v, const std::vector<Index>& in) const
  {
    Vec3 n = Vec3::Zero();
    for (const Index h : in)
    {
      const auto& t = this->Mesh.Triangles[h / 3];
      n += (this->Mesh.Points[t[1]] - this->Mesh.Points[t[0]])
             .cross(this->Mesh.Points[t[2]] - this->Mesh.Points[t[0]])
             .normalized();
    }
    return n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3((this->Mesh.Points[v]).unitOrthogonal());
  }

  /// Angle in (0, 2 pi] from the edge back along `in`, counter-clockwise, to the edge of `out`: the
  /// width of the gap between them.
  double turn(Index out, Index in, const Vec3& normal) const
  {
    const Vec3& v = this->Mesh.Points[this->start(out)];
    const Vec3 a = this->Mesh.Points[this->start(in)] - v;
    const Vec3 b = this->Mesh.Points[this->end(out)] - v;
    const double angle =
      std::atan2(normal.dot(a.cross(b)), a.dot(b) - normal.dot(a) * normal.dot(b));
    return angle > 0.0 ? angle : angle + 2.0 * M_PI;
  }

  /// Cuts a round that passes a point twice into rounds that do not.
  void splitSimple(const std::vector<Index>& round, std::vector<BoundaryLoop>& loops) const
  {
    std::vector<Index> path;
    std::vector<Index> points;
    const auto emit = [&](std::size_t from)
    {
      BoundaryLoop loop;
      for (std::size_t i = from; i < path.size(); ++i)
      {
        loop.Points.push_back(points[i]);
        loop.Triangles.push_back(path[i] / 3);
      }
      path.resize(from);
      points.resize(from);
      if (loop.Points.size() > 2)
      {
        loops.push_back(std::move(loop));
      }
    };
    for (const Index h : round)
    {
      const auto seen = std::find(points.begin(), points.end(), this->end(h));
      if (seen != points.end())
      {
        emit(static_cast<std::size_t>(seen - points.begin()));
      }
      path.push_back(h);
      points.push_back(this->end(h));
    }
    emit(0);
  }

  const TriangleMesh& Mesh;
  const std::vector<Index>& Twin;
  std::vector<Index> Previous;
};

void measure(const TriangleMesh& mesh, BoundaryLoop& loop)
{
  const std::size_t n = loop.Points.size();
  const auto at = [&](std::size_t i) -> const Vec3& { return mesh.Points[loop.Points[i % n]]; };
  Vec3 center = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i)
  {
    center += at(i) / static_cast<double>(n);
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  const std::size_t stride = 1 + n / 1000;
  double size = 0.0;
  for (std::size_t i = 0; i < n; ++i)
  {
    spread += (at(i) - center) * (at(i) - center).transpose();
    for (std::size_t j = i % stride; j < n; j += stride)
    {
      size = std::max(size, (at(i) - at(j)).squaredNorm());
    }
  }
  loop.Size = std::sqrt(size);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Vec3 normal = axes.eigenvectors().col(0);
  double off = 0.0;
  double steep = 0.0;
  double length = 0.0;
  for (std::size_t i = 0; i < n; ++i)
  {
    off = std::max(off, std::abs(normal.dot(at(i) - center)));
    const auto& t = mesh.Triangles[loop.Triangles[i]];
    const Vec3 face =
      (mesh.Points[t[1]] - mesh.Points[t[0]]).cross(mesh.Points[t[2]] - mesh.Points[t[0]]);
    const double l = (at(i + 1) - at(i)).norm();
    const double area = face.norm();
    const double c = area > 0.0 ? std::min(1.0, std::abs(normal.dot(face)) / area) : 1.0;
    steep += l * std::acos(c);
    length += l;
  }
  loop.Flatness = loop.Size > 0.0 ? off / loop.Size : 0.0;
  loop.Steepness = length > 0.0 ? steep / length * 180.0 / M_PI : 0.0;
}
} // namespace

Result<std::vector<Index>> halfEdgeTwins(const TriangleMesh& mesh)
{
  if (Status s = checkMesh(mesh); !s)
  {
    return s;
  }
  const auto nh = static_cast<Index>(3 * mesh.Triangles.size());
  const auto start = [&](Index h) { return mesh.Triangles[h / 3][h % 3]; };
  const auto key = [&](Index h)
  {
    const Index a = start(h);
    const Index b = start(nextOf(h));
    return std::make_pair(std::min(a, b), std::max(a, b));
  };
  std::vector<Index> order(nh);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  std::vector<Index> twin(nh, -1);
  for (std::size_t i = 0; i < order.size();)
  {
    std::size_t j = i + 1;
    while (j < order.size() && key(order[j]) == key(order[i]))
    {
      ++j;
    }
    if (j - i > 2)
    {
      return Status::invalidInput("Three or more triangles meet at an edge; remove the surplus "
                                  "triangles first (Feature Edges shows the places).");
    }
    if (j - i == 2)
    {
      if (start(order[i]) == start(order[i + 1]))
      {
        return Status::invalidInput("Neighboring triangles are oriented against each other; run "
                                    "Generate Surface Normals with Consistency first.");
      }
      twin[order[i]] = order[i + 1];
      twin[order[i + 1]] = order[i];
    }
    i = j;
  }
  return twin;
}

Result<std::vector<BoundaryLoop>> boundaryLoops(const TriangleMesh& mesh)
{
  const auto twin = halfEdgeTwins(mesh);
  if (!twin)
  {
    return twin.status();
  }
  auto loops = LoopFinder(mesh, *twin).find();
  for (BoundaryLoop& loop : loops)
  {
    measure(mesh, loop);
  }
  return loops;
}
} // namespace bsr
