#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Contour/SkinCap.h"
#include "Spline/TensorFit.h"

namespace bsr
{
enum class SkinParameters
{
  Relaxed,    ///< start from Chord, then every point moves to where the surface is nearest to it
  Chord,      ///< the data set's grid, chord lengths averaged across its lines (paper 004, 2.2)
  Centripetal ///< the same with square roots of chord lengths
};

struct SkinFitOptions
{
  SkinParameters Parameters = SkinParameters::Relaxed;
  int Degree = 3;
  /// Refined until neither the average error of eq. 13 (squared world units) nor the RMS distance
  /// (world units) exceeds this. 0: a thousandth of the sections' mean diameter.
  double Tolerance = 0.0;
  int ControlPointLimit = 4000;
  int CountU = 0; ///< control points along u (columns), 0: by refinement
  int CountV = 0;
  double Fairing = 1e-3; ///< see TensorSolver::solve, after relaxation
  /// RMS distance, in tolerances, at which a surface is not refined further; 0: never.
  double Hopeless = 0.0;
  double PointSpacing = 0.0; ///< of samples along the contours; 0: the contours' own
};

/// A sample of a contour (or of a cap) on the surface.
struct SkinSample
{
  TensorSample Sample;
  Vec2 Place;                  ///< in the grid
  Index Ring = -1;             ///< of the grid
  bool Cap = false;            ///< not measured, added to close a leg
  bool Bridge = false;         ///< a cap between legs
  bool Node = false;           ///< a node of the data set
  std::array<bool, 2> Fixed{}; ///< u, v stay
};

struct SkinSurface
{
  TensorShape Shape;
  std::vector<Vec3> Control; ///< u runs fastest
  std::vector<SkinSample> Samples;
  double TotalError = 0.0;   ///< eq. 12 over the data set
  double AverageError = 0.0; ///< eq. 13
  double Rms = 0.0;          ///< distance of the samples from the surface
  double Max = 0.0;
  bool Reached = false; ///< the tolerance
  int Folds = 0;        ///< countFolds
};

/// Neighboring samples, five a span, between which the normal turns by more than 90 degrees.
int countFolds(const SkinSurface& surface);

/// Fits one patch to the data set of a tree.
Result<SkinSurface> fitSkin(const SkinGrid& grid, const std::vector<CapPoint>& caps,
  const SkinFitOptions& options, Monitor& monitor);
} // namespace bsr
