#include "Mesh/Geodesic.h"

#include "Mesh/PlaneVector.h"
#include "Mesh/TriangleSurface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace bsr
{
namespace
{
constexpr double Infinite = std::numeric_limits<double>::infinity();

/// Distance at the origin of a circular front with distances a and b at A and B; infinite where
/// the ray does not pass between them.
double circular(const Vec2& A, double a, const Vec2& B, double b)
{
  const Vec2 ab = B - A;
  const double l = ab.norm();
  if (!(l > 0.0) || !std::isfinite(a) || !std::isfinite(b) || std::abs(a - b) > l)
  {
    return Infinite;
  }
  const Vec2 x = ab / l;
  Vec2 y(-x[1], x[0]);
  if (y.dot(-A) < 0.0)
  {
    y = -y; // towards the origin
  }
  const double along = (a * a - b * b + l * l) / (2.0 * l);
  const double height = std::sqrt(std::max(0.0, a * a - along * along));
  const Vec2 source = A + along * x - height * y;
  const double side = -A.dot(y); // of the origin, >= 0
  const double total = side + height;
  if (!(total > 0.0))
  {
    return Infinite;
  }
  const double origin = -A.dot(x);
  const double crossing = along + (origin - along) * height / total;
  return crossing >= 0.0 && crossing <= l ? source.norm() : Infinite;
}
} // namespace

double pathLength(const std::vector<EdgePoint>& path, const std::vector<Vec3>& points)
{
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    length += (path[i].at(points) - path[i - 1].at(points)).norm();
  }
  return length;
}

FastMarching::FastMarching(const TriangleMesh& mesh, const std::vector<Index>& twin)
    : Mesh(mesh), Twin(twin)
{
  const std::size_t n = mesh.Points.size();
  const auto corners = static_cast<Index>(3 * mesh.Triangles.size());
  this->Boundary.assign(n, 0);
  for (Index h = 0; h < corners; ++h)
  {
    if (twin[h] < 0)
    {
      this->Boundary[this->vertex(h)] = this->Boundary[this->vertex(TriangleSurface::next(h))] = 1;
    }
  }
  const auto fill = [&](std::vector<Index>& first, std::vector<Index>& items, const auto& key)
  {
    first.assign(n + 1, 0);
    for (Index c = 0; c < corners; ++c)
    {
      if (key(c) >= 0)
      {
        ++first[key(c) + 1];
      }
    }
    for (std::size_t v = 0; v < n; ++v)
    {
      first[v + 1] += first[v];
    }
    items.resize(static_cast<std::size_t>(first[n]));
    std::vector<Index> at(first.begin(), first.end() - 1);
    for (Index c = 0; c < corners; ++c)
    {
      if (key(c) >= 0)
      {
        items[at[key(c)]++] = c;
      }
    }
  };
  fill(this->First, this->Corner, [&](Index c) { return this->vertex(c); });
  this->Supports.resize(static_cast<std::size_t>(corners));
  for (Index c = 0; c < corners; ++c)
  {
    this->Supports[c] = this->unfold(c, nullptr);
  }
  fill(this->DependFirst, this->DependCorner, [&](Index c) { return this->Supports[c].Vertex; });
}

/// The other two corners of a triangle in its plane, the given corner at the origin.
std::array<Vec2, 2> FastMarching::flatten(Index corner) const
{
  const Vec3 c = this->Mesh.Points[this->vertex(corner)];
  const Vec3 a = this->Mesh.Points[this->vertex(TriangleSurface::next(corner))] - c;
  const Vec3 b = this->Mesh.Points[this->vertex(TriangleSurface::prev(corner))] - c;
  const double la = a.norm();
  if (!(la > 0.0))
  {
    return {Vec2::Zero(), Vec2(b.norm(), 0.0)};
  }
  return {Vec2(la, 0.0), Vec2(a.dot(b) / la, a.cross(b).norm() / la)};
}

