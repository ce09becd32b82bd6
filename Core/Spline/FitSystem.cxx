#include "Spline/FitSystem.h"

#include "Common/Parallel.h"

#include <Eigen/SparseCholesky>

namespace bsr
{
namespace
{
using Columns = Eigen::SparseMatrix<double>;

const char* const Singular =
  "The equations of the fit are singular: too few points hold the surface. "
  "Give more points, fewer quads or more fairing.";

/// The rows of the basis that a patch uses, over its own columns.
struct LocalBasis
{
  std::vector<Index> Column;                            ///< global, increasing
  std::vector<std::vector<std::pair<int, double>>> Row; ///< of each control point
  std::vector<int> Position;                            ///< of the lower triangle in the values
};

LocalBasis localBasis(const PatchNet& net, const SparseRows& basis, Index patch)
{
  LocalBasis b;
  for (int l = 0; l < net.perPatch(); ++l)
  {
    for (SparseRows::InnerIterator it(basis, net.at(patch, l)); it; ++it)
    {
      b.Column.push_back(static_cast<Index>(it.col()));
    }
  }
  std::sort(b.Column.begin(), b.Column.end());
  b.Column.erase(std::unique(b.Column.begin(), b.Column.end()), b.Column.end());
  b.Row.resize(net.perPatch());
  for (int l = 0; l < net.perPatch(); ++l)
  {
    for (SparseRows::InnerIterator it(basis, net.at(patch, l)); it; ++it)
    {
      const auto c = std::lower_bound(b.Column.begin(), b.Column.end(), it.col());
      b.Row[l].emplace_back(static_cast<int>(c - b.Column.begin()), it.value());
    }
  }
  return b;
}

/// Lower triangle of B^T A B and B^T r.
struct LocalSystem
{
  Eigen::MatrixXd Matrix;
  Eigen::MatrixXd Right;
};

LocalSystem reduce(const LocalBasis& b, const Eigen::MatrixXd& a, const Eigen::MatrixXd& r)
{
  const auto k = static_cast<Eigen::Index>(b.Column.size());
  LocalSystem s{Eigen::MatrixXd::Zero(k, k), Eigen::MatrixXd::Zero(k, 3)};
  // C = (A B)^T, one row a local unknown.
  Eigen::MatrixXd ab = Eigen::MatrixXd::Zero(a.rows(), k);
  for (std::size_t l = 0; l < b.Row.size(); ++l)
  {
    for (const auto& [column, value] : b.Row[l])
    {
      ab.col(column) += value * a.col(static_cast<Eigen::Index>(l));
      s.Right.row(column) += value * r.row(static_cast<Eigen::Index>(l));
    }
  }
  const Eigen::MatrixXd ba = ab.transpose();
  for (std::size_t l = 0; l < b.Row.size(); ++l)
  {
    for (const auto& [column, value] : b.Row[l])
    {
      s.Matrix.col(column) += value * ba.col(static_cast<Eigen::Index>(l));
    }
  }
  return s;
}

class ReducedSolver : public FitSolver
{
public:
  ReducedSolver(const PatchNet& net, const SplineSpace& space)
      : Net(net), Basis(space.Basis), Local(net.patches())
  {
    parallelFor(0, net.patches(), 8,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t p = begin; p < end; ++p)
        {
          this->Local[p] = localBasis(this->Net, this->Basis, static_cast<Index>(p));
        }
      });
    this->buildPattern();
  }

  Index unknowns() const override { return static_cast<Index>(this->Basis.cols()); }

  Result<NetPoints> solve(const PatchBlocks& blocks) override
  {
    this->assemble(blocks);
    if (!this->Analyzed)
    {
      this->Cholesky.analyzePattern(this->Matrix);
      this->Analyzed = true;
    }
    this->Cholesky.factorize(this->Matrix);
    if (this->Cholesky.info() != Eigen::Success)
    {
      return Status::failed(Singular);
    }
    return this->netFrom(this->Cholesky.solve(this->Right));
  }

