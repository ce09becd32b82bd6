#pragma once

#include "Spline/PatchNet.h"
#include "Spline/VertexFrames.h"

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

/**
 * The whole space of nets whose surface has continuous tangent planes, by an explicit local basis:
 * net = Basis * x. For every mix of valences >= 3, for borders and for creases (across which only
 * the curve is shared). Sparse (2 to 6 entries a row)
 * and well conditioned; Reader recovers x from a net of the space (and projects any other net). The
 * columns are linearly independent; their number is the dimension of the space.
 */
SplineSpace makeG1Space(
  const QuadComplex& complex, const PatchNet& net, EdgeRule rule, const Creases& creases = {});

/// The G1 conditions themselves as rows over net points (redundant); zero on the space.
SparseRows g1Constraints(
  const QuadComplex& complex, const PatchNet& net, EdgeRule rule, const Creases& creases = {});
} // namespace bsr
