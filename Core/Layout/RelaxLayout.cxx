#include "Layout/RelaxLayout.h"

#include "Layout/Attraction.h"

#include "Common/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
constexpr double GoodJacobian = 0.35;
constexpr double MendedJacobian = 0.5; ///< points of worse quads look for better places
constexpr double Bending = 0.2;        ///< what a place may gain by being put onto the surface
constexpr double LeastPull = 0.35;     ///< of the surface on the points, where it draws them little
constexpr double MorePull = 10.0; ///< by how far along the surface, relative to the longest edge

class Relaxer
{
public:
  Relaxer(LayoutDraft& draft, const ReferenceSurface& reference)
      : Draft(draft),
        Reference(reference),
        Around(draft.Mesh.Points.size()),
        Triangle(draft.Mesh.Points.size(), -1)
  {
    for (std::size_t q = 0; q < draft.Mesh.Quads.size(); ++q)
    {
      for (int k = 0; k < 4; ++k)
      {
        this->Around[draft.Mesh.Quads[q][k]].push_back({static_cast<Index>(q), k});
      }
    }
  }

  /// One step of every vertex towards the rectangles its quads ask for.
  void relaxOnce(double share, bool guarded, bool attracted, Monitor& monitor)
  {
    const std::vector<Vec3> before = this->Draft.Mesh.Points;
    this->measure();
    std::vector<std::array<Vec3, 4>> asked(this->Draft.Mesh.Quads.size());
    parallelFor(0, static_cast<std::int64_t>(asked.size()), 256,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t q = first; q < last; ++q)
        {
          asked[q] = this->rectangle(static_cast<Index>(q));
        }
      });
    std::vector<Vec3> moved = this->Draft.Mesh.Points;
    if (attracted && !this->Reference.Samples.empty())
    {
      this->attract(moved, monitor);
    }
    parallelFor(0, static_cast<std::int64_t>(moved.size()), 64,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t v = first; v < last; ++v)
        {
          Vec3 sum = Vec3::Zero();
          for (const Corner& c : this->Around[v])
          {
            sum += asked[c.Quad][c.At];
          }
          const Vec3 mean = sum / static_cast<double>(this->Around[v].size());
          moved[v] += share * (mean - this->Draft.Mesh.Points[v]);
        }
      });
    for (std::size_t v = 0; v < moved.size(); ++v)
    {
      if (this->Draft.Kind[v] == VertexKind::Fixed)
      {
        moved[v] = this->Draft.Mesh.Points[v];
      }
    }
    this->Draft.Mesh.Points.swap(moved);
    this->Draft.project(this->Reference, this->Triangle);
    if (guarded)
    {
      this->takeBack(before);
    }
  }

  double worst() const
  {
    double w = 1.0;
    for (std::size_t q = 0; q < this->Draft.Mesh.Quads.size(); ++q)
    {
      w = std::min(w, scaledJacobian(this->Draft.Mesh, static_cast<Index>(q)));
    }
    return w;
  }

  /// Moves the vertices of bad quads to better places; returns the number of moves.
  int mend(Monitor& monitor)
  {
    int moves = 0;
    for (std::size_t v = 0; v < this->Around.size(); ++v)
    {
      const auto i = static_cast<Index>(v);
      if (this->Draft.Kind[v] != VertexKind::Fixed && this->worst(i) < MendedJacobian)
      {
        if (monitor.cancelled())
        {
          break;
        }
        moves += this->search(i);
      }
    }
    return moves;
  }

