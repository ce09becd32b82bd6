#include "Common/UnionFind.h"
#include "Spline/PatchImprover.h"

namespace bsr
{
namespace
{
/// Strip of patches that an edge of the layout lies across: edges on opposite sides of a quad
/// belong to one.
std::vector<Index> stripsOf(const QuadComplex& complex)
{
  UnionFind sets(complex.edges());
  for (Index f = 0; f < complex.faces(); ++f)
  {
    for (int k = 0; k < 2; ++k)
    {
      sets.join(complex.edgeOf(4 * f + k), complex.edgeOf(4 * f + k + 2));
    }
  }
  std::vector<Index> strip(complex.edges());
  for (Index e = 0; e < complex.edges(); ++e)
  {
    strip[e] = static_cast<Index>(sets.find(e));
  }
  return strip;
}

/// Neighbors get the same bits: those of the edge's first half-edge.
void shareSides(const QuadComplex& complex, std::vector<RationalPatch>& patches)
{
  for (Index e = 0; e < complex.edges(); ++e)
  {
    const QuadEdge& edge = complex.edge(e);
    if (edge.Second < 0)
    {
      continue;
    }
    RationalPatch& from = patches[edge.First / 4];
    RationalPatch& to = patches[edge.Second / 4];
    const int n = sideCount(from, edge.First % 4);
    for (int c = 1; c < n - 1; ++c)
    {
      to.ControlPoints[sideIndex(to, edge.Second % 4, n - 1 - c)] =
        from.ControlPoints[sideIndex(from, edge.First % 4, c)];
    }
  }
}
} // namespace

Status refineShells(const ShellLayout& layout, std::vector<RationalShell>& shells,
  const std::vector<const ShellFitResult*>& fits, const std::vector<ShellFitOptions>& options,
  const RationalOptions& rational, Monitor& monitor)
{
  const QuadComplex& complex = *layout.Complex;
  const auto strips = stripsOf(complex);
  for (int factor = 2; factor <= rational.MaximumRefinement; factor *= 2)
  {
    std::vector<char> cut(complex.edges(), 0); // by strip
    bool any = false;
    for (const RationalShell& shell : shells)
    {
      for (Index f = 0; f < complex.faces(); ++f)
      {
        if (shell.Gains[f].MeanAfter > rational.Tolerance)
        {
          cut[strips[complex.edgeOf(4 * f)]] = 1;
          cut[strips[complex.edgeOf(4 * f + 1)]] = 1;
          any = true;
        }
      }
    }
    if (!any)
    {
      return Status::ok();
    }
    for (std::size_t s = 0; s < shells.size(); ++s)
    {
      RationalShell& shell = shells[s];
      PatchImprover stage(layout, *fits[s], options[s], rational);
      std::vector<char> changed(complex.faces(), 0);
      for (Index f = 0; f < complex.faces(); ++f)
      {
        const int cutU = cut[strips[complex.edgeOf(4 * f)]] ? 2 : 1;
        const int cutV = cut[strips[complex.edgeOf(4 * f + 1)]] ? 2 : 1;
        changed[f] = cutU * cutV > 1;
        if (changed[f])
        {
          shell.Patches[f] = refined(shell.Patches[f], cutU, cutV);
          stage.prepare(shell.Patches[f].SegmentsU, shell.Patches[f].SegmentsV);
        }
      }
      shareSides(complex, shell.Patches);
      const auto first = sortByPatch(shell.Points, complex.faces());
      Status status = forPatches(complex.faces(), monitor,
        [&](Index p)
        {
          FitPoint* points = shell.Points.data();
          if (changed[p])
          {
            stage.refit(
              p, shell.Patches[p], points + first[p], points + first[p + 1], shell.Gains[p]);
          }
        });
      if (!status)
      {
        return status;
      }
    }
  }
  return Status::ok();
}
} // namespace bsr
