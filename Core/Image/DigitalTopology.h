#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Image/ImageView.h"

#include <cstdint>
#include <vector>

namespace bsr
{
/// Which neighbors of a voxel are connected to it: over faces, or over faces, edges and corners.
enum class Connectivity
{
  Six,
  TwentySix
};

/// Betti numbers of a digital object.
struct BettiNumbers
{
  std::int64_t Components = 0;
  std::int64_t Tunnels = 0;
  std::int64_t Cavities = 0;

  std::int64_t euler() const { return this->Components - this->Tunnels + this->Cavities; }
  bool isBall() const { return this->Components == 1 && this->Tunnels == 0 && this->Cavities == 0; }
  bool operator==(const BettiNumbers& o) const
  {
    return this->Components == o.Components && this->Tunnels == o.Tunnels &&
           this->Cavities == o.Cavities;
  }
  bool operator!=(const BettiNumbers& o) const { return !(*this == o); }
};

/**
 * A run of equal voxels of one row, as labeling sees it: [Begin, End) along x in row `Row`
 * (y + ny z), and the number of its component, counted from 0 in the order of first voxels.
 */
struct LabeledRun
{
  std::int64_t Row;
  std::int32_t Begin;
  std::int32_t End;
  std::int64_t Label;
};

/// Connected components of the nonzero (or of the zero) voxels of a mask, by runs.
struct Components
{
  std::vector<LabeledRun> Runs;
  std::vector<std::int64_t> Voxels; ///< number of voxels of each component
};

/**
 * Labels the voxels whose being nonzero equals `foreground`. Linear in the image plus nearly linear
 * in the number of runs (union-find); 24 bytes a run.
 */
Result<Components> connectedComponents(const ImageView<const std::uint8_t>& mask, bool foreground,
  Connectivity connectivity, Monitor& monitor);

/// Clears everything but the largest component (of several largest: the first in memory order).
/// Returns the number of components found.
Result<std::int64_t> keepLargestComponent(
  const ImageView<std::uint8_t>& mask, Connectivity connectivity, Monitor& monitor);

/**
 * Betti numbers of the nonzero voxels; what lies beyond the image is background. `object` is the
 * connectivity of the object, the background has the other one (26 with 6, 6 with 26).
 * Components and cavities are counted by labeling, tunnels follow from the Euler characteristic,
 * which is summed over all 2 x 2 x 2 neighborhoods (as a complex of closed unit cubes for
 * connectivity 26).
 */
Result<BettiNumbers> bettiNumbers(
  const ImageView<const std::uint8_t>& mask, Connectivity object, Monitor& monitor);

/// The Euler characteristic alone.
std::int64_t eulerCharacteristic(
  const ImageView<const std::uint8_t>& mask, Connectivity object = Connectivity::TwentySix);
} // namespace bsr
