#include "Layout/FitLayout.h"

#include "Common/Parallel.h"
#include "Common/SparseFactors.h"
#include "Layout/LeastQuads.h"
#include "Layout/NearestQuad.h"
#include "Layout/RelaxLayout.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr int Rounds = 4;
constexpr double Stay = 0.1;        ///< weight of staying, relative to that of a point's samples
constexpr double SoundShape = 0.4;  ///< quads better than this may get worse
constexpr double MostOffset = 0.15; ///< from the surface, of the shortest edge
constexpr double MostWeight = 9.0;  ///< more, of a sample that is far off
constexpr int Slides = 5;           ///< between two fits

struct Sample
{
  Vec3 Point;
  Vec3 Normal;
  double Weight; ///< area
};

/// Points of the triangles, each with a share of the area: one, or if `many` four of each.
std::vector<Sample> samplesOf(const TriangleSurface& s, bool many)
{
  std::vector<Sample> samples;
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (s.hole(f))
    {
      continue;
    }
    const Vec3 n = s.areaNormal(f);
    const double area = n.norm();
    if (!(area > 0.0))
    {
      continue;
    }
    const auto c = s.corners(f);
    const Vec3 middle = (s.Points[c[0]] + s.Points[c[1]] + s.Points[c[2]]) / 3.0;
    samples.push_back({middle, n / area, many ? 0.4 * area : area});
    for (int k = 0; k < 3 && many; ++k)
    {
      const Index v = c[k];
      samples.push_back({0.3 * middle + 0.7 * s.Points[v], n / area, 0.2 * area});
    }
  }
  return samples;
}

class Fitter
{
public:
  Fitter(LayoutDraft& draft, const TriangleSurface& s)
      : D(draft),
        Samples(samplesOf(
          s, !crowded(s.eulerCharacteristic(), static_cast<int>(draft.Mesh.Quads.size())))),
        Row(draft.Mesh.Points.size(), -1),
        Offset(draft.Mesh.Points.size(), 0.0)
  {
    for (std::size_t v = 0; v < this->Row.size(); ++v)
    {
      if (draft.Kind[v] == VertexKind::Free)
      {
        this->Row[v] = this->Rows++;
      }
    }
  }

  Status run(Monitor& monitor)
  {
    for (int round = 0; round<Rounds&& this->Rows> 0; ++round)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      monitor.progress(static_cast<double>(round) / Rounds);
      this->normals();
      if (!this->locate(monitor))
      {
        return Status::cancelled();
      }
      Eigen::VectorXd step;
      if (!this->solve(step, monitor))
      {
        if (monitor.cancelled())
        {
          return Status::cancelled();
        }
        break;
      }
      this->apply(step);
      for (int i = 0; i < Slides && round + 1 < Rounds; ++i)
      {
        this->slide();
        if (monitor.cancelled())
        {
          return Status::cancelled();
        }
      }
    }
    return Status::ok();
  }

