#include "Spline/RationalPatch.h"

namespace bsr
{
namespace
{
/// Polar form of the spline's polynomial piece over the span [knots[s], knots[s + 1]].
std::array<double, 4> blossomWeights(const std::vector<double>& knots, int s, const double (&t)[3])
{
  // Column c: the four coefficients of the piece as combinations of the spline's s-3 .. s.
  std::array<std::array<double, 4>, 4> d{};
  for (int i = 0; i < 4; ++i)
  {
    d[i][i] = 1.0;
  }
  for (int level = 1; level <= 3; ++level)
  {
    for (int i = 3; i >= level; --i)
    {
      const double left = knots[s - 3 + i];
      const double right = knots[s + 1 + i - level];
      const double a = (t[level - 1] - left) / (right - left);
      for (int c = 0; c < 4; ++c)
      {
        d[i][c] = (1.0 - a) * d[i - 1][c] + a * d[i][c];
      }
    }
  }
  return d[3];
}

/// Coefficients over `fine` knots of each spline over `coarse` knots: fine count x coarse count.
Eigen::MatrixXd insertion(const std::vector<double>& coarse, const std::vector<double>& fine)
{
  const int rows = static_cast<int>(fine.size()) - 4;
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(coarse.size()) - 4);
  for (int i = 0; i < rows; ++i)
  {
    int k = i;
    while (fine[k + 1] <= fine[k])
    {
      ++k;
    }
    const double middle = 0.5 * (fine[k] + fine[k + 1]);
    int s = 3;
    while (coarse[s + 1] <= middle)
    {
      ++s;
    }
    const double t[3] = {fine[i + 1], fine[i + 2], fine[i + 3]};
    const auto w = blossomWeights(coarse, s, t);
    for (int c = 0; c < 4; ++c)
    {
      m(i, s - 3 + c) += w[c];
    }
  }
  return m;
}

Eigen::MatrixXd insertion(int segments, int factor)
{
  return insertion(segmentKnots(3, segments, 2), segmentKnots(3, segments * factor, 2));
}
} // namespace

RationalPatch::RationalPatch(int segmentsU, int segmentsV)
    : SegmentsU(segmentsU),
      SegmentsV(segmentsV),
      KnotsU(segmentKnots(3, segmentsU, 2)),
      KnotsV(segmentKnots(3, segmentsV, 2)),
      ControlPoints(static_cast<std::size_t>(this->countU()) * this->countV())
{
}

SurfacePoint RationalPatch::at(double u, double v) const
{
  const int n = this->countU();
  const BasisValues bu = evaluateBasis(this->KnotsU.data(), 3, n, u);
  const BasisValues bv = evaluateBasis(this->KnotsV.data(), 3, this->countV(), v);
  HomogeneousPoint h = HomogeneousPoint::Zero();
  for (int j = 0; j < 4; ++j)
  {
    for (int i = 0; i < 4; ++i)
    {
      Vec4 p = this->ControlPoints[(bv.First + j) * n + bu.First + i];
      p.head<3>() *= p[3];
      h.col(0) += bu.Value[i] * bv.Value[j] * p;
      h.col(1) += bu.Derivative[i] * bv.Value[j] * p;
      h.col(2) += bu.Value[i] * bv.Derivative[j] * p;
      h.col(3) += bu.Derivative2[i] * bv.Value[j] * p;
      h.col(4) += bu.Derivative[i] * bv.Derivative[j] * p;
      h.col(5) += bu.Value[i] * bv.Derivative2[j] * p;
    }
  }
  return projected(h);
}

RationalPatch refined(const RationalPatch& patch, int factorU, int factorV)
{
  RationalPatch fine(patch.SegmentsU * factorU, patch.SegmentsV * factorV);
  const Eigen::MatrixXd tu = insertion(patch.SegmentsU, factorU);
  const Eigen::MatrixXd tv = insertion(patch.SegmentsV, factorV);
  const int n = patch.countU();
  const int m = fine.countU();
  Eigen::MatrixXd grid(patch.countV(), n);
  for (int k = 3; k >= 0; --k)
  {
    for (int l = 0; l < static_cast<int>(patch.ControlPoints.size()); ++l)
    {
      const Vec4& p = patch.ControlPoints[l];
      grid(l / n, l % n) = k == 3 ? p[3] : p[k] * p[3];
    }
    const Eigen::MatrixXd out = tv * grid * tu.transpose();
    for (int l = 0; l < static_cast<int>(fine.ControlPoints.size()); ++l)
    {
      Vec4& p = fine.ControlPoints[l];
      p[k] = k == 3 ? out(l / m, l % m) : out(l / m, l % m) / p[3];
    }
  }
  return fine;
}
} // namespace bsr