private:
  struct Corner
  {
    Index Quad;
    int At;
  };

  /// Puts the points of quads that became bad back, until there are none.
  void takeBack(const std::vector<Vec3>& before)
  {
    auto& points = this->Draft.Mesh.Points;
    const auto& quads = this->Draft.Mesh.Quads;
    std::vector<double> was(quads.size());
    for (std::size_t q = 0; q < quads.size(); ++q)
    {
      const auto& c = quads[q];
      was[q] = scaledJacobian(before[c[0]], before[c[1]], before[c[2]], before[c[3]]);
    }
    for (bool any = true; any;)
    {
      any = false;
      for (std::size_t q = 0; q < quads.size(); ++q)
      {
        if (scaledJacobian(this->Draft.Mesh, static_cast<Index>(q)) <
            std::min(was[q], GoodJacobian))
        {
          for (Index v : quads[q])
          {
            any = any || points[v] != before[v];
            points[v] = before[v];
          }
        }
      }
    }
  }

  /// Adds the way to where the surface draws the points: all of it where they slipped off.
  void attract(std::vector<Vec3>& moved, Monitor& monitor)
  {
    const std::vector<Vec3> pull =
      attraction(this->Draft.Mesh, this->Reference.Samples, this->Nearest, monitor);
    const std::vector<PointFrame> frames = pointFrames(this->Draft.Mesh);
    for (std::size_t v = 0; v < moved.size(); ++v)
    {
      const Vec3 n = frames[v].Normal.normalized();
      const double along = (pull[v] - n.dot(pull[v]) * n).norm();
      const double share = LeastPull + MorePull * along / std::max(frames[v].Longest, 1e-300);
      moved[v] += std::min(share, 1.0) * pull[v];
    }
  }

  /// Side of each quad, averaged over those around it.
  void measure()
  {
    const auto& p = this->Draft.Mesh.Points;
    const auto& quads = this->Draft.Mesh.Quads;
    std::vector<double> own(quads.size());
    for (std::size_t q = 0; q < quads.size(); ++q)
    {
      const auto& c = quads[q];
      own[q] = std::sqrt(0.5 * (p[c[2]] - p[c[0]]).cross(p[c[3]] - p[c[1]]).norm());
    }
    this->Side.assign(quads.size(), 0.0);
    for (const auto& around : this->Around)
    {
      double mean = 0.0;
      for (const Corner& c : around)
      {
        mean += own[c.Quad] / static_cast<double>(around.size());
      }
      for (const Corner& c : around)
      {
        this->Side[c.Quad] += 0.25 * mean;
      }
    }
  }

  std::array<Vec3, 4> rectangle(Index quad) const
  {
    const auto& q = this->Draft.Mesh.Quads[quad];
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k)
    {
      p[k] = this->Draft.Mesh.Points[q[k]];
    }
    return nearestRectangle(p, this->Side[quad]);
  }

  double worst(Index v) const
  {
    double w = 1.0;
    for (const Corner& c : this->Around[v])
    {
      w = std::min(w, scaledJacobian(this->Draft.Mesh, c.Quad));
    }
    return w;
  }

  Vec3 onSurface(Index v, const Vec3& p, const PointFrame& frame)
  {
    if (this->Draft.Kind[v] == VertexKind::Crease)
    {
      return this->Reference.Creases.nearest(p).Point;
    }
    const auto hit =
      this->Reference.Faces.nearestFacing(p, frame.Normal, frame.Longest, this->Triangle[v]);
    this->Triangle[v] = hit.Triangle;
    return hit.Point;
  }

  int search(Index v)
  {
    Vec3& p = this->Draft.Mesh.Points[v];
    PointFrame frame;
    for (const Corner& c : this->Around[v])
    {
      const auto& q = this->Draft.Mesh.Quads[c.Quad];
      const Vec3 e = this->Draft.Mesh.Points[q[(c.At + 1) % 4]] - p;
      const Vec3 f = this->Draft.Mesh.Points[q[(c.At + 3) % 4]] - p;
      frame.Normal += e.cross(f);
      frame.Longest = std::max(frame.Longest, e.norm());
    }
    double step = 0.3 * frame.Longest;
    const Vec3 x = frame.Normal.unitOrthogonal();
    const Vec3 y = frame.Normal.normalized().cross(x);
    double best = this->worst(v);
    int moves = 0;
    for (int round = 0; round < 6; ++round)
    {
      Vec3 bestPoint = p;
      const Vec3 from = p;
      for (int k = 0; k < 8; ++k)
      {
        const double angle = k * M_PI / 4.0;
        p = from + step * (std::cos(angle) * x + std::sin(angle) * y);
        double w = this->worst(v);
        if (w > best - Bending || this->Draft.Kind[v] == VertexKind::Crease)
        {
          p = this->onSurface(v, p, frame);
          w = this->worst(v);
        }
        if (w > best + 1e-6)
        {
          best = w;
          bestPoint = p;
        }
      }
      p = bestPoint;
      moves += bestPoint != from;
      step *= bestPoint == from ? 0.5 : 1.0;
    }
    return moves;
  }

  LayoutDraft& Draft;
  const ReferenceSurface& Reference;
  std::vector<std::vector<Corner>> Around;
  std::vector<double> Side;    ///< per quad
  std::vector<Index> Nearest;  ///< quad of each sample
  std::vector<Index> Triangle; ///< of the surface, per point: where it was last
};
} // namespace

