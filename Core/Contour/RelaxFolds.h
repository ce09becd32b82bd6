#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Contour/ContourStack.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/**
 * Smooths parts of a model in which patches are folded: least thin-plate energy with the contours'
 * points as data, then samples whose normal points backward are turned over by Newton's method on
 * the same energy, until none is left. All contacts of patches stay as they are (RelaxSpace).
 * \param jacobians patchJacobians of the model; brought up to date
 * \return number of patches that are still folded; the model is changed only where that helps
 */
Result<int> relaxFolds(
  SplineModel& model, std::vector<double>& jacobians, const ContourStack& stack, Monitor& monitor);
} // namespace bsr
