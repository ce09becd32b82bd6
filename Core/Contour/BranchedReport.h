#pragma once

#include "Contour/BranchedSurface.h"
#include "Contour/SurfaceReport.h"

namespace bsr
{
/// What a branched surface is worth, measured on its exact model.
struct BranchedReport
{
  InputError Input;
  ResliceError Reslice;
  std::vector<double> NormalJump; ///< of each patch: largest along its sides, degrees
  double MaxNormalJump = 0.0;
  double JunctionNormalJump = 0.0; ///< of sides between tubes, or of tubes at a junction
  std::int64_t OpenSides = 0;
  std::vector<NetworkNote> LeftOut; ///< contours and links that are not in it, and why
};

Result<BranchedReport> reportBranched(
  const BranchedSurface& surface, const ContourStack& stack, Monitor& monitor);
} // namespace bsr
