#include "Spline/FitSystem.h"

#include "Common/Parallel.h"

#include <Eigen/SparseCholesky>

namespace bsr
{
namespace
{
using Columns = Eigen::SparseMatrix<double>;

/// A constraint "copy - owner = 0" as a patch sees it.
struct Tie
{
  Index Multiplier;
  int Local; ///< control point of the patch
  double Sign;
};

/**
 * The saddle point system [A G^T; G 0] of eq. 6 by block elimination: A falls into one dense block
 * a patch, so that the multipliers have a sparse positive definite system of their own,
 * G A^-1 G^T l = G A^-1 r. A patch with few points has a singular block; a tiny epsilon I makes it
 * definite, and iterative refinement with the exact blocks removes what epsilon does.
 */
class MultiplierSolver : public FitSolver
{
public:
  explicit MultiplierSolver(const PatchNet& net) : Net(net), Ties(net.patches())
  {
    // A chain through the copies of each net point.
    const int n = net.perPatch();
    this->Owner.assign(net.points(), -1);
    for (Index f = 0; f < net.patches(); ++f)
    {
      for (int l = 0; l < n; ++l)
      {
        Index& last = this->Owner[net.at(f, l)];
        if (last >= 0)
        {
          this->Ties[last / n].push_back({this->Multipliers, static_cast<int>(last % n), -1.0});
          this->Ties[f].push_back({this->Multipliers, l, 1.0});
          ++this->Multipliers;
        }
        last = f * n + l;
      }
    }
  }

  Index unknowns() const override
  {
    return this->Net.patches() * this->Net.perPatch() + this->Multipliers;
  }

  Result<NetPoints> solve(const PatchBlocks& blocks) override { return this->solve(blocks, 1e-11); }

  Result<NetPoints> solveRoughly(const PatchBlocks& blocks) override
  {
    return this->solve(blocks, 1e-5);
  }

private:
  using Blocks = std::vector<Eigen::MatrixXd>;

  Result<NetPoints> solve(const PatchBlocks& blocks, double tolerance)
  {
    if (!this->factorize(blocks))
    {
      return Status::failed("The equations of the fit with multipliers are singular: some patches "
                            "have too few points. Use C0 Reduction or Full G1.");
    }
    constexpr int Refinements = 20;
    const auto zero = Eigen::MatrixXd::Zero(this->Net.perPatch(), 3);
    Blocks x(this->Net.patches(), zero);
    Blocks rest = blocks.Right;
    Eigen::MatrixXd l = Eigen::MatrixXd::Zero(this->Multipliers, 3);
    const double size = std::sqrt(squaredNorm(rest));
    for (int i = 0; i < Refinements; ++i)
    {
      this->correct(rest, x, l);
      rest = this->residual(blocks, x, l);
      if (std::sqrt(squaredNorm(rest)) <= tolerance * size)
      {
        break;
      }
    }
    NetPoints net(this->Net.points(), 3);
    for (Index p = 0; p < this->Net.points(); ++p)
    {
      const Index at = this->Owner[p];
      net.row(p) = x[at / this->Net.perPatch()].row(at % this->Net.perPatch());
    }
    return net;
  }

  template <class F>
  void eachPatch(const F& f) const
  {
    parallelFor(0, this->Net.patches(), 4,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t p = begin; p < end; ++p)
        {
          f(static_cast<Index>(p));
        }
      });
  }

  static double squaredNorm(const Blocks& b)
  {
    double sum = 0.0;
    for (const auto& m : b)
    {
      sum += m.squaredNorm();
    }
    return sum;
  }

