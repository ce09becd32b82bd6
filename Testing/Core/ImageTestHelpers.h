#pragma once

#include "Common/Monitor.h"
#include "Image/ImageView.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace bsrtest
{
template <class F>
void forEachVoxel(const bsr::Int3& dims, const F& f)
{
  for (std::int64_t k = 0; k < dims[2]; ++k)
  {
    for (std::int64_t j = 0; j < dims[1]; ++j)
    {
      for (std::int64_t i = 0; i < dims[0]; ++i)
      {
        f(bsr::Int3{{i, j, k}});
      }
    }
  }
}

/// A volume whose voxels are f(index).
template <class T, class F>
bsr::Volume<T> makeVolume(const bsr::Int3& dims, const bsr::Double3& spacing, const F& f)
{
  bsr::Volume<T> v(bsr::Box{{{0, 0, 0}}, dims}, spacing);
  forEachVoxel(dims, [&](const bsr::Int3& p) { v.view()(p[0], p[1], p[2]) = f(p); });
  return v;
}

/// Each voxel set with probability `share`.
inline bsr::Volume<std::uint8_t> randomMask(
  const bsr::Int3& dims, const bsr::Double3& spacing, double share, int seed)
{
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return makeVolume<std::uint8_t>(
    dims, spacing, [&](const bsr::Int3&) { return uniform(random) < share ? 1 : 0; });
}

/// Says "cancelled" from the n-th question on.
class CancelAfter : public bsr::Monitor
{
public:
  explicit CancelAfter(int questions) : Left(questions) {}
  bool cancelled() override { return this->Left-- <= 0; }

private:
  int Left;
};
} // namespace bsrtest
