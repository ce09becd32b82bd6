#include "Mesh/RemoveSlivers.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace bsr
{
namespace
{
constexpr int Rounds = 6;

class SliverRemover
{
public:
  SliverRemover(TriangleSurface& s, double share) : S(s), Share(share) {}

  Index run()
  {
    Index all = 0;
    for (int round = 0; round < Rounds; ++round)
    {
      const Index changed = this->collapseShort() + this->flipFlat();
      all += changed;
      if (changed == 0)
      {
        break;
      }
    }
    this->S.compact();
    return all;
  }

private:
  double length(Index h) const
  {
    return (this->S.Points[this->S.end(h)] - this->S.Points[this->S.start(h)]).norm();
  }
  bool real(Index h) const
  {
    return !this->S.Virtual[this->S.start(h)] && !this->S.Virtual[this->S.end(h)];
  }

  /// Mean length of the edges at both ends, the edge itself left out.
  double meanAround(Index h) const
  {
    double sum = 0.0;
    int count = 0;
    for (const Index x : {h, this->S.Opposite[h]})
    {
      this->S.around(this->S.start(x),
        [&](Index y)
        {
          if (y != x && this->real(y))
          {
            sum += this->length(y);
            ++count;
          }
        });
    }
    return count > 0 ? sum / count : 0.0;
  }

  Index collapseShort()
  {
    Index changed = 0;
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (this->S.Vertex[h] < 0 || !this->real(h))
      {
        continue;
      }
      if (this->length(h) < this->Share * this->meanAround(h) && this->S.canCollapse(h) &&
          this->fanKeeps(h))
      {
        this->S.collapse(h, this->S.Points[this->S.end(h)]);
        ++changed;
      }
    }
    return changed;
  }

  /// Whether no triangle at the start of h turns over, or flattens, when it moves to the end.
  bool fanKeeps(Index h) const
  {
    const Vec3 to = this->S.Points[this->S.end(h)];
    bool keeps = true;
    this->S.around(this->S.start(h),
      [&](Index x)
      {
        const Index f = x / 3;
        if (this->S.hole(f) || f == h / 3 || f == this->S.Opposite[h] / 3)
        {
          return;
        }
        const Vec3 a = this->S.Points[this->S.start(x)];
        const Vec3 b = this->S.Points[this->S.end(x)];
        const Vec3 c = this->S.Points[this->S.apex(x)];
        const Vec3 before = (b - a).cross(c - a);
        const Vec3 after = (b - to).cross(c - to);
        const double flat = 1e-3 * (c - b).squaredNorm();
        keeps = keeps && (before.norm() <= flat || before.dot(after) > 0.0);
      });
    return keeps;
  }

  /// Twice the area over the squared longest edge.
  static double quality(const Vec3& a, const Vec3& b, const Vec3& c)
  {
    const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest > 0.0 ? (b - a).cross(c - a).norm() / longest : 0.0;
  }

  Index flipFlat()
  {
    Index changed = 0;
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      if (!this->S.alive(f) || this->S.hole(f))
      {
        continue;
      }
      Index h = 3 * f;
      for (const Index x : {3 * f + 1, 3 * f + 2})
      {
        h = this->length(x) > this->length(h) ? x : h;
      }
      const Index o = this->S.Opposite[h];
      if (this->S.hole(o / 3) || !this->S.canFlip(h))
      {
        continue;
      }
      const Vec3& a = this->S.Points[this->S.start(h)];
      const Vec3& b = this->S.Points[this->S.end(h)];
      const Vec3& c = this->S.Points[this->S.apex(h)];
      const Vec3& d = this->S.Points[this->S.apex(o)];
      const double now = quality(a, b, c);
      const Vec3 normal = (b - a).cross(c - a) + (a - b).cross(d - b);
      if (now < this->Share && std::min(quality(d, c, a), quality(c, d, b)) > now &&
          (c - d).cross(a - d).dot(normal) > 0.0 && (d - c).cross(b - c).dot(normal) > 0.0)
      {
        this->S.flip(h);
        ++changed;
      }
    }
    return changed;
  }

  TriangleSurface& S;
  double Share;
};
} // namespace

Index removeSlivers(TriangleSurface& s, double share)
{
  return SliverRemover(s, share).run();
}
} // namespace bsr
