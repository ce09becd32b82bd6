#pragma once

#include "Spline/PatchNet.h"

namespace bsr
{
/// The function alpha of the G1 condition  dv p + dv q = alpha(u) du p  along an edge.
enum class EdgeRule
{
  /// Quadratic in the outer segments, zero between; for any number of segments >= 3.
  Quadratic,
  /// Linear in the outer segments where both vertices are irregular; for 3 segments. Smaller
  /// largest errors than Quadratic.
  Linear
};

/// The rule of choice for a number of segments.
EdgeRule defaultRule(int segments);

/// alpha at a vertex: 2 cos(2 pi / valence), on a border 2 cos(pi / faces); exactly 0 where
/// regular.
double vertexAlpha(const VertexFan& fan);

/**
 * The whole space of nets whose surface has continuous tangent planes, by an explicit local basis:
 * net = Basis * x. For every mix of valences >= 3 and for borders. Sparse (2 to 6 entries a row)
 * and well conditioned; Reader recovers x from a net of the space (and projects any other net). The
 * columns are linearly independent; their number is the dimension of the space.
 */
SplineSpace makeG1Space(const QuadComplex& complex, const PatchNet& net, EdgeRule rule);

/// The G1 conditions themselves as rows over net points (redundant); zero on the space.
SparseRows g1Constraints(const QuadComplex& complex, const PatchNet& net, EdgeRule rule);
} // namespace bsr
