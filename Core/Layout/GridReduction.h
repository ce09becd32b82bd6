#pragma once

#include "Common/SparseFactors.h"
#include "Common/Types.h"

#include <Eigen/Core>

namespace bsr
{
/// Columns of L^-1 P B for sparse B: only the paths to the root of the elimination tree are
/// touched. Incomplete once cancelled.
Eigen::SparseMatrix<double> forwardSolved(const SparseFactors<Eigen::SparseMatrix<double>>& factors,
  const Eigen::SparseMatrix<double>& b, Monitor& monitor);

/// own - R^T diag(weight) R, which is symmetric (of own, the lower half is given); incomplete once
/// cancelled.
Eigen::MatrixXd schurComplement(const Eigen::MatrixXd& own, const Eigen::SparseMatrix<double>& r,
  const Eigen::VectorXd& weight, Monitor& monitor);

/// Replaces a symmetric matrix (lower half given) without negative eigenvalues by its inverse;
/// pivots below `least` are raised to that. False: cancelled.
bool invert(Eigen::MatrixXd& a, double least, Monitor& monitor);
} // namespace bsr
