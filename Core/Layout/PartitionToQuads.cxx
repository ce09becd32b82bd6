#include "Layout/PartitionToQuads.h"
#include "Common/Parallel.h"
#include "Layout/NearestQuad.h"

#include <cmath>

namespace bsr
{
namespace
{
Status checkQuads(const QuadMesh& mesh)
{
  if (mesh.Quads.empty())
  {
    return Status::invalidInput("The layout has no quads; connect the output of QuadRemesh.");
  }
  const auto n = static_cast<Index>(mesh.Points.size());
  for (std::size_t i = 0; i < mesh.Quads.size(); ++i)
  {
    const auto& q = mesh.Quads[i];
    for (int k = 0; k < 4; ++k)
    {
      if (q[k] < 0 || q[k] >= n || q[k] == q[(k + 1) % 4] || q[k] == q[(k + 2) % 4])
      {
        return Status::invalidInput("Quad " + std::to_string(i) +
                                    " of the layout has a missing or repeated corner; use a pure "
                                    "quad mesh, as QuadRemesh makes.");
      }
      if (!mesh.Points[q[k]].allFinite())
      {
        return Status::invalidInput(
          "Point " + std::to_string(q[k]) + " of the layout has a NaN or infinite coordinate.");
      }
    }
  }
  return Status::ok();
}

Status check(
  const std::vector<Vec3>& points, const QuadMesh& quads, const PartitionOptions& options)
{
  if (points.empty())
  {
    return Status::invalidInput("There is no point to partition; check the filters above.");
  }
  if (!options.Facing.empty() && options.Facing.size() != points.size())
  {
    return Status::invalidParameter("The number of normals differs from the number of points.");
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (!points[i].allFinite())
    {
      return Status::invalidInput(
        "Point " + std::to_string(i) + " has a NaN or infinite coordinate; remove such points.");
    }
  }
  return checkQuads(quads);
}

/// -1 where the quads enclose a negative volume (inside out), else 1.
double orientationOf(const QuadMesh& mesh)
{
  const Vec3& apex = mesh.Points[mesh.Quads[0][0]];
  double volume = 0.0;
  for (const auto& q : mesh.Quads)
  {
    const Vec3 diagonal = mesh.Points[q[2]] - mesh.Points[q[0]];
    const Vec3 other = mesh.Points[q[3]] - mesh.Points[q[1]];
    volume += (mesh.Points[q[0]] + mesh.Points[q[2]] - 2.0 * apex).dot(diagonal.cross(other));
  }
  return volume < 0.0 ? -1.0 : 1.0;
}

void locate(const NearestQuad& nearest, const std::vector<Vec3>& points,
  const std::vector<Vec3>& facing, double sign, std::int64_t begin, std::int64_t end,
  Partition& out)
{
  Index hint = -1;
  for (std::int64_t i = begin; i < end; ++i)
  {
    QuadHit hit;
    if (!facing.empty() && facing[i].squaredNorm() > 0.0)
    {
      hit = nearest.findFacing(points[i], sign * facing[i], hint);
    }
    if (hit.Quad < 0)
    {
      hit = nearest.find(points[i], hint);
    }
    hint = hit.Quad;
    out.QuadId[i] = hit.Quad;
    out.UV[i] = hit.UV;
    out.Distance[i] = std::sqrt(hit.SquaredDistance);
  }
}

void summarize(std::int64_t quads, Partition& out)
{
  std::vector<char> used(static_cast<std::size_t>(quads), 0);
  double sum = 0.0;
  for (std::size_t i = 0; i < out.QuadId.size(); ++i)
  {
    used[out.QuadId[i]] = 1;
    sum += out.Distance[i] * out.Distance[i];
    out.Max = std::max(out.Max, out.Distance[i]);
  }
  out.EmptyQuads = std::count(used.begin(), used.end(), 0);
  out.RMS = std::sqrt(sum / static_cast<double>(out.QuadId.size()));
}
} // namespace

Result<Partition> partitionToQuads(const std::vector<Vec3>& points, const QuadMesh& quads,
  const PartitionOptions& options, Monitor& monitor)
{
  if (Status s = check(points, quads, options); !s)
  {
    return s;
  }
  const NearestQuad nearest(quads);
  const double sign = orientationOf(quads);
  Partition out;
  out.QuadId.resize(points.size());
  out.UV.resize(points.size());
  out.Distance.resize(points.size());
  const auto n = static_cast<std::int64_t>(points.size());
  const std::int64_t block = 100000;
  for (std::int64_t first = 0; first < n; first += block)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    monitor.progress(static_cast<double>(first) / static_cast<double>(n));
    parallelFor(first, std::min(first + block, n), 1000,
      [&](std::int64_t begin, std::int64_t end)
      { locate(nearest, points, options.Facing, sign, begin, end, out); });
  }
  summarize(nearest.size(), out);
  monitor.progress(1.0);
  return out;
}
} // namespace bsr
