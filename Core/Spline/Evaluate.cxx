#include "Spline/Evaluate.h"

namespace bsr
{
namespace
{
HomogeneousPoint sumUp(
  const SplineModel& model, const SplinePatch& patch, const BasisValues& bu, const BasisValues& bv)
{
  HomogeneousPoint h = HomogeneousPoint::Zero();
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
  return projected(sumUp(model, patch, basisU, basisV));
}
} // namespace bsr
