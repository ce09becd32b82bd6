#include "Layout/FitMoves.h"

#include "Layout/NearestQuad.h"
#include "Layout/QuadEditor.h"
#include "Layout/RelaxLayout.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr int SamplesPerQuad = 48;
constexpr int LeastSamples = 8;    ///< of a patch that is fitted
constexpr double Ridge = 1e-3;     ///< towards the bilinear quad, of the mean diagonal
constexpr double Skewed = 4.0;     ///< more weighs the residual of a quad of scaled Jacobian 0
constexpr double Gain = 0.02;      ///< share of the residual that a step must save
constexpr double SoundShape = 0.4; ///< scaled Jacobian down to which quads may get worse
constexpr std::array<double, 4> Steps = {0.3, 0.3, 0.15, 0.15}; ///< of an edge, of each sweep

std::array<double, 4> bernstein(double t)
{
  const double s = 1.0 - t;
  return {s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t};
}

struct Place
{
  Index Sample;
  Vec2 UV;
};

/// Sum of squared distances, along their normals, of samples to the bicubic patch that fits them.
double patchResidual(const std::array<Vec3, 4>& corner, const std::vector<SurfaceSample>& samples,
  const std::vector<Place>& places)
{
  using Matrix = Eigen::Matrix<double, 16, 16>;
  Matrix normal = Matrix::Zero();
  Eigen::Matrix<double, 16, 3> right = Eigen::Matrix<double, 16, 3>::Zero();
  const auto basis = [](const Vec2& uv)
  {
    const auto u = bernstein(uv[0]);
    const auto v = bernstein(uv[1]);
    Eigen::Matrix<double, 16, 1> b;
    for (int k = 0; k < 16; ++k)
    {
      b[k] = u[k % 4] * v[k / 4];
    }
    return b;
  };
  const auto off = [&](const Place& p)
  {
    const double u = p.UV[0];
    const double v = p.UV[1];
    return Vec3(samples[p.Sample].Point - (1 - v) * ((1 - u) * corner[0] + u * corner[1]) -
                v * ((1 - u) * corner[3] + u * corner[2]));
  };
  const bool fitted = places.size() >= LeastSamples;
  for (const Place& p : places)
  {
    const auto b = basis(p.UV);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(b);
    right += b * off(p).transpose();
  }
  normal.diagonal().array() += Ridge * normal.trace() / 16.0 + 1e-300;
  Eigen::Matrix<double, 16, 3> control = Eigen::Matrix<double, 16, 3>::Zero();
  if (fitted)
  {
    control = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
  }
  double sum = 0.0;
  for (const Place& p : places)
  {
    const Vec3 left = off(p) - control.transpose() * basis(p.UV);
    const double d = samples[p.Sample].Normal.dot(left);
    sum += d * d;
  }
  return sum;
}

class Mover
{
public:
  Mover(const LayoutDraft& draft, const TriangleSurface& s, const ReferenceSurface& reference)
      : E(draft),
        Reference(reference),
        Samples(surfaceSamples(s, SamplesPerQuad * static_cast<int>(draft.Mesh.Quads.size()))),
        Held(draft.Mesh.Quads.size()),
        Residual(draft.Mesh.Quads.size(), 0.0)
  {
  }

  Status run(Monitor& monitor, FitMovesReport& report)
  {
    std::vector<Index> all(this->E.Quads.size());
    for (std::size_t q = 0; q < all.size(); ++q)
    {
      all[q] = static_cast<Index>(q);
    }
    std::vector<Index> everything(this->Samples.size());
    for (std::size_t i = 0; i < everything.size(); ++i)
    {
      everything[i] = static_cast<Index>(i);
    }
    this->take(this->look(all, everything));
    report.Before = this->rms();
    const auto vertices = static_cast<Index>(this->E.Points.size());
    for (std::size_t sweep = 0; sweep < Steps.size(); ++sweep)
    {
      bool any = false;
      for (Index v = 0; v < vertices; ++v)
      {
        if (monitor.cancelled())
        {
          return Status::cancelled();
        }
        const double done = static_cast<double>(v) / vertices;
        monitor.progress((static_cast<double>(sweep) + done) / Steps.size());
        const bool irregular = this->E.Rim[v] == 0 && this->E.valence(v) != 4;
        if (irregular && this->turn(v))
        {
          ++report.Turned;
          any = true;
        }
        if (this->shift(v, Steps[sweep], irregular))
        {
          ++report.Moved;
          any = true;
        }
      }
      if (!any && sweep % 2 == 1)
      {
        break;
      }
    }
    report.After = this->rms();
    return Status::ok();
  }

