#include "Spline/Volume.h"
#include "Common/Parallel.h"
#include "Spline/Evaluate.h"
#include "Spline/SampleModel.h"
#include "Spline/Topology.h"

#include <cmath>
#include <tuple>

namespace bsr
{
namespace
{
struct GaussRule
{
  std::vector<double> Points; ///< in [0, 1]
  std::vector<double> Weights;
};

/// Gauss-Legendre points as roots of the Legendre polynomial by Newton's method.
GaussRule gaussRule(int n)
{
  GaussRule g;
  for (int i = 0; i < n; ++i)
  {
    double x = std::cos(std::acos(-1.0) * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int iteration = 0; iteration < 50; ++iteration)
    {
      double p0 = 1.0;
      double p1 = x;
      for (int k = 2; k <= n; ++k)
      {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = n == 1 ? 1.0 : n * (x * p1 - p0) / (x * x - 1.0);
      const double step = p1 / slope;
      x -= step;
      if (std::abs(step) < 1e-15)
      {
        break;
      }
    }
    g.Points.push_back(0.5 * (1.0 - x));
    g.Weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return g;
}

/// Basis values at the Gauss points of every piece along one direction, with their weights.
struct Line
{
  std::vector<BasisValues> Basis;
  std::vector<double> Weights;
};

Line quadratureLine(
  const SplineModel& model, const SplinePatch& patch, int direction, bool rational)
{
  const int degree = direction == 0 ? patch.DegreeU : patch.DegreeV;
  const int count = direction == 0 ? patch.CountU : patch.CountV;
  const double* knots = model.Knots.data() + (direction == 0 ? patch.FirstKnotU : patch.FirstKnotV);
  // x . (Su x Sv) has degree 3 d - 1 in each parameter.
  const GaussRule g = gaussRule(rational ? 3 * degree + 12 : (3 * degree + 1) / 2);
  const std::vector<double> ends = pieceEnds(model, patch, direction);
  Line line;
  for (std::size_t e = 0; e + 1 < ends.size(); ++e)
  {
    const double length = ends[e + 1] - ends[e];
    for (std::size_t k = 0; k < g.Points.size(); ++k)
    {
      line.Basis.push_back(evaluateBasis(knots, degree, count, ends[e] + g.Points[k] * length));
      line.Weights.push_back(g.Weights[k] * length);
    }
  }
  return line;
}

bool isRational(const SplineModel& model, const SplinePatch& patch)
{
  const Vec4* c = model.ControlPoints.data() + patch.FirstControlPoint;
  for (std::int64_t i = 1; i < static_cast<std::int64_t>(patch.CountU) * patch.CountV; ++i)
  {
    if (c[i][3] != c[0][3])
    {
      return true;
    }
  }
  return false;
}

/// {volume of the cone from `apex`, area} of a patch.
std::array<double, 2> measurePatch(
  const SplineModel& model, const SplinePatch& patch, const Vec3& apex)
{
  const bool rational = isRational(model, patch);
  const Line u = quadratureLine(model, patch, 0, rational);
  const Line v = quadratureLine(model, patch, 1, rational);
  std::array<double, 2> sum = {0.0, 0.0};
  for (std::size_t j = 0; j < v.Basis.size(); ++j)
  {
    for (std::size_t i = 0; i < u.Basis.size(); ++i)
    {
      const SurfacePoint s = evaluatePatch(model, patch, u.Basis[i], v.Basis[j]);
      const double w = u.Weights[i] * v.Weights[j];
      sum[0] += w * (s.Point - apex).dot(s.normal()) / 3.0;
      sum[1] += w * s.normal().norm();
    }
  }
  return sum;
}

std::vector<std::array<double, 2>> measurePatches(const SplineModel& model)
{
  Vec3 apex = Vec3::Zero();
  for (const Vec4& c : model.ControlPoints)
  {
    apex += c.head<3>() / static_cast<double>(model.ControlPoints.size());
  }
  const std::vector<char> flip = orientationFlips(model);
  std::vector<std::array<double, 2>> m(model.Patches.size());
  parallelFor(0, static_cast<std::int64_t>(m.size()), 4,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t p = begin; p < end; ++p)
      {
        m[p] = measurePatch(model, model.Patches[p], apex);
        m[p][0] *= flip[p] ? -1.0 : 1.0;
      }
    });
  return m;
}
} // namespace

std::vector<double> componentVolumes(const SplineModel& model)
{
  const auto [component, count] = patchComponents(model);
  const auto patches = measurePatches(model);
  std::vector<double> volume(static_cast<std::size_t>(count), 0.0);
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    volume[component[p]] += patches[p][0];
  }
  return volume;
}

