#pragma once

#include "Contour/ContourStack.h"
#include "Contour/MatchArcs.h"

namespace bsr
{
/// Piece of a stem's contour that continues into one branch; counterclockwise.
struct JunctionArc
{
  Index Branch = -1;        ///< position in Junction::Branches
  double StemShare = 0.0;   ///< where it starts on the stem's contour (share of its length)
  double BranchShare = 0.0; ///< where it starts on the branch's contour
  ArcMatch Match;           ///< places along the branch's (First) and the stem's arc
  double StemLength = 1.0;  ///< of the arc on the stem's contour, share of its length
  double BranchLength = 1.0;
  int Spans = 0;
  int StemColumn = 0; ///< where it starts among the columns of the stem's tube
  int BranchColumn = 0;
  Index StartHub = -1;
  Index EndHub = -1;
};

/// A point where the loops of two or more branches meet: the crotch.
struct JunctionHub
{
  /// Arcs whose ends are the seams at this hub, counterclockwise around it.
  std::vector<Index> Seams;
  Vec2 Flat = Vec2::Zero(); ///< place in the stack's flat coordinates
};

/// Where one tube (the stem) goes over into several others (the branches), between two slices.
struct Junction
{
  Index Stem = -1;
  std::vector<Index> Branches;
  bool StemAbove = true;
  /// A hole takes part: contours run with the material on their left, so the turn about a crotch is
  /// clockwise. Branches of both kinds: a bay of the stem closes to a hole.
  bool Clockwise = false;
  bool Mixed = false;
  std::vector<JunctionArc> Arcs; ///< in their order along the stem's contour
  std::vector<JunctionHub> Hubs;
};

/// A run of linked contours without split or merge: a tube of `Columns` strips, numbered with the
/// material on the left.
struct Tube
{
  std::vector<Index> Contours;            ///< of the stack, upward
  std::array<Index, 2> Junctions{-1, -1}; ///< below and above
  std::array<bool, 2> Capped{false, false};
  bool Hole = false;
  int Columns = 0;
  /// Columns where its surface has corners at its lower and upper end: hubs, or corners of caps.
  std::array<std::vector<int>, 2> Corners;
  /// Share of arc length of each column's start, for each contour; not wrapped.
  std::vector<std::vector<double>> Shares;
};

/// What was left out, and why.
struct NetworkNote
{
  Index Source = -1; ///< polyline
  std::string Text;
};

struct BranchedNetwork
{
  std::vector<Tube> Tubes;
  std::vector<Junction> Junctions;
  std::vector<NetworkNote> Notes;
};

enum class EndCaps
{
  Inside, ///< only ends that lie inside the stack: the next slice is there, the contour is not
  All,
  None
};

struct NetworkOptions
{
  int Order = 3;                 ///< along u
  int PointsPerSection = 0;      ///< 0: as the contours' shape needs
  double SectionTolerance = 0.1; ///< then: of the median distance of their points
  double Refinement = 1.0;       ///< factor on the columns that tubes need
  /// Columns below a junction go where its match of contours wants them; false: only its corners.
  bool FollowMatch = true;
  EndCaps Caps = EndCaps::Inside;
  /// Lower and upper end of each contour of the stack, where it is the end of a tube; empty: Caps.
  std::vector<std::array<bool, 2>> ClosedEnds;
  std::vector<Index> Components; ///< of the stack, only these, sorted; empty: all
};

/**
 * Tubes and junctions of the closed contours of a stack, with the arrangement of control points
 * that paper 002 leaves to the reader: which part of a stem belongs to which branch, where
 * branches touch, how many columns each tube has (the columns of a stem are those of its branches
 * together) and where on the contours they lie. Links between several contours on both sides at
 * once are thinned out until each junction has one stem.
 */
Result<BranchedNetwork> makeNetwork(
  const ContourStack& stack, const NetworkOptions& options, Monitor& monitor);

/// A contour as a tube runs around it, material on the left: outer ones counterclockwise, holes
/// clockwise. In space, or in the flat coordinates (z = 0).
ArcCurve tubeCurve(const Contour& contour, bool flat = false);

/// Arcs, seams and hubs of a junction from its contours (columns are not assigned yet).
void arrangeJunction(const ContourStack& stack, const std::vector<Tube>& tubes, Junction& junction);

/// Columns of all tubes, arcs and corners.
void assignColumns(const ContourStack& stack, const NetworkOptions& options, BranchedNetwork& net);

/// Number of columns that a contour needs so that the periodic curve of that order through points
/// on it stays within a tolerance.
int columnsNeeded(const Contour& contour, int order, double tolerance);
} // namespace bsr
