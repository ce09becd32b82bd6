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
#include <queue>

namespace bsr
{
namespace
{
constexpr double TrianglesPerQuad = 24.0;
constexpr double FewerTriangles = 16.0; ///< a quad, of many to be made coarser
constexpr double GoodCost = 8.0;        ///< no other field is tried then
constexpr int MostCompared = 1500; ///< quads more, of a layout to be made coarser, are not compared
constexpr int MostAttempts = 5;    ///< with each field
constexpr int MostFailures = 4;    ///< before the first layout
constexpr double Shrink = 0.6;     ///< of cells where a map folds
constexpr double Around = 2.0;     ///< cells around a fold that shrink
constexpr double Crowded = 0.8;    ///< singular vertices a quad that leave no room for a map
constexpr double Hopeless = 0.08;  ///< share of triangles that fold: a finer map would, too

/// Side of a grid cell wanted in each triangle; incomplete once cancelled.
std::vector<double> cellsOf(
  const TriangleSurface& s, const Sizing& sizing, double cell, Monitor& monitor)
{
  std::vector<double> cells(s.Region.size(), cell);
  parallelForUntilCancelled(0, s.faces(), 256, monitor,
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

/// Is every piece of a region other than 0 a disc with region 0 all around?
bool regionsAreDiscs(const TriangleSurface& s)
{
  UnionFind pieces(s.faces());
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    const Index region = s.Region[h / 3];
    const Index other = s.Region[s.Opposite[h] / 3];
    if (region == other)
    {
      pieces.join(h / 3, s.Opposite[h] / 3);
    }
    else if (region != 0 && other != 0 && (region > 0 || other > 0))
    {
      return false;
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
LayoutDraft layoutOf(const GridMap& map, int euler, Monitor& monitor)
{
  std::vector<std::vector<Index>> borders;
  std::vector<Index> regions;
  LayoutDraft draft = extractQuads(map, borders, regions, monitor);
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

/// A map's layout, if it has a valid one, and where the map is squeezed.
struct Trial
{
  LayoutDraft Draft;
  std::vector<Index> Squeezed; ///< triangles turned over or nearly so
};

std::vector<Index> squeezed(const GridMap& map, const std::vector<double>& cells)
{
  const TriangleSurface& s = map.Surface;
  std::vector<Index> bad;
  for (Index f = 0; f < s.faces(); ++f)
  {
    const Vec2 a = map.UV[3 * f + 1] - map.UV[3 * f];
    const Vec2 b = map.UV[3 * f + 2] - map.UV[3 * f];
    const double wished = 2.0 * s.areaNormal(f).norm() / (cells[f] * cells[f]);
    if (map.Inside[f] && a[0] * b[1] - a[1] * b[0] < 0.05 * wished)
    {
      bad.push_back(f);
    }
  }
  return bad;
}

Trial tryCells(GridMapper& mapper, const std::vector<double>& cells, int euler, Monitor& monitor)
{
  Trial trial;
  mapper.run(cells,
    [&](const GridMap& map)
    {
      trial.Squeezed = squeezed(map, cells);
      trial.Draft = layoutOf(map, euler, monitor);
      return !trial.Draft.Mesh.Quads.empty();
    });
  return trial;
}

/// Multiplies values of triangles by Shrink at the given ones, and less up to `reach` from them.
void shrinkAround(const TriangleSurface& s, const std::vector<Index>& triangles, double reach,
  std::vector<double>& values)
{
  const auto middle = [&](Index f)
  {
    const auto c = s.corners(f);
    return Vec3((s.Points[c[0]] + s.Points[c[1]] + s.Points[c[2]]) / 3.0);
  };
  using Step = std::pair<double, Index>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
  std::vector<double> distance(values.size(), reach);
  for (Index f : triangles)
  {
    distance[f] = 0.0;
    queue.emplace(0.0, f);
  }
  while (!queue.empty())
  {
    const auto [d, f] = queue.top();
    queue.pop();
    if (d > distance[f])
    {
      continue;
    }
    values[f] *= Shrink + (1.0 - Shrink) * d / reach;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index g = s.Opposite[h] / 3;
      const double there = s.hole(g) ? reach : d + (middle(f) - middle(g)).norm();
      if (there < distance[g])
      {
        distance[g] = there;
        queue.emplace(there, g);
      }
    }
  }
}
} // namespace

double layoutCost(const LayoutDraft& draft, const LayoutReport& report, const TriangleSurface& s,
  const ReferenceSurface& reference, int wanted, Monitor& monitor)
{
  const auto got = static_cast<double>(draft.Mesh.Quads.size());
  const double miss = std::abs(std::log(got / wanted));
  const double cell = std::sqrt(s.area() / wanted);
  const double off = layoutDistance(draft.Mesh, s, reference, {}, monitor).Maximum / cell;
  return report.MeanAngleDeviation + 60.0 * std::max(0.0, 0.4 - report.MinJacobian) +
         3.3 * report.Irregular / std::sqrt(static_cast<double>(wanted)) +
         60.0 * std::max(0.0, miss - 0.07) + 20.0 * std::max(0.0, off - 0.8) +
         50.0 * report.Flipped + 5.0 * std::max(0, report.MaxValence - 6);
}

Result<ParametrizedLayout> parametrizedLayout(const TriangleSurface& s,
  const ReferenceSurface& reference, const Sizing& sizing, const ParametrizedOptions& options,
  Monitor& monitor)
{
  const int quads = options.Quads;
  const double cell0 = sizing.cellFor(quads);
  TriangleSurface fine = s;
  SubMonitor remeshing(monitor, 0.0, 0.3);
  const bool fewer = options.ToCoarsen && quads > MostCompared;
  const double density = fewer ? FewerTriangles : TrianglesPerQuad;
  const double edge = std::sqrt(4.0 / std::sqrt(3.0) / density);
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
  ParametrizedLayout best;
  double bestCost = std::numeric_limits<double>::infinity();
  int failed = 0;
  const std::array<double, 3> curvature = {1.0, 0.2, 5.0};
  for (std::size_t i = 0; i < curvature.size() && bestCost > GoodCost; ++i)
  {
    monitor.progress(0.3 + 0.7 * i / curvature.size());
    CrossFieldOptions crosses;
    crosses.Size = cell0;
    crosses.Curvature = curvature[(i + static_cast<std::size_t>(std::abs(options.Seed))) % 3];
    QuietMonitor quiet(monitor);
    const CrossField field = crossField(fine, inside, crosses, quiet);
    const int most = static_cast<int>(Crowded * quads) + 24;
    GridMapper mapper(fine, field, most, quiet);
    if (mapper.singular() > most)
    {
      continue;
    }
    double cell = cell0;
    std::vector<double> share(fine.Region.size(), 1.0); // of the cells, where they had to shrink
    for (int attempt = 0; attempt < MostAttempts; ++attempt)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      std::vector<double> cells = cellsOf(fine, sizing, cell, quiet);
      std::transform(cells.begin(), cells.end(), share.begin(), cells.begin(), std::multiplies<>());
      Trial trial = tryCells(mapper, cells, euler, quiet);
      LayoutDraft& draft = trial.Draft;
      const auto got = static_cast<int>(draft.Mesh.Quads.size());
      if (i == 0 && attempt == 0)
      {
        best.Folds = static_cast<int>(trial.Squeezed.size());
        best.Hopeless = got == 0 && best.Folds > options.MostFolds;
        if (best.Hopeless)
        {
          return best;
        }
      }
      if (got == 0)
      {
        const auto folds = static_cast<double>(trial.Squeezed.size());
        best.Hopeless =
          best.Draft.Mesh.Quads.empty() && folds > Hopeless * static_cast<double>(fine.faces());
        if (best.Draft.Mesh.Quads.empty() && (++failed > MostFailures || best.Hopeless))
        {
          return best; // there is no room for a map
        }
        if (trial.Squeezed.empty())
        {
          cell *= 0.93;
        }
        else
        {
          shrinkAround(fine, trial.Squeezed, Around * cell, share);
        }
        continue;
      }
      if (Status status = relaxLayout(draft, reference, 40, quiet); !status)
      {
        return status;
      }
      if (options.ToCoarsen && quads > MostCompared)
      {
        best.Draft = std::move(draft);
        return best;
      }
      const LayoutReport report = checkLayout(draft.Mesh);
      const double cost = layoutCost(draft, report, s, reference, quads, quiet);
      if (cost < bestCost)
      {
        bestCost = cost;
        best.Draft = std::move(draft);
      }
      if (options.ToCoarsen || std::abs(got - quads) <= 0.05 * quads)
      {
        break;
      }
      cell *= std::sqrt(static_cast<double>(got) / quads);
    }
  }
  return best;
}
} // namespace bsr
