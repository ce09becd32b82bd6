#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Mesh/Laplacian.h"

#include <memory>

namespace bsr
{
/// One eigenfunction of a surface.
struct Eigenfunction
{
  int Number = 0;             ///< place in the spectrum, 0: the constant
  double Eigenvalue = 0.0;    ///< of -Laplace-Beltrami, 0 and more, in 1 / length^2
  std::vector<double> Values; ///< per vertex of the surface, 0 at virtual ones; largest |value| 1
};

/**
 * Any part of the spectrum of a surface, without what lies below: Lanczos iteration in shift-invert
 * mode (Spectra) around a shift, whose place in the spectrum is read from the inertia of the
 * factorization (Sylvester's law). So the 300th eigenfunction costs as much as the third. The
 * start vector is fixed: the same surface gives the same functions.
 */
class LaplaceSpectrum
{
public:
  /// `density` per vertex of the surface scales the mass: the metric grows by it (areas), so that
  /// waves are shorter where it is large. Empty: 1 everywhere.
  explicit LaplaceSpectrum(Laplacian laplacian, const std::vector<double>& density = {});
  ~LaplaceSpectrum();
  LaplaceSpectrum(const LaplaceSpectrum&) = delete;
  LaplaceSpectrum& operator=(const LaplaceSpectrum&) = delete;

  Index size() const;  ///< number of eigenfunctions
  double area() const; ///< sum of the masses
  /// The eigenvalue expected at a place, by Weyl's law.
  double weyl(double number) const;
  /// Number of eigenvalues below `lambda`; -1 if the factorization fails.
  Index countBelow(double lambda);
  /// The `count` eigenfunctions whose eigenvalues are nearest to `lambda`, in rising order.
  Result<std::vector<Eigenfunction>> near(double lambda, int count, Monitor& monitor);
  /// The eigenfunction at one place of the spectrum, 0 to size() - 1.
  Result<Eigenfunction> at(int number, Monitor& monitor);

private:
  struct Factor;

  /// What converged at this very shift; nothing if it is no good.
  Result<std::vector<Eigenfunction>> lanczos(double shift, int wanted, Monitor& monitor);
  Eigenfunction function(Index number, double value, const Eigen::VectorXd& vector) const;

  std::vector<Index> Row;
  Eigen::VectorXd Scale; ///< 1 / sqrt(mass)
  double Area = 0.0;
  std::unique_ptr<Factor> Solver;
};
} // namespace bsr
