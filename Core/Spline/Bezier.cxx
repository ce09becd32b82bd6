#include "Spline/Bezier.h"
#include "Spline/SampleModel.h"

#include <algorithm>

namespace bsr
{
namespace
{
/// A row of homogeneous control points with its knots.
struct Curve
{
  int Degree = 0;
  std::vector<double> Knots;
  std::vector<Vec4> Points;
};

/// Inserts t once (The NURBS Book, A5.1).
void insertKnot(Curve& c, double t)
{
  const int p = c.Degree;
  const auto n = static_cast<int>(c.Points.size());
  int span = p;
  while (span + 1 < n && c.Knots[span + 1] <= t)
  {
    ++span;
  }
  std::vector<Vec4> q(c.Points.size() + 1);
  for (int i = 0; i <= n; ++i)
  {
    if (i <= span - p)
    {
      q[i] = c.Points[i];
    }
    else if (i > span || c.Knots[i] >= t)
    {
      q[i] = c.Points[i - 1];
    }
    else
    {
      const double a = (t - c.Knots[i]) / (c.Knots[i + p] - c.Knots[i]);
      q[i] = a * c.Points[i] + (1.0 - a) * c.Points[i - 1];
    }
  }
  c.Points = std::move(q);
  c.Knots.insert(c.Knots.begin() + span + 1, t);
}

/// Raises the multiplicity of the inner `ends` to the degree.
void refine(Curve& c, const std::vector<double>& ends)
{
  for (std::size_t e = 1; e + 1 < ends.size(); ++e)
  {
    const auto have = std::count(c.Knots.begin(), c.Knots.end(), ends[e]);
    for (auto k = have; k < c.Degree; ++k)
    {
      insertKnot(c, ends[e]);
    }
  }
}

std::vector<double> splitEnds(const std::vector<double>& ends, int split)
{
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
  {
    for (int k = 0; k < split; ++k)
    {
      out.push_back(ends[i] + (ends[i + 1] - ends[i]) * k / split);
    }
  }
  out.push_back(ends.back());
  return out;
}

/// Refines `lines` curves of `count` points; point (k, l) of the grid is at k * step + l * stride.
std::vector<Vec4> refineLines(const std::vector<Vec4>& grid, std::int64_t count, std::int64_t lines,
  bool alongU, const Curve& shape, const std::vector<double>& ends, std::int64_t& newCount)
{
  std::vector<Curve> curves(static_cast<std::size_t>(lines), shape);
  for (std::int64_t l = 0; l < lines; ++l)
  {
    for (std::int64_t k = 0; k < count; ++k)
    {
      curves[l].Points.push_back(grid[alongU ? l * count + k : k * lines + l]);
    }
    refine(curves[l], ends);
  }
  newCount = static_cast<std::int64_t>(curves[0].Points.size());
  std::vector<Vec4> out(static_cast<std::size_t>(newCount * lines));
  for (std::int64_t l = 0; l < lines; ++l)
  {
    for (std::int64_t k = 0; k < newCount; ++k)
    {
      out[alongU ? l * newCount + k : k * lines + l] = curves[l].Points[k];
    }
  }
  return out;
}
} // namespace

BezierPatch bezierPieces(const SplineModel& model, const SplinePatch& patch, int split)
{
  BezierPatch b;
  b.DegreeU = patch.DegreeU;
  b.DegreeV = patch.DegreeV;
  b.EndsU = splitEnds(pieceEnds(model, patch, 0), split);
  b.EndsV = splitEnds(pieceEnds(model, patch, 1), split);
  const auto first = model.ControlPoints.begin() + patch.FirstControlPoint;
  std::vector<Vec4> grid(first, first + static_cast<std::int64_t>(patch.CountU) * patch.CountV);
  for (Vec4& p : grid)
  {
    p.head<3>() *= p[3];
  }
  const double* ku = model.Knots.data() + patch.FirstKnotU;
  const double* kv = model.Knots.data() + patch.FirstKnotV;
  const Curve u{patch.DegreeU, {ku, ku + patch.CountU + patch.DegreeU + 1}, {}};
  const Curve v{patch.DegreeV, {kv, kv + patch.CountV + patch.DegreeV + 1}, {}};
  std::int64_t countU = 0;
  std::int64_t countV = 0;
  grid = refineLines(grid, patch.CountU, patch.CountV, true, u, b.EndsU, countU);
  grid = refineLines(grid, patch.CountV, countU, false, v, b.EndsV, countV);
  for (Vec4& p : grid)
  {
    p.head<3>() /= p[3];
  }
  b.Points = std::move(grid);
  return b;
}
} // namespace bsr
