#include "Mesh/LoopTriangulation.h"

#include <limits>

namespace bsr
{
namespace
{
constexpr std::size_t MostPoints = 120;

class LeastArea
{
public:
  LeastArea(const std::vector<Vec3>& loop, const std::function<bool(Index, Index)>& taken)
      : Loop(loop), Taken(taken)
  {
  }

  /// Triangles of the polygon over some positions of the loop; false: there are none.
  bool polygon(const std::vector<Index>& at, std::vector<std::array<Index, 3>>& out) const
  {
    if (at.size() < 3)
    {
      return true;
    }
    if (at.size() > MostPoints)
    {
      return this->inPieces(at, out);
    }
    const std::size_t n = at.size();
    std::vector<double> cost(n * n, 0.0);
    std::vector<Index> middle(n * n, -1);
    for (std::size_t span = 2; span < n; ++span)
    {
      for (std::size_t i = 0; i + span < n; ++i)
      {
        this->relax(at, i, i + span, cost, middle);
      }
    }
    if (!(cost[n - 1] < std::numeric_limits<double>::infinity()))
    {
      return false;
    }
    this->collect(at, 0, n - 1, middle, out);
    return true;
  }

private:
  void relax(const std::vector<Index>& at, std::size_t i, std::size_t k, std::vector<double>& cost,
    std::vector<Index>& middle) const
  {
    const std::size_t n = at.size();
    double& best = cost[i * n + k];
    best = std::numeric_limits<double>::infinity();
    // A side of the whole polygon is wanted; a chord must be new.
    if (k - i != n - 1 && this->Taken && this->Taken(at[i], at[k]))
    {
      return;
    }
    for (std::size_t m = i + 1; m < k; ++m)
    {
      const Vec3 area =
        (this->Loop[at[m]] - this->Loop[at[i]]).cross(this->Loop[at[k]] - this->Loop[at[i]]);
      const double c = cost[i * n + m] + cost[m * n + k] + area.norm();
      if (c < best)
      {
        best = c;
        middle[i * n + k] = static_cast<Index>(m);
      }
    }
  }

  void collect(const std::vector<Index>& at, std::size_t i, std::size_t k,
    const std::vector<Index>& middle, std::vector<std::array<Index, 3>>& out) const
  {
    if (k - i < 2)
    {
      return;
    }
    const auto m = static_cast<std::size_t>(middle[i * at.size() + k]);
    out.push_back({at[i], at[m], at[k]});
    this->collect(at, i, m, middle, out);
    this->collect(at, m, k, middle, out);
  }

  bool inPieces(const std::vector<Index>& at, std::vector<std::array<Index, 3>>& out) const
  {
    const std::size_t n = at.size();
    const std::size_t step = (n + MostPoints - 1) / MostPoints;
    const auto taken = [&](std::size_t a, std::size_t b)
    { return b - a > 1 && this->Taken && this->Taken(at[a], at[b % n]); };
    std::vector<Index> coarse;
    for (std::size_t i = 0; i < n;)
    {
      // A piece ends at the next point that its first one is not joined with already.
      std::size_t end = std::min(i + step, n);
      while (end < n && taken(i, end))
      {
        ++end;
      }
      coarse.push_back(at[i]);
      std::vector<Index> piece;
      for (; i <= end; ++i)
      {
        piece.push_back(at[i % n]);
      }
      i = end;
      if (!this->polygon(piece, out))
      {
        return false;
      }
    }
    return this->polygon(coarse, out);
  }

  const std::vector<Vec3>& Loop;
  const std::function<bool(Index, Index)>& Taken;
};
} // namespace

std::vector<std::array<Index, 3>> triangulateLoop(
  const std::vector<Vec3>& loop, const std::function<bool(Index, Index)>& taken)
{
  std::vector<Index> all(loop.size());
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    all[i] = static_cast<Index>(i);
  }
  std::vector<std::array<Index, 3>> out;
  if (!LeastArea(loop, taken).polygon(all, out))
  {
    out.clear();
  }
  return out;
}
} // namespace bsr
