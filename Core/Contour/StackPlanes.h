#pragma once

#include "Contour/ContourStack.h"

namespace bsr
{
/// The first half of buildStack: cleaned contours in slices, flat coordinates, counterclockwise.
/// Leaves Level, Parent, links and numbers to linkStack.
Result<ContourStack> sliceContours(
  const std::vector<Polyline>& polylines, const StackOptions& options, Monitor& monitor);

/// The second half: nesting, crossings, links, components and branches.
Status linkStack(ContourStack& stack, const StackOptions& options, Monitor& monitor);
} // namespace bsr
