#pragma once

#include "Mesh/Meshes.h"

namespace bsr
{
/**
 * Splits the triangles of a mesh along the zero level of a function on its vertices, linear in
 * between; `value` gains the new vertices (0 there), new triangles their parent's region. Vertices
 * nearer to the level than `snap` of an edge are moved onto the level by setting their value to 0.
 */
void cutAtZero(TriangleMesh& mesh, std::vector<double>& value, double snap);

/// The boundary loops of the triangles with a region; empty when one of them is not simple.
std::vector<std::vector<Index>> regionLoops(const TriangleMesh& mesh, Index region);

/// V - E + F of the triangles with a region.
std::int64_t regionEuler(const TriangleMesh& mesh, Index region);
} // namespace bsr
