#pragma once

#include "Mesh/Meshes.h"

namespace bsr
{
/// A face at an edge of three or more faces.
struct EdgeFace
{
  Index HalfEdge;
  bool Forward; ///< runs through the edge from its first to its second end
  bool Loose;   ///< has an edge at a boundary
  Vec3 Apex;    ///< the corner opposite the edge
};

/**
 * Takes an edge of three or more faces apart into sheets (after Gueziec, Taubin, Lazarus and Horn,
 * Cutting and stitching, IEEE TVCG 7 (2001)): pairs of half-edges that stay joined; the others
 * become boundaries. Where the faces bound solids that touch along the edge, each solid keeps its
 * two faces; otherwise the smoothest pairs are joined first, those of one orientation before
 * others and loose faces last: fins are cut off.
 */
std::vector<std::array<Index, 2>> pairAtEdge(
  const Vec3& a, const Vec3& b, std::vector<EdgeFace> faces);
} // namespace bsr
