#pragma once

#include "Common/Types.h"

#include <cmath>
#include <cstdint>

namespace bsr
{
/**
 * Random numbers from a counter: number n of stream s of seed q is a function of (q, s, n) alone.
 * So they do not depend on threads, on the order of calls or on the standard library, and any
 * piece of an image can be made by itself. The mixing is that of SplitMix64 (Steele, Lea, Flood:
 * Fast splittable pseudorandom number generators, OOPSLA 2014).
 */
inline std::uint64_t mixBits(std::uint64_t z)
{
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Bits of the lattice point (i, j, k); the coordinates may be negative.
inline std::uint64_t latticeBits(std::uint64_t key, std::int64_t i, std::int64_t j, std::int64_t k)
{
  const auto u = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
  return mixBits(key ^ (u(i) * 0x8da6b343d8163841ULL + u(j) * 0xd8163841cb1ab31fULL +
                         u(k) * 0xcb1ab31f4a7c159bULL));
}

/// Uniform in [0, 1).
inline double uniformOf(std::uint64_t bits)
{
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

/// Mean 0, variance 1, nearly normal (the sum of four uniforms), within +-3.47.
inline double normalOf(std::uint64_t bits)
{
  const auto part = [bits](int shift) { return static_cast<double>((bits >> shift) & 0xffffU); };
  const double sum = part(0) + part(16) + part(32) + part(48); // mean 4 * 32767.5
  return (sum - 131070.0) * (1.7320508075688772 / 65536.0);
}

/// A stream of random numbers.
class CounterRandom
{
public:
  CounterRandom(std::uint64_t seed, std::uint64_t stream) : Key(mixBits(seed) ^ mixBits(~stream)) {}

  std::uint64_t bits() { return mixBits(this->Key + this->Next++ * 0x9e3779b97f4a7c15ULL); }
  double uniform() { return uniformOf(this->bits()); }
  double uniform(double low, double high) { return low + (high - low) * this->uniform(); }
  double normal() { return normalOf(this->bits()); }
  /// Uniform in 0..count-1.
  int below(int count) { return static_cast<int>(this->uniform() * count); }
  std::uint64_t key() const { return this->Key; }

private:
  std::uint64_t Key;
  std::uint64_t Next = 0;
};

/// Smooth noise in space: uniform values in [-1, 1] on the integer lattice, blended by smoothstep.
/// Its variance is (1/3) (26/35)^3 on average.
inline double latticeNoise(std::uint64_t key, const Vec3& p)
{
  std::int64_t base[3];
  double weight[3][2];
  for (int a = 0; a < 3; ++a)
  {
    const double f = std::floor(p[a]);
    const double t = p[a] - f;
    base[a] = static_cast<std::int64_t>(f);
    weight[a][1] = t * t * (3.0 - 2.0 * t);
    weight[a][0] = 1.0 - weight[a][1];
  }
  double sum = 0.0;
  for (int c = 0; c < 8; ++c)
  {
    const int i = c & 1;
    const int j = (c >> 1) & 1;
    const int k = c >> 2;
    sum += weight[0][i] * weight[1][j] * weight[2][k] *
           uniformOf(latticeBits(key, base[0] + i, base[1] + j, base[2] + k));
  }
  return 2.0 * sum - 1.0;
}
} // namespace bsr