  LayoutDraft draft() const { return this->E.draft(); }

private:
  /// Where the samples of some quads are, and the quads' residuals.
  struct View
  {
    std::vector<Index> Quads;
    std::vector<std::vector<Place>> Held;
    std::vector<double> Residual;
    double Sum = 0.0;
  };

  double rms() const
  {
    double sum = 0.0;
    for (double r : this->Residual)
    {
      sum += r;
    }
    return std::sqrt(sum / std::max<double>(1.0, static_cast<double>(this->Samples.size())));
  }

  std::array<Vec3, 4> corners(Index q) const
  {
    const auto& c = this->E.Quads[q];
    const auto& p = this->E.Points;
    return {p[c[0]], p[c[1]], p[c[2]], p[c[3]]};
  }

  View look(const std::vector<Index>& quads, const std::vector<Index>& samples) const
  {
    View view;
    view.Quads = quads;
    view.Held.resize(quads.size());
    QuadMesh mesh;
    for (Index q : quads)
    {
      const auto first = static_cast<Index>(mesh.Points.size());
      const auto p = this->corners(q);
      mesh.Points.insert(mesh.Points.end(), p.begin(), p.end());
      mesh.Quads.push_back({first, first + 1, first + 2, first + 3});
    }
    const NearestQuad nearest(mesh);
    Index hint = -1;
    for (Index i : samples)
    {
      QuadHit hit = nearest.findFacing(this->Samples[i].Point, this->Samples[i].Normal, hint);
      hit = hit.Quad < 0 ? nearest.find(this->Samples[i].Point, hint) : hit;
      view.Held[hit.Quad].push_back({i, hit.UV});
      hint = hit.Quad;
    }
    for (std::size_t q = 0; q < quads.size(); ++q)
    {
      view.Residual.push_back(patchResidual(this->corners(quads[q]), this->Samples, view.Held[q]));
      view.Residual.back() *= 1.0 + Skewed * (1.0 - this->shape(quads[q]));
      view.Sum += view.Residual.back();
    }
    return view;
  }

  void take(const View& view)
  {
    for (std::size_t i = 0; i < view.Quads.size(); ++i)
    {
      this->Held[view.Quads[i]] = view.Held[i];
      this->Residual[view.Quads[i]] = view.Residual[i];
    }
  }

  std::vector<Index> ring(Index v) const
  {
    std::vector<Index> around;
    for (Index q : this->E.Around[v])
    {
      const int k = this->E.corner(q, v);
      for (int i = 1; i < 4; ++i)
      {
        around.push_back(this->E.Quads[q][(k + i) % 4]);
      }
    }
    QuadEditor::sortUnique(around);
    return around;
  }

  PointFrame frame(Index v) const
  {
    PointFrame frame;
    const auto& p = this->E.Points;
    for (Index q : this->E.Around[v])
    {
      const auto& c = this->E.Quads[q];
      const int k = this->E.corner(q, v);
      const Vec3 e = p[c[(k + 1) % 4]] - p[v];
      frame.Normal += e.cross(p[c[(k + 3) % 4]] - p[v]);
      frame.Longest = std::max(frame.Longest, e.norm());
    }
    return frame;
  }

  Vec3 onSurface(Index v, const Vec3& p) const
  {
    const PointFrame f = this->frame(v);
    return this->Reference.Faces.nearestFacing(p, f.Normal, f.Longest).Point;
  }

  /// Towards the rectangles that the quads around ask for.
  void follow(Index v)
  {
    if (this->E.Kind[v] != VertexKind::Free)
    {
      return;
    }
    Vec3 sum = Vec3::Zero();
    for (Index q : this->E.Around[v])
    {
      sum += nearestRectangle(this->corners(q), -1.0)[this->E.corner(q, v)];
    }
    const Vec3 mean = sum / static_cast<double>(this->E.Around[v].size());
    this->E.move(v, this->onSurface(v, 0.5 * (this->E.Points[v] + mean)));
  }

  double shape(Index q) const
  {
    const auto p = this->corners(q);
    return scaledJacobian(p[0], p[1], p[2], p[3]);
  }

  /// What quads and samples a step will touch, and how they are before it.
  struct Before
  {
    std::vector<Index> Quads;
    std::vector<Index> Samples;
    double Sum = 0.0;
    double Shape = 1.0;
  };

