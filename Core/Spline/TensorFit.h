#pragma once

#include "Common/Types.h"
#include "Spline/Basis.h"
#include "Spline/SplineModel.h"

#include <Eigen/Core>

#include <memory>

namespace bsr
{
/// Degrees and knots (0 to 1, full multiplicity at the ends) of one tensor-product patch.
struct TensorShape
{
  int DegreeU = 3;
  int DegreeV = 3;
  std::vector<double> KnotsU;
  std::vector<double> KnotsV;

  int countU() const { return static_cast<int>(this->KnotsU.size()) - this->DegreeU - 1; }
  int countV() const { return static_cast<int>(this->KnotsV.size()) - this->DegreeV - 1; }
  Index controlPoints() const { return this->countU() * this->countV(); }
};

/**
 * Knots for the least-squares approximation of data at increasing parameters (first 0, last 1) by
 * `count` control points: every span holds a parameter (The NURBS Book, eqs. 9.68 and 9.69; paper
 * 004, eqs. 3 and 4). \pre degree < count <= number of parameters
 */
std::vector<double> dataKnots(const std::vector<double>& parameters, int degree, int count);

/**
 * Least-squares control points for a grid of data (columns run fastest) at the tensor product of
 * the parameters: rows first, then columns, with the ends of each interpolated (The NURBS Book,
 * A9.7; paper 004, eqs. 1, 2 and 6). \pre every span holds data (dataKnots)
 */
std::vector<Vec3> fitGrid(const TensorShape& shape, const std::vector<double>& u,
  const std::vector<double>& v, const std::vector<Vec3>& points);

/// A point with parameters and a weight.
struct TensorSample
{
  Vec3 Point;
  Vec2 UV;
  double Weight = 1.0;
};

/// Least-squares fit of scattered samples with thin-plate fairing.
class TensorSolver
{
public:
  /// \param lengthU, lengthV the typical length of the surface along u and v: the fairing
  /// integrates over a plate of that size.
  TensorSolver(TensorShape shape, double lengthU, double lengthV);
  ~TensorSolver();
  TensorSolver(const TensorSolver&) = delete;
  TensorSolver& operator=(const TensorSolver&) = delete;

  /**
   * Control points that minimize (sum of w e^2) / (sum of w) + fairing h^4 / area * plate, where h
   * is the mean size of a span: a fairing of 1 weighs bends at the scale of one span like errors.
   * Returns no points where the system is singular.
   */
  std::vector<Vec3> solve(const std::vector<TensorSample>& samples, double fairing);

private:
  struct Factor;
  void addPlate(double fairing);

  TensorShape Shape;
  double LengthU, LengthV;
  std::vector<double> Band; ///< a window of (2 p + 1) (2 q + 1) entries a control point
  std::unique_ptr<Factor> Solver;
};

/// A model of one patch without neighbors.
SplineModel modelOf(const TensorShape& shape, const std::vector<Vec3>& control);
} // namespace bsr
