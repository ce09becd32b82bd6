// Distance transform and closing on a bent hollow tube that fills about 3 % of a cube.
#include "Common/Parallel.h"
#include "Image/BallClosing.h"
#include "Image/DistanceTransform.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

namespace
{
using bsr::Volume;

const Volume<std::uint8_t>& tube(std::int64_t n)
{
  static std::map<std::int64_t, Volume<std::uint8_t>> cache;
  Volume<std::uint8_t>& v = cache[n];
  if (!v.Data)
  {
    v = Volume<std::uint8_t>(bsr::Box{{{0, 0, 0}}, {{n, n, n}}}, {{1.0, 1.0, 1.0}});
    const auto image = v.view();
    const double s = static_cast<double>(n);
    bsr::parallelFor(0, n, 1,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t k = begin; k < end; ++k)
        {
          for (std::int64_t j = 0; j < n; ++j)
          {
            for (std::int64_t i = 0; i < n; ++i)
            {
              const double x = static_cast<double>(i) / s;
              const double y = static_cast<double>(j) / s - 0.5 - 0.15 * std::sin(6.0 * x);
              const double z = static_cast<double>(k) / s - 0.5 - 0.1 * std::cos(5.0 * x);
              const double r = std::hypot(y, z);
              image(i, j, k) = x > 0.06 && x < 0.94 && r > 0.11 && r < 0.152 ? 1 : 0;
            }
          }
        }
      });
  }
  return v;
}

void distanceTransform(benchmark::State& state)
{
  const auto& v = tube(state.range(0));
  for (auto _ : state)
  {
    bsr::Monitor monitor;
    auto d = bsr::squaredDistance(v.view(), {}, monitor);
    benchmark::DoNotOptimize(d->Data.get());
  }
}

void closing(benchmark::State& state)
{
  const auto& v = tube(state.range(0));
  for (auto _ : state)
  {
    bsr::Monitor monitor;
    auto d = bsr::closeByBall(v.view(), static_cast<double>(state.range(1)), monitor);
    benchmark::DoNotOptimize(d->Data.get());
  }
}
} // namespace

BENCHMARK(distanceTransform)
  ->Arg(256)
  ->Arg(512)
  ->Unit(benchmark::kMillisecond)
  ->MeasureProcessCPUTime()
  ->UseRealTime();
BENCHMARK(closing)
  ->ArgsProduct({{256, 512}, {5, 10, 20, 40}})
  ->Unit(benchmark::kMillisecond)
  ->MeasureProcessCPUTime()
  ->UseRealTime();
BENCHMARK_MAIN();
