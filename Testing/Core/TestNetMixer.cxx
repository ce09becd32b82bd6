#include "Spline/NetMixer.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace bsr;

namespace
{
/// A contraction toward `aim` whose slowest component keeps 97 % of its distance a step.
NetPoints step(const NetPoints& x, const NetPoints& aim)
{
  NetPoints y = x;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
  {
    const double rate = 0.97 * static_cast<double>(i + 1) / static_cast<double>(x.rows());
    y.row(i) = aim.row(i) + rate * (x.row(i) - aim.row(i));
  }
  return y;
}

NetPoints aimOf(Eigen::Index rows)
{
  NetPoints aim(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i)
  {
    aim.row(i) << std::sin(1.0 + i), std::cos(2.0 * i), 0.1 * static_cast<double>(i);
  }
  return aim;
}
} // namespace

TEST(NetMixer, ASlowIterationArrivesInFewSteps)
{
  const NetPoints aim = aimOf(8);
  NetPoints plain = NetPoints::Zero(8, 3);
  NetPoints mixed = plain;
  NetMixer mixer(6);
  for (int i = 0; i < 30; ++i)
  {
    plain = step(plain, aim);
    mixed = mixer.next(mixed, step(mixed, aim));
  }
  EXPECT_GT((plain - aim).norm(), 0.1);
  EXPECT_LT((mixed - aim).norm(), 1e-3 * (plain - aim).norm());
}

TEST(NetMixer, KeepsToALinearSpace)
{
  // Rows 0 and 1 stay equal, as control points that two patches share must.
  NetPoints aim = aimOf(8);
  aim.row(1) = aim.row(0);
  NetPoints x = NetPoints::Ones(8, 3);
  NetMixer mixer(4);
  for (int i = 0; i < 12; ++i)
  {
    NetPoints y = step(x, aim);
    y.row(1) = y.row(0);
    x = mixer.next(x, y);
    ASSERT_LT((x.row(1) - x.row(0)).norm(), 1e-12);
  }
}

TEST(NetMixer, StandingStillStays)
{
  const NetPoints aim = aimOf(5);
  NetMixer mixer(6);
  for (int i = 0; i < 5; ++i)
  {
    EXPECT_LT((mixer.next(aim, aim) - aim).norm(), 1e-12);
  }
}
