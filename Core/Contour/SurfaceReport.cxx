#include "Contour/SurfaceReport.h"

#include "Common/BoxTree.h"
#include "Common/Parallel.h"
#include "Spline/ClosestPoint.h"
#include "Spline/Evaluate.h"
#include "Spline/FoldCheck.h"
#include "Spline/SampleModel.h"
#include "Spline/Topology.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr int Grid = 25;
constexpr double Degrees = 57.29577951308232;

SurfacePoint onSide(const SplineModel& model, std::int64_t patch, int side, double t)
{
  const SplinePatch& p = model.Patches[patch];
  const auto d = patchDomain(model, p);
  const double u = side == 1 ? d[1] : side == 3 ? d[0] : d[0] + t * (d[1] - d[0]);
  const double v = side == 0 ? d[2] : side == 2 ? d[3] : d[2] + t * (d[3] - d[2]);
  return evaluatePatch(model, p, u, v);
}

using Segment = std::array<Vec3, 2>;

double segmentDistance(const Segment& s, const Vec3& p)
{
  const Vec3 d = s[1] - s[0];
  const double l = d.squaredNorm();
  const double t = l > 0.0 ? std::clamp(d.dot(p - s[0]) / l, 0.0, 1.0) : 0.0;
  return (s[0] + t * d - p).squaredNorm();
}

/// Nearest distances from points to a set of segments.
std::vector<double> distancesTo(
  const std::vector<Segment>& segments, const std::vector<Vec3>& points)
{
  std::vector<Box> boxes;
  for (const Segment& s : segments)
  {
    Box b;
    b.add(s[0]);
    b.add(s[1]);
    boxes.push_back(b);
  }
  const BoxTree tree(boxes);
  std::vector<double> out;
  for (const Vec3& p : points)
  {
    double best = std::numeric_limits<double>::infinity();
    tree.nearest(p, best, [&](Index i) { best = std::min(best, segmentDistance(segments[i], p)); });
    out.push_back(std::sqrt(best));
  }
  return out;
}

std::vector<Segment> cutBy(const SampledModel& mesh, const Vec3& origin, const Vec3& normal)
{
  std::vector<double> height;
  height.reserve(mesh.Points.size());
  for (const Vec3& p : mesh.Points)
  {
    height.push_back(normal.dot(p - origin));
  }
  std::vector<Segment> segments;
  const auto triangle = [&](const std::array<Index, 3>& t)
  {
    Segment s;
    int n = 0;
    for (int k = 0; k < 3 && n < 2; ++k)
    {
      const Index a = t[k];
      const Index b = t[(k + 1) % 3];
      if ((height[a] < 0.0) != (height[b] < 0.0))
      {
        const double r = height[a] / (height[a] - height[b]);
        s[n++] = mesh.Points[a] + r * (mesh.Points[b] - mesh.Points[a]);
      }
    }
    if (n == 2)
    {
      segments.push_back(s);
    }
  };
  for (const auto& q : mesh.Polygons)
  {
    triangle({q[0], q[1], q[2]});
    if (q[3] >= 0)
    {
      triangle({q[0], q[2], q[3]});
    }
  }
  return segments;
}

