#include "Layout/MappedTriangles.h"

#include "Mesh/TriangleTree.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
void MappedTriangles::add(const TriangleMesh& region, const std::vector<Vec2>& uv, Index quad)
{
  for (const auto& t : region.Triangles)
  {
    Item item;
    for (int k = 0; k < 3; ++k)
    {
      item.P[k] = region.Points[t[k]];
      item.UV[k] = uv[t[k]];
    }
    item.Quad = quad;
    this->Items.push_back(item);
  }
}

void MappedTriangles::addUnmapped(const TriangleSurface& s, Index face)
{
  Item item;
  for (int k = 0; k < 3; ++k)
  {
    item.P[k] = s.Points[s.corners(face)[k]];
    item.UV[k] = Vec2::Zero();
  }
  this->Items.push_back(item);
}

void MappedTriangles::build()
{
  std::vector<Box> boxes(this->Items.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    for (const Vec3& p : this->Items[i].P)
    {
      boxes[i].add(p);
    }
  }
  this->Tree = BoxTree(boxes);
}

QuadHit MappedTriangles::find(const Vec3& p, const Vec3& facing, double on) const
{
  QuadHit hit = this->find(p, facing);
  if (facing.squaredNorm() > 0.0 && !(hit.SquaredDistance <= on * on))
  {
    const QuadHit any = this->find(p, Vec3::Zero());
    return hit.Quad < 0 || any.SquaredDistance <= on * on ? any : hit;
  }
  return hit;
}

QuadHit MappedTriangles::find(const Vec3& p, const Vec3& facing) const
{
  QuadHit hit;
  double bound = hit.SquaredDistance;
  Index best = -1;
  Vec3 foot = Vec3::Zero();
  this->Tree.nearest(p, bound,
    [&](Index i)
    {
      const Item& t = this->Items[i];
      if (facing.squaredNorm() > 0.0 && (t.P[1] - t.P[0]).cross(t.P[2] - t.P[0]).dot(facing) <= 0.0)
      {
        return;
      }
      const Vec3 q = nearestOnTriangle(p, t.P[0], t.P[1], t.P[2]);
      const double d = (q - p).squaredNorm();
      if (d < bound || (d == bound && i < best))
      {
        bound = d;
        best = i;
        foot = q;
      }
    });
  if (best < 0)
  {
    return hit;
  }
  const Item& t = this->Items[best];
  hit.Quad = t.Quad;
  hit.SquaredDistance = bound;
  hit.UV = interpolate(t, foot);
  return hit;
}

Vec2 MappedTriangles::interpolate(const Item& t, const Vec3& p)
{
  const Vec3 n = (t.P[1] - t.P[0]).cross(t.P[2] - t.P[0]);
  const double all = n.squaredNorm();
  if (!(all > 0.0))
  {
    return (t.UV[0] + t.UV[1] + t.UV[2]) / 3.0;
  }
  const double b = std::clamp((p - t.P[0]).cross(t.P[2] - t.P[0]).dot(n) / all, 0.0, 1.0);
  const double c = std::clamp((t.P[1] - t.P[0]).cross(p - t.P[0]).dot(n) / all, 0.0, 1.0);
  const Vec2 uv = t.UV[0] + b * (t.UV[1] - t.UV[0]) + c * (t.UV[2] - t.UV[0]);
  return uv.cwiseMax(0.0).cwiseMin(1.0);
}
} // namespace bsr