namespace
{
/// Winding number of the sampled polygons of component `c` about p.
double windingNumber(
  const SampledModel& mesh, const std::vector<Index>& component, Index c, const Vec3& p)
{
  double angle = 0.0;
  for (std::size_t i = 0; i < mesh.Polygons.size(); ++i)
  {
    if (component[mesh.PatchId[i]] != c)
    {
      continue;
    }
    const auto& q = mesh.Polygons[i];
    for (int k = 1; k + 1 < (q[3] < 0 ? 3 : 4); ++k)
    {
      // Solid angle of a triangle (van Oosterom and Strackee, 1983).
      const Vec3 a = mesh.Points[q[0]] - p;
      const Vec3 b = mesh.Points[q[k]] - p;
      const Vec3 d = mesh.Points[q[k + 1]] - p;
      const double la = a.norm();
      const double lb = b.norm();
      const double ld = d.norm();
      angle += 2.0 * std::atan2(a.dot(b.cross(d)),
                       la * lb * ld + a.dot(b) * ld + b.dot(d) * la + d.dot(a) * lb);
    }
  }
  return angle / (4.0 * std::acos(-1.0));
}
} // namespace

Nesting findNesting(const SplineModel& model)
{
  Nesting n;
  Index count = 0;
  std::tie(n.Component, count) = patchComponents(model);
  const auto open = openSides(model, n.Component, count);
  n.Volume = componentVolumes(model);
  n.Depth.assign(static_cast<std::size_t>(count), 0);
  n.Parent.assign(static_cast<std::size_t>(count), -1);
  std::vector<Vec3> member(static_cast<std::size_t>(count));
  for (std::size_t p = model.Patches.size(); p-- > 0;)
  {
    member[n.Component[p]] = model.ControlPoints[model.Patches[p].FirstControlPoint].head<3>();
  }
  for (Index c = 0; c < count; ++c)
  {
    n.Closed.push_back(open[c] == 0);
  }
  if (count < 2)
  {
    return n;
  }
  Monitor monitor;
  SampleOptions options;
  options.Outward = false;
  const Result<SampledModel> mesh = sampleModel(model, options, monitor);
  for (Index c = 0; mesh.isOk() && c < count; ++c)
  {
    for (Index d = 0; d < count; ++d)
    {
      if (d == c || !n.Closed[d] || std::abs(windingNumber(*mesh, n.Component, d, member[c])) < 0.5)
      {
        continue;
      }
      ++n.Depth[c];
      if (n.Parent[c] < 0 || std::abs(n.Volume[d]) < std::abs(n.Volume[n.Parent[c]]))
      {
        n.Parent[c] = d;
      }
    }
  }
  return n;
}

std::vector<char> outwardFlips(const SplineModel& model)
{
  std::vector<char> flip = orientationFlips(model);
  const Nesting n = findNesting(model);
  for (std::size_t p = 0; p < flip.size(); ++p)
  {
    const Index c = n.Component[p];
    const bool turn = n.Closed[c] && (n.Volume[c] < 0.0) != (n.Depth[c] % 2 == 1);
    flip[p] = turn ? !flip[p] : flip[p];
  }
  return flip;
}

ModelMeasure measureModel(const SplineModel& model)
{
  ModelMeasure m;
  for (const auto& patch : measurePatches(model))
  {
    m.Area += patch[1];
  }
  const Nesting n = findNesting(model);
  for (std::size_t c = 0; c < n.Closed.size(); ++c)
  {
    if (n.Closed[c])
    {
      m.Volume += std::abs(n.Volume[c]) * (n.Depth[c] % 2 ? -1.0 : 1.0);
    }
    m.Closed = m.Closed && n.Closed[c];
  }
  return m;
}
} // namespace bsr
