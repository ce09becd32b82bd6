#include "Contour/SkinMeasure.h"

#include "Spline/Evaluate.h"
#include "Spline/SampleModel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
/// An end of a leg by its points, normals outward: convex where nothing of it lies above the
/// tangent plane.
void judgeEnd(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, double height,
  double room, SkinMeasures& out)
{
  double convex = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    double above = 0.0;
    for (const Vec3& q : points)
    {
      above = std::max(above, normals[i].dot(q - points[i]));
    }
    convex += above <= 0.05 * room ? 1.0 : 0.0;
  }
  if (!points.empty())
  {
    out.ConvexShare = std::min(out.ConvexShare, convex / static_cast<double>(points.size()));
  }
  if (room > 0.0)
  {
    out.EndHeight = std::max(out.EndHeight, height / room);
  }
}
} // namespace

void measureEnds(const ContourStack& stack, const std::vector<LegEnd>& ends,
  const SampledModel& samples, SkinMeasures& out)
{
  for (const LegEnd& e : ends)
  {
    const Slice& s = stack.Slices[stack.Contours[e.Contour].Slice];
    // a slice's own plane may be tilted a little against its normal here
    double level = -std::numeric_limits<double>::infinity();
    for (const Vec3& p : stack.Contours[e.Contour].Points)
    {
      level = std::max(level, e.Out.dot(p - s.Origin));
    }
    std::vector<Index> own;
    for (std::size_t q = 0; q < samples.Polygons.size(); ++q)
    {
      if (std::binary_search(e.Patches.begin(), e.Patches.end(), samples.PatchId[q]))
      {
        const auto& corners = samples.Polygons[q];
        own.insert(own.end(), corners.begin(), corners.begin() + (corners[3] < 0 ? 3 : 4));
      }
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    std::vector<Vec3> points;
    std::vector<Vec3> normals;
    double top = 0.0;
    for (const Index i : own)
    {
      const double height = e.Out.dot(samples.Points[i] - s.Origin) - level;
      if (height > 0.0)
      {
        const Vec3& n = samples.Normals[i];
        points.push_back(samples.Points[i]);
        normals.push_back(n.dot(e.Out) < 0.0 ? Vec3(-n) : n);
        top = std::max(top, height);
      }
    }
    judgeEnd(points, normals, top, e.Room, out);
  }
}

namespace
{
class Meter
{
public:
  Meter(const ContourStack& stack, const SkinGrid& grid, const SkinSurface& surface)
      : Stack(stack),
        Grid(grid),
        Surface(surface),
        Model(modelOf(surface.Shape, surface.Control)),
        Patch(Model.Patches[0])
  {
  }

  SkinMeasures run()
  {
    std::vector<Index> contours;
    for (const SkinRing& r : this->Grid.Rings)
    {
      if (r.Outer >= 0) // the border lies in its plane: no cut
      {
        contours.push_back(r.Contour);
      }
    }
    Monitor quiet;
    if (const auto r = resliceError(this->Model, this->Stack, contours, quiet))
    {
      this->Out.Reslice = *r;
    }
    this->jumps();
    for (Index r = 0; r < static_cast<Index>(this->Grid.Rings.size()); ++r)
    {
      if (this->Grid.Rings[r].Core)
      {
        this->end(r);
      }
      this->signs(r);
    }
    return this->Out;
  }

private:
  SurfacePoint at(const Vec2& uv) const
  {
    return evaluatePatch(this->Model, this->Patch, uv.x(), uv.y());
  }

  void jumps()
  {
    double largest = 0.0;
    double jump = 0.0;
    for (const int d : {0, 1})
    {
      const std::vector<double> ends = pieceEnds(this->Model, this->Patch, d);
      for (std::size_t k = 1; k + 1 < ends.size(); ++k)
      {
        const double step = 1e-9 * std::min(ends[k] - ends[k - 1], ends[k + 1] - ends[k]);
        for (int i = 0; i <= 40; ++i)
        {
          const auto second = [&](double t)
          {
            const SurfacePoint p = this->at(d == 0 ? Vec2(t, i / 40.0) : Vec2(i / 40.0, t));
            return d == 0 ? p.Duu : p.Dvv;
          };
          const Vec3 right = second(ends[k]);
          jump = std::max(jump, (right - second(ends[k] - step)).norm());
          largest = std::max(largest, right.norm());
        }
      }
    }
    this->Out.SecondDerivativeJump = largest > 0.0 ? jump / largest : 0.0;
  }

  /// Height and convexity of the end of a leg, at the points that close it.
  void end(Index r)
  {
    const Vec3 out = this->Grid.CapDirection[r];
    const Vec3 origin =
      this->Stack.Slices[this->Stack.Contours[this->Grid.Rings[r].Contour].Slice].Origin;
    double top = 0.0;
    std::vector<SurfacePoint> points;
    for (const SkinSample& s : this->Surface.Samples)
    {
      if (s.Cap && !s.Bridge && s.Ring == r)
      {
        points.push_back(this->at(s.Sample.UV));
        top = std::max(top, out.dot(points.back().Point - origin));
      }
    }
    std::vector<Vec3> places;
    std::vector<Vec3> normals;
    for (const SurfacePoint& p : points)
    {
      places.push_back(p.Point);
      normals.push_back(p.normal().normalized() * (p.normal().dot(out) < 0.0 ? -1.0 : 1.0));
    }
    judgeEnd(places, normals, top, this->Grid.CapRoom[r], this->Out);
  }

  static int signChanges(const std::vector<Vec2>& curve)
  {
    const std::size_t n = curve.size();
    std::vector<double> turn;
    for (std::size_t i = 0; n > 3 && i < n; ++i)
    {
      const Vec2 a = curve[(i + 1) % n] - curve[i];
      const Vec2 b = curve[(i + 2) % n] - curve[(i + 1) % n];
      const double t = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
      if (std::abs(t) > 1e-3) // straight is no sign
      {
        turn.push_back(t);
      }
    }
    int changes = 0;
    for (std::size_t i = 0; i < turn.size(); ++i)
    {
      changes += turn[i] * turn[(i + 1) % turn.size()] < 0.0 ? 1 : 0;
    }
    return changes;
  }

  void signs(Index r)
  {
    std::vector<Vec2> data;
    std::vector<Vec2> model;
    for (const SkinSample& s : this->Surface.Samples)
    {
      if (!s.Cap && s.Ring == r)
      {
        data.push_back(this->Stack.flat(s.Sample.Point));
        model.push_back(this->Stack.flat(this->at(s.Sample.UV).Point));
      }
    }
    this->Out.SignChangesData += signChanges(data);
    this->Out.SignChangesModel += signChanges(model);
  }

  const ContourStack& Stack;
  const SkinGrid& Grid;
  const SkinSurface& Surface;
  SplineModel Model;
  const SplinePatch& Patch;
  SkinMeasures Out;
};
} // namespace

SkinMeasures measureSkin(
  const ContourStack& stack, const SkinGrid& grid, const SkinSurface& surface)
{
  return Meter(stack, grid, surface).run();
}
} // namespace bsr
