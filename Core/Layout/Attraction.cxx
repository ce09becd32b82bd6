#include "Layout/Attraction.h"

#include "Common/Parallel.h"
#include "Layout/NearestQuad.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace bsr
{
double attractionWeight(double relativeDistance)
{
  const double d = relativeDistance / 0.1;
  return 1.0 + std::min(d * d, 20.0);
}

std::vector<Vec3> attraction(const QuadMesh& mesh, const std::vector<SurfaceSample>& samples,
  std::vector<Index>& quads, Monitor& monitor)
{
  const NearestQuad nearest(mesh);
  std::vector<QuadHit> hits(samples.size());
  quads.resize(samples.size(), -1);
  parallelForUntilCancelled(0, static_cast<std::int64_t>(hits.size()), 256, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t i = first; i < last; ++i)
      {
        hits[i] = nearest.findFacing(samples[i].Point, samples[i].Normal, quads[i]);
        quads[i] = hits[i].Quad;
      }
    });
  std::vector<Vec3> pull(mesh.Points.size(), Vec3::Zero());
  std::vector<double> weight(mesh.Points.size(), 0.0);
  for (std::size_t i = 0; i < hits.size(); ++i)
  {
    if (hits[i].Quad < 0)
    {
      continue;
    }
    const auto& q = mesh.Quads[hits[i].Quad];
    const double u = hits[i].UV[0];
    const double v = hits[i].UV[1];
    const std::array<double, 4> share = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    Vec3 on = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
    {
      on += share[k] * mesh.Points[q[k]];
    }
    const Vec3 way = samples[i].Point - on;
    const double side = std::sqrt(
      0.5 *
      (mesh.Points[q[2]] - mesh.Points[q[0]]).cross(mesh.Points[q[3]] - mesh.Points[q[1]]).norm());
    const double w = attractionWeight(way.norm() / std::max(side, 1e-300));
    for (int k = 0; k < 4; ++k)
    {
      pull[q[k]] += w * share[k] * way;
      weight[q[k]] += w * share[k];
    }
  }
  for (std::size_t v = 0; v < pull.size(); ++v)
  {
    if (weight[v] > 0.0)
    {
      pull[v] /= weight[v];
    }
  }
  return pull;
}
} // namespace bsr
