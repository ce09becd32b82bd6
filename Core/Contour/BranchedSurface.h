#pragma once

#include "Contour/BranchedNetwork.h"
#include "Contour/JunctionRows.h"
#include "Spline/SplineModel.h"

namespace bsr
{
struct BranchedOptions
{
  int OrderU = 3; ///< along the contours, 3 to 8
  int OrderV = 3; ///< from slice to slice, 3 to 5
  JunctionKind Kind = JunctionKind::Automatic;
  JunctionTangency Tangency = JunctionTangency::Space;
  bool PeriodicKnots = false; ///< along v, at open ends (section 7); else open uniform ones
  bool Interpolate = true;    ///< the contours are data; else they are control polygons
  EndCaps Caps = EndCaps::Inside;
  double CapHeight = 0.5;                      ///< in slice distances, above 0
  std::vector<std::array<bool, 2>> ClosedEnds; ///< see NetworkOptions
  std::vector<Index> Components;               ///< of the stack, only these; empty: all
  int PointsPerSection = 0;                    ///< columns of a contour; 0: as its shape needs
  double SectionTolerance = 0.1;               ///< then: deviation, in distances of its points
  double JunctionPosition = 0.0; ///< height of the crotch between branch (0) and stem (1); 0: auto
};

/// Where a patch comes from.
struct PatchOrigin
{
  Index Tube = -1;
  Index Cap = -1;       ///< 0 lower, 1 upper end of the tube; -1: the tube itself
  Index Component = -1; ///< of the stack
  int End = 0;          ///< nearer to the lower (0) or the upper (1) end of the tube
};

struct BranchedSurface
{
  SplineModel Model;
  std::vector<PatchOrigin> Origins;
  BranchedNetwork Network;
  std::vector<double> Jacobians; ///< patchJacobians
  int FoldedPatches = 0;
};

/**
 * The branched surface of a stack: for each tube one tensor-product surface over all its contours
 * and the inserted slices of its junctions, all with the same columns, so that together they are
 * one disjoint B-spline surface (paper 002) with knots of full multiplicity where the curves part.
 * It is cut into patches between crotches; sides that meet have equal control points.
 * Fails with InvalidParameter on options out of range, InvalidInput where no two closed contours
 * are linked.
 */
Result<BranchedSurface> makeBranchedSurface(
  const ContourStack& stack, const BranchedOptions& options, Monitor& monitor);

/// Control rows of a tube on an arc between corners, and their knots along v.
struct TubeArc
{
  int Column = 0;
  int Spans = 0;
  std::vector<ControlRow> Rows; ///< on clamped knots of the spans
};
struct TubeSurface
{
  std::vector<TubeArc> Arcs;
  std::vector<double> KnotsV; ///< clamped
  /// Knots along v at which it is cut into patches, both ends with it: about the inserted slices,
  /// where it bends most, and between so that no patch has many spans.
  std::vector<double> CutsV;
};

/// Rows at the ends of the tubes that junctions and caps insert.
struct InsertedRows
{
  std::vector<JunctionRows> Junctions;
  std::vector<std::array<CapRows, 2>> Caps; ///< of each tube
};

/// The tubes' control rows at their contours (periodic), by solving along u where data.
std::vector<std::vector<ControlRow>> sectionRows(
  const ContourStack& stack, const BranchedNetwork& net, const BranchedOptions& options);

/// How the rows of each junction and of the two ends of each tube are made.
struct RowChoices
{
  std::vector<RowOptions> Junctions;
  std::vector<std::array<RowOptions, 2>> Caps;
};

/// \param capHeight see BranchedOptions
InsertedRows insertRows(const ContourStack& stack, const BranchedNetwork& net,
  const std::vector<std::vector<ControlRow>>& sections, const RowChoices& choices,
  double capHeight);

/// Solves along v and puts all rows together.
/// \param fine short patches along v, where long ones fold or bend more than samples tell
TubeSurface makeTube(const BranchedNetwork& net, Index tube,
  const std::vector<ControlRow>& sections, const InsertedRows& inserted,
  const BranchedOptions& options, const RowOptions& rows, bool fine);

/// Patches of all tubes and caps with their neighbors.
BranchedSurface assemblePatches(const ContourStack& stack, const BranchedNetwork& net,
  const std::vector<TubeSurface>& tubes, const InsertedRows& inserted,
  const BranchedOptions& options);
} // namespace bsr