private:
  /// Normals and shortest edges at the points.
  void normals()
  {
    const auto& p = this->D.Mesh.Points;
    this->Normal.assign(p.size(), Vec3::Zero());
    this->Shortest.assign(p.size(), std::numeric_limits<double>::infinity());
    for (const auto& q : this->D.Mesh.Quads)
    {
      for (int k = 0; k < 4; ++k)
      {
        const Vec3 e = p[q[(k + 1) % 4]] - p[q[k]];
        this->Normal[q[k]] += e.cross(p[q[(k + 3) % 4]] - p[q[k]]);
        for (Index v : {q[k], q[(k + 1) % 4]})
        {
          this->Shortest[v] = std::min(this->Shortest[v], e.norm());
        }
      }
    }
    for (Vec3& n : this->Normal)
    {
      n.normalize();
    }
  }

  /// Moves the points towards even rectangles, across their normals.
  void slide()
  {
    this->normals();
    auto& p = this->D.Mesh.Points;
    const std::vector<Vec3> before = p;
    std::vector<Vec3> sum(p.size(), Vec3::Zero());
    std::vector<double> weight(p.size(), 0.0);
    for (const auto& q : this->D.Mesh.Quads)
    {
      const auto asked = nearestRectangle({p[q[0]], p[q[1]], p[q[2]], p[q[3]]}, -1.0);
      for (int k = 0; k < 4; ++k)
      {
        sum[q[k]] += asked[k];
        weight[q[k]] += 1.0;
      }
    }
    for (std::size_t v = 0; v < p.size(); ++v)
    {
      if (this->Row[v] >= 0)
      {
        const Vec3 step = sum[v] / weight[v] - p[v];
        p[v] += 0.5 * (step - this->Normal[v].dot(step) * this->Normal[v]);
      }
    }
    this->takeBack(before, this->Offset);
  }

  /// False: cancelled.
  bool locate(Monitor& monitor)
  {
    const NearestQuad nearest(this->D.Mesh);
    const bool first = this->Hit.empty();
    this->Hit.resize(this->Samples.size());
    return parallelForUntilCancelled(0, static_cast<std::int64_t>(this->Hit.size()), 512, monitor,
      [&](std::int64_t from, std::int64_t to)
      {
        Index hint = -1;
        for (std::int64_t i = from; i < to; ++i)
        {
          hint = first ? hint : this->Hit[i].Quad;
          this->Hit[i] = nearest.findFacing(this->Samples[i].Point, this->Samples[i].Normal, hint);
          hint = this->Hit[i].Quad;
        }
      });
  }

  /// Shares of the corners in the patch at (u, v).
  static std::array<double, 4> shares(const Vec2& uv)
  {
    const double u = uv[0];
    const double v = uv[1];
    return {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  }

  double residual(std::size_t i) const
  {
    const auto& q = this->D.Mesh.Quads[this->Hit[i].Quad];
    const auto b = shares(this->Hit[i].UV);
    Vec3 on = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
    {
      on += b[k] * this->D.Mesh.Points[q[k]];
    }
    return this->Samples[i].Normal.dot(this->Samples[i].Point - on);
  }

  bool solve(Eigen::VectorXd& step, Monitor& monitor) const
  {
    std::vector<double> off(this->Samples.size(), 0.0);
    double square = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < off.size(); ++i)
    {
      if (this->Hit[i].Quad >= 0)
      {
        off[i] = this->residual(i);
        square += this->Samples[i].Weight * off[i] * off[i];
        total += this->Samples[i].Weight;
      }
    }
    if (!(square > 0.0))
    {
      return false;
    }
    const double rms2 = square / total;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(this->Rows);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(this->Rows);
    for (std::size_t i = 0; i < off.size(); ++i)
    {
      if (i % 8192 == 0 && monitor.cancelled())
      {
        return false;
      }
      if (this->Hit[i].Quad < 0)
      {
        continue;
      }
      const auto& q = this->D.Mesh.Quads[this->Hit[i].Quad];
      const auto b = shares(this->Hit[i].UV);
      const double w =
        this->Samples[i].Weight * (1.0 + std::min(off[i] * off[i] / rms2, MostWeight)) / total;
      std::array<double, 4> a{};
      for (int k = 0; k < 4; ++k)
      {
        a[k] = b[k] * this->Samples[i].Normal.dot(this->Normal[q[k]]);
      }
      for (int k = 0; k < 4; ++k)
      {
        const Index r = this->Row[q[k]];
        for (int l = 0; l < 4 && r >= 0; ++l)
        {
          const Index c = this->Row[q[l]];
          if (c >= 0 && c <= r)
          {
            entries.emplace_back(r, c, w * a[k] * a[l]);
          }
        }
        if (r >= 0)
        {
          right[r] += w * a[k] * off[i];
          diagonal[r] += w * a[k] * a[k];
        }
      }
    }
    const double mean = diagonal.sum() / static_cast<double>(this->Rows);
    for (std::size_t v = 0; v < this->Row.size(); ++v)
    {
      const Index r = this->Row[v];
      if (r >= 0)
      {
        const double stay = Stay * (diagonal[r] + 0.1 * mean) + 1e-300;
        entries.emplace_back(r, r, stay);
        right[r] -= stay * this->Offset[v];
      }
    }
    if (monitor.cancelled())
    {
      return false;
    }
    Eigen::SparseMatrix<double> m(this->Rows, this->Rows);
    m.setFromTriplets(entries.begin(), entries.end());
    if (monitor.cancelled())
    {
      return false;
    }
    SparseFactors<Eigen::SparseMatrix<double>> solver;
    solver.analyzePattern(m);
    if (!solver.factorize(m, monitor))
    {
      return false;
    }
    step = solver.solve(right);
    return step.allFinite();
  }

  void apply(const Eigen::VectorXd& step)
  {
    const std::vector<Vec3> before = this->D.Mesh.Points;
    const std::vector<double> offset = this->Offset;
    auto& p = this->D.Mesh.Points;
    for (std::size_t v = 0; v < p.size(); ++v)
    {
      if (this->Row[v] >= 0)
      {
        const double most = MostOffset * this->Shortest[v];
        const double to = std::clamp(this->Offset[v] + step[this->Row[v]], -most, most);
        p[v] += (to - this->Offset[v]) * this->Normal[v];
        this->Offset[v] = to;
      }
    }
    this->takeBack(before, offset);
  }

  /// Puts the points of quads that became bad back, until there are none.
  void takeBack(const std::vector<Vec3>& before, const std::vector<double>& offset)
  {
    auto& p = this->D.Mesh.Points;
    for (bool any = true; any;)
    {
      any = false;
      for (const auto& q : this->D.Mesh.Quads)
      {
        const double was = scaledJacobian(before[q[0]], before[q[1]], before[q[2]], before[q[3]]);
        if (scaledJacobian(p[q[0]], p[q[1]], p[q[2]], p[q[3]]) < std::min(was, SoundShape))
        {
          for (Index v : q)
          {
            any = any || p[v] != before[v];
            p[v] = before[v];
            this->Offset[v] = offset[v];
          }
        }
      }
    }
  }

  LayoutDraft& D;
  std::vector<Sample> Samples;
  std::vector<QuadHit> Hit;
  std::vector<Index> Row;
  Index Rows = 0;
  std::vector<Vec3> Normal;
  std::vector<double> Shortest;
  std::vector<double> Offset; ///< from the surface, so far
};
} // namespace

Status fitLayout(LayoutDraft& draft, const TriangleSurface& s, Monitor& monitor)
{
  return Fitter(draft, s).run(monitor);
}
} // namespace bsr
