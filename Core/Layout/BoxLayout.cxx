#include "Layout/BoxLayout.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

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

bool isDisc(const TriangleSurface& s)
{
  if (s.eulerCharacteristic() != 1 || std::count(s.Virtual.begin(), s.Virtual.end(), 1) != 1)
  {
    return false;
  }
  for (std::size_t h = 0; h < s.Vertex.size(); ++h)
  {
    const Index f = static_cast<Index>(h) / 3;
    if (s.Crease[h] && !s.hole(f) && !s.hole(s.Opposite[h] / 3))
    {
      return false;
    }
  }
  return true;
}

LayoutDraft singleQuad(const TriangleSurface& s)
{
  constexpr double sound = 0.1; // least scaled Jacobian
  constexpr int turns = 16;
  std::vector<Vec3> loop;
  const auto middle = std::find(s.Virtual.begin(), s.Virtual.end(), 1) - s.Virtual.begin();
  s.around(static_cast<Index>(middle), [&](Index h) { loop.push_back(s.Points[s.end(h)]); });
  Vec3 normal = Vec3::Zero();
  Index region = 0;
  for (Index f = 0; f < s.faces(); ++f)
  {
    normal += s.hole(f) ? Vec3(Vec3::Zero()) : s.areaNormal(f);
    region = s.hole(f) ? region : s.Region[f];
  }
  std::vector<double> way(1, 0.0);
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    way.push_back(way.back() + (loop[(i + 1) % loop.size()] - loop[i]).norm());
  }
  const auto place = [&](double share)
  {
    const double at = (share - std::floor(share)) * way.back();
    const auto i = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(std::upper_bound(way.begin(), way.end(), at) - way.begin() - 1, 0,
        static_cast<std::ptrdiff_t>(loop.size()) - 1));
    const double length = std::max(way[i + 1] - way[i], 1e-300);
    return Vec3(loop[i] + (at - way[i]) / length * (loop[(i + 1) % loop.size()] - loop[i]));
  };
  LayoutDraft best;
  double shape = sound;
  for (int turn = 0; turn < turns; ++turn)
  {
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k)
    {
      p[k] = place(0.25 * (k + static_cast<double>(turn) / turns));
    }
    if ((p[2] - p[0]).cross(p[3] - p[1]).dot(normal) < 0.0)
    {
      std::swap(p[1], p[3]);
    }
    const double here = scaledJacobian(p[0], p[1], p[2], p[3]);
    if (here > shape)
    {
      shape = here;
      best.Mesh.Points.assign(p.begin(), p.end());
      best.Mesh.Quads = {{0, 1, 2, 3}};
      best.Mesh.Region = {region};
      best.Kind.assign(4, VertexKind::Crease);
    }
  }
  best.completeCreases();
  return best;
}
} // namespace bsr
