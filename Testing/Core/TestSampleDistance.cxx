#include "ImageTestHelpers.h"

#include "Image/SampleDistance.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

using namespace bsrtest;

namespace
{
/// A field that is linear in the world, so that interpolation is exact.
const bsr::Vec3 Slope(0.3, -1.2, 0.7);

bsr::ImageFrame turned()
{
  bsr::ImageFrame f;
  f.Origin = bsr::Vec3(5.0, -2.0, 1.0);
  f.Direction = Eigen::AngleAxisd(0.7, bsr::Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  return f;
}

bsr::Volume<float> linearField(const bsr::ImageFrame& frame)
{
  const bsr::Double3 s{{0.5, 0.7, 1.1}};
  return makeVolume<float>({{8, 7, 6}}, s,
    [&](const bsr::Int3& p)
    {
      const bsr::Vec3 local(static_cast<double>(p[0]) * s[0], static_cast<double>(p[1]) * s[1],
        static_cast<double>(p[2]) * s[2]);
      return static_cast<float>(Slope.dot(frame.Origin + frame.Direction * local));
    });
}
} // namespace

TEST(SampleDistance, IsExactOnLinearFields)
{
  const bsr::ImageFrame frame = turned();
  const auto v = linearField(frame);
  for (const bsr::Vec3& local : {bsr::Vec3(0.0, 0.0, 0.0), bsr::Vec3(1.3, 2.2, 3.1),
         bsr::Vec3(3.5, 4.2, 5.5), bsr::Vec3(0.01, 4.19, 2.0)})
  {
    const bsr::Vec3 p = frame.Origin + frame.Direction * local;
    bsr::Vec3 gradient;
    EXPECT_NEAR(bsr::sampleVolume(v.view(), frame, p, &gradient), Slope.dot(p), 1e-5);
    EXPECT_LT((gradient - Slope).norm(), 1e-5);
  }
}

TEST(SampleDistance, PointsOutsideGetTheBorder)
{
  const bsr::ImageFrame frame = turned();
  const auto v = linearField(frame);
  const bsr::Vec3 far = frame.Origin + frame.Direction * bsr::Vec3(-9.0, 0.0, 0.0);
  EXPECT_NEAR(bsr::sampleVolume(v.view(), frame, far), v.view()(0, 0, 0), 1e-6);
}

TEST(SampleDistance, OneVoxelIsEnough)
{
  const auto v =
    makeVolume<float>({{1, 1, 1}}, {{1.0, 1.0, 1.0}}, [](const bsr::Int3&) { return 3.0F; });
  EXPECT_EQ(bsr::sampleVolume(v.view(), {}, bsr::Vec3(4.0, -1.0, 0.3)), 3.0);
}