  Before before(const std::vector<Index>& vertices) const
  {
    Before b;
    b.Quads = this->E.quadsAt(vertices);
    for (Index q : b.Quads)
    {
      for (const Place& p : this->Held[q])
      {
        b.Samples.push_back(p.Sample);
      }
      b.Sum += this->Residual[q];
      b.Shape = std::min(b.Shape, this->shape(q));
    }
    std::sort(b.Samples.begin(), b.Samples.end());
    return b;
  }

  /// The layout around after a step, if it is sound and its residual is below `best`.
  bool better(const Before& b, double best, View& view) const
  {
    const bool sound = std::all_of(b.Quads.begin(), b.Quads.end(),
      [&](Index q) { return this->shape(q) >= std::min(b.Shape, SoundShape); });
    if (!sound)
    {
      return false;
    }
    View now = this->look(b.Quads, b.Samples);
    if (!(now.Sum < best))
    {
      return false;
    }
    view = std::move(now);
    return true;
  }

  /// Shifts v a share of the way to the points around; the best way, if one is good enough.
  bool shift(Index v, double share, bool follow)
  {
    if (this->E.Kind[v] != VertexKind::Free)
    {
      return false;
    }
    const std::vector<Index> around = this->ring(v);
    std::vector<Index> moving = {v};
    if (follow)
    {
      moving.insert(moving.end(), around.begin(), around.end());
    }
    const Before b = this->before(moving);
    double best = (1.0 - Gain) * b.Sum;
    std::vector<Vec3> bestPoints;
    View bestView;
    for (Index to : around)
    {
      this->E.begin();
      const Vec3& p = this->E.Points[v];
      this->E.move(v, this->onSurface(v, p + share * (this->E.Points[to] - p)));
      for (std::size_t i = 1; i < moving.size(); ++i)
      {
        this->follow(moving[i]);
      }
      if (this->better(b, best, bestView))
      {
        best = bestView.Sum;
        bestPoints.clear();
        for (Index m : moving)
        {
          bestPoints.push_back(this->E.Points[m]);
        }
      }
      this->E.rollback();
    }
    for (std::size_t i = 0; i < bestPoints.size(); ++i)
    {
      this->E.Points[moving[i]] = bestPoints[i];
    }
    if (!bestPoints.empty())
    {
      this->take(bestView);
    }
    return !bestPoints.empty();
  }

  /// Turns an edge at v or of the quads around, if that is good enough.
  bool turn(Index v)
  {
    const std::vector<Index> quads = this->E.Around[v];
    for (Index q : quads)
    {
      for (int k = 0; k < 4; ++k)
      {
        const Index other = this->E.neighbor(q, k);
        if (other < 0 || this->E.crease(q, k))
        {
          continue;
        }
        for (int way : {1, -1})
        {
          if (this->E.rotateGain(q, k, way) <= 1e-9 && this->turn(q, other, k, way))
          {
            return true;
          }
        }
      }
    }
    return false;
  }

  bool turn(Index q, Index other, int k, int way)
  {
    std::vector<Index> moving(this->E.Quads[q].begin(), this->E.Quads[q].end());
    moving.insert(moving.end(), this->E.Quads[other].begin(), this->E.Quads[other].end());
    QuadEditor::sortUnique(moving);
    const Before b = this->before(moving);
    this->E.begin();
    View view;
    bool good = this->E.rotate(q, k, way);
    for (int round = 0; round < 4 && good; ++round)
    {
      for (Index m : moving)
      {
        this->follow(m);
      }
    }
    good = good && this->better(b, (1.0 - Gain) * b.Sum, view);
    if (good)
    {
      this->take(view);
    }
    else
    {
      this->E.rollback();
    }
    return good;
  }

  QuadEditor E;
  const ReferenceSurface& Reference;
  std::vector<SurfaceSample> Samples;
  std::vector<std::vector<Place>> Held; ///< samples of each quad
  std::vector<double> Residual;         ///< of each quad: sum of squares
};
} // namespace

Status moveToFit(LayoutDraft& draft, const TriangleSurface& s, const ReferenceSurface& reference,
  Monitor& monitor, FitMovesReport* report)
{
  FitMovesReport own;
  Mover mover(draft, s, reference);
  Status status = mover.run(monitor, report != nullptr ? *report : own);
  draft = mover.draft();
  return status;
}
} // namespace bsr
