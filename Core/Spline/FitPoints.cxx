#include "Spline/FitPoints.h"

#include <algorithm>

namespace bsr
{
SurfacePoint NetEvaluator::at(Index patch, const BasisValues& u, const BasisValues& v) const
{
  Eigen::Matrix<double, 3, 6> sum = Eigen::Matrix<double, 3, 6>::Zero();
  for (int j = 0; j < 4; ++j)
  {
    Vec3 value = Vec3::Zero();
    Vec3 first = Vec3::Zero();
    Vec3 second = Vec3::Zero();
    for (int i = 0; i < 4; ++i)
    {
      const Vec3 p = this->Points.row(this->Net.at(patch, u.First + i, v.First + j)).transpose();
      value += u.Value[i] * p;
      first += u.Derivative[i] * p;
      second += u.Derivative2[i] * p;
    }
    sum.col(0) += v.Value[j] * value;
    sum.col(1) += v.Value[j] * first;
    sum.col(2) += v.Derivative[j] * value;
    sum.col(3) += v.Value[j] * second;
    sum.col(4) += v.Derivative[j] * first;
    sum.col(5) += v.Derivative2[j] * value;
  }
  return {sum.col(0), sum.col(1), sum.col(2), sum.col(3), sum.col(4), sum.col(5)};
}

RationalPatch ownPatch(const PatchNet& net, const NetPoints& points, Index patch)
{
  RationalPatch own(net.segments(), net.segments());
  for (int l = 0; l < net.perPatch(); ++l)
  {
    own.ControlPoints[l] << points.row(net.at(patch, l)).transpose(), 1.0;
  }
  return own;
}

std::vector<std::int64_t> sortByPatch(std::vector<FitPoint>& points, Index patches)
{
  std::stable_sort(points.begin(), points.end(),
    [](const FitPoint& a, const FitPoint& b)
    { return a.Patch != b.Patch ? a.Patch < b.Patch : a.Source < b.Source; });
  std::vector<std::int64_t> first(static_cast<std::size_t>(patches) + 1, 0);
  for (const FitPoint& p : points)
  {
    ++first[p.Patch + 1];
  }
  for (Index p = 0; p < patches; ++p)
  {
    first[p + 1] += first[p];
  }
  return first;
}
} // namespace bsr
