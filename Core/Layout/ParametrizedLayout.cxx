#include "Layout/ParametrizedLayout.h"

#include "Layout/CapDisc.h"
#include "Layout/CrossField.h"
#include "Layout/ExtractQuads.h"
#include "Layout/GridMap.h"
#include "Layout/RelaxLayout.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double TrianglesPerQuad = 24.0;

/// One try: extraction, caps, check.
LayoutDraft tryField(const TriangleSurface& s, const CrossField& field, double cell, int euler)
{
  std::vector<std::vector<Index>> borders;
  std::vector<Index> regions;
  const GridMap map = gridMap(s, field, cell);
  LayoutDraft draft = extractQuads(map, borders, regions);
  if (draft.Mesh.Quads.empty())
  {
    return {};
  }
  for (std::size_t i = 0; i < borders.size(); ++i)
  {
    std::reverse(borders[i].begin(), borders[i].end());
    if (regions[i] != TriangleSurface::HoleRegion && !capDisc(draft, borders[i], regions[i]))
    {
      return {};
    }
  }
  const LayoutReport report = checkLayout(draft.Mesh);
  return report.Valid && report.Euler == euler && report.MaxValence <= 8 ? draft : LayoutDraft{};
}
} // namespace

double layoutCost(const LayoutReport& report, int wanted, int got)
{
  const double miss = std::abs(std::log(static_cast<double>(got) / wanted));
  return report.MeanAngleDeviation + 60.0 * std::max(0.0, 0.4 - report.MinJacobian) +
         10.0 * report.Irregular / std::sqrt(static_cast<double>(wanted)) / 3.0 +
         100.0 * std::max(0.0, miss - 0.08) + 50.0 * report.Flipped;
}

Result<LayoutDraft> parametrizedLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  int quads, int seed, Monitor& monitor)
{
  const double area = s.area();
  const double cell0 = std::sqrt(area / quads);
  TriangleSurface fine = s;
  SubMonitor remeshing(monitor, 0.0, 0.3);
  const double edge = cell0 * std::sqrt(4.0 / std::sqrt(3.0) / TrianglesPerQuad);
  if (Status status = remesh(fine, reference, edge, 5, remeshing); !status)
  {
    return status;
  }
  std::vector<std::uint8_t> inside(fine.Region.size());
  for (std::size_t f = 0; f < inside.size(); ++f)
  {
    inside[f] = fine.Region[f] == 0;
  }
  const int euler = s.eulerCharacteristic();
  LayoutDraft best;
  double bestCost = std::numeric_limits<double>::infinity();
  const std::array<double, 3> curvature = {1.0, 0.2, 5.0};
  for (std::size_t i = 0; i < curvature.size(); ++i)
  {
    monitor.progress(0.3 + 0.7 * i / curvature.size());
    CrossFieldOptions options;
    options.Size = cell0;
    options.Curvature = curvature[(i + static_cast<std::size_t>(std::abs(seed))) % 3];
    const CrossField field = crossField(fine, inside, options);
    double cell = cell0;
    for (int attempt = 0; attempt < 2; ++attempt)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      LayoutDraft draft = tryField(fine, field, cell, euler);
      const auto got = static_cast<int>(draft.Mesh.Quads.size());
      if (got == 0)
      {
        cell *= 0.93;
        continue;
      }
      Monitor quiet;
      if (Status status = relaxLayout(draft, reference, 40, quiet); !status)
      {
        return status;
      }
      const LayoutReport report = checkLayout(draft.Mesh);
      const double cost = layoutCost(report, quads, got);
      if (cost < bestCost)
      {
        bestCost = cost;
        best = std::move(draft);
      }
      if (std::abs(got - quads) <= 0.05 * quads)
      {
        break;
      }
      cell *= std::sqrt(static_cast<double>(got) / quads);
    }
  }
  return best;
}
} // namespace bsr
