#pragma once

#include "Mesh/TriangleSurface.h"

namespace bsr
{
/// What a vertex of a boundary is for the function along its boundary, and for the surface.
enum class BoundaryNode : std::uint8_t
{
  None,
  Minimum,     ///< lowest of all around it
  Maximum,     ///< highest of all around it
  LowerSaddle, ///< lowest along the boundary, but the surface falls inwards
  UpperSaddle  ///< highest along the boundary, but the surface rises inwards
};

/// A saddle and the extremum it may be cancelled with.
struct PersistencePair
{
  double Persistence = 0.0; ///< difference of the function
  Index Saddle = -1;        ///< place in MorseGradient::Saddles
  bool Upper = false;       ///< with a maximum, not a minimum
};

/**
 * The discrete gradient of a function on the vertices of a surface: every vertex points down an
 * edge, every triangle up across an edge, no edge serves twice. What is left over is critical:
 * vertices without way down (minima), triangles without way up (maxima), edges that serve nobody
 * (saddles). Paths down run along edges, paths up cross edges; an edge serves one kind only, so
 * paths of different kinds never cross, and paths of one kind that meet go on as one.
 *
 * Built vertex by vertex from the lower star (Robins, Wood and Sheppard 2011), down the steepest
 * edge: critical cells are exactly the critical points of the piecewise linear function (Banchoff
 * 1970), equal values are told apart by the vertices' order (simulation of simplicity), and a
 * saddle of order k becomes k simple saddles. On boundaries the flow runs along the boundary, as
 * for a function continued by reflection; so boundaries are lines of the flow.
 */
struct MorseGradient
{
  std::vector<double> Value;  ///< of the function, per vertex
  std::vector<Index> Down;    ///< per vertex: half-edge down, -1: minimum (or virtual)
  std::vector<Index> Up;      ///< per triangle: half-edge crossed upwards, -1: maximum (or hole)
  std::vector<Index> Saddles; ///< half-edge of each saddle, from the higher vertex if inside
  std::vector<BoundaryNode> Boundary; ///< per vertex
  std::vector<Index> UpperEdge; ///< per vertex: UpperSaddle: half-edge on the boundary that is it

  /// Is a before b in the order of values?
  bool lower(Index a, Index b) const
  {
    return this->Value[a] != this->Value[b] ? this->Value[a] < this->Value[b] : a < b;
  }
  /// The minimum reached from a vertex.
  Index descend(const TriangleSurface& s, Index vertex) const;
  /// The triangle of the maximum reached from a triangle.
  Index ascend(const TriangleSurface& s, Index triangle) const;
  /// The highest vertex of a triangle.
  Index top(const TriangleSurface& s, Index triangle) const;
  Index minima(const TriangleSurface& s) const;
  Index maxima(const TriangleSurface& s) const;
};

/// \pre `s` is compact; one value per vertex, those of virtual vertices are not read.
MorseGradient morseGradient(const TriangleSurface& s, std::vector<double> values);

/**
 * The pairs by which noise is cancelled, least persistence first (Edelsbrunner, Letscher and
 * Zomorodian 2002): each saddle inside that joins two basins with the higher of the two minima, or
 * that joins two hills with the lower of the two maxima. Extrema on boundaries stay.
 */
std::vector<PersistencePair> persistencePairs(const TriangleSurface& s, const MorseGradient& g);

/// Cancels the first `count` pairs by turning the path between saddle and extremum around.
void cancelPairs(const TriangleSurface& s, const std::vector<PersistencePair>& pairs,
  std::size_t count, MorseGradient& g);

/**
 * Removes ripples along boundaries: pairs of a minimum and a maximum of the function along a
 * boundary that differ by less than `persistence` are levelled. At least one pair stays.
 */
void smoothBoundaries(const TriangleSurface& s, double persistence, std::vector<double>& values);
} // namespace bsr
