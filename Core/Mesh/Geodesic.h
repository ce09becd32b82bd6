#pragma once

#include "Common/Status.h"
#include "Mesh/Meshes.h"

namespace bsr
{
/// A point on an edge of a mesh, or on a vertex (B = A).
struct EdgePoint
{
  Index A = -1;
  Index B = -1;
  double T = 0.0; ///< at A + T (B - A)
  bool isVertex() const { return this->A == this->B; }
  Vec3 at(const std::vector<Vec3>& points) const
  {
    return this->isVertex() ? points[this->A]
                            : Vec3((1.0 - this->T) * points[this->A] + this->T * points[this->B]);
  }
};

double pathLength(const std::vector<EdgePoint>& path, const std::vector<Vec3>& points);

/**
 * Geodesic distances and shortest paths on a triangle mesh by fast marching (Kimmel and Sethian
 * 1998), in O(n log n). Fronts are circular: a vertex's distance comes from the unfolded place of
 * the source (Novotni and Klein 2002), which is exact on developable surfaces. Across obtuse angles
 * the mesh is unfolded until a vertex lies in the front's cone. Consistently oriented meshes with
 * or without boundary; keeps references to the mesh.
 */
class FastMarching
{
public:
  /// \param twin see halfEdgeTwins
  FastMarching(const TriangleMesh& mesh, const std::vector<Index>& twin);

  /**
   * The distance of each vertex from the nearest source; infinity where none is reached.
   * \param slowness factor on lengths at each vertex, > 0; empty: 1
   * \param target the march ends once this vertex is reached (-1: never)
   */
  std::vector<double> distances(const std::vector<Index>& sources,
    const std::vector<double>& slowness = {}, Index target = -1) const;

  /// The path from a vertex downhill to a source, by gradient descent through the faces; empty when
  /// the vertex was not reached.
  std::vector<EdgePoint> descend(const std::vector<double>& distance, Index from) const;

  /**
   * Makes a path locally shortest: points slide along their edges until the path is straight there
   * in the unfolded triangles, and it is led round vertices on the side where its angle is below pi
   * (Xin and Wang 2007). Points keep away from the ends of their edges by `margin` of the edge, or
   * become vertices inside the surface.
   */
  void straighten(std::vector<EdgePoint>& path, int rounds, double margin) const;

private:
  /// A vertex that splits an obtuse corner, in the plane of its triangle: corner at 0.
  struct Support
  {
    Index Vertex = -1;
    Vec2 Position = Vec2::Zero();
  };
  Index vertex(Index h) const { return this->Mesh.Triangles[h / 3][h % 3]; }
  Support unfold(Index corner, std::vector<EdgePoint>* crossed) const;
  double update(Index corner, const std::vector<double>& d, const std::vector<std::uint8_t>& done,
    double slowness) const;
  std::array<Vec2, 2> flatten(Index corner) const;
  void slide(std::vector<EdgePoint>& path, double margin) const;
  void snap(std::vector<EdgePoint>& path, double margin) const;
  bool bypass(std::vector<EdgePoint>& path, std::size_t i, double margin) const;
  std::vector<Index> fan(Index v) const;
  Vec3 gradient(Index face, const std::vector<double>& d) const;
  bool leap(std::vector<EdgePoint>& path, const std::vector<double>& d) const;
  EdgePoint leaveVertex(Index v, const std::vector<double>& d, Index& entered) const;
  EdgePoint crossFace(
    Index h, const EdgePoint& p, const std::vector<double>& d, Index& entered) const;

  const TriangleMesh& Mesh;
  const std::vector<Index>& Twin;
  std::vector<std::uint8_t> Boundary;
  std::vector<Index> First; ///< corners of each vertex
  std::vector<Index> Corner;
  std::vector<Support> Supports;  ///< of each corner; none where not obtuse
  std::vector<Index> DependFirst; ///< corners that a vertex supports
  std::vector<Index> DependCorner;
};
} // namespace bsr