/// Normal of the plane that fits points best, on the side of `like`.
Vec3 planeNormal(const std::vector<Vec3>& points, const Vec3& like)
{
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points)
  {
    mean += p / static_cast<double>(points.size());
  }
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points)
  {
    m += (p - mean) * (p - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  const Vec3 n = solver.eigenvectors().col(0);
  const bool flat = solver.eigenvalues()[0] < 0.01 * solver.eigenvalues()[1];
  return flat && std::abs(n.dot(like)) > 0.5 ? Vec3(n.dot(like) < 0.0 ? -n : n) : like;
}

/// Errors of one slice.
struct SliceError
{
  std::vector<double> There;
  std::vector<double> Back;
};

SliceError compareSlice(const SampledModel& mesh, const ContourStack& stack, std::size_t s,
  const std::vector<Index>& contours)
{
  SliceError out;
  std::vector<Segment> given;
  std::vector<Vec3> points;
  for (const Index c : contours)
  {
    const std::vector<Vec3>& p = stack.Contours[c].Points;
    for (std::size_t i = 0; i < p.size(); ++i)
    {
      points.push_back(p[i]);
      if (stack.Contours[c].Closed || i + 1 < p.size())
      {
        given.push_back({p[i], p[(i + 1) % p.size()]});
      }
    }
  }
  // At the ends the surface may end in the plane itself: cut just inside.
  const double inside = s == 0 ? 1.0 : s + 1 == stack.Slices.size() ? -1.0 : 0.0;
  const Slice& slice = stack.Slices[s];
  if (points.empty())
  {
    return out;
  }
  const Vec3 normal = planeNormal(points, slice.Normal);
  Vec3 origin = 1e-3 * inside * stack.spacing() * stack.Axis;
  for (const Vec3& p : points)
  {
    origin += p / static_cast<double>(points.size());
  }
  const std::vector<Segment> cut = cutBy(mesh, origin, normal);
  if (cut.empty())
  {
    out.There.assign(points.size(), stack.meanDiameter());
    return out;
  }
  out.There = distancesTo(cut, points);
  std::vector<Vec3> middles;
  middles.reserve(cut.size());
  for (const Segment& c : cut)
  {
    middles.emplace_back(0.5 * (c[0] + c[1]));
  }
  out.Back = distancesTo(given, middles);
  return out;
}
} // namespace

Percentiles percentilesOf(std::vector<double> values)
{
  Percentiles p;
  p.Count = static_cast<std::int64_t>(values.size());
  if (values.empty())
  {
    return p;
  }
  std::sort(values.begin(), values.end());
  const double share[6] = {0.5, 0.75, 0.9, 0.95, 0.99, 1.0};
  for (int k = 0; k < 6; ++k)
  {
    p.Value[k] =
      values[static_cast<std::size_t>(share[k] * static_cast<double>(values.size() - 1))];
  }
  return p;
}

std::vector<SideJumps> normalJumps(const SplineModel& model, int samples)
{
  std::vector<SideJumps> jumps(model.Patches.size(), {-1.0, -1.0, -1.0, -1.0});
  parallelFor(0, static_cast<std::int64_t>(jumps.size()), 1,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t p = begin; p < end; ++p)
      {
        for (int s = 0; s < 4; ++s)
        {
          const SideMatch m = matchSide(model, p, s);
          for (int k = 0; m.Patch >= 0 && k < samples; ++k)
          {
            const double t = static_cast<double>(k) / (samples - 1);
            const Vec3 a = onSide(model, p, s, t).normal();
            Vec3 b = onSide(model, m.Patch, m.Side, m.Reversed ? 1.0 - t : t).normal();
            b *= m.Coherent ? 1.0 : -1.0;
            jumps[p][s] = std::max(jumps[p][s], Degrees * std::atan2(a.cross(b).norm(), a.dot(b)));
          }
        }
      }
    });
  return jumps;
}

double patchJacobian(const SplineModel& model, std::int64_t patch)
{
  const SplinePatch& s = model.Patches[patch];
  const auto d = patchDomain(model, s);
  std::vector<BasisValues> basis[2];
  for (int i = 0; i < Grid; ++i)
  {
    const double x = static_cast<double>(i) / (Grid - 1);
    basis[0].push_back(evaluateBasis(
      model.Knots.data() + s.FirstKnotU, s.DegreeU, s.CountU, d[0] + (d[1] - d[0]) * x));
    basis[1].push_back(evaluateBasis(
      model.Knots.data() + s.FirstKnotV, s.DegreeV, s.CountV, d[2] + (d[3] - d[2]) * x));
  }
  std::vector<Vec3> normals;
  double mean = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const BasisValues& v : basis[1])
  {
    for (const BasisValues& u : basis[0])
    {
      normals.push_back(evaluatePatch(model, s, u, v).normal());
      mean += normals.back().norm() / (Grid * Grid);
      least = std::min(least, normals.back().norm());
    }
  }
  const double size = mean > 0.0 ? least / mean : 0.0;
  return normalsFold(normals, Grid) ? std::min(-size, -1e-300) : size;
}

