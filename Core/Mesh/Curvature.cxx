#include "Mesh/Curvature.h"

#include "Common/Parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace bsr
{
FaceFrame faceFrame(const TriangleSurface& s, Index face)
{
  const auto c = s.corners(face);
  const Vec3 x = (s.Points[c[1]] - s.Points[c[0]]).normalized();
  return {x, s.areaNormal(face).normalized().cross(x)};
}

std::vector<Vec3> faceCurvature(
  const TriangleSurface& s, const std::vector<std::uint8_t>& inside, Monitor& monitor)
{
  std::vector<Vec3> normal(s.Points.size(), Vec3::Zero());
  for (Index f = 0; f < s.faces(); ++f)
  {
    if (inside[f])
    {
      const Vec3 n = s.areaNormal(f);
      for (Index v : s.corners(f))
      {
        normal[v] += n;
      }
    }
  }
  for (Vec3& n : normal)
  {
    n.normalize();
  }
  std::vector<Vec3> form(s.Region.size(), Vec3::Zero());
  parallelForUntilCancelled(0, s.faces(), 512, monitor,
    [&](std::int64_t first, std::int64_t last)
    {
      for (auto f = static_cast<Index>(first); f < last; ++f)
      {
        if (!inside[f])
        {
          continue;
        }
        const FaceFrame frame = faceFrame(s, f);
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Vec3 b = Vec3::Zero();
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          const Vec3 e = s.Points[s.end(h)] - s.Points[s.start(h)];
          const Vec3 d = normal[s.end(h)] - normal[s.start(h)];
          const Vec3 rowX(e.dot(frame.X), e.dot(frame.Y), 0.0);
          const Vec3 rowY(0.0, e.dot(frame.X), e.dot(frame.Y));
          a += rowX * rowX.transpose() + rowY * rowY.transpose();
          b += d.dot(frame.X) * rowX + d.dot(frame.Y) * rowY;
        }
        const Vec3 q = a.ldlt().solve(b);
        form[f] = q.allFinite() ? q : Vec3(Vec3::Zero());
      }
    });
  return form;
}
} // namespace bsr
