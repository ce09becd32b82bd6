#pragma once

#include "Common/BoxTree.h"
#include "Layout/NearestQuad.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
/// Triangles with (u, v) at their corners, for nearest-point queries.
class MappedTriangles
{
public:
  /// The triangles of a quad's region; one (u, v) a point.
  void add(const TriangleMesh& region, const std::vector<Vec2>& uv, Index quad);
  /// A triangle that belongs to no quad.
  void addUnmapped(const TriangleSurface& s, Index face);
  /// \pre all triangles are there
  void build();

  /// The nearest triangle that faces a way, if there is one (zero: any). Points of the mesh itself
  /// (within `on`) take their own place whatever their normals say. Quad -1: it belongs to none.
  QuadHit find(const Vec3& p, const Vec3& facing, double on) const;

private:
  struct Item
  {
    std::array<Vec3, 3> P;
    std::array<Vec2, 3> UV;
    Index Quad = -1;
  };
  QuadHit find(const Vec3& p, const Vec3& facing) const;
  static Vec2 interpolate(const Item& t, const Vec3& p);

  std::vector<Item> Items;
  BoxTree Tree;
};
} // namespace bsr
