#pragma once

#include "Common/Monitor.h"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace bsr
{
/// May be asked on any thread; only the thread that made it passes questions on to the parent, the
/// others learn what was answered there.
class SharedMonitor : public Monitor
{
public:
  explicit SharedMonitor(Monitor& parent) : Parent(parent) {}
  bool cancelled() override
  {
    if (!this->Stop && std::this_thread::get_id() == this->Caller && this->Parent.cancelled())
    {
      this->Stop = true;
    }
    return this->Stop;
  }

private:
  Monitor& Parent;
  std::thread::id Caller = std::this_thread::get_id();
  std::atomic<bool> Stop{false};
};

/**
 * Calls work(i, monitor) for each i below `count` in parallel: for few items that take long. Each
 * may ask the monitor it is given on its thread and should do so at least every 0.1 s; the calling
 * thread goes on asking while it waits for items of other threads. An item must write only what
 * belongs to it, so that the result does not depend on the number of threads. False: cancelled.
 */
template <class Work>
bool parallelItems(std::size_t count, Monitor& monitor, const Work& work)
{
  SharedMonitor shared(monitor);
  std::atomic<std::size_t> next{0};
  std::atomic<int> running{0};
  const auto run = [&]
  {
    ++running;
    for (std::size_t i = next++; i < count && !shared.cancelled(); i = next++)
    {
      work(i, shared);
    }
    --running;
  };
  tbb::task_group others;
  const int threads = tbb::this_task_arena::max_concurrency();
  for (int i = 1; i < threads && i < static_cast<int>(count); ++i)
  {
    others.run(run);
  }
  run();
  while (running > 0)
  {
    shared.cancelled();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  others.wait(); // those not begun find nothing left to do
  return !shared.cancelled();
}
} // namespace bsr