  /// The patches' blocks and the system of the multipliers; false where one is not definite.
  bool factorize(const PatchBlocks& blocks)
  {
    const int n = this->Net.perPatch();
    double scale = 0.0;
    for (const auto& a : blocks.Matrix)
    {
      scale = std::max(scale, a.diagonal().maxCoeff());
    }
    this->Factors.resize(blocks.Matrix.size());
    Blocks coupling(blocks.Matrix.size());
    this->eachPatch(
      [&](Index f)
      {
        Eigen::MatrixXd a = blocks.Matrix[f];
        a.diagonal().array() += 1e-8 * scale;
        this->Factors[f].compute(a);
        const auto& ties = this->Ties[f];
        Eigen::MatrixXd g = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(ties.size()));
        for (std::size_t i = 0; i < ties.size(); ++i)
        {
          g(ties[i].Local, static_cast<Eigen::Index>(i)) = ties[i].Sign;
        }
        coupling[f] = g.transpose() * this->Factors[f].solve(g);
      });
    std::vector<Eigen::Triplet<double>> t;
    for (Index f = 0; f < this->Net.patches(); ++f)
    {
      if (this->Factors[f].info() != Eigen::Success)
      {
        return false;
      }
      const auto& ties = this->Ties[f];
      for (std::size_t i = 0; i < ties.size(); ++i)
      {
        for (std::size_t j = 0; j < ties.size(); ++j)
        {
          if (ties[i].Multiplier >= ties[j].Multiplier)
          {
            t.emplace_back(ties[i].Multiplier, ties[j].Multiplier,
              coupling[f](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
          }
        }
      }
    }
    Columns s(this->Multipliers, this->Multipliers);
    s.setFromTriplets(t.begin(), t.end());
    if (!this->Analyzed)
    {
      this->Schur.analyzePattern(s);
      this->Analyzed = true;
    }
    this->Schur.factorize(s);
    return this->Multipliers == 0 || this->Schur.info() == Eigen::Success;
  }

  /// Adds the solution of the regularized system for right sides `rest` and -G x.
  void correct(const Blocks& rest, Blocks& x, Eigen::MatrixXd& l) const
  {
    Blocks step(rest.size());
    this->eachPatch([&](Index f) { step[f] = this->Factors[f].solve(rest[f]); });
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(this->Multipliers, 3);
    for (Index f = 0; f < this->Net.patches(); ++f)
    {
      for (const Tie& t : this->Ties[f])
      {
        right.row(t.Multiplier) += t.Sign * (step[f].row(t.Local) + x[f].row(t.Local));
      }
    }
    const Eigen::MatrixXd dl =
      this->Multipliers > 0 ? Eigen::MatrixXd(this->Schur.solve(right)) : right;
    l += dl;
    this->eachPatch(
      [&](Index f)
      {
        Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(this->Net.perPatch(), 3);
        for (const Tie& t : this->Ties[f])
        {
          pull.row(t.Local) += t.Sign * dl.row(t.Multiplier);
        }
        x[f] += step[f] - this->Factors[f].solve(pull);
      });
  }

  /// r - A x - G^T l with the exact blocks.
  Blocks residual(const PatchBlocks& blocks, const Blocks& x, const Eigen::MatrixXd& l) const
  {
    Blocks rest(x.size());
    this->eachPatch(
      [&](Index f)
      {
        rest[f] = blocks.Right[f] - blocks.Matrix[f] * x[f];
        for (const Tie& t : this->Ties[f])
        {
          rest[f].row(t.Local) -= t.Sign * l.row(t.Multiplier);
        }
      });
    return rest;
  }

  const PatchNet& Net;
  std::vector<std::vector<Tie>> Ties; ///< of each patch
  std::vector<Index> Owner;           ///< a copy of each net point: patch * perPatch + local
  Index Multipliers = 0;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> Factors;
  Eigen::SimplicialLLT<Columns, Eigen::Lower, Eigen::AMDOrdering<int>> Schur;
  bool Analyzed = false;
};
} // namespace

std::unique_ptr<FitSolver> makeMultiplierSolver(const PatchNet& net)
{
  return std::make_unique<MultiplierSolver>(net);
}
} // namespace bsr
