#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"
#include "Image/Lumen.h"
#include "Mesh/Meshes.h"

namespace bsr
{
/// Values of FiberSides::Side.
enum class FiberSide : std::uint8_t
{
  Outer = 0,
  Inner = 1,
  Neither = 255
};

struct FiberSidesOptions
{
  /// Facing Void: the wall a point lies on, among the walls of the lumen and of the outside.
  /// Depth: inner is what lies deeper below the closed surface than DepthThreshold.
  bool ByDepth = false;
  double DepthThreshold = 2.0; ///< voxels
  bool AutoDepthThreshold = false;
  double PoreRadius = 0.0; ///< voxels; see LumenOptions
};

struct FiberSides
{
  std::vector<float> Depth;       ///< voxels below the closed surface, per point
  std::vector<std::uint8_t> Side; ///< FiberSide, per point
  bool Lumen = false;             ///< a lumen was found
  double LumenRadius = 0.0;       ///< voxels; 0 without a lumen
  double PoreRadius = 0.0;        ///< voxels, the one used
  double DepthThreshold = 0.0;    ///< voxels, the one used or what the histogram says
  /// Open ends of the lumen (centers in voxel indices of the closed image); not by depth.
  std::vector<LumenMouth> Mouths;
};

/// The closed object: distance to its surface, negative inside, in voxels.
struct ClosedObject
{
  ImageView<const std::uint8_t> Mask;
  ImageView<const float> SignedDistance;
};

/**
 * Tells the outer from the inner wall of a raw fiber surface, and both from debris, pits, pores and
 * the walls of holes. `surface` in voxel indices of the closed object's image.
 */
Result<FiberSides> classifySides(const TriangleMesh& surface, const ClosedObject& object,
  const FiberSidesOptions& options, Monitor& monitor);

/// The valley between the two classes of a histogram of depths (0.25 voxels a bin); `fallback`
/// where there are not two.
double depthValley(const std::vector<float>& depth, double fallback);
} // namespace bsr
