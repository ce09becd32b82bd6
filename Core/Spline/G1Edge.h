#pragma once

#include "Spline/G1Space.h"

namespace bsr
{
/// alpha(0) = A and alpha(1) = -B of an inner edge, from its two vertices (VertexFrames).
struct EdgeAlpha
{
  double A = 0.0;
  double B = 0.0;
};

/// Whether curve coefficient c (of n) is determined by the others.
bool isPivot(EdgeRule rule, const EdgeAlpha& alpha, int n, int c);

/// Sets the determined coefficients of the boundary curve d.
void solvePivots(EdgeRule rule, const EdgeAlpha& alpha, std::vector<LinearForm>& d);

/// P + Q - 2 d of the rows next to the edge, in closed form; d must satisfy the pivots.
std::vector<LinearForm> edgeSum(
  EdgeRule rule, const EdgeAlpha& alpha, const std::vector<LinearForm>& d);

/// The same from the Bernstein coefficients of alpha d', segment by segment (to check the former).
std::vector<LinearForm> edgeSumGeneric(
  EdgeRule rule, const EdgeAlpha& alpha, const std::vector<LinearForm>& d);

/// What the boundary curve alone must fulfil, as forms that vanish (to check the pivots).
std::vector<LinearForm> curveConditions(
  EdgeRule rule, const EdgeAlpha& alpha, const std::vector<LinearForm>& d);
} // namespace bsr
