#include "Layout/GridReduction.h"

#include "Common/Parallel.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace bsr
{
namespace
{
using Sparse = Eigen::SparseMatrix<double>;
constexpr Eigen::Index Block = 48; ///< columns of a dense matrix at a time

/// L D L^T of columns `first` to `first + count` of the lower half, and of the rows below.
void factorPanel(
  Eigen::MatrixXd& a, Eigen::VectorXd& d, Eigen::Index first, Eigen::Index count, double least)
{
  for (Eigen::Index k = first; k < first + count; ++k)
  {
    d[k] = std::max(a(k, k), least);
    const Eigen::Index below = a.rows() - k - 1;
    a.col(k).tail(below) /= d[k];
    for (Eigen::Index j = k + 1; j < first + count; ++j)
    {
      a.col(j).tail(a.rows() - j) -= d[k] * a(j, k) * a.col(k).tail(a.rows() - j);
    }
  }
}

/// L D L^T in the lower half; false: cancelled.
bool factor(Eigen::MatrixXd& a, Eigen::VectorXd& d, double least, Monitor& monitor)
{
  const Eigen::Index n = a.rows();
  d.resize(n);
  for (Eigen::Index first = 0; first < n; first += Block)
  {
    const Eigen::Index count = std::min(Block, n - first);
    factorPanel(a, d, first, count, least);
    const Eigen::Index rest = first + count;
    const Eigen::MatrixXd scaled =
      a.block(rest, first, n - rest, count) * d.segment(first, count).asDiagonal();
    const Eigen::Index tiles = (n - rest + Block - 1) / Block;
    const bool goesOn = parallelForUntilCancelled(0, tiles, 1, monitor,
      [&](std::int64_t from, std::int64_t to)
      {
        for (std::int64_t tile = from; tile < to; ++tile)
        {
          const Eigen::Index at = rest + tile * Block;
          const Eigen::Index wide = std::min(Block, n - at);
          a.block(at, at, n - at, wide).noalias() -=
            scaled.bottomRows(n - at) * a.block(at, first, wide, count).transpose();
        }
      });
    if (!goesOn)
    {
      return false;
    }
  }
  return true;
}
} // namespace

Sparse forwardSolved(const SparseFactors<Sparse>& factors, const Sparse& b, Monitor& monitor)
{
  const auto& lower = factors.matrixL().nestedExpression();
  const auto n = static_cast<Index>(lower.cols());
  std::vector<Index> parent(n, -1);
  for (Index j = 0; j < n; ++j)
  {
    Sparse::InnerIterator it(lower, j);
    for (; it && it.row() <= j; ++it)
    {
    }
    parent[j] = it ? static_cast<Index>(it.row()) : -1;
  }
  const auto& permute = factors.permutationP().indices();
  std::vector<std::vector<std::pair<Index, double>>> columns(b.cols());
  parallelForUntilCancelled(0, b.cols(), 8, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      std::vector<double> x(n, 0.0);
      std::vector<std::uint8_t> seen(n, 0);
      for (std::int64_t c = first; c < last; ++c)
      {
        std::vector<Index> reached;
        for (Sparse::InnerIterator it(b, c); it; ++it)
        {
          const Index i = permute[it.row()];
          x[i] = it.value();
          for (Index j = i; j >= 0 && seen[j] == 0; j = parent[j])
          {
            seen[j] = 1;
            reached.push_back(j);
          }
        }
        std::sort(reached.begin(), reached.end());
        columns[c].reserve(reached.size());
        for (Index j : reached)
        {
          for (Sparse::InnerIterator it(lower, j); it; ++it)
          {
            if (it.row() > j)
            {
              x[it.row()] -= it.value() * x[j];
            }
          }
          columns[c].emplace_back(j, x[j]);
          x[j] = 0.0;
          seen[j] = 0;
        }
      }
    });
  Sparse out(n, b.cols());
  Eigen::VectorXi entries(b.cols());
  for (Eigen::Index c = 0; c < b.cols(); ++c)
  {
    entries[c] = static_cast<int>(columns[c].size());
  }
  out.reserve(entries);
  for (std::size_t c = 0; c < columns.size() && (c % 16 != 0 || !monitor.cancelled()); ++c)
  {
    for (const auto& [row, value] : columns[c])
    {
      out.insert(row, static_cast<Index>(c)) = value;
    }
  }
  out.makeCompressed();
  return out;
}

Eigen::MatrixXd schurComplement(
  const Eigen::MatrixXd& own, const Sparse& r, const Eigen::VectorXd& weight, Monitor& monitor)
{
  Eigen::MatrixXd out = own;
  parallelForUntilCancelled(0, own.cols(), 2, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(r.rows());
      for (std::int64_t j = first; j < last; ++j)
      {
        for (Sparse::InnerIterator it(r, j); it; ++it)
        {
          column[it.row()] = weight[it.row()] * it.value();
        }
        for (Eigen::Index i = j; i < own.rows(); ++i)
        {
          double sum = 0.0;
          for (Sparse::InnerIterator it(r, i); it; ++it)
          {
            sum += it.value() * column[it.row()];
          }
          out(i, j) -= sum;
        }
        for (Sparse::InnerIterator it(r, j); it; ++it)
        {
          column[it.row()] = 0.0;
        }
      }
    });
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  return out;
}

bool invert(Eigen::MatrixXd& a, double least, Monitor& monitor)
{
  const Eigen::Index n = a.rows();
  Eigen::VectorXd d;
  if (!factor(a, d, least, monitor))
  {
    return false;
  }
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  const bool done = parallelForUntilCancelled(0, (n + Block - 1) / Block, 1, monitor,
    [&](std::int64_t from, std::int64_t to)
    {
      for (std::int64_t tile = from; tile < to; ++tile)
      {
        const Eigen::Index at = tile * Block;
        const Eigen::Index wide = std::min(Block, n - at);
        Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, wide);
        x.middleRows(at, wide).setIdentity();
        a.triangularView<Eigen::UnitLower>().solveInPlace(x);
        x = d.cwiseInverse().asDiagonal() * x;
        a.transpose().triangularView<Eigen::UnitUpper>().solveInPlace(x);
        inverse.middleCols(at, wide) = x;
      }
    });
  a.swap(inverse);
  return done;
}
} // namespace bsr
