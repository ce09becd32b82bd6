#pragma once

#include "Mesh/PointTree.h"
#include "Spline/FitPoints.h"

namespace bsr
{
/// Measures how far below the outer shell a place lies (nearest of 13 x 13 samples a patch).
class WallGauge
{
public:
  WallGauge(const PatchNet& net, const NetPoints& outer);

  struct Wall
  {
    double Thickness = 0.0; ///< distance to the outer shell, negative outside of it
    double Height = 0.0;    ///< its part along the outer normal
    Vec3 Normal = Vec3::Zero();
  };
  Wall at(const Vec3& place) const;

private:
  std::vector<SurfacePoint> Outside;
  PointTree Tree;
};

/// Smallest distance between samples of the two shells, negative where a sample of the inner shell
/// lies outside the outer one.
double minimumWall(const PatchNet& net, const WallGauge& outer, const NetPoints& inner);

/// Median of the positive thicknesses at the points; 0 without any.
double medianWall(const WallGauge& outer, const std::vector<FitPoint>& points);

/// Places of the inner shell with less wall than `least`, with targets deep enough inside; their
/// factor Robust is 2 where the shells cross, 1 elsewhere.
std::vector<FitPoint> thinPlaces(
  const PatchNet& net, const WallGauge& outer, const NetPoints& inner, double least);

/// Border half-edges whose ruled wall between the two shells folds (25 x 25 normals).
std::vector<Index> foldedWalls(
  const QuadComplex& complex, const PatchNet& net, const NetPoints& outer, const NetPoints& inner);
} // namespace bsr
