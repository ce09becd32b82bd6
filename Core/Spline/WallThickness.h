#pragma once

#include "Spline/FitPoints.h"

namespace bsr
{
/// Smallest distance between samples of the two shells (9 x 9 a patch), negative where a sample of
/// the inner shell lies outside the outer one.
double minimumWall(const PatchNet& net, const NetPoints& outer, const NetPoints& inner);
} // namespace bsr