std::array<Vec3, 4> nearestRectangle(const std::array<Vec3, 4>& p, double side)
{
  const Vec3 center = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  const Vec3 u = 0.5 * (p[1] + p[2] - p[0] - p[3]);
  const Vec3 v = 0.5 * (p[2] + p[3] - p[0] - p[1]);
  const Vec3 n = u.cross(v).normalized();
  // The square that fits best: u and v turned back by 90 degrees agree on its axis.
  const Vec3 axis = (u - n.cross(v)).normalized();
  const Vec3 other = n.cross(axis);
  if (!axis.allFinite() || !other.allFinite())
  {
    return p;
  }
  const double share = side > 0.0 ? 0.3 : 0.0;
  const double lu = (1.0 - share) * std::abs(axis.dot(u)) + share * side;
  const double lv = (1.0 - share) * std::abs(other.dot(v)) + share * side;
  const Vec3 a = 0.5 * lu * axis;
  const Vec3 b = 0.5 * lv * other;
  return {center - a - b, center + a - b, center + a + b, center - a + b};
}

void relaxPart(LayoutDraft& draft, const ReferenceSurface& reference,
  const std::vector<Index>& points, int iterations)
{
  std::vector<std::uint8_t> moving(draft.Mesh.Points.size(), 0);
  for (Index v : points)
  {
    moving[v] = draft.Kind[v] != VertexKind::Fixed;
  }
  std::vector<Index> quads;
  for (std::size_t q = 0; q < draft.Mesh.Quads.size(); ++q)
  {
    const auto& c = draft.Mesh.Quads[q];
    if (std::any_of(c.begin(), c.end(), [&](Index v) { return moving[v] != 0; }))
    {
      quads.push_back(static_cast<Index>(q));
    }
  }
  auto& p = draft.Mesh.Points;
  for (int i = 0; i < iterations; ++i)
  {
    std::vector<Vec3> sum(p.size(), Vec3::Zero());
    std::vector<double> weight(p.size(), 0.0);
    std::vector<PointFrame> frames(p.size());
    for (Index q : quads)
    {
      const auto& c = draft.Mesh.Quads[q];
      const auto asked = nearestRectangle({p[c[0]], p[c[1]], p[c[2]], p[c[3]]}, -1.0);
      for (int k = 0; k < 4; ++k)
      {
        sum[c[k]] += asked[k];
        weight[c[k]] += 1.0;
        const Vec3 e = p[c[(k + 1) % 4]] - p[c[k]];
        frames[c[k]].Normal += e.cross(p[c[(k + 3) % 4]] - p[c[k]]);
        frames[c[k]].Longest = std::max(frames[c[k]].Longest, e.norm());
      }
    }
    parallelFor(0, static_cast<std::int64_t>(points.size()), 32,
      [&](std::int64_t first, std::int64_t last)
      {
        for (std::int64_t n = first; n < last; ++n)
        {
          const Index v = points[n];
          if (moving[v] != 0 && weight[v] > 0.0)
          {
            const Vec3 to = 0.3 * p[v] + 0.7 * sum[v] / weight[v];
            p[v] = draft.Kind[v] == VertexKind::Crease
                     ? reference.Creases.nearest(to).Point
                     : reference.Faces.nearestFacing(to, frames[v].Normal, frames[v].Longest).Point;
          }
        }
      });
  }
}

Status relaxLayout(LayoutDraft& draft, const ReferenceSurface& reference, int iterations,
  Monitor& monitor, int mending)
{
  const std::vector<Vec3> start = draft.Mesh.Points;
  Relaxer relaxer(draft, reference);
  const double before = relaxer.worst();
  draft.project(reference);
  // A second, guarded run where the free one folds what was not folded.
  for (bool guarded : {false, true})
  {
    if (guarded)
    {
      draft.Mesh.Points = start;
    }
    for (int i = 0; i < iterations; ++i)
    {
      relaxer.relaxOnce(0.7, guarded, i % 2 == 0, monitor);
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      monitor.progress((i + 1.0) / iterations);
    }
    for (int i = 0; i < mending && relaxer.mend(monitor) > 0; ++i)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
    }
    if (before <= 0.0 || relaxer.worst() >= std::min(before, 0.5 * GoodJacobian))
    {
      break;
    }
  }
  return Status::ok();
}
} // namespace bsr
