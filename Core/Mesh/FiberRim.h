#pragma once

#include "Mesh/FiberEnds.h"

#include <array>
#include <optional>
#include <vector>

namespace bsr
{
/// Cylinder coordinates around the axis of a mouth, the angle in bins.
struct MouthFrame
{
  static constexpr int Bins = 72; ///< directions around the axis
  static constexpr double Pi = 3.14159265358979323846;

  Vec3 Center;
  Vec3 Axis; ///< of length 1, outwards
  Vec3 U;
  Vec3 V;

  MouthFrame(const Vec3& center, const Vec3& axis);

  double height(const Vec3& p) const { return (p - this->Center).dot(this->Axis); }
  double radius(const Vec3& p) const
  {
    const Vec3 d = p - this->Center;
    return (d - d.dot(this->Axis) * this->Axis).norm();
  }
  /// Angle in bins, 0..Bins.
  double bin(const Vec3& p) const;
  Vec3 radial(double bin) const;
};

/// A value for each direction around a mouth, of the middle of its bin.
using RimProfile = std::array<double, MouthFrame::Bins>;

/// The value at a bin beyond the first or last.
template <class T>
const T& ring(const std::array<T, MouthFrame::Bins>& values, int i)
{
  constexpr int n = MouthFrame::Bins;
  return values[((i % n) + n) % n];
}

/// The value of a profile between the middles of its bins.
double between(const RimProfile& profile, double bin);

/// A fiber's rim around a mouth: for each direction its radius and height in the mouth's frame.
struct FiberRim
{
  RimProfile Radius{};
  RimProfile Height{};

  /// The i-th of Bins points.
  Vec3 point(const MouthFrame& f, int i) const
  {
    return f.Center + this->Radius[i] * f.radial(i + 0.5) + this->Height[i] * f.Axis;
  }
  /// Radius (x) and height (y) between the directions.
  Vec2 at(double bin) const;
};

/// What a rim is sought on.
struct RimSurface
{
  const TriangleMesh& Mesh;
  std::vector<Vec3> Normals;      ///< as of wideNormals()
  const std::vector<double>& Off; ///< how far each vertex is off the fiber's wall
};

/// Finds the rim closest to a mouth: the outermost convex edge around it, as a smooth curve from
/// which debris and holes at the rim do not turn it away. The frame is turned to the rim's plane.
/// `lean` weighs radius against height. Empty where the surface does not go round the mouth.
std::optional<FiberRim> findRim(const TriangleMesh& mesh, const std::vector<double>& off,
  const EndMouth& mouth, double lean, MouthFrame& frame);

/// The closed sequence of rim points in a frame with the least losses and jumps; what is far from
/// a `smooth` height, if given, or off the wall counts as less far out.
std::optional<FiberRim> searchRim(const RimSurface& surface, const MouthFrame& frame, double radius,
  double lean, const RimProfile* smooth);

/// Outward vertex normals, averaged over some rings of neighbors; the surface may be turned inside
/// out, as isosurfaces of a distance that is negative inside are.
std::vector<Vec3> wideNormals(const TriangleMesh& mesh);
} // namespace bsr
