#pragma once

#include "Common/Monitor.h"

#include <Eigen/SparseCholesky>

#include <vector>

namespace bsr
{
/**
 * Factors L D L* of a sparse self-adjoint matrix (lower half given), as Eigen::SimplicialLDLT, but
 * `factorize` asks the monitor every few thousandths of a second. Rows of L one after the other by
 * the elimination tree (Davis 2005, "Algorithm 849: a concise sparse Cholesky factorization
 * package"); the same numbers as Eigen's.
 */
template <class Matrix>
class SparseFactors : public Eigen::SimplicialLDLT<Matrix>
{
  using Base = Eigen::SimplicialLDLT<Matrix>;
  using Scalar = typename Matrix::Scalar;
  using StorageIndex = typename Matrix::StorageIndex;
  static constexpr std::int64_t MostSteps = 1 << 21; ///< products between two questions

public:
  /// \pre analyzePattern was called for a matrix with the same entries
  /// \return false if cancelled or singular
  bool factorize(const Matrix& a, Monitor& monitor)
  {
    typename Base::CholMatrixType upper(a.rows(), a.cols());
    upper.template selfadjointView<Eigen::Upper>() =
      a.template selfadjointView<Eigen::Lower>().twistedBy(this->m_P);
    const auto n = static_cast<StorageIndex>(a.rows());
    this->m_diag.resize(n);
    this->m_info = Eigen::NumericalIssue;
    this->m_factorizationIsOk = true;
    this->Row.assign(n, Scalar(0));
    this->Path.assign(n, 0);
    this->Seen.assign(n, -1);
    std::int64_t steps = MostSteps;
    for (StorageIndex k = 0; k < n; ++k)
    {
      if (steps >= MostSteps)
      {
        if (monitor.cancelled())
        {
          return false;
        }
        steps = 0;
      }
      this->m_nonZerosPerCol[k] = 0;
      steps += 16 + this->solveRow(k, this->reach(upper, k));
      if (this->m_diag[k] == Scalar(0))
      {
        return false;
      }
    }
    this->m_info = Eigen::Success;
    return true;
  }

private:
  /// Scatters column k of the upper half; the columns of L that row k depends on are put, each
  /// behind those that it depends on, at the end of Path from the place returned.
  StorageIndex reach(const typename Base::CholMatrixType& upper, StorageIndex k)
  {
    auto first = static_cast<StorageIndex>(this->Path.size());
    this->Row[k] = Scalar(0);
    this->Seen[k] = k;
    for (typename Base::CholMatrixType::InnerIterator it(upper, k); it && it.index() <= k; ++it)
    {
      StorageIndex i = it.index();
      this->Row[i] += Eigen::numext::conj(it.value());
      StorageIndex length = 0;
      for (; this->Seen[i] != k; i = this->m_parent[i])
      {
        this->Path[length++] = i;
        this->Seen[i] = k;
      }
      while (length > 0)
      {
        this->Path[--first] = this->Path[--length];
      }
    }
    return first;
  }

  /// Appends row k to L; returns the number of products.
  std::int64_t solveRow(StorageIndex k, StorageIndex first)
  {
    const StorageIndex* start = this->m_matrix.outerIndexPtr();
    StorageIndex* rows = this->m_matrix.innerIndexPtr();
    Scalar* values = this->m_matrix.valuePtr();
    auto diagonal = Eigen::numext::real(this->Row[k]);
    this->Row[k] = Scalar(0);
    std::int64_t products = 0;
    for (std::size_t at = first; at < this->Path.size(); ++at)
    {
      const StorageIndex i = this->Path[at];
      const Scalar y = this->Row[i];
      this->Row[i] = Scalar(0);
      const Scalar l = y / Eigen::numext::real(this->m_diag[i]);
      const StorageIndex end = start[i] + this->m_nonZerosPerCol[i]++;
      for (StorageIndex p = start[i]; p < end; ++p)
      {
        this->Row[rows[p]] -= Eigen::numext::conj(values[p]) * y;
      }
      diagonal -= Eigen::numext::real(l * Eigen::numext::conj(y));
      rows[end] = k;
      values[end] = l;
      products += end - start[i] + 1;
    }
    this->m_diag[k] = diagonal;
    return products;
  }

  std::vector<Scalar> Row;        ///< of A, then of L
  std::vector<StorageIndex> Path; ///< stack at the end; from the start a path of the tree
  std::vector<StorageIndex> Seen; ///< per column: the last row that reached it
};
} // namespace bsr
