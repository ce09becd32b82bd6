#include "Spline/SampleModel.h"
#include "Common/Parallel.h"
#include "Spline/Evaluate.h"
#include "Spline/Topology.h"
#include "Spline/Volume.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace bsr
{
namespace
{
constexpr int MaximumResolution = 256;

/// Parameters of the sample lines: each piece cut into `resolution` equal parts.
std::vector<double> sampleLines(const std::vector<double>& ends, int resolution)
{
  std::vector<double> t;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
  {
    for (int k = 0; k < resolution; ++k)
    {
      t.push_back(ends[i] + (ends[i + 1] - ends[i]) * k / resolution);
    }
  }
  t.push_back(ends.back());
  return t;
}

/// Strips: the directions of patches that must be cut alike because they share sides.
class Strips
{
public:
  explicit Strips(const SplineModel& model) : Parent(2 * model.Patches.size())
  {
    std::iota(this->Parent.begin(), this->Parent.end(), std::size_t{0});
    for (std::size_t p = 0; p < model.Patches.size(); ++p)
    {
      for (int s = 0; s < 4; ++s)
      {
        const std::int64_t code = model.Neighbors[p][s];
        if (code >= 0)
        {
          this->join(2 * p + s % 2, 2 * (code / 4) + code % 2);
        }
      }
    }
  }
  std::size_t find(std::size_t a)
  {
    while (this->Parent[a] != a)
    {
      this->Parent[a] = this->Parent[this->Parent[a]];
      a = this->Parent[a];
    }
    return a;
  }

private:
  void join(std::size_t a, std::size_t b)
  {
    a = this->find(a);
    b = this->find(b);
    this->Parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::size_t> Parent;
};

/// Quads a piece along u and v that keep a patch's polygons within the tolerance: by
/// (hu^2 |Suu| + 2 hu hv |Suv| + hv^2 |Svv|) / 8, half of it for each direction.
std::array<int, 2> resolutionFor(const SplineModel& model, const SplinePatch& patch, double tol)
{
  const std::array<std::vector<double>, 2> ends = {
    pieceEnds(model, patch, 0), pieceEnds(model, patch, 1)};
  std::array<double, 2> need = {1.0, 1.0};
  for (std::size_t j = 0; j + 1 < ends[1].size(); ++j)
  {
    for (std::size_t i = 0; i + 1 < ends[0].size(); ++i)
    {
      const double lu = ends[0][i + 1] - ends[0][i];
      const double lv = ends[1][j + 1] - ends[1][j];
      double uu = 0.0;
      double uv = 0.0;
      double vv = 0.0;
      for (int k = 0; k < 25; ++k)
      {
        // Stay inside the piece: second derivatives jump at its ends.
        const int column = k % 5;
        const int row = k / 5;
        const double a = std::clamp(column / 4.0, 1e-9, 1.0 - 1e-9);
        const double b = std::clamp(row / 4.0, 1e-9, 1.0 - 1e-9);
        const SurfacePoint s =
          evaluatePatch(model, patch, ends[0][i] + a * lu, ends[1][j] + b * lv);
        uu = std::max(uu, s.Duu.norm() * lu * lu);
        uv = std::max(uv, s.Duv.norm() * lu * lv);
        vv = std::max(vv, s.Dvv.norm() * lv * lv);
      }
      need[0] = std::max(need[0], std::sqrt((uu + uv) / (4.0 * tol)));
      need[1] = std::max(need[1], std::sqrt((vv + uv) / (4.0 * tol)));
    }
  }
  const auto cut = [](double n)
  { return static_cast<int>(std::min<double>(std::ceil(n), MaximumResolution)); };
  return {cut(need[0]), cut(need[1])};
}

std::vector<std::array<int, 2>> resolutions(const SplineModel& model, const SampleOptions& options)
{
  std::vector<std::array<int, 2>> r(model.Patches.size(), {options.Resolution, options.Resolution});
  if (options.Tolerance <= 0.0)
  {
    return r;
  }
  parallelFor(0, static_cast<std::int64_t>(r.size()), 1,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t p = begin; p < end; ++p)
      {
        r[p] = resolutionFor(model, model.Patches[p], options.Tolerance);
      }
    });
  Strips strips(model);
  std::vector<int> most(2 * r.size(), 1);
  for (std::size_t i = 0; i < most.size(); ++i)
  {
    int& m = most[strips.find(i)];
    m = std::max(m, r[i / 2][i % 2]);
  }
  for (std::size_t i = 0; i < most.size(); ++i)
  {
    r[i / 2][i % 2] = most[strips.find(i)];
  }
  return r;
}

/// What is kept of a sample before stitching.
struct Sample
{
  Vec3 Point;
  Vec3 Normal;
  double Mean = 0.0;
  double Gauss = 0.0;
};

/// Unit normal; at a singular point (a pole) that of a point a little towards the middle.
Vec3 unitNormal(
  const SplineModel& model, const SplinePatch& patch, const SurfacePoint& s, double u, double v)
{
  Vec3 n = s.normal();
  const std::array<double, 4> d = patchDomain(model, patch);
  double scale = (s.Du.norm() + s.Dv.norm());
  for (double step = 1e-6; step < 0.1 && !(n.norm() > 1e-10 * scale * scale); step *= 100)
  {
    const double a = u + step * (0.5 * (d[0] + d[1]) - u);
    const double b = v + step * (0.5 * (d[2] + d[3]) - v);
    n = evaluatePatch(model, patch, a, b).normal();
    scale *= std::sqrt(step);
  }
  const double length = n.norm();
  return length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero());
}

