#include "Image/DigitalTopology.h"

#include "Common/UnionFind.h"

#include "Common/MonitoredLoop.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace bsr
{
namespace
{
using Mask = ImageView<const std::uint8_t>;

/// The runs of some consecutive rows.
std::vector<LabeledRun> runsOf(
  const Mask& mask, bool foreground, std::int64_t begin, std::int64_t end)
{
  std::vector<LabeledRun> runs;
  const auto nx = static_cast<std::int32_t>(mask.Dims[0]);
  for (std::int64_t row = begin; row < end; ++row)
  {
    const std::uint8_t* p = mask.Data + row * mask.Dims[0];
    std::int32_t i = 0;
    while (i < nx)
    {
      while (i < nx && (p[i] != 0) != foreground)
      {
        ++i;
      }
      const std::int32_t first = i;
      while (i < nx && (p[i] != 0) == foreground)
      {
        ++i;
      }
      if (i > first)
      {
        runs.push_back({row, first, i, 0});
      }
    }
  }
  return runs;
}

/// Joins the runs of two rows that touch; `slack` is 1 where diagonal neighbors count.
void joinRows(const std::vector<LabeledRun>& runs, const std::vector<std::int64_t>& first,
  std::int64_t rowA, std::int64_t rowB, std::int32_t slack, UnionFind& sets)
{
  std::int64_t a = first[rowA];
  std::int64_t b = first[rowB];
  while (a < first[rowA + 1] && b < first[rowB + 1])
  {
    if (runs[a].Begin < runs[b].End + slack && runs[b].Begin < runs[a].End + slack)
    {
      sets.join(a, b);
    }
    if (runs[a].End < runs[b].End)
    {
      ++a;
    }
    else
    {
      ++b;
    }
  }
}

/// Joins every row with its neighbors before it.
bool joinAll(const Mask& mask, Components& c, const std::vector<std::int64_t>& first,
  Connectivity connectivity, UnionFind& sets, Monitor& monitor)
{
  const std::int64_t ny = mask.Dims[1];
  const bool all = connectivity == Connectivity::TwentySix;
  const std::int32_t slack = all ? 1 : 0;
  for (std::int64_t z = 0; z < mask.Dims[2]; ++z)
  {
    if (monitor.cancelled())
    {
      return false;
    }
    for (std::int64_t y = 0; y < ny; ++y)
    {
      const std::int64_t row = y + ny * z;
      if (y > 0)
      {
        joinRows(c.Runs, first, row - 1, row, slack, sets);
      }
      if (z == 0)
      {
        continue;
      }
      joinRows(c.Runs, first, row - ny, row, slack, sets);
      if (all && y > 0)
      {
        joinRows(c.Runs, first, row - ny - 1, row, slack, sets);
      }
      if (all && y + 1 < ny)
      {
        joinRows(c.Runs, first, row - ny + 1, row, slack, sets);
      }
    }
  }
  return true;
}

void number(Components& c, UnionFind& sets)
{
  for (std::size_t i = 0; i < c.Runs.size(); ++i)
  {
    const std::int64_t root = sets.find(static_cast<std::int64_t>(i));
    if (root == static_cast<std::int64_t>(i))
    {
      c.Runs[i].Label = static_cast<std::int64_t>(c.Voxels.size());
      c.Voxels.push_back(0);
    }
    else
    {
      c.Runs[i].Label = c.Runs[root].Label;
    }
    c.Voxels[c.Runs[i].Label] += c.Runs[i].End - c.Runs[i].Begin;
  }
}

/// Eight times the share of a lattice point in the Euler characteristic, for each of the 256
/// states of the eight voxels around it (bit = x + 2 y + 4 z), voxels being closed cubes.
std::array<int, 256> eulerTable()
{
  std::array<int, 256> table{};
  for (int state = 0; state < 256; ++state)
  {
    int sum = state != 0 ? 8 : 0; // the lattice point itself
    for (int axis = 0; axis < 3; ++axis)
    {
      const int a = 1 << axis;
      const int b = 1 << ((axis + 1) % 3);
      const int c = 1 << ((axis + 2) % 3);
      const auto voxel = [state](int corner) { return (state >> corner) & 1; };
      for (int side : {0, a})
      {
        // Half an edge along the axis, shared by four voxels.
        sum -= (voxel(side) | voxel(side | b) | voxel(side | c) | voxel(side | b | c)) ? 4 : 0;
      }
      for (int q : {0, b, c, b | c})
      {
        // A quarter of a face across the axis, shared by two voxels.
        sum += (voxel(q) | voxel(q | a)) ? 2 : 0;
      }
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      sum -= (state >> corner) & 1;
    }
    table[state] = sum;
  }
  return table;
}

/// Sum of the table over one row of lattice points between four rows of voxels (null: outside).
std::int64_t eulerRow(const std::array<const std::uint8_t*, 4>& rows, std::int64_t nx, bool invert,
  const std::array<int, 256>& table)
{
  static const std::array<int, 4> shift{{0, 2, 4, 6}};
  const int flip = invert ? 255 : 0;
  std::int64_t sum = 0;
  int state = 0;
  for (std::int64_t i = 0; i <= nx; ++i)
  {
    state = (state >> 1) & 0x55;
    for (int r = 0; r < 4; ++r)
    {
      const int set = i < nx && rows[r] && rows[r][i] != 0 ? 1 : 0;
      state |= set << (shift[r] + 1);
    }
    sum += table[static_cast<std::size_t>(state ^ flip)];
  }
  return sum;
}
} // namespace

Result<Components> connectedComponents(
  const Mask& mask, bool foreground, Connectivity connectivity, Monitor& monitor)
{
  const std::int64_t rows = mask.Dims[1] * mask.Dims[2];
  if (mask.size() <= 0 || mask.Dims[0] > std::numeric_limits<std::int32_t>::max())
  {
    return Status::invalidInput("The image is empty or too long to be labeled.");
  }
  constexpr std::int64_t Chunk = 256;
  std::vector<std::vector<LabeledRun>> parts(static_cast<std::size_t>((rows + Chunk - 1) / Chunk));
  SubMonitor scan(monitor, 0.0, 0.5);
  if (!monitoredFor(0, static_cast<std::int64_t>(parts.size()), 1, scan,
        [&](std::int64_t begin, std::int64_t end)
        {
          for (std::int64_t p = begin; p < end; ++p)
          {
            parts[p] = runsOf(mask, foreground, p * Chunk, std::min(rows, (p + 1) * Chunk));
          }
        }))
  {
    return Status::cancelled();
  }
  Components c;
  for (auto& part : parts)
  {
    c.Runs.insert(c.Runs.end(), part.begin(), part.end());
    std::vector<LabeledRun>().swap(part);
  }
  std::vector<std::int64_t> first(static_cast<std::size_t>(rows) + 1, 0);
  for (const LabeledRun& r : c.Runs)
  {
    ++first[r.Row + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  UnionFind sets(c.Runs.size());
  if (!joinAll(mask, c, first, connectivity, sets, monitor))
  {
    return Status::cancelled();
  }
  number(c, sets);
  monitor.progress(1.0);
  return c;
}

Result<std::int64_t> keepLargestComponent(
  const ImageView<std::uint8_t>& mask, Connectivity connectivity, Monitor& monitor)
{
  auto found = connectedComponents(mask, true, connectivity, monitor);
  if (!found)
  {
    return found.status();
  }
  const Components& c = *found;
  const auto best = std::max_element(c.Voxels.begin(), c.Voxels.end()) - c.Voxels.begin();
  parallelFor(0, static_cast<std::int64_t>(c.Runs.size()), 4096,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        const LabeledRun& r = c.Runs[i];
        if (r.Label != best)
        {
          std::memset(mask.Data + r.Row * mask.Dims[0] + r.Begin, 0,
            static_cast<std::size_t>(r.End - r.Begin));
        }
      }
    });
  return static_cast<std::int64_t>(c.Voxels.size());
}

std::int64_t eulerCharacteristic(const Mask& mask, Connectivity object)
{
  // A 6-connected object has the Euler characteristic of its complement in the 3-sphere (Alexander
  // duality), a complex of closed cubes; far away its lattice points contribute nothing.
  static const std::array<int, 256> table = eulerTable();
  const bool invert = object == Connectivity::Six;
  const std::int64_t nx = mask.Dims[0];
  const std::int64_t ny = mask.Dims[1];
  const std::int64_t nz = mask.Dims[2];
  const auto row = [&](std::int64_t j, std::int64_t k) -> const std::uint8_t*
  { return j < 0 || k < 0 || j >= ny || k >= nz ? nullptr : mask.row(j, k); };
  const std::int64_t eighths = parallelReduce(
    0, (ny + 1) * (nz + 1), 64, std::int64_t{0},
    [&](std::int64_t begin, std::int64_t end)
    {
      std::int64_t sum = 0;
      for (std::int64_t r = begin; r < end; ++r)
      {
        const std::int64_t j = r % (ny + 1);
        const std::int64_t k = r / (ny + 1);
        sum += eulerRow(
          {{row(j - 1, k - 1), row(j, k - 1), row(j - 1, k), row(j, k)}}, nx, invert, table);
      }
      return sum;
    },
    [](std::int64_t a, std::int64_t b) { return a + b; });
  return eighths / 8;
}

Result<BettiNumbers> bettiNumbers(const Mask& mask, Connectivity object, Monitor& monitor)
{
  const Connectivity other =
    object == Connectivity::Six ? Connectivity::TwentySix : Connectivity::Six;
  SubMonitor first(monitor, 0.0, 0.4);
  SubMonitor second(monitor, 0.4, 0.8);
  auto inside = connectedComponents(mask, true, object, first);
  if (!inside)
  {
    return inside.status();
  }
  auto outside = connectedComponents(mask, false, other, second);
  if (!outside)
  {
    return outside.status();
  }
  // Background components that reach the border are one with what lies beyond it.
  std::vector<char> open(outside->Voxels.size(), 0);
  for (const LabeledRun& r : outside->Runs)
  {
    const std::int64_t j = r.Row % mask.Dims[1];
    const std::int64_t k = r.Row / mask.Dims[1];
    if (r.Begin == 0 || r.End == mask.Dims[0] || j == 0 || j == mask.Dims[1] - 1 || k == 0 ||
        k == mask.Dims[2] - 1)
    {
      open[r.Label] = 1;
    }
  }
  BettiNumbers b;
  b.Components = static_cast<std::int64_t>(inside->Voxels.size());
  b.Cavities = std::count(open.begin(), open.end(), 0);
  b.Tunnels = b.Components + b.Cavities - eulerCharacteristic(mask, object);
  monitor.progress(1.0);
  return b;
}
} // namespace bsr
