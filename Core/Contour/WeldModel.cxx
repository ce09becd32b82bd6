#include "Contour/WeldModel.h"

#include "Common/UnionFind.h"
#include "Spline/Topology.h"

#include <algorithm>

namespace bsr
{
namespace
{
std::int64_t sidePoint(const SplinePatch& p, int side, std::int64_t k)
{
  return p.FirstControlPoint + gridSideIndex({p.CountU, p.CountV}, side, k);
}

std::int64_t sideCount(const SplinePatch& p, int side)
{
  return side % 2 == 0 ? p.CountU : p.CountV;
}
} // namespace

double weldModel(SplineModel& model)
{
  UnionFind sets(static_cast<std::int64_t>(model.ControlPoints.size()));
  for (std::size_t i = 0; i < model.Patches.size(); ++i)
  {
    for (int s = 0; s < 4; ++s)
    {
      const SideMatch m = matchSide(model, static_cast<std::int64_t>(i), s);
      const std::int64_t n = sideCount(model.Patches[i], s);
      if (m.Patch < 0 || sideCount(model.Patches[m.Patch], m.Side) != n)
      {
        continue;
      }
      for (std::int64_t k = 0; k < n; ++k)
      {
        sets.join(sidePoint(model.Patches[i], s, k),
          sidePoint(model.Patches[m.Patch], m.Side, m.Reversed ? n - 1 - k : k));
      }
    }
  }
  double moved = 0.0;
  for (std::size_t i = 0; i < model.ControlPoints.size(); ++i)
  {
    const Vec4& owner = model.ControlPoints[sets.find(static_cast<std::int64_t>(i))];
    moved = std::max(moved, (owner - model.ControlPoints[i]).head<3>().norm());
    model.ControlPoints[i] = owner;
  }
  return moved;
}
} // namespace bsr
