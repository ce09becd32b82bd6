#pragma once

#include "Spline/FitPoints.h"

namespace bsr
{
/// Which control points of a patch may change.
enum class FreeControlPoints
{
  /// All but two rows along each side: position and tangent planes on the sides stay as they are,
  /// so that neighbors never notice (specification of the G1 spaces, section F).
  Interior,
  All
};

/// Range of the weights that the optimizers may choose; those near the sides are 1.
constexpr double LeastPatchWeight = 0.1;
constexpr double LargestPatchWeight = 10.0;

/// What the points and the fairing of a patch count; the objective is
/// Data * sum w |S - p|^2 + b^T Fairing b - 2 b^T FairingRight.
struct PatchObjective
{
  double Data = 1.0;
  Eigen::MatrixXd Fairing;      ///< n^2 x n^2, or empty
  Eigen::MatrixXd FairingRight; ///< n^2 x 3, or empty
};

/**
 * Least squares of one rational patch at fixed parameters: for given weights the free control
 * points follow from a linear system; what is left is a function of the free weights alone
 * (separable least squares, variable projection).
 */
class WeightProblem
{
public:
  /// The points must belong to the patch; those of no weight are ignored.
  WeightProblem(const RationalPatch& start, const FitPoint* first, const FitPoint* last,
    FreeControlPoints free, const PatchObjective& objective);

  int variables() const { return static_cast<int>(this->Free.size()); }
  int points() const { return static_cast<int>(this->Samples.size()); }

  /// The patch of these weights with the best control points; false if the system is singular.
  struct State
  {
    RationalPatch Patch;
    double Objective = 0.0;
    double Mean = 0.0; ///< weighted mean of the distances at the parameters (paper 003, eq. 2)
    double Rms = 0.0;
  };
  bool solve(const Eigen::VectorXd& weights, State& state) const;

  /**
   * Minimizes the objective over the free weights by Levenberg-Marquardt steps in their logarithms
   * on the projected problem (Golub and Pereyra's variable projection, with Kaufman's
   * approximation). Weights stay in [0.1, 10]. `state` is the start and the result; returns the
   * number of steps taken.
   */
  int optimize(State& state, int iterations) const;

  Eigen::VectorXd weightsOf(const RationalPatch& patch) const;

private:
  struct Sample
  {
    BasisValues U;
    BasisValues V;
    Vec3 Position;
    double Weight;
  };
  struct Derivatives;

  void rational(const Sample& s, const RationalPatch& p, double (&phi)[16], int (&index)[16]) const;
  bool linearize(const State& state, Eigen::MatrixXd& normal, Eigen::VectorXd& gradient) const;
  bool assemble(const RationalPatch& p, Eigen::MatrixXd& a, Eigen::MatrixXd& right) const;

  RationalPatch Start;
  PatchObjective Objective;
  std::vector<Sample> Samples;
  std::vector<int> Free;     ///< local numbers of the free control points, increasing
  std::vector<int> Position; ///< of each control point among the free ones, or -1
};
} // namespace bsr
