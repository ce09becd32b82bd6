#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bsr
{
/// Disjoint sets of the indices 0 .. n - 1; the smallest index represents a set.
class UnionFind
{
public:
  explicit UnionFind(std::int64_t n) : Parent(static_cast<std::size_t>(n))
  {
    std::iota(this->Parent.begin(), this->Parent.end(), std::int64_t{0});
  }

  std::int64_t find(std::int64_t i)
  {
    while (this->Parent[i] != i)
    {
      this->Parent[i] = this->Parent[this->Parent[i]];
      i = this->Parent[i];
    }
    return i;
  }

  void join(std::int64_t a, std::int64_t b)
  {
    a = this->find(a);
    b = this->find(b);
    this->Parent[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::int64_t> Parent;
};
} // namespace bsr
