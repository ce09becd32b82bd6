#include "Spline/Evaluate.h"

namespace bsr
{
namespace
{
/// Homogeneous point and derivatives: columns S, Su, Sv, Suu, Suv, Svv of (w x, w y, w z, w).
using Homogeneous = Eigen::Matrix<double, 4, 6>;

Homogeneous sumUp(
  const SplineModel& model, const SplinePatch& patch, const BasisValues& bu, const BasisValues& bv)
{
  Homogeneous h = Homogeneous::Zero();
  for (int j = 0; j <= patch.DegreeV; ++j)
  {
    Eigen::Matrix<double, 4, 3> row = Eigen::Matrix<double, 4, 3>::Zero();
    const Vec4* cp = model.ControlPoints.data() + patch.FirstControlPoint +
                     static_cast<std::int64_t>(bv.First + j) * patch.CountU + bu.First;
    for (int i = 0; i <= patch.DegreeU; ++i)
    {
      Vec4 p = cp[i];
      p.head<3>() *= p[3];
      row.col(0) += bu.Value[i] * p;
      row.col(1) += bu.Derivative[i] * p;
      row.col(2) += bu.Derivative2[i] * p;
    }
    h.col(0) += bv.Value[j] * row.col(0);
    h.col(1) += bv.Value[j] * row.col(1);
    h.col(2) += bv.Derivative[j] * row.col(0);
    h.col(3) += bv.Value[j] * row.col(2);
    h.col(4) += bv.Derivative[j] * row.col(1);
    h.col(5) += bv.Derivative2[j] * row.col(0);
  }
  return h;
}
} // namespace

std::array<double, 4> patchDomain(const SplineModel& model, const SplinePatch& patch)
{
  const double* ku = model.Knots.data() + patch.FirstKnotU;
  const double* kv = model.Knots.data() + patch.FirstKnotV;
  return {ku[patch.DegreeU], ku[patch.CountU], kv[patch.DegreeV], kv[patch.CountV]};
}

SurfacePoint evaluatePatch(const SplineModel& model, const SplinePatch& patch, double u, double v)
{
  return evaluatePatch(model, patch,
    evaluateBasis(model.Knots.data() + patch.FirstKnotU, patch.DegreeU, patch.CountU, u),
    evaluateBasis(model.Knots.data() + patch.FirstKnotV, patch.DegreeV, patch.CountV, v));
}

SurfacePoint evaluatePatch(const SplineModel& model, const SplinePatch& patch,
  const BasisValues& basisU, const BasisValues& basisV)
{
  const Homogeneous h = sumUp(model, patch, basisU, basisV);
  const auto w = h.row(3);
  SurfacePoint s;
  s.Point = h.col(0).head<3>() / w[0];
  s.Du = (h.col(1).head<3>() - w[1] * s.Point) / w[0];
  s.Dv = (h.col(2).head<3>() - w[2] * s.Point) / w[0];
  s.Duu = (h.col(3).head<3>() - 2 * w[1] * s.Du - w[3] * s.Point) / w[0];
  s.Duv = (h.col(4).head<3>() - w[1] * s.Dv - w[2] * s.Du - w[4] * s.Point) / w[0];
  s.Dvv = (h.col(5).head<3>() - 2 * w[2] * s.Dv - w[5] * s.Point) / w[0];
  return s;
}
} // namespace bsr
