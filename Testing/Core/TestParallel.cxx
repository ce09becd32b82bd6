#include "Common/Parallel.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace
{
double sumOfRoots(std::int64_t n, std::int64_t chunk)
{
  return bsr::parallelReduce(
    0, n, chunk, 0.0,
    [](std::int64_t begin, std::int64_t end)
    {
      double s = 0;
      for (std::int64_t i = begin; i < end; ++i)
      {
        s += std::sqrt(static_cast<double>(i));
      }
      return s;
    },
    [](double a, double b) { return a + b; });
}
} // namespace

TEST(Parallel, ForVisitsEveryIndexOnce)
{
  std::vector<int> hits(10007, 0);
  bsr::parallelFor(0, 10007, 13,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        ++hits[i];
      }
    });
  EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](int h) { return h == 1; }));
}

TEST(Parallel, EmptyRangeCallsNothing)
{
  bsr::parallelFor(5, 5, 1, [](std::int64_t, std::int64_t) { FAIL(); });
  EXPECT_EQ(sumOfRoots(0, 10), 0.0);
}

TEST(Parallel, ReductionIsBitIdenticalForAnyNumberOfThreads)
{
  const double two = sumOfRoots(100003, 97);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(two, sumOfRoots(100003, 97));
}
