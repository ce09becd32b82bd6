#pragma once

#include "Contour/SkinMeasure.h"

namespace bsr
{
enum class SkinLayout
{
  Automatic,  ///< one patch where it meets the tolerance without a fold, else tubes of patches
  SinglePatch ///< one patch for all parts with an open base
};

struct ContourSkinOptions
{
  StackOptions Stack;
  SkinFitOptions Fit;
  SkinBase Base = SkinBase::Automatic;
  SkinLayout Layout = SkinLayout::Automatic;
  bool ConvexEnds = true; ///< legs end convexly within one slice distance; off: flat
  int CorePoints = 12;    ///< x of eq. 7: rows of a leg's core, 3 to 1000
  /// Polynomial pieces a side of a patch of the model: a surface of more is handed on in blocks
  /// that meet exactly. 0: one patch, or, where a patch is too crooked for coarse checks of it,
  /// the largest blocks that are not.
  int PatchSpans = 0;
};

/// One skin of the model.
struct SkinReport
{
  Index Component = -1;
  Shell Side = Shell::Outer;
  Index Contours = 0;
  bool Closed = false;     ///< no border
  bool SinglePatch = true; ///< one C2 tensor-product surface; otherwise tubes of G1 patches
  Index FirstPatch = 0;    ///< of the model, and the number of its patches
  Index Patches = 0;
  int Rows = 0; ///< of the data set
  int Columns = 0;
  int CountU = 0; ///< control points
  int CountV = 0;
  double Tolerance = 0.0; ///< that it was fitted to
  bool Reached = false;
  double TotalError = 0.0;   ///< eq. 12
  double AverageError = 0.0; ///< eq. 13: over the data points
  /// Total error over the number of control points: what paper 004's table 2 calls average error.
  double AverageErrorPerControlPoint = 0.0;
  double Rms = 0.0;
  double Max = 0.0;
  double PointSpacing = 0.0; ///< of the contours, median
  double NormalJump = 0.0;   ///< degrees, between patches
  int FoldedPatches = 0;
  SkinMeasures Measures;
};

struct ContourSkinResult
{
  SplineModel Model;
  std::vector<SkinReport> Skins;
  ContourStack Stack;
  std::vector<ContourNote> Notes; ///< what could not be done, contour by contour
};

/**
 * Surfaces over stacks of contours that split and merge: paper 004 (H. S. Kim et al., ICCS 2004),
 * its arrangement of points automated. Every connected part of the stack gets one bicubic (or
 * higher) C2 tensor-product surface, open at its base, closed convexly at the legs. A part whose
 * base is closed, too, that has legs on both sides or handles, or that one patch cannot follow,
 * gets tubes of patches and junctions between them with continuous tangent planes (fitNetwork).
 * Holes (contours inside contours) are skins of their own, with normals into the hole. Fails where
 * buildStack fails, on an option out of range, or where no part can be skinned (the message tells
 * why for the first contours).
 */
Result<ContourSkinResult> skinContours(
  const std::vector<Polyline>& polylines, const ContourSkinOptions& options, Monitor& monitor);
} // namespace bsr