/// Unfolds the triangles beyond the side opposite to an obtuse corner until one of their vertices
/// makes acute angles with both sides (Kimmel and Sethian 1998, section 4).
FastMarching::Support FastMarching::unfold(Index corner, std::vector<EdgePoint>* crossed) const
{
  std::vector<std::array<Vec2, 2>> sides;
  const auto [a, b] = this->flatten(corner);
  Support none;
  if (a.dot(b) >= 0.0)
  {
    return none;
  }
  Index h = TriangleSurface::next(corner); // the side from a to b
  Vec2 left = a;
  Vec2 right = b;
  for (int step = 0; step < 16; ++step)
  {
    const Index o = this->Twin[h];
    if (o < 0)
    {
      return none;
    }
    // In the neighbor the side runs from right to left; its third vertex beyond, in its own frame.
    const Vec3& pl = this->Mesh.Points[this->vertex(h)];
    const Vec3& pr = this->Mesh.Points[this->vertex(TriangleSurface::next(h))];
    const Vec3& p = this->Mesh.Points[this->vertex(TriangleSurface::prev(o))];
    const double l = (pr - pl).norm();
    if (!(l > 0.0))
    {
      return none;
    }
    const double x = (p - pl).dot(pr - pl) / l;
    const double y = (p - pl).cross(pr - pl).norm() / l;
    const Vec2 along = (right - left).normalized();
    Vec2 out(-along[1], along[0]);
    out = out.dot(-left) > 0.0 ? Vec2(-out) : out; // away from the corner
    const Vec2 q = left + x * along + y * out;
    if (crossed)
    {
      crossed->push_back({this->vertex(h), this->vertex(TriangleSurface::next(h)), 0.5});
      sides.push_back({left, right});
    }
    // Right angles count: rounding must not decide about them on regular meshes.
    const double tolerance = -1e-9 * q.norm();
    const bool acuteA = q.dot(a) > tolerance * a.norm();
    const bool acuteB = q.dot(b) > tolerance * b.norm();
    if (acuteA && acuteB)
    {
      for (std::size_t i = 0; i < sides.size(); ++i)
      {
        const Vec2 side = sides[i][1] - sides[i][0];
        const double t = planeCross(q, sides[i][0]) / -planeCross(q, side);
        (*crossed)[i].T = std::clamp(std::isfinite(t) ? t : 0.5, 0.0, 1.0);
      }
      return {this->vertex(TriangleSurface::prev(o)), q};
    }
    // o runs right -> left -> q: next(o) is left -> q, prev(o) is q -> right.
    if (acuteA)
    {
      left = q; // q lies towards a: the cone passes between q and right
      h = TriangleSurface::prev(o);
    }
    else
    {
      right = q;
      h = TriangleSurface::next(o);
    }
  }
  return none;
}

double FastMarching::update(Index corner, const std::vector<double>& d,
  const std::vector<std::uint8_t>& done, double slowness) const
{
  const auto [a, b] = this->flatten(corner);
  const Index va = this->vertex(TriangleSurface::next(corner));
  const Index vb = this->vertex(TriangleSurface::prev(corner));
  const double da = done[va] ? d[va] / slowness : Infinite;
  const double db = done[vb] ? d[vb] / slowness : Infinite;
  double best = std::min(da + a.norm(), db + b.norm());
  const Support& s = this->Supports[corner];
  if (s.Vertex < 0)
  {
    best = std::min(best, circular(a, da, b, db));
  }
  else if (done[s.Vertex])
  {
    const double ds = d[s.Vertex] / slowness;
    best = std::min({best, circular(a, da, s.Position, ds), circular(s.Position, ds, b, db),
      ds + s.Position.norm()});
  }
  return best * slowness;
}

