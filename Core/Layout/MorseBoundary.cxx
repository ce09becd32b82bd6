#include "Layout/MorseGradient.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// The vertices of a boundary, in order, from the start of h (the hole on its other side).
std::vector<Index> loopFrom(const TriangleSurface& s, Index h, std::vector<std::uint8_t>& done)
{
  std::vector<Index> loop;
  while (!done[s.start(h)])
  {
    done[s.start(h)] = 1;
    loop.push_back(s.start(h));
    h = TriangleSurface::next(h);
    while (!s.hole(s.Opposite[h] / 3))
    {
      h = TriangleSurface::next(s.Opposite[h]);
    }
  }
  return loop;
}

/// The function along a boundary.
class Ripples
{
public:
  Ripples(const std::vector<Index>& loop, std::vector<double>& values) : Loop(loop), Values(values)
  {
  }

  void level(double persistence)
  {
    const auto n = static_cast<int>(this->Loop.size());
    int top = 0;
    int bottom = 0;
    for (int i = 1; i < n; ++i)
    {
      top = this->value(i) > this->value(top) ? i : top;
      bottom = this->value(i) < this->value(bottom) ? i : bottom;
    }
    const double range = this->value(top) - this->value(bottom);
    if (range > 0.0)
    {
      const auto turns = this->turns(top, std::min(persistence, 0.45 * range));
      for (std::size_t t = 0; t + 1 < turns.size(); ++t)
      {
        this->makeMonotone(turns[t], turns[t + 1]);
      }
    }
  }

private:
  double& value(int i)
  {
    const auto n = static_cast<int>(this->Loop.size());
    return this->Values[this->Loop[(i % n + n) % n]];
  }

  /// Extrema that the function leaves by more than the band, from the highest point once around.
  std::vector<int> turns(int top, double band)
  {
    const int end = top + static_cast<int>(this->Loop.size());
    std::vector<int> turns(1, top);
    bool falling = true;
    int extreme = top;
    for (int i = top + 1; i <= end; ++i)
    {
      const double v = this->value(i);
      if (falling ? v <= this->value(extreme) : v >= this->value(extreme))
      {
        extreme = i;
      }
      else if (std::abs(v - this->value(extreme)) > band)
      {
        turns.push_back(extreme);
        falling = !falling;
        extreme = i;
      }
    }
    if (turns.back() != end)
    {
      turns.push_back(end);
    }
    return turns;
  }

  /// Between two turns: the mean of the running extrema from either end, with a touch of the
  /// straight line, so that no two values are equal.
  void makeMonotone(int a, int b)
  {
    const bool down = this->value(a) > this->value(b);
    const auto further = [&](double x, double y) { return down ? std::min(x, y) : std::max(x, y); };
    const auto nearer = [&](double x, double y) { return down ? std::max(x, y) : std::min(x, y); };
    std::vector<double> ahead(b - a + 1, this->value(a));
    std::vector<double> back(b - a + 1, this->value(b));
    for (int i = 1; i <= b - a; ++i)
    {
      ahead[i] = further(ahead[i - 1], this->value(a + i));
      back[b - a - i] = nearer(back[b - a - i + 1], this->value(b - i));
    }
    const double first = this->value(a);
    const double slope = (this->value(b) - first) / (b - a);
    for (int i = 1; i < b - a; ++i)
    {
      this->value(a + i) = (1.0 - 1e-6) * 0.5 * (ahead[i] + back[i]) + 1e-6 * (first + slope * i);
    }
  }

  const std::vector<Index>& Loop;
  std::vector<double>& Values;
};
} // namespace

void smoothBoundaries(const TriangleSurface& s, double persistence, std::vector<double>& values)
{
  std::vector<std::uint8_t> done(s.Points.size(), 0);
  for (Index h = 0; h < static_cast<Index>(s.Vertex.size()); ++h)
  {
    if (!s.hole(h / 3) && s.hole(s.Opposite[h] / 3) && !done[s.start(h)])
    {
      const auto loop = loopFrom(s, h, done);
      Ripples(loop, values).level(persistence);
    }
  }
}
} // namespace bsr