  Result<NetPoints> solveRoughly(const PatchBlocks& blocks) override
  {
    this->assemble(blocks);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(this->Basis.cols(), 3);
    if (this->Last.rows() == x.rows())
    {
      x = this->Scale.cwiseInverse().asDiagonal() * this->Last;
    }
    for (int c = 0; c < 3; ++c)
    {
      Eigen::VectorXd column = x.col(c);
      this->conjugateGradients(this->Right.col(c), column);
      x.col(c) = column;
    }
    return this->netFrom(x);
  }

private:
  void buildPattern()
  {
    std::vector<Eigen::Triplet<double>> pattern;
    // Column by column: the rows of all patches that hold the column.
    std::vector<std::vector<Index>> rows(this->Basis.cols());
    for (const LocalBasis& b : this->Local)
    {
      for (std::size_t c = 0; c < b.Column.size(); ++c)
      {
        auto& list = rows[b.Column[c]];
        list.insert(list.end(), b.Column.begin() + static_cast<std::ptrdiff_t>(c), b.Column.end());
      }
    }
    std::vector<int> outer(rows.size() + 1, 0);
    std::vector<int> inner;
    for (std::size_t c = 0; c < rows.size(); ++c)
    {
      std::sort(rows[c].begin(), rows[c].end());
      rows[c].erase(std::unique(rows[c].begin(), rows[c].end()), rows[c].end());
      inner.insert(inner.end(), rows[c].begin(), rows[c].end());
      outer[c + 1] = static_cast<int>(inner.size());
      rows[c] = {};
    }
    const std::vector<double> zero(inner.size(), 0.0);
    this->Matrix = Eigen::Map<const Columns>(this->Basis.cols(), this->Basis.cols(),
      static_cast<Eigen::Index>(inner.size()), outer.data(), inner.data(), zero.data());
    for (LocalBasis& b : this->Local)
    {
      for (std::size_t c = 0; c < b.Column.size(); ++c)
      {
        auto from = inner.begin() + outer[b.Column[c]];
        for (std::size_t r = c; r < b.Column.size(); ++r)
        {
          from = std::lower_bound(from, inner.begin() + outer[b.Column[c] + 1], b.Column[r]);
          b.Position.push_back(static_cast<int>(from - inner.begin()));
        }
      }
    }
  }

  /// Sums the patches in their order, whatever the number of threads; scales to a unit diagonal.
  void assemble(const PatchBlocks& blocks)
  {
    constexpr Index Batch = 64;
    double* values = this->Matrix.valuePtr();
    std::fill(values, values + this->Matrix.nonZeros(), 0.0);
    this->Right = Eigen::MatrixXd::Zero(this->Basis.cols(), 3);
    std::vector<LocalSystem> local(Batch);
    for (Index first = 0; first < this->Net.patches(); first += Batch)
    {
      const Index end = std::min(first + Batch, this->Net.patches());
      parallelFor(first, end, 2,
        [&](std::int64_t a, std::int64_t b)
        {
          for (std::int64_t p = a; p < b; ++p)
          {
            local[p - first] = reduce(this->Local[p], blocks.Matrix[p], blocks.Right[p]);
          }
        });
      for (Index p = first; p < end; ++p)
      {
        this->scatter(this->Local[p], local[p - first], values);
      }
    }
    this->scaleToUnitDiagonal(values);
  }

  void scatter(const LocalBasis& b, const LocalSystem& s, double* values)
  {
    const int* position = b.Position.data();
    const auto k = static_cast<Eigen::Index>(b.Column.size());
    for (Eigen::Index c = 0; c < k; ++c)
    {
      for (Eigen::Index r = c; r < k; ++r)
      {
        values[*position++] += s.Matrix(r, c);
      }
      this->Right.row(b.Column[c]) += s.Right.row(c);
    }
  }

