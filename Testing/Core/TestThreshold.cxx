#include "ImageTestHelpers.h"

#include "Image/Threshold.h"

#include <gtest/gtest.h>

using namespace bsrtest;

namespace
{
template <class T>
bsr::Volume<T> twoClasses(double low, double high, double noise)
{
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, noise);
  return makeVolume<T>({{30, 20, 20}}, {{1.0, 1.0, 1.0}},
    [&](const bsr::Int3& p) { return static_cast<T>((p[0] < 21 ? low : high) + normal(random)); });
}

template <class T>
double otsu(const bsr::Volume<T>& v)
{
  bsr::Monitor monitor;
  const auto t = bsr::otsuThreshold<T>(v.view(), monitor);
  EXPECT_TRUE(t) << t.status().message();
  return *t;
}
} // namespace

TEST(Threshold, OtsuSeparatesTwoClasses)
{
  EXPECT_NEAR(otsu(twoClasses<std::uint16_t>(9000, 30000, 2500)), 19500, 800);
  EXPECT_NEAR(otsu(twoClasses<short>(-1000, 400, 100)), -300, 60);
  EXPECT_NEAR(otsu(twoClasses<float>(0.001, 0.003, 0.0002)), 0.002, 0.0001);
  EXPECT_NEAR(otsu(twoClasses<double>(-4e9, 4e9, 1e8)), 0.0, 4e8);
  EXPECT_NEAR(otsu(twoClasses<std::uint8_t>(0, 1, 0)), 0.5, 1e-12);
}

TEST(Threshold, OtsuRefusesWhatHasNoClasses)
{
  bsr::Monitor monitor;
  auto v = twoClasses<float>(5, 5, 0);
  EXPECT_EQ(
    bsr::otsuThreshold<float>(v.view(), monitor).status().code(), bsr::StatusCode::InvalidInput);
  v.Data[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(
    bsr::otsuThreshold<float>(v.view(), monitor).status().message().find("NaN"), std::string::npos);
  EXPECT_EQ(bsr::otsuThreshold<float>({}, monitor).status().code(), bsr::StatusCode::InvalidInput);
}

TEST(Threshold, MaskIncludesTheThreshold)
{
  bsr::Monitor monitor;
  const auto v = makeVolume<int>(
    {{5, 1, 1}}, {{1.0, 1.0, 1.0}}, [](const bsr::Int3& p) { return static_cast<int>(p[0]); });
  const auto mask = bsr::thresholdMask<int>(v.view(), 3.0, monitor);
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->Data[2], 0);
  EXPECT_EQ(mask->Data[3], 1);
}

TEST(Threshold, HalfwayFindsTheSurfaceOfAThinBlurredWall)
{
  // A sheet of 5 voxels between air at 9000 and wall at 30000 with soft edges.
  const auto image = makeVolume<std::uint16_t>({{60, 20, 20}}, {{1.0, 1.0, 1.0}},
    [](const bsr::Int3& p)
    {
      const double d = 2.5 - std::abs(static_cast<double>(p[0]) - 30.2);
      return static_cast<std::uint16_t>(19500.0 + 10500.0 * std::tanh(d));
    });
  bsr::Monitor monitor;
  const double start = otsu(image);
  const auto t = bsr::halfwayThreshold<std::uint16_t>(image.view(), start, monitor);
  ASSERT_TRUE(t);
  EXPECT_NEAR(*t, 19500.0, 300.0);
}

TEST(Threshold, HalfwayIsNotMovedByCavitiesAndNoise)
{
  // A wall of 10 voxels, blurred, a quarter of it cavities of half its contrast, noise.
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 2000.0);
  const auto image = makeVolume<std::uint16_t>({{60, 24, 24}}, {{1.0, 1.0, 1.0}},
    [&](const bsr::Int3& p)
    {
      const double d = 5.0 - std::abs(static_cast<double>(p[0]) - 30.2);
      const double edge = 0.5 + 0.5 * std::tanh(d);
      const bool cavity = p[1] % 8 < 4 && p[2] % 8 < 4;
      return static_cast<std::uint16_t>(
        9000.0 + 21000.0 * edge * (cavity ? 0.6 : 1.0) + noise(random));
    });
  bsr::Monitor monitor;
  const double start = otsu(image);
  const auto t = bsr::halfwayThreshold<std::uint16_t>(image.view(), start, monitor);
  ASSERT_TRUE(t);
  EXPECT_NEAR(*t, 19500.0, 700.0); // the mean of the wall would say 18500
}

TEST(Threshold, HalfwayKeepsTheStartWithoutInnerVoxels)
{
  bsr::Monitor monitor;
  const auto dots = makeVolume<float>({{9, 9, 9}}, {{1.0, 1.0, 1.0}},
    [](const bsr::Int3& p) { return (p[0] + p[1] + p[2]) % 2 ? 1.0F : 0.0F; });
  EXPECT_EQ(*bsr::halfwayThreshold<float>(dots.view(), 0.4, monitor), 0.4);
  const auto flat = twoClasses<float>(0, 1, 0);
  bsr::ImageView<const float> slice = flat.view();
  slice.Dims[2] = 1;
  EXPECT_EQ(*bsr::halfwayThreshold<float>(slice, 0.3, monitor), 0.5); // a slice has depth, too
  const auto constant = twoClasses<float>(1, 1, 0);
  EXPECT_EQ(*bsr::halfwayThreshold<float>(constant.view(), 0.3, monitor), 0.3);
}
