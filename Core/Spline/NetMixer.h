#pragma once

#include "Spline/FitPoints.h"

#include <deque>

namespace bsr
{
/**
 * Anderson's acceleration of an iteration x -> g(x) on nets (Walker and Ni 2011, "Anderson
 * acceleration for fixed-point iterations"): the next net is the combination of the last images
 * g(x_i), of factors that sum up to 1, whose combined steps g(x_i) - x_i are shortest. Nets of a
 * linear space stay in it.
 */
class NetMixer
{
public:
  explicit NetMixer(std::size_t depth) : Depth(depth) {}

  /// The net to go on from, after the step from `from` to `to`.
  NetPoints next(const NetPoints& from, const NetPoints& to);
  void clear() { this->Images.clear(), this->Steps.clear(); }

private:
  std::size_t Depth; ///< steps that are remembered
  std::deque<NetPoints> Images;
  std::deque<NetPoints> Steps;
};
} // namespace bsr
