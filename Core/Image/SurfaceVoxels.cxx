#include "Image/SurfaceVoxels.h"

#include "Common/MonitoredLoop.h"

#include <cmath>

namespace bsr
{
namespace
{
/// Rows are cut a little beside the voxel centers, where isosurfaces have no vertices.
constexpr double ShiftY = 1.2345e-3;
constexpr double ShiftZ = 2.7183e-3;

struct Crossing
{
  std::int64_t Row;
  float X;
  float Sign; ///< of the x component of the triangle's normal
};

/// Twice the signed area of (a, b, p) in the yz plane, the same but for the sign for (b, a, p).
double side(const TriangleMesh& mesh, Index a, Index b, double y, double z)
{
  const bool swap = b < a;
  const Vec3& p = mesh.Points[swap ? b : a];
  const Vec3& q = mesh.Points[swap ? a : b];
  const double s = (q.y() - p.y()) * (z - p.z()) - (q.z() - p.z()) * (y - p.y());
  return swap ? -s : s;
}

class RowCutter
{
public:
  RowCutter(const TriangleMesh& mesh, const Box& extent) : Mesh(mesh), Extent(extent) {}

  void cut(const std::array<Index, 3>& t)
  {
    Vec3 lo = this->Mesh.Points[t[0]];
    Vec3 hi = lo;
    for (int c = 1; c < 3; ++c)
    {
      lo = lo.cwiseMin(this->Mesh.Points[t[c]]);
      hi = hi.cwiseMax(this->Mesh.Points[t[c]]);
    }
    const auto first = [](double v, double shift)
    { return static_cast<std::int64_t>(std::ceil(v - shift)); };
    const auto last = [](double v, double shift)
    { return static_cast<std::int64_t>(std::floor(v - shift)); };
    const Int3& from = this->Extent.Lo;
    const Int3& size = this->Extent.Size;
    for (std::int64_t k = std::max(first(lo.z(), ShiftZ), from[2]);
         k <= std::min(last(hi.z(), ShiftZ), from[2] + size[2] - 1); ++k)
    {
      for (std::int64_t j = std::max(first(lo.y(), ShiftY), from[1]);
           j <= std::min(last(hi.y(), ShiftY), from[1] + size[1] - 1); ++j)
      {
        this->cutRow(t, j, k);
      }
    }
  }

  std::vector<Crossing> Crossings;

private:
  void cutRow(const std::array<Index, 3>& t, std::int64_t j, std::int64_t k)
  {
    const double y = static_cast<double>(j) + ShiftY;
    const double z = static_cast<double>(k) + ShiftZ;
    const double w0 = side(this->Mesh, t[1], t[2], y, z);
    const double w1 = side(this->Mesh, t[2], t[0], y, z);
    const double w2 = side(this->Mesh, t[0], t[1], y, z);
    const double sum = w0 + w1 + w2;
    if (sum == 0.0 || w0 * sum < 0.0 || w1 * sum < 0.0 || w2 * sum < 0.0)
    {
      return;
    }
    const auto& p = this->Mesh.Points;
    const double x = (w0 * p[t[0]].x() + w1 * p[t[1]].x() + w2 * p[t[2]].x()) / sum;
    this->Crossings.push_back(
      {(j - this->Extent.Lo[1]) + this->Extent.Size[1] * (k - this->Extent.Lo[2]),
        static_cast<float>(x), sum > 0.0 ? 1.0f : -1.0f});
  }

  const TriangleMesh& Mesh;
  const Box& Extent;
};

/// Sign of the crossings where a row enters the object: the first of most rows cut evenly often.
float enteringSign(const std::vector<Crossing>& crossings)
{
  std::int64_t votes = 0;
  for (std::size_t a = 0, b = 0; a < crossings.size(); a = b)
  {
    for (b = a; b < crossings.size() && crossings[b].Row == crossings[a].Row; ++b)
    {
    }
    if ((b - a) % 2 == 0 && crossings[a].Sign != crossings[b - 1].Sign)
    {
      votes += crossings[a].Sign > 0.0f ? 1 : -1;
    }
  }
  return votes > 0 ? 1.0f : -1.0f;
}

/// Fills a row between its crossings; `lo` and `hi` bound the surface along x.
void fillRow(const Crossing* a, const Crossing* b, float entering, double lo, double hi,
  const Box& extent, std::uint8_t* row)
{
  const auto fill = [&](double from, double to)
  {
    const std::int64_t i0 =
      std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(from)) - extent.Lo[0], 0);
    const std::int64_t i1 = std::min<std::int64_t>(
      static_cast<std::int64_t>(std::floor(to)) - extent.Lo[0] + 1, extent.Size[0]);
    std::fill(row + i0, row + std::max(i0, i1), std::uint8_t{1});
  };
  bool inside = a->Sign != entering;
  double start = lo;
  for (const Crossing* c = a; c != b; ++c)
  {
    if (c->Sign == entering && !inside)
    {
      start = c->X;
      inside = true;
    }
    else if (c->Sign != entering && inside)
    {
      fill(start, c->X);
      inside = false;
    }
  }
  if (inside)
  {
    fill(start, hi);
  }
}
} // namespace

Result<Volume<std::uint8_t>> voxelizeSurface(
  const TriangleMesh& surface, const Box& extent, const Double3& spacing, Monitor& monitor)
{
  if (surface.Triangles.empty() || extent.empty())
  {
    return Status::invalidInput("The surface has no triangles. Contour the raw image first.");
  }
  RowCutter cutter(surface, extent);
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    if (t % 65536 == 0 && monitor.cancelled())
    {
      return Status::cancelled();
    }
    cutter.cut(surface.Triangles[t]);
  }
  auto& crossings = cutter.Crossings;
  std::sort(crossings.begin(), crossings.end(),
    [](const Crossing& a, const Crossing& b) {
      return a.Row != b.Row ? a.Row < b.Row : a.X != b.X ? a.X < b.X : a.Sign < b.Sign;
    });
  double lo = surface.Points[surface.Triangles[0][0]].x();
  double hi = lo;
  for (const Vec3& p : surface.Points)
  {
    lo = std::min(lo, p.x());
    hi = std::max(hi, p.x());
  }
  Volume<std::uint8_t> mask(extent, spacing);
  std::fill(mask.Data.get(), mask.Data.get() + extent.volume(), std::uint8_t{0});
  const float entering = enteringSign(crossings);
  for (std::size_t a = 0, b = 0; a < crossings.size(); a = b)
  {
    for (b = a; b < crossings.size() && crossings[b].Row == crossings[a].Row; ++b)
    {
    }
    fillRow(&crossings[a], crossings.data() + b, entering, lo, hi, extent,
      mask.Data.get() + crossings[a].Row * extent.Size[0]);
  }
  return mask;
}
} // namespace bsr