  void scaleToUnitDiagonal(double* values)
  {
    const int* outer = this->Matrix.outerIndexPtr();
    const int* inner = this->Matrix.innerIndexPtr();
    const auto n = this->Matrix.cols();
    this->Scale.resize(n);
    for (Eigen::Index c = 0; c < n; ++c)
    {
      const double d = values[outer[c]]; // the diagonal leads its column
      this->Scale[c] = d > 0.0 ? 1.0 / std::sqrt(d) : 1.0;
    }
    for (Eigen::Index c = 0; c < n; ++c)
    {
      for (int i = outer[c]; i < outer[c + 1]; ++i)
      {
        values[i] *= this->Scale[c] * this->Scale[inner[i]];
      }
      this->Right.row(c) *= this->Scale[c];
    }
  }

  NetPoints netFrom(const Eigen::MatrixXd& x)
  {
    this->Last = this->Scale.asDiagonal() * x;
    return this->Basis * this->Last;
  }

  void conjugateGradients(const Eigen::VectorXd& right, Eigen::VectorXd& x) const
  {
    const auto h = this->Matrix.selfadjointView<Eigen::Lower>();
    Eigen::VectorXd r = right - h * x;
    Eigen::VectorXd d = r;
    double rho = r.squaredNorm();
    const double goal = 1e-10 * right.squaredNorm();
    for (int i = 0; i < 400 && rho > goal; ++i)
    {
      const Eigen::VectorXd hd = h * d;
      const double alpha = rho / d.dot(hd);
      x += alpha * d;
      r -= alpha * hd;
      const double next = r.squaredNorm();
      d = r + next / rho * d;
      rho = next;
    }
  }

  const PatchNet& Net;
  const SparseRows& Basis;
  std::vector<LocalBasis> Local;
  Columns Matrix; ///< lower triangle
  Eigen::MatrixXd Right;
  Eigen::VectorXd Scale;
  Eigen::MatrixXd Last; ///< unknowns of the last solution
  Eigen::SimplicialLDLT<Columns, Eigen::Lower, Eigen::AMDOrdering<int>> Cholesky;
  bool Analyzed = false;
};
} // namespace

void PatchBlocks::resize(Index patches, int perPatch)
{
  this->Matrix.assign(patches, Eigen::MatrixXd::Zero(perPatch, perPatch));
  this->Right.assign(patches, Eigen::MatrixXd::Zero(perPatch, 3));
}

PatchBlocks dataBlocks(
  const PatchNet& net, const std::vector<FitPoint>& points, const std::vector<std::int64_t>& first)
{
  const int n = net.side();
  const auto knots = segmentKnots(3, net.segments(), 2);
  PatchBlocks blocks;
  blocks.resize(net.patches(), net.perPatch());
  const auto addPoint = [&](const FitPoint& p)
  {
    const BasisValues u = evaluateBasis(knots.data(), 3, n, p.U);
    const BasisValues v = evaluateBasis(knots.data(), 3, n, p.V);
    int local[16];
    double value[16];
    for (int l = 0; l < 16; ++l)
    {
      local[l] = (v.First + l / 4) * n + u.First + l % 4;
      value[l] = u.Value[l % 4] * v.Value[l / 4];
    }
    Eigen::MatrixXd& a = blocks.Matrix[p.Patch];
    Eigen::MatrixXd& r = blocks.Right[p.Patch];
    for (int i = 0; i < 16; ++i)
    {
      const double w = p.weight() * value[i];
      r.row(local[i]) += w * p.Position.transpose();
      for (int j = 0; j < 16; ++j)
      {
        a(local[j], local[i]) += w * value[j];
      }
    }
  };
  parallelFor(0, net.patches(), 4,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = first[begin]; i < first[end]; ++i)
      {
        if (points[i].weight() > 0.0)
        {
          addPoint(points[i]);
        }
      }
    });
  return blocks;
}

std::unique_ptr<FitSolver> makeReducedSolver(const PatchNet& net, const SplineSpace& space)
{
  return std::make_unique<ReducedSolver>(net, space);
}
} // namespace bsr
