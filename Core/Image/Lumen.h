#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Common/Types.h"
#include "Image/ImageView.h"

namespace bsr
{
/// What findLumen calls a voxel.
enum class VoidLabel : std::uint8_t
{
  Object = 0,  ///< the object
  Sealed = 1,  ///< pores, cracks and cavities of the object, narrower than about five voxels
  Outside = 2, ///< the void around the object, its concavities included
  Lumen = 3,   ///< the void within
  Mouth = 4,   ///< outside, close before an open end of the lumen
  Hole = 5     ///< holes of the wall, as far as the void within reaches into them
};

/// Value of findLumen's mask `near` for voxels deeper than CoreDepth below the closed surface.
constexpr std::uint8_t WithinObject = 2;
constexpr double CoreDepth = 2.0; ///< voxels

struct LumenOptions
{
  /// Radius in voxels of the ball that seals holes of the wall; 0: 0.65 of the lumen's radius.
  double PoreRadius = 0.0;
};

/// An open end of the lumen: where it meets the outside and the sealing ball passes.
struct LumenMouth
{
  Vec3 Center;         ///< voxel indices of the label image (0 is its first voxel)
  Vec3 Direction;      ///< unit vector out of the lumen, along the axes of the image
  double Radius = 0.0; ///< of the disc of the same vector area, in voxels
};

struct LumenResult
{
  bool Found = false;
  Volume<std::uint8_t> Label;     ///< VoidLabel, on the object's extent
  double LumenRadius = 0.0;       ///< median radius of the balls inscribed in the lumen, in voxels
  double PoreRadius = 0.0;        ///< the one used, in voxels
  std::vector<LumenMouth> Mouths; ///< the open ends (see findMouths)
};

/**
 * Separates the void within a hollow object from the void around it, though they may be connected
 * by holes, cracks and open ends.
 *
 * After pores narrower than 2.5 voxels in radius have been sealed, rays are cast from the void near
 * and within the object (`near`: nonzero, WithinObject where deep enough for the core): the lumen's
 * core is where fewer than 30 % of all directions escape, as far as it lies CoreDepth below the
 * closed surface: nooks between the object and debris on its outside are as dark. Concavities of
 * the outside do not pass (from the bottom of a wide dent some 40 % escape), holes neither (they
 * are few). Towards its open ends the lumen then grows through voxels that are still walled in all
 * around in some plane, but only where a ball of PoreRadius passes: not through holes. What of the
 * lumen no such ball reaches and touches the outside is a hole's.
 *
 * Both masks cover the same extent, which should be some voxels wider than the object.
 */
Result<LumenResult> findLumen(const Volume<std::uint8_t>& object, const Volume<std::uint8_t>& near,
  const LumenOptions& options, Monitor& monitor);
} // namespace bsr
