#include "Mesh/SpatialOrder.h"

#include "Common/Parallel.h"

#include <Eigen/Geometry>

#include <numeric>

namespace bsr
{
namespace
{
constexpr int Bits = 16; ///< of each coordinate

/// Spreads the low bits of x so that two zeros follow each.
std::uint64_t spread(std::uint64_t x)
{
  x = (x | (x << 32)) & 0x1f00000000ffffULL;
  x = (x | (x << 16)) & 0x1f0000ff0000ffULL;
  x = (x | (x << 8)) & 0x100f00f00f00f00fULL;
  x = (x | (x << 4)) & 0x10c30c30c30c30c3ULL;
  return (x | (x << 2)) & 0x1249249249249249ULL;
}

/// Old index of each new vertex; none if cancelled.
std::vector<Index> curveOrder(const TriangleSurface& s, double shift, Monitor& monitor)
{
  Eigen::AlignedBox3d box;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    if (!s.Virtual[v])
    {
      box.extend(s.Points[v]);
    }
  }
  const double size = std::max(box.diagonal().maxCoeff(), 1e-300);
  const double scale = ((1 << Bits) - 1) / ((1.0 + shift) * size);
  const Vec3 origin = box.min() - Vec3::Constant(shift * size);
  std::vector<std::pair<std::uint64_t, Index>> keys(s.Points.size());
  const bool all = parallelForUntilCancelled(0, s.vertices(), 4096, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t v = first; v < last; ++v)
      {
        std::uint64_t code = ~std::uint64_t{0};
        if (!s.Virtual[v])
        {
          const Vec3 p = scale * (s.Points[v] - origin);
          code = 0;
          for (int k = 0; k < 3; ++k)
          {
            code |= spread(static_cast<std::uint64_t>(std::max(p[k], 0.0))) << k;
          }
        }
        keys[v] = {code, static_cast<Index>(v)};
      }
    });
  if (!all)
  {
    return {};
  }
  parallelSort(keys.begin(), keys.end());
  std::vector<Index> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    order[i] = keys[i].second;
  }
  return order;
}

/// Old index of each new face: by the least of its new vertices.
std::vector<Index> faceOrder(const TriangleSurface& s, const std::vector<Index>& rank)
{
  std::vector<Index> least(s.Region.size());
  std::vector<Index> first(s.Points.size() + 1, 0);
  for (Index f = 0; f < s.faces(); ++f)
  {
    const auto c = s.corners(f);
    least[f] = std::min({rank[c[0]], rank[c[1]], rank[c[2]]});
    ++first[least[f] + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Index> order(s.Region.size());
  for (Index f = 0; f < s.faces(); ++f)
  {
    order[first[least[f]]++] = f;
  }
  return order;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<Index>& order)
{
  std::vector<T> moved(values.size());
  parallelFor(0, static_cast<std::int64_t>(order.size()), 8192,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t i = first; i < last; ++i)
      {
        moved[i] = values[order[i]];
      }
    });
  values.swap(moved);
}

std::vector<Index> inverse(const std::vector<Index>& order)
{
  std::vector<Index> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    rank[order[i]] = static_cast<Index>(i);
  }
  return rank;
}
} // namespace

std::vector<Index> sortAlongCurve(TriangleSurface& s, double shift, Monitor& monitor)
{
  std::vector<Index> vertices = curveOrder(s, shift, monitor);
  if (monitor.cancelled())
  {
    return {};
  }
  const std::vector<Index> vertexRank = inverse(vertices);
  const std::vector<Index> faces = faceOrder(s, vertexRank);
  if (monitor.cancelled())
  {
    return {};
  }
  const std::vector<Index> faceRank = inverse(faces);
  if (monitor.cancelled())
  {
    return {};
  }
  const auto moved = [&](Index h) { return 3 * faceRank[h / 3] + h % 3; };
  std::vector<Index> vertex(s.Vertex.size());
  std::vector<Index> opposite(s.Vertex.size());
  std::vector<std::uint8_t> crease(s.Vertex.size());
  const bool all = parallelForUntilCancelled(0, s.faces(), 4096, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t f = first; f < last; ++f)
      {
        for (int k = 0; k < 3; ++k)
        {
          const std::int64_t from = 3 * static_cast<std::int64_t>(faces[f]) + k;
          vertex[3 * f + k] = vertexRank[s.Vertex[from]];
          opposite[3 * f + k] = moved(s.Opposite[from]);
          crease[3 * f + k] = s.Crease[from];
        }
      }
    });
  if (!all || monitor.cancelled())
  {
    return {};
  }
  s.Vertex.swap(vertex);
  s.Opposite.swap(opposite);
  s.Crease.swap(crease);
  for (Index& h : s.Out)
  {
    h = moved(h);
  }
  permute(s.Region, faces);
  permute(s.Points, vertices);
  permute(s.Out, vertices);
  permute(s.Virtual, vertices);
  return vertices;
}
} // namespace bsr
