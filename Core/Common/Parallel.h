#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace bsr
{
/**
 * The one parallel loop of Core: calls body(begin, end) on disjoint ranges that cover [begin, end).
 * The body must write only what belongs to its own indices, so that the result does not depend on
 * the number of threads. `grain` is the smallest number of indices worth a task.
 */
template <class Body>
void parallelFor(std::int64_t begin, std::int64_t end, std::int64_t grain, const Body& body)
{
  if (end <= begin)
  {
    return;
  }
  using Range = tbb::blocked_range<std::int64_t>;
  tbb::parallel_for(Range(begin, end, std::max<std::int64_t>(grain, 1)),
    [&body](const Range& r) { body(r.begin(), r.end()); });
}

/// parallelFor over ranges of at most `grain` indices that asks `monitor` on the calling thread
/// between ranges, which should take a few hundredths of a second at most; false when it was
/// cancelled: some indices were left out then.
template <class Monitor, class Body>
bool parallelForUntilCancelled(
  std::int64_t begin, std::int64_t end, std::int64_t grain, Monitor& monitor, const Body& body)
{
  std::atomic<bool> stop{monitor.cancelled()};
  if (stop || end <= begin)
  {
    return !stop;
  }
  const auto caller = std::this_thread::get_id();
  using Range = tbb::blocked_range<std::int64_t>;
  tbb::parallel_for(
    Range(begin, end, std::max<std::int64_t>(grain, 1)),
    [&](const Range& r)
    {
      if (std::this_thread::get_id() == caller && !stop && monitor.cancelled())
      {
        stop = true;
      }
      if (!stop)
      {
        body(r.begin(), r.end());
      }
    },
    tbb::simple_partitioner());
  return !stop;
}

/// Sorts; elements that compare equal must be alike, so that the threads leave no trace.
template <class Iterator>
void parallelSort(Iterator begin, Iterator end)
{
  tbb::parallel_sort(begin, end);
}

/**
 * Deterministic reduction: body(begin, end) returns the partial result of a chunk of fixed size,
 * join(a, b) combines; chunks are joined in index order, whatever the number of threads.
 */
template <class T, class Body, class Join>
T parallelReduce(std::int64_t begin, std::int64_t end, std::int64_t chunk, T identity,
  const Body& body, const Join& join)
{
  chunk = std::max<std::int64_t>(chunk, 1);
  const std::int64_t chunks = end > begin ? (end - begin + chunk - 1) / chunk : 0;
  std::vector<T> partial(static_cast<std::size_t>(chunks), identity);
  parallelFor(0, chunks, 1,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t c = first; c < last; ++c)
      {
        partial[c] = body(begin + c * chunk, std::min(end, begin + (c + 1) * chunk));
      }
    });
  T total = identity;
  for (const T& p : partial)
  {
    total = join(total, p);
  }
  return total;
}
} // namespace bsr
