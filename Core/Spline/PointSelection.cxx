#include "Spline/PointSelection.h"

#include "Mesh/PointTree.h"

#include <cmath>

namespace bsr
{
namespace
{
constexpr int Grid = 9; ///< samples along a side in the search for the nearest quad

std::vector<Vec3> sampleQuads(const QuadMesh& quads, const CutLayout& cut)
{
  std::vector<Vec3> samples;
  for (const Index q : cut.Kept)
  {
    for (int k = 0; k < Grid * Grid; ++k)
    {
      const int column = k % Grid;
      const int row = k / Grid;
      samples.push_back(bilinearPoint(quads, q, column / (Grid - 1.0), row / (Grid - 1.0)));
    }
  }
  return samples;
}

double median(std::vector<double> v)
{
  if (v.empty())
  {
    return 0.0;
  }
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

/// Gives cap points a new place where the wall is near.
void placeCapPoints(
  const QuadMesh& quads, const CutLayout& cut, double reach, std::vector<FitPoint>& caps)
{
  const PointTree tree(sampleQuads(quads, cut));
  for (FitPoint& p : caps)
  {
    const auto [nearest, distance2] = tree.nearest(p.Position);
    const int local = nearest % (Grid * Grid);
    p.Patch = std::sqrt(distance2) <= reach ? nearest / (Grid * Grid) : -1;
    const int column = local % Grid;
    const int row = local / Grid;
    p.U = column / (Grid - 1.0);
    p.V = row / (Grid - 1.0);
  }
}
} // namespace

Status checkPoints(const PartitionedPoints& points, const QuadMesh& quads)
{
  const std::size_t n = points.Points.size();
  if (n == 0)
  {
    return Status::invalidInput(
      "There are no points to fit; connect the output of PartitionToQuads.");
  }
  if (points.QuadId.size() != n || points.UV.size() != n ||
      (!points.Side.empty() && points.Side.size() != n) ||
      (!points.Weights.empty() && points.Weights.size() != n) ||
      (!points.Normals.empty() && points.Normals.size() != n) ||
      (!points.Boundary.empty() && points.Boundary.size() != n))
  {
    return Status::invalidInput(
      "QuadId, UV, Side, Normals, Boundary or the weights do not have one value a point; apply "
      "PartitionToQuads to these points.");
  }
  const auto quadCount = static_cast<Index>(quads.Quads.size());
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::string name = "Point " + std::to_string(i);
    if (points.QuadId[i] < -1 || points.QuadId[i] >= quadCount)
    {
      return Status::invalidInput(name + " has QuadId " + std::to_string(points.QuadId[i]) +
                                  ", but the layout has " + std::to_string(quadCount) +
                                  " quads; partition the points with this layout.");
    }
    if (!points.Points[i].allFinite() || !points.UV[i].allFinite())
    {
      return Status::invalidInput(
        name + " has a NaN or infinite coordinate or UV; remove such points first.");
    }
    if (!points.Weights.empty() && !(points.Weights[i] >= 0.0 && std::isfinite(points.Weights[i])))
    {
      return Status::invalidInput(
        name + " has a negative, NaN or infinite weight; weights must be 0 or positive.");
    }
  }
  return Status::ok();
}

Vec3 bilinearPoint(const QuadMesh& quads, Index quad, double u, double v)
{
  const auto& q = quads.Quads[quad];
  const auto& p = quads.Points;
  return (1 - v) * ((1 - u) * p[q[0]] + u * p[q[1]]) + v * ((1 - u) * p[q[3]] + u * p[q[2]]);
}

std::vector<FitPoint> selectPoints(
  const PartitionedPoints& points, const QuadMesh& quads, const CutLayout& cut, int side)
{
  std::vector<FitPoint> own;
  std::vector<FitPoint> caps;
  std::vector<double> distance;
  for (std::size_t i = 0; i < points.Points.size(); ++i)
  {
    const int itsSide = points.Side.empty() ? 0 : points.Side[i];
    if (itsSide != side || points.QuadId[i] < 0)
    {
      continue;
    }
    FitPoint p;
    p.Position = points.Points[i];
    p.U = std::clamp(points.UV[i][0], 0.0, 1.0);
    p.V = std::clamp(points.UV[i][1], 0.0, 1.0);
    p.Weight = points.Weights.empty() ? 1.0 : points.Weights[i];
    p.Normal = points.Normals.empty() ? Vec3(Vec3::Zero()) : points.Normals[i];
    p.Source = static_cast<Index>(i);
    p.Patch = cut.NewId[points.QuadId[i]];
    if (p.Patch >= 0)
    {
      distance.push_back((p.Position - bilinearPoint(quads, points.QuadId[i], p.U, p.V)).norm());
      own.push_back(p);
    }
    else
    {
      caps.push_back(p);
    }
  }
  if (!caps.empty() && !own.empty())
  {
    placeCapPoints(quads, cut, 1.3 * median(distance), caps);
    std::copy_if(caps.begin(), caps.end(), std::back_inserter(own),
      [](const FitPoint& p) { return p.Patch >= 0; });
  }
  sortByPatch(own, static_cast<Index>(cut.Kept.size()));
  return own;
}

std::vector<RimSample> borderSamples(const PartitionedPoints& points, const CutLayout& cut,
  const QuadComplex& complex, const std::vector<Vec3>& vertices, bool inner)
{
  constexpr double SideWeight = 24.0; ///< of all samples of a side: half of a patch's points
  // Of a sample of a known rim, which is a smooth curve without noise: along the fiber (both)
  // nothing else tells where the wall ends, across it the wall's own points have a say.
  constexpr double Along = 4.0;
  constexpr double Whole = 5.0;
  std::vector<RimSample> samples;
  std::vector<double> count(4 * cut.Kept.size(), 0.0);
  for (std::size_t i = 0; i < points.Boundary.size(); ++i)
  {
    const Index quad = points.QuadId[i] < 0 ? -1 : cut.NewId[points.QuadId[i]];
    const Vec2& uv = points.UV[i];
    const std::array<double, 4> across = {uv[1], 1.0 - uv[0], 1.0 - uv[1], uv[0]};
    const std::array<double, 4> along = {uv[0], uv[1], 1.0 - uv[0], 1.0 - uv[1]};
    for (int k = 0; k < 4 && quad >= 0 && points.Boundary[i]; ++k)
    {
      if (across[k] == 0.0 && complex.twin(4 * quad + k) < 0)
      {
        samples.push_back({4 * quad + k, along[k], points.Points[i], Vec3::Zero()});
        count[4 * quad + k] += 1.0;
      }
    }
  }
  for (RimSample& s : samples)
  {
    s.Weight = SideWeight / count[s.HalfEdge];
  }
  const auto add = [&](bool axialOnly, double weight)
  {
    for (RimSample& s : rimSamples(complex, vertices, points.Rims, axialOnly))
    {
      if (count[s.HalfEdge] == 0.0)
      {
        s.Weight = weight;
        samples.push_back(s);
      }
    }
  };
  add(true, points.Rims.empty() ? 1.0 : Along);
  if (!points.Rims.empty() && !inner)
  {
    add(false, Whole);
  }
  return samples;
}
} // namespace bsr
