#pragma once

#include "Spline/LinearForm.h"
#include "Spline/QuadComplex.h"

#include <Eigen/SparseCore>

namespace bsr
{
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/**
 * Numbering of the control points of a complex of bicubic patches with m segments a side (double
 * inner knots, n = 2 m + 2 control points a side), points on shared sides counted once: vertices,
 * then the inner points of each edge in its stored direction, then the inner points of each patch.
 */
class PatchNet
{
public:
  PatchNet(const QuadComplex& complex, int segments);

  int segments() const { return this->Segments; }
  int side() const { return this->Side; } ///< control points along a side, n
  int perPatch() const { return this->Side * this->Side; }
  Index points() const { return this->Count; }
  Index patches() const { return this->Patches; }

  /// Net point of control point (i, j) of a patch; i runs along u.
  Index at(Index patch, int i, int j) const
  {
    return this->Map[static_cast<std::size_t>(patch) * this->perPatch() + j * this->Side + i];
  }
  /// Net point number `local` = j * n + i of a patch.
  Index at(Index patch, int local) const
  {
    return this->Map[static_cast<std::size_t>(patch) * this->perPatch() + local];
  }
  /// Net point at distance r from the side of a half-edge, c along it.
  Index row(Index halfEdge, int r, int c) const;
  /// Net point c along spoke k of a fan, from its vertex.
  Index spoke(const VertexFan& fan, int k, int c) const;
  /// The control point diagonal to the fan's vertex in face k.
  Index twist(const VertexFan& fan, int k) const { return this->row(fan.HalfEdges[k], 1, 1); }

private:
  int Segments;
  int Side;
  Index Patches;
  Index Count = 0;
  std::vector<Index> Map;
};

/// A linear space of control nets: net = Basis * unknowns; Reader * Basis = 1 where Reader is
/// given.
struct SplineSpace
{
  SparseRows Basis;  ///< net points x unknowns
  SparseRows Reader; ///< unknowns x net points; empty where the space has none
};

/// The matrix whose rows are the forms.
SparseRows matrixFrom(const std::vector<LinearForm>& rows, Index columns);

/// All C0 nets: one unknown a net point (reduction of variables, paper 000, eq. 7).
SplineSpace makeC0Space(const PatchNet& net);
} // namespace bsr
