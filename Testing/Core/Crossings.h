#ifndef Crossings_h
#define Crossings_h

#include "Spline/SampleModel.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace bsrtest
{
/// Whether a segment passes through the inside of a triangle.
inline bool pierces(const bsr::Vec3& p, const bsr::Vec3& q, const std::array<bsr::Vec3, 3>& t)
{
  const bsr::Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double a = n.dot(p - t[0]);
  const double b = n.dot(q - t[0]);
  if (!(a * b < 0.0) || std::min(std::abs(a), std::abs(b)) < 1e-9 * n.norm())
  {
    return false;
  }
  const bsr::Vec3 x = p + a / (a - b) * (q - p);
  for (int k = 0; k < 3; ++k)
  {
    const bsr::Vec3 side = t[(k + 1) % 3] - t[k];
    if (n.dot(side.cross(x - t[k])) < 1e-6 * n.squaredNorm())
    {
      return false;
    }
  }
  return true;
}

/// Pairs of triangles of a sampled model that cross, without those that have a point in common.
inline int crossings(const bsr::SplineModel& model, int resolution = 4)
{
  bsr::Monitor monitor;
  const auto mesh = bsr::sampleModel(model, {resolution, 0.0, false}, monitor);
  std::vector<std::array<bsr::Vec3, 3>> all;
  std::vector<std::pair<bsr::Vec3, bsr::Vec3>> box;
  for (const auto& q : mesh->Polygons)
  {
    const auto add = [&](bsr::Index a, bsr::Index b, bsr::Index c)
    {
      all.push_back({mesh->Points[a], mesh->Points[b], mesh->Points[c]});
      const auto& t = all.back();
      box.emplace_back(t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2]));
    };
    add(q[0], q[1], q[2]);
    if (q[3] >= 0)
    {
      add(q[0], q[2], q[3]);
    }
  }
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return box[a].first.z() < box[b].first.z(); });
  int count = 0;
  for (std::size_t a = 0; a < all.size(); ++a)
  {
    const std::size_t i = order[a];
    for (std::size_t b = a + 1; b < all.size(); ++b)
    {
      const std::size_t j = order[b];
      if (box[j].first.z() > box[i].second.z())
      {
        break;
      }
      if ((box[i].first.array() > box[j].second.array()).any() ||
          (box[j].first.array() > box[i].second.array()).any())
      {
        continue;
      }
      bool touch = false;
      for (const bsr::Vec3& p : all[i])
      {
        for (const bsr::Vec3& q : all[j])
        {
          touch = touch || (p - q).norm() < 1e-9;
        }
      }
      for (int k = 0; k < 3 && !touch; ++k)
      {
        if (pierces(all[i][k], all[i][(k + 1) % 3], all[j]) ||
            pierces(all[j][k], all[j][(k + 1) % 3], all[i]))
        {
          ++count;
          break;
        }
      }
    }
  }
  return count;
}
} // namespace bsrtest

#endif
