#include "Layout/ParametrizedLayout.h"

#include "Common/Parallel.h"
#include "Common/UnionFind.h"
#include "Layout/CapDisc.h"
#include "Layout/CleanLayout.h"
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
constexpr double GoodCost = 8.0; ///< no other field is tried then

/// Side of a grid cell wanted in each triangle.
std::vector<double> cellsOf(const TriangleSurface& s, const Sizing& sizing, double cell)
{
  std::vector<double> cells(s.Region.size(), cell);
  parallelFor(0, s.faces(), 256,
    [&](std::int64_t first, std::int64_t last)
    {
      for (auto f = static_cast<Index>(first); f < last; ++f)
      {
        const auto c = s.corners(f);
        cells[f] = sizing.side((s.Points[c[0]] + s.Points[c[1]] + s.Points[c[2]]) / 3.0, cell);
      }
    });
  return cells;
}

/// Is every piece of a region other than 0 a disc?
bool regionsAreDiscs(const TriangleSurface& s)
{
  UnionFind pieces(s.faces());
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    if (s.Region[h / 3] == s.Region[s.Opposite[h] / 3])
    {
      pieces.join(h / 3, s.Opposite[h] / 3);
    }
  }
  std::vector<int> euler(s.Region.size(), 0);
  for (Index f = 0; f < s.faces(); ++f)
  {
    ++euler[pieces.find(f)];
  }
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    const std::int64_t mine = pieces.find(h / 3);
    euler[mine] -= h < s.Opposite[h] || pieces.find(s.Opposite[h] / 3) != mine;
  }
  std::vector<std::int64_t> seen;
  for (Index v = 0; v < s.vertices(); ++v)
  {
    seen.clear();
    s.around(v, [&](Index h) { seen.push_back(pieces.find(h / 3)); });
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    for (std::int64_t piece : seen)
    {
      ++euler[piece];
    }
  }
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (s.Region[f] > 0 && pieces.find(f) == f && euler[f] != 1)
    {
      return false;
    }
  }
  return true;
}

/// The layout of a map: extraction, repair, caps, check. No quads if it is not valid.
LayoutDraft layoutOf(const GridMap& map, int euler)
{
  std::vector<std::vector<Index>> borders;
  std::vector<Index> regions;
  LayoutDraft draft = extractQuads(map, borders, regions);
  for (std::size_t i = 0; i < borders.size() && !draft.Mesh.Quads.empty(); ++i)
  {
    std::reverse(borders[i].begin(), borders[i].end());
    if (regions[i] != TriangleSurface::HoleRegion && !capDisc(draft, borders[i], regions[i]))
    {
      return {};
    }
  }
  if (draft.Mesh.Quads.empty())
  {
    return {};
  }
  cleanLayout(draft);
  const LayoutReport report = checkLayout(draft.Mesh);
  return report.Valid && report.Euler == euler && report.MaxValence <= 8 ? draft : LayoutDraft{};
}

LayoutDraft tryCells(GridMapper& mapper, const std::vector<double>& cells, int euler)
{
  LayoutDraft draft;
  mapper.run(cells,
    [&](const GridMap& map)
    {
      draft = layoutOf(map, euler);
      return !draft.Mesh.Quads.empty();
    });
  return draft;
}
} // namespace

double layoutCost(const LayoutDraft& draft, const LayoutReport& report, const TriangleSurface& s,
  const ReferenceSurface& reference, int wanted)
{
  const auto got = static_cast<double>(draft.Mesh.Quads.size());
  const double miss = std::abs(std::log(got / wanted));
  const double cell = std::sqrt(s.area() / wanted);
  const double off = layoutDistance(draft.Mesh, s, reference).Maximum / cell;
  return report.MeanAngleDeviation + 60.0 * std::max(0.0, 0.4 - report.MinJacobian) +
         3.3 * report.Irregular / std::sqrt(static_cast<double>(wanted)) +
         60.0 * std::max(0.0, miss - 0.07) + 20.0 * std::max(0.0, off - 0.8) +
         50.0 * report.Flipped + 5.0 * std::max(0, report.MaxValence - 6);
}

Result<LayoutDraft> parametrizedLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, int quads, int seed, Monitor& monitor)
{
  const double cell0 = sizing.cellFor(quads);
  TriangleSurface fine = s;
  SubMonitor remeshing(monitor, 0.0, 0.3);
  const double edge = std::sqrt(4.0 / std::sqrt(3.0) / TrianglesPerQuad);
  const auto length = [&](const Vec3& p) { return edge * sizing.side(p, cell0); };
  if (Status status = remesh(fine, reference, length, 5, remeshing); !status)
  {
    return status;
  }
  std::vector<std::uint8_t> inside(fine.Region.size());
  const bool discs = regionsAreDiscs(fine);
  for (std::size_t f = 0; f < inside.size(); ++f)
  {
    inside[f] = discs ? fine.Region[f] == 0 : fine.Region[f] != TriangleSurface::HoleRegion;
  }
  const int euler = s.eulerCharacteristic();
  LayoutDraft best;
  double bestCost = std::numeric_limits<double>::infinity();
  int failed = 0;
  const std::array<double, 3> curvature = {1.0, 0.2, 5.0};
  for (std::size_t i = 0; i < curvature.size() && bestCost > GoodCost; ++i)
  {
    monitor.progress(0.3 + 0.7 * i / curvature.size());
    CrossFieldOptions options;
    options.Size = cell0;
    options.Curvature = curvature[(i + static_cast<std::size_t>(std::abs(seed))) % 3];
    QuietMonitor quiet(monitor);
    const CrossField field = crossField(fine, inside, options, quiet);
    GridMapper mapper(fine, field, quiet);
    double cell = cell0;
    for (int attempt = 0; attempt < 3; ++attempt)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      LayoutDraft draft = tryCells(mapper, cellsOf(fine, sizing, cell), euler);
      const auto got = static_cast<int>(draft.Mesh.Quads.size());
      if (got == 0)
      {
        if (best.Mesh.Quads.empty() && ++failed > 3)
        {
          return best; // there is no room for a map
        }
        cell *= 0.93;
        continue;
      }
      if (Status status = relaxLayout(draft, reference, 40, quiet); !status)
      {
        return status;
      }
      const LayoutReport report = checkLayout(draft.Mesh);
      const double cost = layoutCost(draft, report, s, reference, quads);
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
