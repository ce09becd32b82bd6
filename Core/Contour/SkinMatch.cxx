#include "Contour/SkinMatch.h"

#include <algorithm>
#include <limits>

namespace bsr
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/**
 * Monotone assignment of nodes to positions on a closed curve by dynamic programming: squared
 * distances to targets, and squares of uneven steps.
 */
class Matcher
{
public:
  /// \param steps the wanted number of positions from each node to the next.
  Matcher(const std::vector<Vec2>& curve, const std::vector<Vec2>& targets,
    const std::vector<double>& steps, double stiffness)
      : Curve(curve),
        Targets(targets),
        Steps(steps),
        Fine(static_cast<int>(curve.size() / targets.size()))
  {
    double length = 0.0;
    for (std::size_t i = 0; i < curve.size(); ++i)
    {
      length += (curve[(i + 1) % curve.size()] - curve[i]).norm();
    }
    const double step = length / static_cast<double>(targets.size());
    this->Stiffness = stiffness * step * step;
  }

  /// Positions of the nodes, the first one's near `start`.
  std::vector<int> run(int start) const
  {
    const auto n = static_cast<int>(this->Targets.size());
    std::vector<int> first = this->pass(0, start);
    // once more from the node opposite, whose place is known better than the start was
    const int half = n / 2;
    const std::vector<int> second = this->pass(half, first[half]);
    std::vector<int> result(n);
    for (int k = 0; k < n; ++k)
    {
      const int j = (k - half + n) % n;
      result[k] = second[j] - (k < half ? static_cast<int>(this->Curve.size()) : 0);
    }
    return result;
  }

private:
  int wrap(int m) const
  {
    const auto n = static_cast<int>(this->Curve.size());
    return ((m % n) + n) % n;
  }

  /// Positions of nodes first, first + 1, ..., once around, from a fixed one.
  std::vector<int> pass(int first, int start) const
  {
    const auto n = static_cast<int>(this->Targets.size());
    const auto m = static_cast<int>(this->Curve.size());
    const int reach = std::max(m / 5, 2 * this->Fine);
    const int width = 2 * reach + 1;
    const int most = 4 * this->Fine;
    std::vector<double> cost(static_cast<std::size_t>(width), Infinity);
    std::vector<std::vector<std::int16_t>> from(n + 1, std::vector<std::int16_t>(width, 0));
    cost[reach] = 0.0;
    for (int k = 1; k <= n; ++k)
    {
      std::vector<double> next(static_cast<std::size_t>(width), Infinity);
      const Vec2& target = this->Targets[(first + k) % n];
      const double wanted = this->Steps[(first + k - 1) % n];
      for (int w = 0; w < width; ++w)
      {
        const int at = start + k * this->Fine + w - reach;
        const double d = (this->Curve[this->wrap(at)] - target).squaredNorm();
        for (int step = 1; step <= most; ++step)
        {
          const int before = w + this->Fine - step;
          if (before < 0 || before >= width || !(cost[before] < Infinity))
          {
            continue;
          }
          const double uneven = (step - wanted) / this->Fine;
          const double c = cost[before] + d + this->Stiffness * uneven * uneven;
          if (c < next[w])
          {
            next[w] = c;
            from[k][w] = static_cast<std::int16_t>(step);
          }
        }
      }
      cost.swap(next);
    }
    std::vector<int> positions(n);
    int w = reach; // closed: back at the start after one turn
    for (int k = n; k > 0; --k)
    {
      w += this->Fine - from[k][w];
      positions[k - 1] = start + (k - 1) * this->Fine + w - reach;
    }
    return positions;
  }

  const std::vector<Vec2>& Curve;
  const std::vector<Vec2>& Targets;
  const std::vector<double>& Steps;
  int Fine;
  double Stiffness = 0.0;
};
} // namespace

std::vector<int> matchNodes(const std::vector<Vec2>& curve, const std::vector<Vec2>& targets,
  const std::vector<double>& steps, double stiffness, int start)
{
  return Matcher(curve, targets, steps, stiffness).run(start);
}
} // namespace bsr
