#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Common/Types.h"
#include "Image/FiberDefects.h"
#include "Image/FiberShape.h"

#include <array>
#include <cstdint>
#include <vector>

namespace bsr
{
/**
 * A digital CT image of one damaged hollow fiber whose smooth walls are known exactly.
 *
 * The fiber runs along x. Its centerline bends, its section turns from an ellipse to a kidney and
 * twists, its wall varies in thickness; the ends are cut open or closed by caps of the wall's
 * thickness. The image adds what a scan of a real fiber shows: rough walls, through holes, slits,
 * pits, crooked tunnels, cavities, debris inside and outside, blur, rings, shading, noise. The
 * truth is the smooth walls, without any of that.
 *
 * "Voxels" are multiples of the smallest spacing. Everything is a function of the options: the
 * same for any number of threads, and the same whether an image is made at once or in pieces.
 */
struct FiberPhantomOptions
{
  std::array<int, 3> Dimensions{192, 96, 96};   ///< voxels along x, y, z
  std::array<double, 3> Spacing{1.0, 1.0, 1.0}; ///< world units
  std::int64_t Seed = 1;                        ///< another seed, another fiber
  int Holes = 8;                                ///< openings through the wall: round or slits
  int Pits = -1;                                ///< blind pits; -1: two a hole
  int Tunnels = -1;                             ///< narrow crooked openings; -1: eight a hole
  int Cavities = -1;                            ///< voids within the wall; -1: six a hole
  int Debris = 24;                              ///< pieces, loose or adhering, and fibrils
  double Roughness = 0.6;                       ///< of both walls, root mean square in voxels
  double Noise = 0.10;                          ///< standard deviation / contrast
  double Rings = 0.02;                          ///< standard deviation / contrast
  double Shading = 0.05;                        ///< loss of contrast on the scan's axis
  double Blur = 0.8;                            ///< standard deviation in voxels
  double Collapse = 0.5;                        ///< 0 nearly round .. 1 flat kidney
  double Bend = 1.0;                            ///< share of the room there is for bending
  double Twist = 0.5;                           ///< turns of the section over the length
  double WallThickness = 0.28;                  ///< of the fiber's mean radius
  double Length = 0.86;                         ///< of the volume's; above 1.1 it leaves the volume
  bool OpenEnds = true;                         ///< cut open, or closed by rounded caps
  double AirValue = 9000.0;                     ///< gray value of air
  double WallValue = 30000.0;                   ///< gray value of the wall
};

/// The analytic fiber: what image and truth are made from.
struct FiberPhantom
{
  FiberPhantomOptions Options;
  FiberShape Shape;
  std::vector<FiberDefect> Defects;
  /// The gray value halfway between air and wall: its isosurface follows the true walls.
  double isoValue() const { return 0.5 * (this->Options.AirValue + this->Options.WallValue); }
};

/// The true walls as grids of points about a voxel apart, without holes, roughness and debris.
struct FiberTruth
{
  std::vector<Vec3> Points;                ///< world coordinates; voxel (0, 0, 0) is the origin
  std::vector<std::uint8_t> Side;          ///< a point: 0 outer wall, 1 inner wall
  std::vector<std::int32_t> End;           ///< a point: 0, or 1 / 2 on the rim of an open end
  std::vector<std::array<Index, 4>> Quads; ///< a triangle at the tip of a cap repeats its last id
};

/// Checks the options and designs the fiber. Quick, whatever the dimensions.
Result<FiberPhantom> makeFiberPhantom(const FiberPhantomOptions& options);

/// The image on an extent (first and last voxel along x, y and z) inside the dimensions, x fastest.
Result<std::vector<std::uint16_t>> fiberImage(
  const FiberPhantom& phantom, const std::array<int, 6>& extent, Monitor& monitor);

/// The true walls.
FiberTruth fiberTruth(const FiberPhantom& phantom);
} // namespace bsr
