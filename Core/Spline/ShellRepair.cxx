#include "Spline/ShellRepair.h"

#include "Common/Parallel.h"
#include "Spline/FoldCheck.h"

#include <algorithm>

namespace bsr
{
namespace
{
constexpr int Grid = 7; ///< samples along a side of a patch
/// A patch whose normals shrink this much against their mean is nearly folded.
constexpr double NearlyFolded = 2e-3;

/// The k-th of Grid x Grid places on a patch.
void placeOnGrid(FitPoint& p, int k)
{
  const int row = k / Grid;
  p.U = (k - row * Grid) / (Grid - 1.0);
  p.V = row / (Grid - 1.0);
}
} // namespace

ShellFaults::ShellFaults(
  const QuadComplex& complex, const PatchNet& net, const NetPoints* outer, double leastWall)
    : Complex(&complex), Net(&net), Outer(outer), LeastWall(leastWall)
{
  if (outer)
  {
    this->Gauge = std::make_shared<WallGauge>(net, *outer);
  }
}

void ShellFaults::look(const NetPoints& surface)
{
  this->Folded = 0;
  this->Score = 0.0;
  this->BadPatches.clear();
  const auto shapes = checkShapes(*this->Net, surface);
  for (Index f = 0; f < this->Net->patches(); ++f)
  {
    if (shapes[f].Folded || shapes[f].MinJacobian < NearlyFolded)
    {
      this->Folded += shapes[f].Folded;
      this->Score += shapes[f].Folded ? Severe : 1.0;
      this->BadPatches.push_back(f);
    }
  }
  if (!this->Gauge)
  {
    return;
  }
  this->Thin = thinPlaces(*this->Net, *this->Gauge, surface, this->LeastWall);
  for (const FitPoint& p : this->Thin)
  {
    this->Score += p.Robust > 1.0 ? Severe : 0.01;
    this->BadPatches.push_back(p.Patch);
  }
  this->Walls = foldedWalls(*this->Complex, *this->Net, *this->Outer, surface);
  for (const Index h : this->Walls)
  {
    this->Score += Severe;
    this->BadPatches.push_back(h / 4);
  }
  std::sort(this->BadPatches.begin(), this->BadPatches.end());
  this->BadPatches.erase(
    std::unique(this->BadPatches.begin(), this->BadPatches.end()), this->BadPatches.end());
}

bool ShellFaults::tooClose(const Vec3& place) const
{
  return this->Gauge && this->Gauge->at(place).Thickness < this->LeastWall;
}

std::vector<FitPoint> layoutPoints(const QuadComplex& complex, const std::vector<Vec3>& vertices)
{
  std::vector<FitPoint> points;
  for (Index f = 0; f < complex.faces(); ++f)
  {
    const auto& q = complex.quad(f);
    for (int k = 0; k < Grid * Grid; ++k)
    {
      FitPoint p;
      p.Patch = f;
      placeOnGrid(p, k);
      p.Position = (1 - p.V) * ((1 - p.U) * vertices[q[0]] + p.U * vertices[q[1]]) +
                   p.V * ((1 - p.U) * vertices[q[3]] + p.U * vertices[q[2]]);
      points.push_back(p);
    }
  }
  return points;
}

std::vector<FitPoint> ShellFaults::pointsBelow(double depth) const
{
  constexpr int Steps = 48;
  const NetEvaluator surface(*this->Net, *this->Outer);
  std::vector<FitPoint> points(static_cast<std::size_t>(this->Net->patches()) * Grid * Grid);
  parallelFor(0, static_cast<std::int64_t>(points.size()), 256,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        const auto k = static_cast<int>(i % (Grid * Grid));
        FitPoint& p = points[i];
        p.Patch = static_cast<Index>(i / (Grid * Grid));
        placeOnGrid(p, k);
        const SurfacePoint s = surface.at(p.Patch, p.U, p.V);
        p.Position = s.Point - 0.25 * depth * s.normal().normalized();
        for (int n = 0; n < Steps; ++n)
        {
          const WallGauge::Wall wall = this->Gauge->at(p.Position);
          const double missing = depth - wall.Thickness;
          if (missing <= 0.02 * depth)
          {
            break;
          }
          p.Position -= std::min(missing, 0.25 * depth) * wall.Normal;
        }
      }
    });
  return points;
}

std::vector<RimSample> alignedRim(
  const QuadComplex& complex, const PatchNet& net, const NetPoints& outer)
{
  const NetEvaluator surface(net, outer);
  std::vector<RimSample> samples;
  for (const auto& loop : complex.borderLoops())
  {
    for (const Index h : loop)
    {
      for (int s = 0; s < 8; ++s)
      {
        const double t = (s + 0.5) / 8.0;
        const double uv[4][2] = {{t, 0.0}, {1.0, t}, {1.0 - t, 1.0}, {0.0, 1.0 - t}};
        const SurfacePoint p = surface.at(h / 4, uv[h % 4][0], uv[h % 4][1]);
        const Vec3 along = h % 2 ? p.Dv : p.Du;
        samples.push_back({h, t, p.Point, along.normalized(), 1.0});
      }
    }
  }
  return samples;
}
} // namespace bsr