std::vector<double> FastMarching::distances(
  const std::vector<Index>& sources, const std::vector<double>& slowness, Index target) const
{
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> d(this->Mesh.Points.size(), Infinite);
  std::vector<std::uint8_t> done(d.size(), 0);
  for (const Index v : sources)
  {
    d[v] = 0.0;
    queue.push({0.0, v});
  }
  const auto improve = [&](Index corner)
  {
    const Index v = this->vertex(corner);
    if (done[v])
    {
      return;
    }
    double s = 1.0;
    if (!slowness.empty())
    {
      s = (slowness[v] + slowness[this->vertex(TriangleSurface::next(corner))] +
            slowness[this->vertex(TriangleSurface::prev(corner))]) /
          3.0;
    }
    const double candidate = this->update(corner, d, done, s);
    if (candidate < d[v])
    {
      d[v] = candidate;
      queue.push({candidate, v});
    }
  };
  while (!queue.empty())
  {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (done[v])
    {
      continue;
    }
    done[v] = 1;
    if (v == target)
    {
      break;
    }
    for (Index i = this->First[v]; i < this->First[v + 1]; ++i)
    {
      improve(TriangleSurface::next(this->Corner[i]));
      improve(TriangleSurface::prev(this->Corner[i]));
    }
    for (Index i = this->DependFirst[v]; i < this->DependFirst[v + 1]; ++i)
    {
      improve(this->DependCorner[i]);
    }
  }
  return d;
}

Vec3 FastMarching::gradient(Index face, const std::vector<double>& d) const
{
  const auto& t = this->Mesh.Triangles[face];
  const Vec3& p = this->Mesh.Points[t[0]];
  const Vec3 a = this->Mesh.Points[t[1]] - p;
  const Vec3 b = this->Mesh.Points[t[2]] - p;
  const double aa = a.squaredNorm();
  const double ab = a.dot(b);
  const double bb = b.squaredNorm();
  const double det = aa * bb - ab * ab;
  if (!(det > 1e-24 * aa * bb))
  {
    return Vec3::Zero();
  }
  const double da = d[t[1]] - d[t[0]];
  const double db = d[t[2]] - d[t[0]];
  const Vec3 g = ((bb * da - ab * db) * a + (aa * db - ab * da) * b) / det;
  return g.allFinite() ? g : Vec3(Vec3::Zero());
}

/// The next point downhill from a vertex; `entered`: the half-edge by which the next face is
/// entered, -1 at a vertex.
EdgePoint FastMarching::leaveVertex(Index v, const std::vector<double>& d, Index& entered) const
{
  EdgePoint best;
  double steepest = 0.0;
  entered = -1;
  const Vec3& p = this->Mesh.Points[v];
  for (Index i = this->First[v]; i < this->First[v + 1]; ++i)
  {
    const Index c = this->Corner[i];
    const Index a = this->vertex(TriangleSurface::next(c));
    const Index b = this->vertex(TriangleSurface::prev(c));
    for (const Index n : {a, b})
    {
      const double slope = (d[v] - d[n]) / (this->Mesh.Points[n] - p).norm();
      if (slope > steepest)
      {
        steepest = slope;
        best = {n, n, 0.0};
        entered = -1;
      }
    }
    if (!std::isfinite(d[a]) || !std::isfinite(d[b]))
    {
      continue;
    }
    const Vec3 down = -this->gradient(c / 3, d);
    const double slope = down.norm();
    // p + s down on the side a b.
    const Vec3 pa = this->Mesh.Points[a] - p;
    const Vec3 pb = this->Mesh.Points[b] - p;
    const Vec3 n = pa.cross(pb);
    const double wa = down.cross(pb).dot(n);
    const double wb = pa.cross(down).dot(n);
    if (slope > steepest * (1.0 + 1e-12) && wa > 0.0 && wb > 0.0)
    {
      steepest = slope;
      best = {a, b, wb / (wa + wb)};
      entered = this->Twin[TriangleSurface::next(c)];
    }
  }
  return best;
}

