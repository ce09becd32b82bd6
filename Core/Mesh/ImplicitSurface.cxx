#include "Mesh/ImplicitSurface.h"

#include <Eigen/LU>

namespace bsr
{
namespace
{
constexpr int Monomials = 10;
using Polynomial = Eigen::Matrix<double, 1, Monomials>;

Polynomial monomials(const Vec3& x)
{
  Polynomial m;
  m << 1.0, x[0], x[1], x[2], x[0] * x[0], x[1] * x[1], x[2] * x[2], x[0] * x[1], x[1] * x[2],
    x[2] * x[0];
  return m;
}
} // namespace

Result<ImplicitSurface> ImplicitSurface::fit(
  const std::vector<Vec3>& points, const std::vector<Vec3>& normals, double offset)
{
  ImplicitSurface s;
  std::vector<Vec3> centers = points;
  std::vector<double> values(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (normals[i].squaredNorm() > 0.0)
    {
      for (const double side : {1.0, -1.0})
      {
        centers.push_back(points[i] + side * offset * normals[i]);
        values.push_back(side * offset);
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(centers.size());
  if (n < Monomials)
  {
    return Status::failed("Too few points for an implicit surface.");
  }
  Vec3 low = centers[0];
  Vec3 high = centers[0];
  for (const Vec3& c : centers)
  {
    low = low.cwiseMin(c);
    high = high.cwiseMax(c);
  }
  s.Center = 0.5 * (low + high);
  s.Scale = 2.0 / (high - low).norm();
  s.Centers.resize(3, n);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    s.Centers.col(i) = (centers[i] - s.Center) * s.Scale;
  }
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + Monomials, n + Monomials);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + Monomials);
  for (Eigen::Index j = 0; j < n; ++j)
  {
    for (Eigen::Index i = 0; i < n; ++i)
    {
      a(i, j) = -(s.Centers.col(i) - s.Centers.col(j)).norm();
    }
    const Polynomial m = monomials(s.Centers.col(j));
    a.block<1, Monomials>(j, n) = m;
    a.block<Monomials, 1>(n, j) = m.transpose();
    b[j] = values[j] * s.Scale;
  }
  s.Coefficients = a.partialPivLu().solve(b);
  if (!s.Coefficients.allFinite())
  {
    return Status::failed("The points do not determine an implicit surface.");
  }
  return s;
}

ImplicitSurface::Value ImplicitSurface::at(const Vec3& p) const
{
  const Vec3 x = (p - this->Center) * this->Scale;
  const Eigen::Index n = this->Centers.cols();
  Value v;
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const Vec3 d = x - this->Centers.col(i);
    const double r = d.norm();
    v.F -= this->Coefficients[i] * r;
    v.Gradient -= this->Coefficients[i] / std::max(r, 1e-30) * d;
  }
  const auto c = this->Coefficients.tail<Monomials>();
  v.F += monomials(x).dot(c);
  v.Gradient += Vec3(c[1] + 2 * c[4] * x[0] + c[7] * x[1] + c[9] * x[2],
    c[2] + 2 * c[5] * x[1] + c[7] * x[0] + c[8] * x[2],
    c[3] + 2 * c[6] * x[2] + c[8] * x[1] + c[9] * x[0]);
  v.F /= this->Scale;
  return v;
}
} // namespace bsr
