#pragma once

#include "Spline/QuadComplex.h"

#include <Eigen/Core>

namespace bsr
{
/// Edges along which the surface may have an edge: neighbors meet there without a common tangent
/// plane.
struct Creases
{
  std::vector<char> Edge;     ///< one flag an edge of the complex, or empty: none
  std::vector<Vec3> Vertices; ///< of the layout; its corner angles count where creases meet

  bool at(Index edge) const { return !this->Edge.empty() && this->Edge[edge]; }
  bool any() const;
};

/// The faces around a vertex between two creases (or borders), with the alpha of its inner spokes.
struct VertexSector
{
  VertexFan Fan; ///< closed only where no crease meets the vertex
  double Alpha = 0.0;
};

/// How the first control points along the spokes depend on few unknowns:
/// d1_k = p + sum_j Tangents(k, j) x_j, spokes as in the complex' fan.
struct VertexFrame
{
  std::vector<VertexSector> Sectors;
  Eigen::MatrixXd Tangents;
};

/**
 * Sectors and tangents of all vertices. A sector of m faces that spans the angle theta has
 * alpha = 2 cos(theta / m): theta is 2 pi around a vertex without creases or at the end of one, pi
 * where a border or a crease runs smoothly through it (two sectors of at least two faces each), and
 * else, where creases meet, the layout's angle rounded to a multiple of 30 degrees other than 180.
 */
class VertexFrames
{
public:
  VertexFrames(const QuadComplex& complex, const Creases& creases);

  const VertexFrame& at(Index vertex) const { return this->Frames[vertex]; }
  /// alpha of the spoke that a half-edge leaves its vertex along; it must be no crease or border.
  double alpha(Index halfEdge) const { return this->Alphas[halfEdge]; }

private:
  std::vector<VertexFrame> Frames;
  std::vector<double> Alphas;
};
} // namespace bsr