std::vector<double> patchJacobians(const SplineModel& model)
{
  std::vector<double> out(model.Patches.size(), 0.0);
  parallelFor(0, static_cast<std::int64_t>(out.size()), 1,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t p = begin; p < end; ++p)
      {
        out[p] = patchJacobian(model, p);
      }
    });
  return out;
}

Result<InputError> inputError(const SplineModel& model, const ContourStack& stack,
  const std::vector<Index>& contours, Monitor& monitor)
{
  std::vector<Vec3> points;
  for (const Index c : contours)
  {
    points.insert(points.end(), stack.Contours[c].Points.begin(), stack.Contours[c].Points.end());
  }
  const auto deviation = measureDeviation(model, points, {}, monitor);
  if (!deviation)
  {
    return deviation.status();
  }
  InputError e;
  e.Points.assign(model.Patches.size(), 0);
  e.RMS.assign(model.Patches.size(), 0.0);
  e.Max.assign(model.Patches.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Index p = deviation->PatchId[i];
    const double d = std::abs(deviation->Distance[i]);
    ++e.Points[p];
    e.RMS[p] += d * d;
    e.Max[p] = std::max(e.Max[p], d);
  }
  for (std::size_t p = 0; p < e.RMS.size(); ++p)
  {
    e.RMS[p] = e.Points[p] > 0 ? std::sqrt(e.RMS[p] / static_cast<double>(e.Points[p])) : 0.0;
  }
  std::size_t at = 0;
  for (const Index c : contours)
  {
    const std::size_t n = stack.Contours[c].Points.size();
    double sum = 0.0;
    for (std::size_t i = at; i < at + n; ++i)
    {
      sum += deviation->Distance[i] * deviation->Distance[i];
    }
    e.ContourRMS.push_back(std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, n))));
    at += n;
  }
  e.TotalRMS = deviation->RMS;
  e.TotalMax = deviation->Max;
  return e;
}

Result<ResliceError> resliceError(const SplineModel& model, const ContourStack& stack,
  const std::vector<Index>& contours, Monitor& monitor)
{
  SampleOptions sampling;
  sampling.Resolution = 4;
  const auto mesh = sampleModel(model, sampling, monitor);
  if (!mesh)
  {
    return mesh.status();
  }
  const std::size_t n = stack.Slices.size();
  std::vector<std::vector<Index>> of(n);
  for (const Index c : contours)
  {
    of[stack.Contours[c].Slice].push_back(c);
  }
  std::vector<SliceError> errors(n);
  for (std::size_t first = 0; first < n; first += 8)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    parallelFor(static_cast<std::int64_t>(first), static_cast<std::int64_t>(std::min(first + 8, n)),
      1,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t s = begin; s < end; ++s)
        {
          errors[s] = compareSlice(*mesh, stack, static_cast<std::size_t>(s), of[s]);
        }
      });
  }
  std::vector<double> there;
  std::vector<double> back;
  for (const SliceError& e : errors)
  {
    there.insert(there.end(), e.There.begin(), e.There.end());
    back.insert(back.end(), e.Back.begin(), e.Back.end());
  }
  ResliceError out;
  double sum = 0.0;
  for (const double d : there)
  {
    sum += d * d;
  }
  for (const double d : back)
  {
    sum += d * d;
  }
  out.RMS = std::sqrt(sum / std::max<double>(1.0, static_cast<double>(there.size() + back.size())));
  out.There = percentilesOf(std::move(there));
  out.Back = percentilesOf(std::move(back));
  return out;
}
} // namespace bsr