void curvatures(const SurfacePoint& s, const Vec3& n, Sample& out)
{
  const double e = s.Du.dot(s.Du);
  const double f = s.Du.dot(s.Dv);
  const double g = s.Dv.dot(s.Dv);
  const double l = n.dot(s.Duu);
  const double m = n.dot(s.Duv);
  const double k = n.dot(s.Dvv);
  const double det = e * g - f * f;
  if (det > 0.0)
  {
    out.Mean = -(e * k - 2 * f * m + g * l) / (2 * det);
    out.Gauss = (l * k - m * m) / det;
  }
}

void samplePatch(const SplineModel& model, const SplinePatch& patch, const std::vector<double>& us,
  const std::vector<double>& vs, const SampleOptions& options, bool flip, Sample* out)
{
  std::vector<BasisValues> bu(us.size());
  for (std::size_t i = 0; i < us.size(); ++i)
  {
    bu[i] =
      evaluateBasis(model.Knots.data() + patch.FirstKnotU, patch.DegreeU, patch.CountU, us[i]);
  }
  for (const double v : vs)
  {
    const BasisValues bv =
      evaluateBasis(model.Knots.data() + patch.FirstKnotV, patch.DegreeV, patch.CountV, v);
    for (std::size_t i = 0; i < us.size(); ++i, ++out)
    {
      const SurfacePoint s = evaluatePatch(model, patch, bu[i], bv);
      out->Point = s.Point;
      out->Normal = unitNormal(model, patch, s, us[i], v);
      if (flip)
      {
        out->Normal = -out->Normal;
      }
      if (options.Curvatures)
      {
        curvatures(s, out->Normal, *out);
      }
    }
  }
}

/// Where each patch is sampled and how its points are shared.
struct Plan
{
  std::vector<std::array<std::vector<double>, 2>> Lines;
  std::vector<GridSize> Sizes;
  std::vector<char> Flip;
  StitchedGrids Grids;
};

Result<Plan> makePlan(const SplineModel& model, const SampleOptions& options)
{
  Plan plan;
  const auto cuts = resolutions(model, options);
  double total = 0.0;
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    plan.Lines.push_back({sampleLines(pieceEnds(model, model.Patches[p], 0), cuts[p][0]),
      sampleLines(pieceEnds(model, model.Patches[p], 1), cuts[p][1])});
    plan.Sizes.push_back({static_cast<std::int64_t>(plan.Lines[p][0].size()),
      static_cast<std::int64_t>(plan.Lines[p][1].size())});
    total += static_cast<double>(plan.Sizes[p][0]) * static_cast<double>(plan.Sizes[p][1]);
  }
  if (total > 2e8)
  {
    return Status::invalidParameter(
      "This would make more than 200 million points; lower the resolution or raise the tolerance.");
  }
  plan.Flip = options.Outward ? outwardFlips(model) : orientationFlips(model);
  plan.Grids = stitchGrids(model, plan.Sizes);
  return plan;
}

void addPolygon(std::array<Index, 4> q, bool flip, Index patch, SampledModel& out)
{
  if (flip)
  {
    std::swap(q[1], q[3]);
  }
  std::array<Index, 4> kept = {-1, -1, -1, -1};
  int n = 0;
  for (int k = 0; k < 4; ++k)
  {
    if (q[k] != q[(k + 3) % 4])
    {
      kept[n++] = q[k];
    }
  }
  if (n >= 3)
  {
    out.Polygons.push_back(kept);
    out.PatchId.push_back(patch);
  }
}

