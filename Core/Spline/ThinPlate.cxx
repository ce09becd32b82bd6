#include "Spline/ThinPlate.h"

#include "Spline/Basis.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Gram matrices of the values and of the first and second derivatives of the univariate splines.
struct Gram
{
  Eigen::MatrixXd Value;
  Eigen::MatrixXd First;
  Eigen::MatrixXd Second;
};

Gram gramMatrices(int segments)
{
  const int n = 2 * segments + 2;
  const auto knots = segmentKnots(3, segments, 2);
  // Four Gauss points: exact to degree 7, the products have degree 6.
  const double x0 = std::sqrt(3.0 / 7.0 - 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double x1 = std::sqrt(3.0 / 7.0 + 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double w0 = (18.0 + std::sqrt(30.0)) / 36.0;
  const double w1 = (18.0 - std::sqrt(30.0)) / 36.0;
  const double x[4] = {-x1, -x0, x0, x1};
  const double w[4] = {w1, w0, w0, w1};
  Gram g{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  for (int s = 0; s < segments; ++s)
  {
    for (int q = 0; q < 4; ++q)
    {
      const BasisValues b = evaluateBasis(knots.data(), 3, n, (s + 0.5 + 0.5 * x[q]) / segments);
      const double weight = 0.5 * w[q] / segments;
      for (int i = 0; i < 4; ++i)
      {
        for (int j = 0; j < 4; ++j)
        {
          g.Value(b.First + i, b.First + j) += weight * b.Value[i] * b.Value[j];
          g.First(b.First + i, b.First + j) += weight * b.Derivative[i] * b.Derivative[j];
          g.Second(b.First + i, b.First + j) += weight * b.Derivative2[i] * b.Derivative2[j];
        }
      }
    }
  }
  return g;
}

/// Kronecker product for numbering j * n + i: rows of `v` outer, of `u` inner.
Eigen::MatrixXd tensor(const Eigen::MatrixXd& u, const Eigen::MatrixXd& v)
{
  const Eigen::Index n = u.rows();
  const Eigen::Index rows = v.rows();
  Eigen::MatrixXd m(n * rows, n * rows);
  for (Eigen::Index j = 0; j < rows; ++j)
  {
    for (Eigen::Index l = 0; l < rows; ++l)
    {
      m.block(j * n, l * n, n, n) = v(j, l) * u;
    }
  }
  return m;
}
} // namespace

PatchEnergies patchEnergies(int segments)
{
  return patchEnergies(segments, segments);
}

PatchEnergies patchEnergies(int segmentsU, int segmentsV)
{
  const Gram u = gramMatrices(segmentsU);
  const Gram v = gramMatrices(segmentsV);
  return {tensor(u.Second, v.Value), tensor(u.First, v.First), tensor(u.Value, v.Second),
    tensor(u.Value, v.Value)};
}

std::vector<std::array<double, 2>> patchAspects(
  const QuadComplex& complex, const std::vector<Vec3>& v)
{
  std::vector<std::array<double, 2>> aspect(complex.faces());
  double mean = 0.0;
  for (Index f = 0; f < complex.faces(); ++f)
  {
    const auto& q = complex.quad(f);
    const double a = 0.5 * ((v[q[1]] - v[q[0]]).norm() + (v[q[2]] - v[q[3]]).norm());
    const double b = 0.5 * ((v[q[3]] - v[q[0]]).norm() + (v[q[2]] - v[q[1]]).norm());
    aspect[f] = {a, b};
    mean += std::sqrt(a * b) / complex.faces();
  }
  for (auto& [a, b] : aspect)
  {
    a = std::clamp(mean > 0.0 ? a / mean : 1.0, 1.0 / 3, 3.0);
    b = std::clamp(mean > 0.0 ? b / mean : 1.0, 1.0 / 3, 3.0);
  }
  return aspect;
}
} // namespace bsr
