#include "Mesh/SmoothRing.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace bsr
{
Eigen::MatrixXd ringPenalty(double waves)
{
  constexpr int n = MouthFrame::Bins;
  Eigen::MatrixXd penalty = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i)
  {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
    d[(i + n - 1) % n] = 1.0;
    d[i] = -2.0;
    d[(i + 1) % n] = 1.0;
    penalty += d * d.transpose();
  }
  return std::pow(2.0 * MouthFrame::Pi * waves / n, -4.0) * penalty;
}

Eigen::VectorXd SmoothRing::through(
  const Eigen::VectorXd& value, const Eigen::VectorXd& weight) const
{
  Eigen::MatrixXd normal = this->Penalty;
  normal.diagonal() += weight;
  return normal.ldlt().solve(weight.cwiseProduct(value));
}
} // namespace bsr
