#pragma once

#include "Mesh/FiberRim.h"

#include <Eigen/Core>

namespace bsr
{
/// The penalty on the second derivative of a profile that halves waves of the given number around
/// where each value has weight 1: a symmetric Bins x Bins matrix.
Eigen::MatrixXd ringPenalty(double waves);

/// Least squares with weights and the penalty of ringPenalty().
class SmoothRing
{
public:
  explicit SmoothRing(double waves) : Penalty(ringPenalty(waves)) {}
  Eigen::VectorXd through(const Eigen::VectorXd& value, const Eigen::VectorXd& weight) const;

private:
  Eigen::MatrixXd Penalty;
};
} // namespace bsr
