#pragma once

#include "Layout/CrossField.h"

#include <functional>
#include <memory>
#include <vector>

namespace bsr
{
using GridPoint = std::array<std::int64_t, 2>;

/// (u, v) turned by 90 degrees, n times.
template <class Pair>
Pair turned(const Pair& p, int n)
{
  switch (n & 3)
  {
  case 1:
    return Pair{-p[1], p[0]};
  case 2:
    return Pair{-p[0], -p[1]};
  case 3:
    return Pair{p[1], -p[0]};
  default:
    return p;
  }
}

/**
 * An integer-grid map of a part of a surface: each triangle has its own chart; across edge h
 * coordinates become turned(uv, Turn[h]) + Shift[h], with whole numbers in Shift. Singular vertices
 * and creases lie on whole numbers. The cells of the unit grid, pulled back, are quads.
 */
struct GridMap
{
  TriangleSurface Surface;
  std::vector<std::uint8_t> Inside; ///< per triangle
  std::vector<Vec2> UV;             ///< per half-edge: its start, in the chart of its triangle
  std::vector<std::uint8_t> Turn;   ///< per half-edge, between triangles inside
  std::vector<GridPoint> Shift;     ///< per half-edge
  int Singular = 0;                 ///< singular vertices of the field
  int Folded = 0;                   ///< triangles turned over by the map
};

/**
 * Integrates a cross field (mixed-integer quadrangulation, Bommes et al. 2009): the least-squares
 * problem is reduced to the integer unknowns (a dense Schur complement), which are fixed one by
 * one in the order of least harm and improved by single steps; then triangles that fold are
 * stiffened. Borders towards regions outside (not holes) get an even number of cells.
 * What does not depend on the size of the cells is computed once, by the constructor.
 */
class GridMapper
{
public:
  /// Once cancelled, or for more than `mostSingular` singular vertices, it gives no maps.
  /// \pre `s`, `field` and `monitor` outlive the mapper.
  GridMapper(const TriangleSurface& s, const CrossField& field, int mostSingular, Monitor& monitor);
  ~GridMapper();
  GridMapper(const GridMapper&) = delete;
  GridMapper& operator=(const GridMapper&) = delete;

  /// `cells` is the side of a cell wanted in each triangle. Each map on the way is offered to
  /// `accept`, which returns true if it is good enough; there may be none.
  void run(const std::vector<double>& cells, const std::function<bool(const GridMap&)>& accept);

  int singular() const; ///< vertices

private:
  struct Solver;
  std::unique_ptr<Solver> Impl;
};
} // namespace bsr
