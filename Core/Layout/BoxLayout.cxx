#include "Layout/BoxLayout.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace bsr
{
bool isSphere(const TriangleSurface& s)
{
  auto set = [](std::uint8_t flag) { return flag != 0; };
  return s.eulerCharacteristic() == 2 && std::none_of(s.Virtual.begin(), s.Virtual.end(), set) &&
         std::none_of(s.Crease.begin(), s.Crease.end(), set);
}

LayoutDraft boxLayout(const TriangleSurface& s)
{
  Vec3 center = Vec3::Zero();
  double total = 0.0;
  for (Index f = 0; f < s.faces(); ++f)
  {
    const double area = s.areaNormal(f).norm();
    for (Index v : s.corners(f))
    {
      center += area / 3.0 * s.Points[v];
    }
    total += area;
  }
  center /= total;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (Index f = 0; f < s.faces(); ++f)
  {
    const double area = s.areaNormal(f).norm();
    for (Index v : s.corners(f))
    {
      const Vec3 d = s.Points[v] - center;
      spread += area / (3.0 * total) * d * d.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  Eigen::Matrix3d axes = eigen.eigenvectors();
  if (axes.determinant() < 0.0)
  {
    axes.col(0) *= -1.0;
  }
  // A flat speck still gets a box of some height. A box's points spread by about 0.7 half sides.
  const double longest = std::sqrt(std::max(eigen.eigenvalues()[2], 1e-300));
  std::array<double, 3> half{};
  for (int k = 0; k < 3; ++k)
  {
    half[k] = 1.3 * std::max(std::sqrt(std::max(eigen.eigenvalues()[k], 0.0)), 0.05 * longest);
  }
  LayoutDraft draft;
  for (int i = 0; i < 8; ++i)
  {
    const Vec3 local(
      (i & 1 ? 1 : -1) * half[0], (i & 2 ? 1 : -1) * half[1], (i & 4 ? 1 : -1) * half[2]);
    draft.Mesh.Points.push_back(Vec3(center + axes * local));
  }
  draft.Mesh.Quads = {
    {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  draft.Mesh.Region.assign(6, s.Region.front());
  draft.Kind.assign(8, VertexKind::Free);
  return draft;
}

} // namespace bsr
