#include "Mesh/LaplaceSpectrum.h"

#include "Common/CounterRandom.h"

#include <Eigen/SparseCholesky>
#include <Spectra/SymEigsShiftSolver.h>

#include <algorithm>
#include <cmath>
#include <exception>

namespace bsr
{
namespace
{
/// Leaves the iteration of Spectra, which knows no other way out.
struct Stopped
{
};
} // namespace

/// The symmetric matrix mass^-1/2 stiffness mass^-1/2 and its factorization at a shift, in the form
/// Spectra asks for.
struct LaplaceSpectrum::Factor
{
  using Scalar = double;

  Eigen::SparseMatrix<double> Matrix;
  Eigen::SparseMatrix<double> Shifted;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> Cholesky;
  double Shift = std::nan("");
  bool Sound = false;
  Monitor* Watch = nullptr; ///< asked before each solve

  Eigen::Index rows() const { return this->Matrix.rows(); } // NOLINT: Spectra's name
  Eigen::Index cols() const { return this->Matrix.cols(); } // NOLINT: Spectra's name
  void set_shift(double shift)                              // NOLINT: Spectra's name
  {
    if (shift == this->Shift)
    {
      return;
    }
    this->Shift = shift;
    this->Shifted = this->Matrix;
    for (Eigen::Index i = 0; i < this->rows(); ++i)
    {
      this->Shifted.coeffRef(i, i) -= shift;
    }
    this->Cholesky.factorize(this->Shifted);
    this->Sound = this->Cholesky.info() == Eigen::Success;
  }
  void perform_op(const double* x, double* y) const // NOLINT: Spectra's name
  {
    if (this->Watch && this->Watch->cancelled())
    {
      throw Stopped();
    }
    const Eigen::Map<const Eigen::VectorXd> in(x, this->rows());
    Eigen::Map<Eigen::VectorXd> out(y, this->rows());
    out = this->Cholesky.solve(in);
  }
};

LaplaceSpectrum::LaplaceSpectrum(Laplacian laplacian, const std::vector<double>& density)
    : Row(std::move(laplacian.Row)), Solver(std::make_unique<Factor>())
{
  Eigen::VectorXd mass = std::move(laplacian.Mass);
  for (std::size_t v = 0; v < density.size(); ++v)
  {
    if (this->Row[v] >= 0)
    {
      mass[this->Row[v]] *= density[v];
    }
  }
  this->Area = mass.sum();
  this->Scale = mass.cwiseSqrt().cwiseInverse();
  this->Solver->Matrix = this->Scale.asDiagonal() * laplacian.Stiffness * this->Scale.asDiagonal();
  // The diagonal must be there for shifts, also of vertices without neighbors.
  for (Eigen::Index i = 0; i < this->Solver->rows(); ++i)
  {
    this->Solver->Matrix.coeffRef(i, i) += 0.0;
  }
  this->Solver->Matrix.makeCompressed();
  this->Solver->Cholesky.analyzePattern(this->Solver->Matrix);
}

LaplaceSpectrum::~LaplaceSpectrum() = default;

Index LaplaceSpectrum::size() const
{
  return static_cast<Index>(this->Solver->rows());
}

double LaplaceSpectrum::area() const
{
  return this->Area;
}

double LaplaceSpectrum::weyl(double number) const
{
  return 4.0 * M_PI * number / this->Area;
}

Index LaplaceSpectrum::countBelow(double lambda)
{
  this->Solver->set_shift(lambda);
  if (!this->Solver->Sound)
  {
    return -1;
  }
  const auto d = this->Solver->Cholesky.vectorD();
  return static_cast<Index>((d.array() < 0.0).count());
}

Result<std::vector<Eigenfunction>> LaplaceSpectrum::near(double lambda, int count, Monitor& monitor)
{
  const int wanted = std::min<int>(count, this->size() - 2);
  if (wanted < 1)
  {
    return Status::invalidInput("The surface has too few points for eigenfunctions.");
  }
  // A shift on an eigenvalue (of the matrix or of a leading block) is moved aside.
  for (int attempt = 0; attempt < 4; ++attempt)
  {
    const double shift = lambda + (attempt * 0.013) * this->weyl(1.0);
    auto found = this->lanczos(shift, wanted, monitor);
    if (!found || !found->empty())
    {
      return found;
    }
  }
  return Status::failed("The eigenfunctions of the surface did not converge; remesh it first.");
}

Result<std::vector<Eigenfunction>> LaplaceSpectrum::lanczos(
  double shift, int wanted, Monitor& monitor)
{
  std::vector<Eigenfunction> found;
  const Index below = this->countBelow(shift);
  if (below < 0)
  {
    return found;
  }
  const Index n = this->size();
  this->Solver->Watch = &monitor;
  try
  {
    const int space = std::min<int>(n, std::max(2 * wanted + 10, 24));
    Spectra::SymEigsShiftSolver<Factor> solver(*this->Solver, wanted, space, shift);
    CounterRandom random(1, 0);
    Eigen::VectorXd start(n);
    for (Index i = 0; i < n; ++i)
    {
      start[i] = random.uniform(-1.0, 1.0);
    }
    solver.init(start.data());
    solver.compute(Spectra::SortRule::LargestMagn, 300, 1e-9, Spectra::SortRule::SmallestAlge);
    const Eigen::VectorXd values = solver.eigenvalues();
    const Eigen::MatrixXd vectors = solver.eigenvectors();
    if (!values.allFinite() || !vectors.allFinite())
    {
      return found;
    }
    const auto lower = static_cast<Index>((values.array() < shift).count());
    for (Index i = 0; i < values.size(); ++i)
    {
      found.push_back(this->function(below + i - lower, values[i], vectors.col(i)));
    }
  }
  catch (const Stopped&)
  {
    return Status::cancelled();
  }
  catch (const std::exception&)
  {
    found.clear();
  }
  return found;
}

Eigenfunction LaplaceSpectrum::function(
  Index number, double value, const Eigen::VectorXd& vector) const
{
  const Eigen::VectorXd u = vector.cwiseProduct(this->Scale);
  Eigen::Index peak = 0;
  u.cwiseAbs().maxCoeff(&peak);
  Eigenfunction e;
  e.Number = number;
  e.Eigenvalue = value;
  e.Values.assign(this->Row.size(), 0.0);
  for (std::size_t v = 0; v < this->Row.size(); ++v)
  {
    e.Values[v] = this->Row[v] < 0 ? 0.0 : u[this->Row[v]] / u[peak];
  }
  return e;
}

Result<Eigenfunction> LaplaceSpectrum::at(int number, Monitor& monitor)
{
  if (number < 0 || number >= this->size() - 2)
  {
    return Status::invalidParameter("There is no eigenfunction " + std::to_string(number) +
                                    "; choose 1 to " + std::to_string(this->size() - 3) + ".");
  }
  // Shifts around Weyl's guess, then between, until the place is found near the shift.
  double low = -this->weyl(1.0);
  double high = std::numeric_limits<double>::infinity();
  double lambda = this->weyl(std::max(1, number));
  for (int i = 0; i < 60; ++i)
  {
    if (monitor.cancelled())
    {
      return Status::cancelled();
    }
    const Index below = this->countBelow(lambda);
    if (below >= 0 && std::abs(below - number) <= 4)
    {
      break;
    }
    (below < number ? low : high) = lambda;
    const double scaled = lambda * (number + 1.0) / std::max<double>(below + 1.0, 1.0);
    const bool inside = scaled > low && scaled < high && i < 8;
    lambda = inside ? scaled : (std::isfinite(high) ? 0.5 * (low + high) : 2.0 * lambda);
  }
  for (int count : {12, 30})
  {
    auto found = this->near(lambda, count, monitor);
    if (!found)
    {
      return found.status();
    }
    for (Eigenfunction& e : *found)
    {
      if (e.Number == number)
      {
        return std::move(e);
      }
    }
  }
  return Status::failed(
    "Eigenfunction " + std::to_string(number) + " was not found; try the next.");
}
} // namespace bsr
