#pragma once

#include "Common/Types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace bsr
{
struct FiberPhantomOptions;

/**
 * The smooth walls of a hollow fiber along x.
 *
 * The centerline is a graph over x. At each x the section lives in the plane normal to it: an
 * ellipse of half axes A, B, turned by the twist, modulated by a trigonometric polynomial and bent
 * to a kidney by v = w + Bean (u^2/A^2 - 1/2). The inner wall has half axes of its own. Both walls
 * are level sets, so that a point's distance needs no search but the projection to the centerline.
 */
class FiberShape
{
public:
  enum Wall
  {
    Outer = 0,
    Inner = 1
  };

  /// The section at one x, in world units.
  struct Station
  {
    Vec3 Center, Derivative, Second; ///< of the centerline, by x
    Vec3 U, V;                       ///< directions of the (twisted) half axes
    std::array<double, 2> A, B;      ///< half axes of the outer and inner wall
    double Bean;
    std::array<std::array<double, 8>, 2> Wave; ///< cos and sin of 1..4 times the angle, by wall
  };

  /// What a point sees.
  struct Local
  {
    double OuterDistance; ///< signed distance to the outer wall, negative inside
    double InnerDistance; ///< signed distance to the inner wall, negative in the lumen
    double CutDistance;   ///< signed distance to the cuts of open ends, negative between them
    bool Near;            ///< false: farther than the margin outside, nothing else is set
  };

  FiberShape() = default;
  explicit FiberShape(const FiberPhantomOptions& options);

  /// Signed distances of a point, exact to first order near the walls; beyond `margin` (world
  /// units) only their signs count.
  Local at(const Vec3& point, double margin) const;

  /// The point of a wall at x and at the angle whose cosine and sine are given (of the section's
  /// own parametrization). `shrink` scales the section: the caps of closed ends use it.
  Vec3 wallPoint(Wall wall, double x, double cosine, double sine, double shrink = 1.0) const;

  /// x of the cut of an end (0 or 1) where the given point of a wall meets it.
  double cutAt(int end, Wall wall, double cosine, double sine) const;

  Station station(double x) const;
  double begin() const { return this->Ends[0]; }
  double end() const { return this->Ends[1]; }
  bool openEnds() const { return this->Open; }
  /// x where the cap of an end begins, and the cap's length at a wall.
  double capBase(int end) const
  {
    return end == 0 ? this->Ends[0] + this->Cap[0] : this->Ends[1] - this->Cap[0];
  }
  double capLength(Wall wall) const { return this->Cap[wall]; }
  double meanRadius() const { return this->Radius; }
  double wallThickness() const { return this->Thickness; }
  double voxel() const { return this->Voxel; }

private:
  void design(const FiberPhantomOptions& options);
  void fitCenterline(const FiberPhantomOptions& options);
  void setFrames(double twist);
  double farthest() const;
  /// Level functions of both walls: 0 on the wall, negative inside it.
  std::array<double, 2> levels(const Station& s, double x, double u, double v) const;
  double cutOffset(int end, double cosine, double sine) const;

  std::vector<Station> Stations; ///< at First + i * Step
  double First = 0.0;
  double Step = 1.0;
  double Voxel = 1.0;
  double Radius = 1.0;
  double Thickness = 0.2;
  double Reach = 1.0; ///< no wall is farther from the centerline
  bool Open = true;
  std::array<double, 2> Ends{0.0, 1.0};
  std::array<double, 2> Cap{0.0, 0.0};
  std::array<std::array<double, 6>, 2> Cut{}; ///< cos and sin of 1..3 times the angle, by end
};
} // namespace bsr
