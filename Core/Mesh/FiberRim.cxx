#include "Mesh/FiberRim.h"

#include "Mesh/SmoothRing.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr int Bins = MouthFrame::Bins;
constexpr double MostTilt = 0.7;    ///< cosine between mouth and rim plane at least
constexpr double PlainWaves = 3.0;  ///< around, of the height that a search is drawn to
constexpr double HeightWaves = 6.0; ///< around, that a rim's height follows
constexpr double RadiusWaves = 8.0; ///< around, that a rim's radius follows
constexpr double Spread = 0.02;     ///< of the mouth's radius: of detours that count in full
constexpr int Rounds = 12;          ///< of weighing

using Values = Eigen::VectorXd;

/// A smooth curve along most of a rim. What lies behind it and farther out at once has little
/// weight: the closed surface spans webs from the rim to debris on the wall, and the rim follows
/// their edge. A notch, where the wall itself ends early, is only behind.
FiberRim robustRim(const FiberRim& rim, double radius, double heightWaves, double radiusWaves)
{
  const SmoothRing smoothHeight(heightWaves);
  const SmoothRing smoothRadius(radiusWaves);
  const Eigen::Map<const Values> h(rim.Height.data(), Bins);
  const Eigen::Map<const Values> r(rim.Radius.data(), Bins);
  Values weight = Values::Ones(Bins);
  Values height;
  Values wide;
  for (int round = 0; round < Rounds; ++round)
  {
    height = smoothHeight.through(h, weight);
    wide = smoothRadius.through(r, weight);
    for (int i = 0; i < Bins; ++i)
    {
      const double back = std::max(height[i] - h[i], 0.0);
      const double outward = std::max(r[i] - wide[i], 0.0);
      const double off = std::sqrt(back * outward) / (Spread * radius);
      weight[i] = round < Rounds / 2 ? 1.0 / (1.0 + off) : 1.0 / (1.0 + off * off);
    }
  }
  FiberRim result;
  Values::Map(result.Height.data(), Bins) = height;
  Values::Map(result.Radius.data(), Bins) = wide;
  return result;
}

/// The frame of the plane through a rim.
MouthFrame planeOf(const FiberRim& rim, const MouthFrame& frame)
{
  Vec3 center = Vec3::Zero();
  for (int i = 0; i < Bins; ++i)
  {
    center += rim.point(frame, i) / Bins;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < Bins; ++i)
  {
    const Vec3 d = rim.point(frame, i) - center;
    covariance += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Vec3 axis = solver.eigenvectors().col(0);
  if (axis.dot(frame.Axis) < 0.0)
  {
    axis = -axis;
  }
  return {center, axis};
}
} // namespace

MouthFrame::MouthFrame(const Vec3& center, const Vec3& axis)
    : Center(center), Axis(axis.normalized())
{
  this->U = this->Axis.unitOrthogonal();
  this->V = this->Axis.cross(this->U);
}

double MouthFrame::bin(const Vec3& p) const
{
  const Vec3 d = p - this->Center;
  const double a = std::atan2(d.dot(this->V), d.dot(this->U)) / (2.0 * Pi) * Bins;
  return a < 0.0 ? a + Bins : a;
}

Vec3 MouthFrame::radial(double bin) const
{
  const double a = bin / Bins * 2.0 * Pi;
  return std::cos(a) * this->U + std::sin(a) * this->V;
}

double between(const RimProfile& profile, double bin)
{
  const double x = bin - 0.5;
  const int i = static_cast<int>(std::floor(x));
  const double t = x - i;
  return (1.0 - t) * ring(profile, i) + t * ring(profile, i + 1);
}

Vec2 FiberRim::at(double bin) const
{
  return {between(this->Radius, bin), between(this->Height, bin)};
}

std::optional<FiberRim> findRim(const TriangleMesh& mesh, const std::vector<double>& off,
  const EndMouth& mouth, double lean, MouthFrame& frame)
{
  const RimSurface surface{mesh, wideNormals(mesh), off};
  std::optional<FiberRim> rim;
  for (int round = 0; round < 4; ++round)
  {
    rim = searchRim(surface, frame, mouth.Radius, lean, nullptr);
    if (!rim)
    {
      return rim;
    }
    if (round < 3)
    {
      const MouthFrame plane = planeOf(*rim, frame);
      if (plane.Axis.dot(mouth.Direction.normalized()) < MostTilt)
      {
        break;
      }
      frame = plane;
    }
  }
  for (int round = 0; round < 2; ++round)
  {
    const FiberRim smooth = robustRim(*rim, mouth.Radius, PlainWaves, RadiusWaves);
    const auto smoother = searchRim(surface, frame, mouth.Radius, lean, &smooth.Height);
    rim = smoother ? smoother : rim;
  }
  return robustRim(*rim, mouth.Radius, HeightWaves, RadiusWaves);
}
} // namespace bsr
