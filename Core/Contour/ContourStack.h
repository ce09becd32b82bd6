#pragma once

#include "Common/Monitor.h"
#include "Common/Status.h"
#include "Contour/PlanarCurve.h"

#include <string>

namespace bsr
{
/// A polyline as it comes: closed ones may repeat their first point.
struct Polyline
{
  std::vector<Vec3> Points;
  bool Closed = false; ///< also found where the first point is repeated
};

struct StackOptions
{
  /// Contours whose planes are at most this far apart (world units) are one slice; 0: a twentieth
  /// of the typical distance of slices.
  double PlaneTolerance = 0.0;
  /// Closed contours are linked to the next slice's where they share this part of the smaller one's
  /// area.
  double MinimumOverlap = 0.1;
  /// Contours left without a partner are linked to the nearest such one within this many mean
  /// diameters of the two (gap between the curves); 0: never.
  double MatchDistance = 0.5;
  /// Slices further apart than this many typical distances are not linked.
  double MaximumGap = 10.0;
  /// Contours of fewer distinct points, or with less than this share of the median length, are
  /// specks: dropped, and reported.
  int MinimumPoints = 4;
  double SpeckShare = 0.01;
  /// Manual override, one value a polyline or empty: contours with the same slice number are one
  /// slice (any order of numbers; the planes decide the order).
  std::vector<int> SliceOf;
  /// Manual override, one value a polyline or empty: only contours with the same value are linked,
  /// and always so, overlapping or not, to the one they overlap most, else to the nearest.
  /// Negative: automatic. -2: leave this contour out.
  std::vector<int> ComponentOf;
};

/// A plane of the stack and the contours in it.
struct Slice
{
  Vec3 Origin = Vec3::Zero();
  Vec3 Normal = Vec3::UnitZ(); ///< along the axis of the stack, up to the tilt of this plane
  double Position = 0.0;       ///< of the origin along the axis
  std::vector<Index> Contours;
};

/// A cleaned contour.
struct Contour
{
  Index Source = -1; ///< the polyline
  Index Slice = -1;
  bool Closed = true;
  int Level = 0;        ///< closed contours around it in its slice; odd: a hole
  Index Parent = -1;    ///< the innermost of these
  Index Component = -1; ///< connected part of the graph, by first contour
  Index Branch = -1;    ///< part of a component without splits or merges
  /// Distinct points, counterclockwise about the axis (holes too); an open contour runs like those
  /// that it is linked to.
  std::vector<Vec3> Points;
  Curve2 Flat; ///< the points in the stack's common coordinates (ContourStack::flat)
  double Length = 0.0;
  double Area = 0.0;          ///< of Flat; 0 where open
  Vec2 Center = Vec2::Zero(); ///< of Flat
  std::vector<Index> Below;   ///< linked contours of the slice below
  std::vector<Index> Above;

  bool hole() const { return (this->Level % 2) != 0; }
  double diameter() const { return this->Length / 3.14159265358979323846; }
};

/// A link between contours of consecutive slices.
struct ContourLink
{
  Index Lower = -1;
  Index Upper = -1;
  double Overlap = 0.0; ///< common area over the smaller area
};

/// A polyline that is not in the stack, and why.
struct DroppedContour
{
  Index Source = -1;
  std::string Reason;
};

/**
 * Slices in the order of their planes with oriented contours and their graph: births (no contour
 * below), deaths (none above), splits (several above), merges (several below).
 */
struct ContourStack
{
  Vec3 Axis = Vec3::UnitZ(); ///< mean normal; the stack's direction
  Vec3 AxisX = Vec3::UnitX();
  Vec3 AxisY = Vec3::UnitY();
  Vec3 Origin = Vec3::Zero();
  std::vector<Slice> Slices;
  std::vector<Contour> Contours;
  std::vector<ContourLink> Links;
  std::vector<DroppedContour> Dropped;
  Index Components = 0;
  Index Branches = 0;

  /// A point in the common coordinates across the axis.
  Vec2 flat(const Vec3& p) const
  {
    return {this->AxisX.dot(p - this->Origin), this->AxisY.dot(p - this->Origin)};
  }
  /// Typical (median) distance of consecutive slices.
  double spacing() const;
  /// Mean of the contours' diameters (length / pi).
  double meanDiameter() const;
};

/**
 * Builds the stack: cleans the polylines (repeated points, specks), fits their planes (each contour
 * its own where they are tilted against each other), groups them into slices, finds nesting,
 * orders, orients and links. Fails with InvalidInput on no or too few points, coordinates that are
 * not finite, fewer than two slices, a contour that is not planar or crosses itself, two contours
 * that cross in one slice, and slices that cut each other; the message gives the polyline and the
 * slice.
 */
Result<ContourStack> buildStack(
  const std::vector<Polyline>& polylines, const StackOptions& options, Monitor& monitor);
} // namespace bsr
