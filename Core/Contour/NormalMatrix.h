#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

#include <vector>

namespace bsr
{
/// A symmetric positive matrix summed up entry by entry (both halves given): dense where it is
/// small, else sparse, with what was added merged from time to time.
class NormalMatrix
{
public:
  explicit NormalMatrix(int size) : Size(size), Small(size <= Least)
  {
    if (this->Small)
    {
      this->Dense = Eigen::MatrixXd::Zero(size, size);
    }
    else
    {
      this->Sum.resize(size, size);
    }
  }

  void add(int row, int column, double value)
  {
    if (this->Small)
    {
      this->Dense(row, column) += value;
      return;
    }
    this->Entries.emplace_back(row, column, value);
    if (this->Entries.size() >= Most)
    {
      this->merge();
    }
  }

  /// Solves with a tiny part of the diagonal added; false where it is singular.
  bool solve(const Eigen::VectorXd& right, Eigen::VectorXd& x)
  {
    if (this->Small)
    {
      for (int i = 0; i < this->Size; ++i)
      {
        this->Dense(i, i) += 1e-9 * this->Dense(i, i) + 1e-12;
      }
      const Eigen::LLT<Eigen::MatrixXd> solver(this->Dense);
      x = solver.solve(right);
      return solver.info() == Eigen::Success && x.allFinite();
    }
    this->merge();
    for (int i = 0; i < this->Size; ++i)
    {
      this->Sum.coeffRef(i, i) += 1e-9 * this->Sum.coeff(i, i) + 1e-12;
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(this->Sum);
    if (solver.info() != Eigen::Success)
    {
      return false;
    }
    x = solver.solve(right);
    return x.allFinite();
  }

private:
  static constexpr int Least = 1200;
  static constexpr std::size_t Most = 1000000;

  void merge()
  {
    Eigen::SparseMatrix<double> more(this->Size, this->Size);
    more.setFromTriplets(this->Entries.begin(), this->Entries.end());
    this->Sum += more;
    this->Entries.clear();
  }

  int Size;
  bool Small;
  Eigen::MatrixXd Dense;
  Eigen::SparseMatrix<double> Sum;
  std::vector<Eigen::Triplet<double>> Entries;
};
} // namespace bsr
