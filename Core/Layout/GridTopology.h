#pragma once

#include "Layout/GridMap.h"
#include "Layout/IntegerKernel.h"

namespace bsr
{
/// The coordinates of a triangle's corner: those of its vertex, turned, plus whole unknowns.
struct CornerForm
{
  int Turn = 0;
  std::array<IntegerForm, 2> Form;

  /// Which coordinate of the vertex makes coordinate c; returns its sign.
  int source(int c, int& from) const
  {
    from = this->Turn % 2 == 0 ? c : 1 - c;
    const GridPoint unit = turned(GridPoint{from == 0, from == 1}, this->Turn);
    return static_cast<int>(unit[c]);
  }
};

/// Everything whole about a grid map: cuts, transitions, and which coordinates are integers.
struct GridTopology
{
  CrossField Field;                  ///< combed: alike across every edge that is not cut
  std::vector<std::uint8_t> Used;    ///< per vertex: belongs to the domain
  std::vector<CornerForm> Corners;   ///< per half-edge: its start in the chart of its triangle
  std::vector<Index> Whole;          ///< per vertex and coordinate: the whole unknown, or -1
  std::vector<Index> Segment;        ///< per half-edge: the cut it lies on, or -1
  std::vector<std::uint8_t> Forward; ///< per half-edge on a cut: runs with the cut
  std::vector<std::uint8_t> Turn;    ///< per half-edge
  IntegerKernel Kernel{0};
  int Singular = 0;
  bool Usable = false;

  /// The transitions of all half-edges for given values of the free whole unknowns.
  void transitions(const TriangleSurface& s, const std::vector<std::int64_t>& free,
    std::vector<std::uint8_t>& turn, std::vector<GridPoint>& shift) const;
};

/// Cuts the domain to a disc through all singular vertices and writes down what must be whole. Not
/// usable once cancelled, or for more than `mostSingular` singular vertices, which are counted
/// only.
GridTopology gridTopology(
  const TriangleSurface& s, const CrossField& field, int mostSingular, Monitor& monitor);
} // namespace bsr
