#include "Layout/GridReduction.h"

#include <gtest/gtest.h>

#include <random>

using namespace bsr;

namespace
{
using Sparse = Eigen::SparseMatrix<double>;

/// The lower half of a grid's Laplacian with some weights.
Sparse gridMatrix(int n)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> weight(0.5, 2.0);
  std::vector<Eigen::Triplet<double>> entries;
  const auto join = [&](int a, int b)
  {
    const double w = weight(random);
    entries.emplace_back(a, a, w);
    entries.emplace_back(b, b, w);
    entries.emplace_back(std::max(a, b), std::min(a, b), -w);
  };
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      entries.emplace_back(n * i + j, n * i + j, 1e-3);
      if (i + 1 < n)
      {
        join(n * i + j, n * i + n + j);
      }
      if (j + 1 < n)
      {
        join(n * i + j, n * i + j + 1);
      }
    }
  }
  Sparse m(n * n, n * n);
  m.setFromTriplets(entries.begin(), entries.end());
  return m;
}

class CancelAfter : public Monitor
{
public:
  explicit CancelAfter(int questions) : Left(questions) {}
  bool cancelled() override { return this->Left-- <= 0; }

private:
  int Left;
};

Eigen::MatrixXd someMatrix(int rows, int cols)
{
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd m(rows, cols);
  for (double& value : m.reshaped())
  {
    value = normal(random);
  }
  return m;
}
} // namespace

TEST(GridReduction, SparseFactorsAreEigensAndCanBeCancelled)
{
  const Sparse m = gridMatrix(120);
  const Eigen::SimplicialLDLT<Sparse> theirs(m);
  SparseFactors<Sparse> ours;
  ours.analyzePattern(m);
  Monitor monitor;
  for (int time = 0; time < 2; ++time) // factors of the same entries are made again
  {
    ASSERT_TRUE(ours.factorize(m, monitor));
    EXPECT_EQ(ours.vectorD(), theirs.vectorD());
    const Sparse a = ours.matrixL();
    const Sparse b = theirs.matrixL();
    EXPECT_EQ((a - b).norm(), 0.0);
  }
  CancelAfter none(0);
  EXPECT_FALSE(ours.factorize(m, none));
  EXPECT_NE(ours.info(), Eigen::Success);
  CancelAfter later(1);
  EXPECT_EQ(ours.factorize(gridMatrix(120), later), false) << "asked once only";
}

TEST(GridReduction, SchurComplementAndInverseAreExact)
{
  const int n = 150; // more than a block
  Monitor monitor;
  const Eigen::MatrixXd root = someMatrix(n, n + 20);
  const Eigen::MatrixXd own = 50.0 * root * root.transpose();
  Sparse mixed = Eigen::MatrixXd(someMatrix(300, n)).sparseView(1.0, 1.5);
  const Eigen::VectorXd weight = someMatrix(300, 1).cwiseAbs();
  const Eigen::MatrixXd dense = mixed;
  const Eigen::MatrixXd expected = own - dense.transpose() * weight.asDiagonal() * dense;
  const Eigen::MatrixXd schur = schurComplement(own, mixed, weight, monitor);
  EXPECT_LT((schur - expected).cwiseAbs().maxCoeff(), 1e-10 * own.cwiseAbs().maxCoeff());
  EXPECT_EQ(schur, Eigen::MatrixXd(schur.transpose()));
  Eigen::MatrixXd inverse = own;
  ASSERT_TRUE(invert(inverse, 1e-12, monitor));
  EXPECT_LT((inverse * own - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-6);
  CancelAfter soon(2);
  Eigen::MatrixXd again = own;
  EXPECT_FALSE(invert(again, 1e-12, soon));
}