void addPolygons(const Plan& plan, SampledModel& out)
{
  for (std::size_t p = 0; p < plan.Sizes.size(); ++p)
  {
    const Index* id = plan.Grids.Id.data() + plan.Grids.First[p];
    const std::int64_t n = plan.Sizes[p][0];
    for (std::int64_t j = 0; j + 1 < plan.Sizes[p][1]; ++j)
    {
      for (std::int64_t i = 0; i + 1 < n; ++i)
      {
        const Index* c = id + j * n + i;
        addPolygon({c[0], c[1], c[n + 1], c[n]}, plan.Flip[p] != 0, static_cast<Index>(p), out);
      }
    }
  }
}

/// Gathers the samples into shared points, in the order of the grids.
void addPoints(
  const Plan& plan, const std::vector<Sample>& samples, bool curvatures, SampledModel& out)
{
  const std::size_t n = plan.Grids.Owner.size();
  out.Points.resize(n);
  out.UV.resize(n);
  out.Normals.assign(n, Vec3::Zero());
  std::vector<int> shared(n, 0);
  out.MeanCurvature.assign(curvatures ? n : 0, 0.0);
  out.GaussCurvature.assign(curvatures ? n : 0, 0.0);
  std::size_t grid = 0;
  for (std::size_t p = 0; p < plan.Sizes.size(); ++p)
  {
    for (const double v : plan.Lines[p][1])
    {
      for (const double u : plan.Lines[p][0])
      {
        const auto id = static_cast<std::size_t>(plan.Grids.Id[grid]);
        const Sample& s = samples[grid];
        if (shared[id]++ == 0)
        {
          out.Points[id] = s.Point;
          out.UV[id] = Vec2(u, v);
        }
        out.Normals[id] += s.Normal;
        if (curvatures)
        {
          out.MeanCurvature[id] += s.Mean;
          out.GaussCurvature[id] += s.Gauss;
        }
        ++grid;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    out.Normals[i].normalize();
    if (curvatures)
    {
      out.MeanCurvature[i] /= shared[i];
      out.GaussCurvature[i] /= shared[i];
    }
  }
}

Status checkOptions(const SampleOptions& o)
{
  if (!std::isfinite(o.Tolerance) || o.Tolerance < 0.0)
  {
    return Status::invalidParameter(
      "The tolerance must be a positive length, or 0 to use the resolution.");
  }
  if (o.Resolution < 1 || o.Resolution > MaximumResolution)
  {
    return Status::invalidParameter(
      "The resolution must be between 1 and 256 quads a side of a polynomial piece.");
  }
  return Status::ok();
}
} // namespace

std::vector<double> pieceEnds(const SplineModel& model, const SplinePatch& patch, int direction)
{
  const double* k = model.Knots.data() + (direction == 0 ? patch.FirstKnotU : patch.FirstKnotV);
  const int degree = direction == 0 ? patch.DegreeU : patch.DegreeV;
  const int count = direction == 0 ? patch.CountU : patch.CountV;
  std::vector<double> ends(1, k[degree]);
  for (int i = degree + 1; i <= count; ++i)
  {
    if (k[i] > ends.back())
    {
      ends.push_back(k[i]);
    }
  }
  return ends;
}

Result<SampledModel> sampleModel(
  const SplineModel& model, const SampleOptions& options, Monitor& monitor)
{
  if (Status s = checkOptions(options); !s)
  {
    return s;
  }
  Result<Plan> plan = makePlan(model, options);
  if (!plan)
  {
    return plan.status();
  }
  std::vector<Sample> samples(plan->Grids.Id.size());
  const auto patches = static_cast<std::int64_t>(model.Patches.size());
  const std::int64_t block = std::max<std::int64_t>(
    1, std::min<std::int64_t>(64, 200000 * patches / static_cast<std::int64_t>(samples.size())));
  for (std::int64_t first = 0; first < patches; first += block)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    monitor.progress(static_cast<double>(first) / static_cast<double>(patches));
    parallelFor(first, std::min(first + block, patches), 1,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t p = begin; p < end; ++p)
        {
          samplePatch(model, model.Patches[p], plan->Lines[p][0], plan->Lines[p][1], options,
            plan->Flip[p] != 0, samples.data() + plan->Grids.First[p]);
        }
      });
  }
  SampledModel out;
  addPoints(*plan, samples, options.Curvatures, out);
  addPolygons(*plan, out);
  monitor.progress(1.0);
  return out;
}
} // namespace bsr
