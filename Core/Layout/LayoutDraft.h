#pragma once

#include "Mesh/Meshes.h"
#include "Mesh/Remesh.h"

#include <string>

namespace bsr
{
/// How a vertex of a layout may move.
enum class VertexKind : std::uint8_t
{
  Free,   ///< on the surface
  Crease, ///< along a region border, boundary or sharp edge
  Fixed   ///< a corner where creases meet or end
};

/// A quad layout in the making.
struct LayoutDraft
{
  QuadMesh Mesh;
  std::vector<VertexKind> Kind; ///< per point
  /// Edges on creases and boundaries, each as (lower, higher) point, sorted.
  std::vector<std::array<Index, 2>> Creases;

  /// Adds boundaries and region borders to the creases, and puts these in order.
  void completeCreases();
  /// Puts each point, by its kind, onto the side of the reference that its quads face.
  void project(const ReferenceSurface& reference);
  /// The same, faster. `triangles`: those of the reference that the points were on last, or empty;
  /// kept up to date.
  void project(const ReferenceSurface& reference, std::vector<Index>& triangles);
};

/// What the quads around a point tell of it.
struct PointFrame
{
  Vec3 Normal = Vec3::Zero(); ///< not of unit length
  double Longest = 0.0;       ///< edge
};
std::vector<PointFrame> pointFrames(const QuadMesh& mesh);

/// Topology and shape of a quad mesh.
struct LayoutReport
{
  bool Valid = false;
  std::string Problem; ///< why it is not valid
  int Components = 0;
  int Euler = 0;
  int BoundaryLoops = 0;
  int Irregular = 0; ///< interior vertices of valence other than 4
  int MaxValence = 0;
  int Flipped = 0; ///< quads of a scaled Jacobian of 0 or less
  double MinJacobian = 0.0;
  double MeanJacobian = 0.0;
  double MeanAngleDeviation = 0.0; ///< of corner angles from 90 degrees
  double MaxAngleDeviation = 0.0;
  /// Interior vertices by valence; the last holds all valences from there up.
  std::array<int, 10> ByValence{};
  std::vector<int> Valence;     ///< edges at each point
  std::vector<double> Jacobian; ///< scaled Jacobian of each quad
};

/**
 * Checks every invariant of a layout: oriented 2-manifold (every edge one or two quads, one fan a
 * vertex), no degenerate or repeated quad, no valence-2 vertex inside, no two quads that share two
 * edges, every point used, finite coordinates. Valid says that all hold.
 */
LayoutReport checkLayout(const QuadMesh& mesh);

/// The smallest scaled Jacobian over the corners of a quad, against its mean normal: 1 for a
/// rectangle, 0 or less when folded.
double scaledJacobian(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
double scaledJacobian(const QuadMesh& mesh, Index quad);

/// The largest distances between a layout (its bilinear quads) and a surface, both ways.
struct LayoutDistance
{
  double Maximum = 0.0;
  double Mean = 0.0; ///< from the surface to the layout
};
/// `samples` are more points of the surface, for the maximum. Incomplete once cancelled.
LayoutDistance layoutDistance(const QuadMesh& mesh, const TriangleSurface& s,
  const ReferenceSurface& reference, const std::vector<Vec3>& samples, Monitor& monitor);
} // namespace bsr
