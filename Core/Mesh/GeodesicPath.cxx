// Making a traced path straight: its crossings slide along their edges and pass around vertices.
#include "Mesh/Geodesic.h"

#include "Mesh/PlaneVector.h"
#include "Mesh/TriangleSurface.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
/// One sweep: each point slides along its edge until the path is straight there.
void FastMarching::slide(std::vector<EdgePoint>& path, double margin) const
{
  const auto& points = this->Mesh.Points;
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
  {
    EdgePoint& p = path[i];
    if (p.isVertex())
    {
      continue;
    }
    const Vec3& a = points[p.A];
    const Vec3 edge = points[p.B] - a;
    const double l = edge.norm();
    if (!(l > 0.0))
    {
      continue;
    }
    // Both neighbors in the plane: along the edge, and off it on either side.
    const Vec3 before = path[i - 1].at(points) - a;
    const Vec3 after = path[i + 1].at(points) - a;
    const double xb = before.dot(edge) / l;
    const double xa = after.dot(edge) / l;
    const double yb = before.cross(edge).norm() / l;
    const double ya = after.cross(edge).norm() / l;
    if (yb + ya > 1e-12 * l)
    {
      p.T = std::clamp((xb + (xa - xb) * yb / (yb + ya)) / l, margin, 1.0 - margin);
    }
  }
}

/// Points at the ends of their edges become vertices, if those are inside the surface; what runs to
/// and fro is cut out.
void FastMarching::snap(std::vector<EdgePoint>& path, double margin) const
{
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
  {
    EdgePoint& p = path[i];
    if (!p.isVertex() && (p.T <= margin || p.T >= 1.0 - margin))
    {
      const Index v = p.T <= margin ? p.A : p.B;
      if (!this->Boundary[v])
      {
        p = {v, v, 0.0};
      }
    }
  }
  std::vector<EdgePoint> out;
  for (const EdgePoint& p : path)
  {
    const auto same = std::find_if(out.begin(), out.end(),
      [&](const EdgePoint& q) { return p.isVertex() && q.isVertex() && p.A == q.A; });
    out.erase(same, out.end());
    out.push_back(p);
  }
  path.swap(out);
}

/// The corners around a vertex in counter-clockwise order, from a boundary where there is one.
std::vector<Index> FastMarching::fan(Index v) const
{
  Index c = this->Corner[this->First[v]];
  const Index start = c;
  for (Index x = this->Twin[c]; x >= 0; x = this->Twin[c])
  {
    c = TriangleSurface::next(x); // clockwise
    if (c == start)
    {
      break;
    }
  }
  std::vector<Index> corners;
  const Index first = c;
  do
  {
    corners.push_back(c);
    const Index x = this->Twin[TriangleSurface::prev(c)];
    c = x;
  } while (c >= 0 && c != first);
  return corners;
}

/// Leads the path round a vertex on the side where its angle is below pi, over the edges there.
bool FastMarching::bypass(std::vector<EdgePoint>& path, std::size_t i, double margin) const
{
  const Index v = path[i].A;
  const auto& points = this->Mesh.Points;
  const std::vector<Index> corners = this->fan(v);
  std::vector<double> angle(1, 0.0);
  for (const Index c : corners)
  {
    const Vec3 a = points[this->vertex(TriangleSurface::next(c))] - points[v];
    const Vec3 b = points[this->vertex(TriangleSurface::prev(c))] - points[v];
    angle.push_back(angle.back() + std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  const std::size_t n = corners.size();
  // Direction of a neighboring path point in the fan; -1: it is not there.
  const auto direction = [&](const EdgePoint& p)
  {
    for (std::size_t k = 0; k < n; ++k)
    {
      const Index a = this->vertex(TriangleSurface::next(corners[k]));
      const Index b = this->vertex(TriangleSurface::prev(corners[k]));
      const bool onA = (p.A == a && (p.B == a || p.B == v)) || (p.A == v && p.B == a);
      const bool onB = (p.A == b && (p.B == b || p.B == v)) || (p.A == v && p.B == b);
      if (onA || onB)
      {
        return angle[onA ? k : k + 1];
      }
      if ((p.A == a && p.B == b) || (p.A == b && p.B == a))
      {
        const Vec3 x = p.at(points) - points[v];
        const Vec3 e = points[a] - points[v];
        return angle[k] + std::atan2(e.cross(x).norm(), e.dot(x));
      }
    }
    return -1.0;
  };
  const double from = direction(path[i - 1]);
  const double to = direction(path[i + 1]);
  if (from < 0.0 || to < 0.0)
  {
    return false;
  }
  const bool closed = !this->Boundary[v];
  const double whole = angle.back();
  double left = to - from; // counter-clockwise from the one to the other
  double right = -left;
  left += left < 0.0 ? (closed ? whole : 100.0) : 0.0;
  right += right < 0.0 ? (closed ? whole : 100.0) : 0.0;
  const bool ccw = left <= right;
  const double turn = std::min(left, right);
  if (turn > M_PI - 1e-4)
  {
    return false;
  }
  std::vector<std::pair<double, Index>> spokes;
  const std::size_t count = closed ? n : n + 1;
  for (std::size_t k = 0; k < count; ++k)
  {
    double at = ccw ? angle[k] - from : from - angle[k];
    at += at < 0.0 && closed ? whole : 0.0;
    if (at > 1e-9 && at < turn - 1e-9)
    {
      const Index end = k < n ? this->vertex(TriangleSurface::next(corners[k]))
                              : this->vertex(TriangleSurface::prev(corners[k - 1]));
      spokes.emplace_back(at, end);
    }
  }
  std::sort(spokes.begin(), spokes.end());
  std::vector<EdgePoint> around;
  around.reserve(spokes.size());
  for (const auto& [at, end] : spokes)
  {
    around.push_back({v, end, std::max(0.05, 2.0 * margin)});
  }
  path.erase(path.begin() + static_cast<std::ptrdiff_t>(i));
  path.insert(path.begin() + static_cast<std::ptrdiff_t>(i), around.begin(), around.end());
  return true;
}

void FastMarching::straighten(std::vector<EdgePoint>& path, int rounds, double margin) const
{
  for (int round = 0; round < rounds; ++round)
  {
    for (int sweep = 0; sweep < 12; ++sweep)
    {
      this->slide(path, margin);
    }
    this->snap(path, std::max(margin, 1e-6));
    bool changed = false;
    for (std::size_t i = 1; i + 1 < path.size(); ++i)
    {
      if (path[i].isVertex() && this->bypass(path, i, margin))
      {
        changed = true;
      }
    }
    if (!changed)
    {
      break;
    }
  }
}
} // namespace bsr