/// The next point downhill from point p on half-edge h, through the face of h.
EdgePoint FastMarching::crossFace(
  Index h, const EdgePoint& p, const std::vector<double>& d, Index& entered) const
{
  const Index a = this->vertex(h);
  const Index b = this->vertex(TriangleSurface::next(h));
  const Index c = this->vertex(TriangleSurface::prev(h));
  entered = -1;
  if (d[c] == 0.0 && std::isfinite(d[a]) && std::isfinite(d[b]))
  {
    return {c, c, 0.0};
  }
  const Index lower = d[a] < d[b] ? a : b;
  if (!std::isfinite(d[c]))
  {
    return {lower, lower, 0.0};
  }
  const Vec3 x = p.at(this->Mesh.Points);
  const Vec3& pa = this->Mesh.Points[a];
  const Vec3& pb = this->Mesh.Points[b];
  const Vec3& pc = this->Mesh.Points[c];
  const Vec3 normal = (pb - pa).cross(pc - pa);
  const Vec3 down = -this->gradient(h / 3, d);
  if (!(normal.cross(pb - pa).dot(down) > 0.0))
  {
    return {lower, lower, 0.0}; // it runs along the edge
  }
  // Which side of c the ray passes: left of it leaves by c a, right by b c.
  const double turn = down.cross(pc - x).dot(normal);
  const Vec3& from = turn > 0.0 ? pb : pa; // turn > 0: c lies left of the ray, so it leaves by b c
  const Vec3 side = pc - from;
  const double numerator = (x - from).cross(down).dot(normal);
  const double denominator = side.cross(down).dot(normal);
  const double t = denominator != 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 1.0;
  if (t > 1.0 - 1e-9)
  {
    return {c, c, 0.0};
  }
  if (t < 1e-9)
  {
    const Index v = turn > 0.0 ? b : a;
    return {v, v, 0.0};
  }
  entered = this->Twin[turn > 0.0 ? TriangleSurface::next(h) : TriangleSurface::prev(h)];
  return {turn > 0.0 ? b : a, c, t};
}

/// From a vertex that is lower than its neighbors straight on to the one that its distance came
/// from, beyond an obtuse corner.
bool FastMarching::leap(std::vector<EdgePoint>& path, const std::vector<double>& d) const
{
  const Index v = path.back().A;
  Index best = -1;
  double least = Infinite;
  for (Index i = this->First[v]; i < this->First[v + 1]; ++i)
  {
    const Support& s = this->Supports[this->Corner[i]];
    if (s.Vertex >= 0 && d[s.Vertex] < d[v] && d[s.Vertex] + s.Position.norm() < least)
    {
      least = d[s.Vertex] + s.Position.norm();
      best = this->Corner[i];
    }
  }
  if (best < 0)
  {
    return false;
  }
  std::vector<EdgePoint> crossed;
  const Support s = this->unfold(best, &crossed);
  path.insert(path.end(), crossed.begin(), crossed.end());
  path.push_back({s.Vertex, s.Vertex, 0.0});
  return true;
}

std::vector<EdgePoint> FastMarching::descend(const std::vector<double>& d, Index from) const
{
  std::vector<EdgePoint> path;
  if (!std::isfinite(d[from]))
  {
    return path;
  }
  const auto value = [&](const EdgePoint& p)
  { return p.isVertex() ? d[p.A] : (1.0 - p.T) * d[p.A] + p.T * d[p.B]; };
  EdgePoint at{from, from, 0.0};
  Index entered = -1;
  path.push_back(at);
  const std::size_t most = 4 * this->Mesh.Triangles.size() + 16;
  while (value(at) > 0.0 && path.size() < most)
  {
    EdgePoint to;
    Index next = -1;
    if (at.isVertex())
    {
      to = this->leaveVertex(at.A, d, next);
    }
    else if (entered < 0) // a boundary edge: along it
    {
      const Index lower = d[at.A] < d[at.B] ? at.A : at.B;
      to = {lower, lower, 0.0};
    }
    else
    {
      to = this->crossFace(entered, at, d, next);
    }
    if (to.A < 0 || !(value(to) < value(at)))
    {
      // Rounding: the lower end of the edge always is a way on.
      if (at.isVertex())
      {
        if (!this->leap(path, d))
        {
          return {};
        }
        at = path.back();
        continue;
      }
      const Index lower = d[at.A] < d[at.B] ? at.A : at.B;
      to = {lower, lower, 0.0};
      next = -1;
      if (!(value(to) < value(at)))
      {
        return {};
      }
    }
    path.push_back(to);
    at = to;
    entered = next;
  }
  return value(at) > 0.0 ? std::vector<EdgePoint>{} : path;
}
} // namespace bsr
