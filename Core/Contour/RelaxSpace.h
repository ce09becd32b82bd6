#pragma once

#include "Spline/LinearForm.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/**
 * Displacements of the control points of some patches of a model that keep how all patches meet:
 * equal points on shared sides, and across each side the order of contact (C0, C1, C2) that it has
 * now, in the patches' parameters or symmetric about the side (P+ + P- = 2 D). About a vertex of
 * other than four sides the affinely regular star (JunctionRows.h) may only be mapped affinely;
 * what is no such star stays. Points of other patches stay.
 */
struct RelaxSpace
{
  int Variables = 0;              ///< each a vector
  std::vector<LinearForm> Points; ///< displacement of each control point of the model
};
/// \param region patches, sorted
RelaxSpace makeRelaxSpace(const SplineModel& model, const std::vector<std::int64_t>& region);

/// The patches and all that share a vertex with them, `rings` times; sorted.
std::vector<std::int64_t> growRegion(
  const SplineModel& model, const std::vector<std::int64_t>& patches, int rings);
} // namespace bsr
