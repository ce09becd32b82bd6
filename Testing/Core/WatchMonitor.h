#ifndef WatchMonitor_h
#define WatchMonitor_h

#include "Common/Monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

namespace bsrtest
{
/// Expects progress to grow from 0 to 1 and takes the longest time between two questions whether to
/// cancel: processor time of the calling thread, which other programs do not lengthen. Cancels once
/// the progress told is `from` or more. (How often it is asked depends on the time that passes.)
class WatchMonitor : public bsr::Monitor
{
public:
  explicit WatchMonitor(double from = 2.0) : From(from), Last(now()) {}

  bool cancelled() override
  {
    const double t = now();
    this->Longest = std::max(this->Longest, t - this->Last);
    this->Last = t;
    ++this->Asked;
    return this->Share >= this->From;
  }

  void progress(double share) override
  {
    EXPECT_GE(share, this->Share - 1e-9);
    EXPECT_LE(share, 1.0 + 1e-9);
    this->Share = share;
  }

  double From;
  long Asked = 0;
  double Longest = 0.0; ///< seconds
  double Share = 0.0;

private:
  static double now()
  {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double Last;
};

/// What a computation owes to whoever waits for it: growing progress that ends at 1, frequent
/// questions (0.2 s is meant, the bound leaves room for slow machines), and an end, without a
/// result, wherever it is cancelled. `compute` takes a monitor and returns a status.
template <class Compute>
void expectWatchable(const Compute& compute)
{
  WatchMonitor watch;
  const bsr::Status done = compute(watch);
  ASSERT_TRUE(done.isOk()) << done.message();
  EXPECT_NEAR(watch.Share, 1.0, 1e-9);
  EXPECT_GT(watch.Asked, 10);
  EXPECT_LT(watch.Longest, 0.8);
  testing::Test::RecordProperty("LongestSilence", std::to_string(watch.Longest));
  for (const double share : {0.0, 0.3, 0.7, 0.85})
  {
    WatchMonitor stop(share);
    EXPECT_EQ(compute(stop).code(), bsr::StatusCode::Cancelled) << share;
  }
}
} // namespace bsrtest

#endif
