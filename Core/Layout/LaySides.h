#pragma once

#include "Layout/CutMesh.h"

#include <limits>

namespace bsr
{
/// A surface cut along all sides of a layout, as far as that was found.
struct LaidSides
{
  CutMesh Mesh;
  int Failed = std::numeric_limits<int>::max(); ///< quads without a disc
  int Detours = 0;                              ///< see detours
  double Length = std::numeric_limits<double>::infinity();
};

/// Flags of the sides that are more than three times as long as the straight line and as half a
/// mean side.
std::vector<std::uint8_t> detours(
  const CutMesh& cut, const QuadMesh& layout, const LayoutGraph& graph);

/**
 * Lays the sides of a layout on a surface: shortest first, with those that failed first in further
 * attempts; then what failed and more and more around it, and at last all of them, in an order that
 * leads to discs whatever way sides take (see safeOrder). Of several results the one with fewest
 * failed quads, then of least length is taken. Short orders are tried until no side is a detour,
 * the others only where quads fail.
 */
Result<LaidSides> laySides(
  const CutMesh& base, const QuadMesh& layout, const LayoutGraph& graph, Monitor& monitor);
} // namespace bsr
