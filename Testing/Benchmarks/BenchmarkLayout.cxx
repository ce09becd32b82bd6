// Layouts of a closed, bent tube: time over the number of triangles and over the number of quads.
// Counters: triangles, quads, irregular vertices; Peak: largest memory of the process so far, MiB
// (run one size alone with --benchmark_filter for that size's figure).
#include "Layout/QuadRemesh.h"
#include "Mesh/BuildSurface.h"
#include "Mesh/Decimate.h"

#include <benchmark/benchmark.h>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace
{
using namespace bsr;

/// About so many triangles: rings of `around` points along the tube, closed by half balls.
const TriangleMesh& tube(std::int64_t triangles)
{
  static std::map<std::int64_t, TriangleMesh> cache;
  TriangleMesh& mesh = cache[triangles];
  if (!mesh.Triangles.empty())
  {
    return mesh;
  }
  const auto around = static_cast<Index>(std::lround(std::sqrt(triangles / 8.0)));
  const auto along = static_cast<Index>(triangles / 2 / around);
  const auto point = [](double u, double v)
  {
    // u: 0..1 from pole to pole; the half balls take an eighth each of the length.
    const double t = std::min(u / 0.125, (1.0 - u) / 0.125);
    const double r = t < 1.0 ? std::sin(0.5 * M_PI * t) : 1.0;
    const double cap = t < 1.0 ? (std::cos(0.5 * M_PI * t)) * (u < 0.5 ? -1.0 : 1.0) : 0.0;
    const double x = 6.0 * std::clamp((u - 0.125) / 0.75, 0.0, 1.0) + cap;
    const double radius = r * (1.0 + 0.1 * std::sin(3.0 * x + 2.0 * v));
    return Vec3(x, radius * std::cos(v) + 0.8 * std::sin(0.8 * x), radius * std::sin(v));
  };
  for (Index i = 1; i < along; ++i)
  {
    for (Index j = 0; j < around; ++j)
    {
      mesh.Points.push_back(point(static_cast<double>(i) / along, 2.0 * M_PI * j / around));
    }
  }
  const auto first = static_cast<Index>(mesh.Points.size());
  mesh.Points.push_back(point(0.0, 0.0));
  mesh.Points.push_back(point(1.0, 0.0));
  for (Index j = 0; j < around; ++j)
  {
    const Index k = (j + 1) % around;
    mesh.Triangles.push_back({first, j, k});
    for (Index i = 0; i + 2 < along; ++i)
    {
      const Index a = i * around;
      mesh.Triangles.push_back({a + j, a + around + j, a + around + k});
      mesh.Triangles.push_back({a + j, a + around + k, a + k});
    }
    mesh.Triangles.push_back({(along - 2) * around + j, first + 1, (along - 2) * around + k});
  }
  return mesh;
}

double peak()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void layout(benchmark::State& state)
{
  const TriangleMesh& mesh = tube(state.range(0));
  QuadRemeshOptions options;
  options.NumberOfQuads = static_cast<int>(state.range(1));
  for (auto _ : state)
  {
    Monitor monitor;
    const auto result = quadRemesh(mesh, options, monitor);
    if (!result)
    {
      state.SkipWithError(result.status().message().c_str());
      return;
    }
    state.counters["Quads"] = static_cast<double>(result->Mesh.Quads.size());
    state.counters["Irregular"] = result->Report.Irregular;
    state.counters["Repair"] = result->Seconds.Repair;
    state.counters["Decimation"] = result->Seconds.Decimation;
    state.counters["Layout"] = result->Seconds.Layout;
  }
  state.counters["Triangles"] = static_cast<double>(mesh.Triangles.size());
  state.counters["Peak"] = peak();
}

void decimation(benchmark::State& state)
{
  const TriangleMesh& mesh = tube(state.range(0));
  for (auto _ : state)
  {
    Monitor monitor;
    RepairReport report;
    auto surfaces = buildSurfaces(mesh, {}, report, monitor);
    DecimateOptions options;
    options.Target = 30000;
    options.Most = 90000;
    const Status status = decimate((*surfaces)[0], options, monitor);
    benchmark::DoNotOptimize(status.isOk());
  }
  state.counters["Triangles"] = static_cast<double>(mesh.Triangles.size());
}
} // namespace

BENCHMARK(layout)
  ->ArgsProduct({{56000, 140000, 350000, 700000, 1400000}, {500}})
  ->ArgsProduct({{140000}, {50, 100, 250, 1000, 2000}})
  ->Unit(benchmark::kMillisecond)
  ->MeasureProcessCPUTime()
  ->UseRealTime();
BENCHMARK(decimation)
  ->Arg(140000)
  ->Arg(350000)
  ->Arg(700000)
  ->Arg(1400000)
  ->Unit(benchmark::kMillisecond)
  ->MeasureProcessCPUTime()
  ->UseRealTime();
BENCHMARK_MAIN();
