#pragma once

#include "Spline/ShellFit.h"
#include "Spline/WallThickness.h"

#include <memory>

namespace bsr
{
/// Finds what must not be in a shell: folds, places too near to the outer shell, folded walls.
class ShellFaults
{
public:
  /// One fault that must not be delivered counts this much; lesser ones 1.
  static constexpr double Severe = 1000.0;

  /// `outer`: none for the outer shell itself.
  ShellFaults(
    const QuadComplex& complex, const PatchNet& net, const NetPoints* outer, double leastWall);

  void look(const NetPoints& surface);
  double score() const { return this->Score; }
  bool tooClose(const Vec3& place) const;
  /// Points that left the outer shell, 7 x 7 a patch, along the gradient of the distance to it
  /// until they were `depth` away: in narrow corners they move out along the middle.
  std::vector<FitPoint> pointsBelow(double depth) const;

  int Folded = 0;
  std::vector<Index> BadPatches; ///< folded, nearly so, with a folded wall or too thin
  std::vector<FitPoint> Thin;    ///< places with too little wall and where they should be
  std::vector<Index> Walls;      ///< border half-edges with a folded wall

private:
  const QuadComplex* Complex;
  const PatchNet* Net;
  const NetPoints* Outer;
  double LeastWall;
  double Score = 0.0;
  std::shared_ptr<const WallGauge> Gauge;
};

/// Points of the layout's bilinear quads, 7 x 7 each.
std::vector<FitPoint> layoutPoints(const QuadComplex& complex, const std::vector<Vec3>& vertices);

/// Rim samples that hold a shell's border beside the given one: equal parameters along the rim.
std::vector<RimSample> alignedRim(
  const QuadComplex& complex, const PatchNet& net, const NetPoints& outer);
} // namespace bsr
