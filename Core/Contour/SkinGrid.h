#pragma once

#include "Contour/SampleContour.h"
#include "Contour/SkinTree.h"

namespace bsr
{
/// A contour laid around a rectangle of the data set, or the outline of a leg's core.
struct SkinRing
{
  Index Contour = -1;
  int Row = 0, Column = 0; ///< its corner of lowest numbers
  int Rows = 2, Columns = 2;
  bool Core = false; ///< the lowest contour of a leg
  bool Up = false;   ///< its tree's direction
  /// How round the ring is laid in a relaxed fit: 0 the rectangle, 1 the ellipse in it.
  double Roundness = 0.0;
  Index Outer = -1; ///< the ring around it; -1 for the outermost
  /// Share of the contour's length at each node, increasing by 1 around (may leave 0 to 1); the
  /// first is its standard point.
  std::vector<double> Shares;

  int size() const { return 2 * (this->Rows + this->Columns) - 4; }
  /// Column (x) and row (y) of node k, counterclockwise (columns to the right, rows up) from the
  /// corner; k may be broken, and wraps.
  Vec2 place(double k) const;
  /// A place inside the rectangle, or on it, where it goes as the ring is rounded.
  Vec2 rounded(const Vec2& place) const;
  /// Share of the contour's length at broken node k.
  double shareAt(double k) const;
};

/**
 * The data set of paper 004, section 2.3: a pair of trousers flattened into one grid. The lowest
 * contour of each leg is the outline of a core, each next one the rectangular ring around it, the
 * base's contours the rings around both halves, so that the size is (x + 2 (n - 1) + 2 m) rows by
 * (4 n + 2 m) columns for two legs of n contours on m of a base (eqs. 7 to 11). Here any number of
 * legs of any length, side by side or above one another as they lie in space, and any number of
 * levels: a leg may again be a base with legs.
 */
struct SkinGrid
{
  int Rows = 0;
  int Columns = 0;
  Vec2 AxisU = Vec2::UnitX();     ///< flat direction of increasing columns
  std::vector<SkinRing> Rings;    ///< the outermost is the first
  std::vector<Vec3> Points;       ///< of each node, columns run fastest
  std::vector<Index> RingOf;      ///< ring of each node; -1 inside a core
  std::vector<Index> OwnerOf;     ///< the same, but inside a core that core's ring
  std::vector<ArcCurve> Curves;   ///< of each ring's contour
  std::vector<Vec3> CapDirection; ///< of each ring that is a core: out of the leg, else zero
  std::vector<double> CapRoom;    ///< distance to the next slice there; 0 else

  /// Where a place goes as the rings are rounded; between rings, between where theirs go.
  Vec2 rounded(const Vec2& place) const;
  Index node(int row, int column) const { return row * this->Columns + column; }
  /// The point of a ring at broken node k.
  Vec3 at(Index ring, double k) const
  {
    return this->Curves[ring].at(this->Rings[ring].shareAt(k));
  }
};

/**
 * Arranges the contours of a tree. \param coreRows x of eq. 7, at least 3: a core has x rows of two
 * points. \param shaped instead, cores of the same number of points on their outline are as wide
 * and high as their contours, and get points inside.
 */
SkinGrid arrangeGrid(
  const ContourStack& stack, const SkinTree& tree, int coreRows, bool shaped = false);

/**
 * Lays the contours on their rings (and fills Points): the standard points and, beyond section 2.4,
 * every node where it is close to the neighboring contour's. At a split the contour outside is
 * divided among the legs by distance, and only what of a leg lies between those parts faces the
 * other legs.
 */
void alignGrid(const ContourStack& stack, SkinGrid& grid);
} // namespace bsr
