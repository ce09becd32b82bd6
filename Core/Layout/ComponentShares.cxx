#include "Layout/ComponentShares.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace bsr
{
namespace
{
constexpr double MostHeld = 0.8; ///< of the quads go to components whatever their area

/// The least of each component if all should get `floor` quads.
std::vector<int> floors(const std::vector<ComponentSize>& components, int floor)
{
  std::vector<int> out;
  out.reserve(components.size());
  for (const ComponentSize& c : components)
  {
    out.push_back(std::max(c.Least, floor));
  }
  return out;
}
} // namespace

std::vector<int> componentShares(const std::vector<ComponentSize>& components, int quads)
{
  const auto n = static_cast<double>(components.size());
  int floor = static_cast<int>(std::clamp(0.3 * quads / n, 6.0, 24.0));
  std::vector<int> out = floors(components, floor);
  while (components.size() > 1 && floor > 1 &&
         std::accumulate(out.begin(), out.end(), std::int64_t{0}) > MostHeld * quads)
  {
    out = floors(components, --floor);
  }
  // Those whose area is worth less than their floor get that; the others share what is left.
  std::vector<std::uint8_t> held(components.size(), 0);
  for (bool changed = true; changed;)
  {
    changed = false;
    double left = quads;
    double area = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i)
    {
      left -= held[i] != 0 ? out[i] : 0;
      area += held[i] != 0 ? 0.0 : components[i].Area;
    }
    const double density = std::max(left, 0.0) / std::max(area, 1e-300);
    for (std::size_t i = 0; i < out.size(); ++i)
    {
      if (held[i] == 0 && density * components[i].Area < out[i])
      {
        held[i] = 1;
        changed = true;
      }
    }
    for (std::size_t i = 0; i < out.size() && !changed; ++i)
    {
      if (held[i] == 0)
      {
        out[i] = std::max(out[i], static_cast<int>(std::lround(density * components[i].Area)));
      }
    }
  }
  return out;
}
} // namespace bsr
