#include "Spline/FitSystem.h"

#include <Eigen/SparseCholesky>

namespace bsr
{
namespace
{
/**
 * The saddle point system [A G^T; G 0] of eq. 6, quasi-definite by a tiny -epsilon I so that a
 * sparse LDL^T exists for every order; iterative refinement removes what epsilon does.
 */
class MultiplierSolver : public FitSolver
{
public:
  explicit MultiplierSolver(const PatchNet& net) : Net(net)
  {
    // One owner of each net point; every other copy gets a constraint "copy - owner = 0".
    std::vector<Index> owner(net.points(), -1);
    this->Total = static_cast<std::int64_t>(net.patches()) * net.perPatch();
    for (Index f = 0; f < net.patches(); ++f)
    {
      for (int l = 0; l < net.perPatch(); ++l)
      {
        const Index copy = f * net.perPatch() + l;
        Index& o = owner[net.at(f, l)];
        if (o < 0)
        {
          o = copy;
        }
        else
        {
          this->Pairs.emplace_back(o, copy);
          o = copy;
        }
      }
    }
    this->Owner = std::move(owner);
  }

  Index unknowns() const override
  {
    return static_cast<Index>(this->Total + static_cast<std::int64_t>(this->Pairs.size()));
  }

  Result<NetPoints> solve(const PatchBlocks& blocks) override
  {
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(this->unknowns(), 3);
    const Eigen::SparseMatrix<double> exact = this->assemble(blocks, 0.0, right);
    Eigen::MatrixXd ignored = right;
    const double scale = exact.coeffs().abs().maxCoeff();
    const Eigen::SparseMatrix<double> regular = this->assemble(blocks, 1e-9 * scale, ignored);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(regular);
    if (solver.info() != Eigen::Success)
    {
      return Status::failed("The equations of the fit with multipliers are singular: some patches "
                            "have too few points. Use C0 Reduction or Full G1.");
    }
    Eigen::MatrixXd x = solver.solve(right);
    const auto h = exact.selfadjointView<Eigen::Lower>();
    for (int i = 0; i < 6; ++i)
    {
      x += solver.solve(right - h * x);
    }
    NetPoints net(this->Net.points(), 3);
    for (Index p = 0; p < this->Net.points(); ++p)
    {
      net.row(p) = x.row(this->Owner[p]);
    }
    return net;
  }

  Result<NetPoints> solveRoughly(const PatchBlocks& blocks) override { return this->solve(blocks); }

private:
  Eigen::SparseMatrix<double> assemble(
    const PatchBlocks& blocks, double epsilon, Eigen::MatrixXd& right) const
  {
    const int n = this->Net.perPatch();
    std::vector<Eigen::Triplet<double>> t;
    double scale = 0.0;
    for (Index f = 0; f < this->Net.patches(); ++f)
    {
      const Eigen::MatrixXd& a = blocks.Matrix[f];
      scale = std::max(scale, a.diagonal().maxCoeff());
      for (int c = 0; c < n; ++c)
      {
        right.row(f * n + c) = blocks.Right[f].row(c);
        t.emplace_back(f * n + c, f * n + c, a(c, c) + epsilon);
        for (int r = c + 1; r < n; ++r)
        {
          t.emplace_back(f * n + r, f * n + c, a(r, c));
        }
      }
    }
    for (std::size_t i = 0; i < this->Pairs.size(); ++i)
    {
      const auto row = static_cast<Index>(this->Total + static_cast<std::int64_t>(i));
      t.emplace_back(row, this->Pairs[i].first, -scale);
      t.emplace_back(row, this->Pairs[i].second, scale);
      t.emplace_back(row, row, -epsilon);
    }
    Eigen::SparseMatrix<double> m(this->unknowns(), this->unknowns());
    m.setFromTriplets(t.begin(), t.end());
    return m;
  }

  const PatchNet& Net;
  std::int64_t Total = 0;
  std::vector<std::pair<Index, Index>> Pairs;
  std::vector<Index> Owner;
};
} // namespace

std::unique_ptr<FitSolver> makeMultiplierSolver(const PatchNet& net)
{
  return std::make_unique<MultiplierSolver>(net);
}
} // namespace bsr
