#pragma once

#include "Contour/BranchedNetwork.h"
#include "Contour/UniformSpline.h"

namespace bsr
{
/// How the sheets meet at a junction (paper 002).
enum class JunctionKind
{
  Automatic,    ///< SharedEdge where the crotch lies in the middle of the stem, else Asymmetric
  Superimposed, ///< section 5.1: the last sections of the branches superimposed; C0
  SharedEdge,   ///< section 5.2: the branches' inserted slices share an edge, open about its middle
  Asymmetric    ///< section 6: they open about any point of the line between the branches
};

/// Where the tangent planes of SharedEdge and Asymmetric agree.
enum class JunctionTangency
{
  Space,    ///< in space
  Parameter ///< as published: only along the parameter lines; creased at the crotch
};

struct RowOptions
{
  int OrderU = 3;
  int OrderV = 3;
  JunctionKind Kind = JunctionKind::Automatic;
  JunctionTangency Tangency = JunctionTangency::Space;
  double Position = 0.0;  ///< of the crotch between branch (0) and stem (1); 0: automatic
  double StarSize = 1.0;  ///< factor on the size of the flat star about the crotch
  double BendSpans = 4.0; ///< columns over which a loop is bent into the star
  bool Follow = false;    ///< columns of a loop as close as the star's next to it
  int ExtraRows = 1;      ///< inserted slices on each side beyond the OrderV that a crotch needs
  int fixedRows() const { return this->OrderV + this->ExtraRows; }
};

/// Parameters, in knot spans from the end of a tube, of its inserted rows, and of the first row of
/// data after them.
struct RowSites
{
  std::vector<double> Rows;
  double Data = 0.0;
  double share(int row) const { return this->Rows[row] / this->Data; }
};
RowSites rowSites(const RowOptions& options);

/// Control rows of the contours next to an end; periodic.
struct EndRows
{
  const ControlRow* Last = nullptr;   ///< the last one
  const ControlRow* Before = nullptr; ///< the one before it, may be null
  double Distance = 1.0;              ///< between the two
};

/// Inserted rows of an arc, on clamped knots of its spans; row 0 lies at the tube's end.
struct ArcRows
{
  std::vector<ControlRow> Branch;
  std::vector<ControlRow> Stem;
};

/// The crotch in space, with its star of tangents: arm k of 4 m points along
/// cos(pi k / 2 m) A + sin(pi k / 2 m) B; arms 0, 4, ... are the seams of the stem.
struct HubStar
{
  Vec3 Center;
  Vec3 A;
  Vec3 B;
  JunctionKind Kind = JunctionKind::SharedEdge;
};

struct JunctionRows
{
  std::vector<ArcRows> Arcs;
  std::vector<HubStar> Hubs;
  double Reach = 0.0; ///< mean length from the last row of data of a tube to its end
};

/**
 * The inserted slices of a junction. They leave the crotch horizontally and arrive at the given
 * rows; the row at the end is common to branch and stem. In Space tangency the control points
 * obey, exactly: rows +1 and -1 beside each side are symmetric about it (no kink), the first span
 * of each side that ends at a crotch is straight, and the control points about a crotch form an
 * affinely regular star. Then alpha(t) = 2 cos(2 pi / n) (1 - t)^degree makes the tangent planes
 * agree everywhere, at the crotch too (n sides there); this holds for all orders.
 * \param branches, stem rows at the ends of the tubes
 * \param gap distance of the two slices along the axis
 */
JunctionRows makeJunctionRows(const ContourStack& stack, const BranchedNetwork& net,
  const Junction& junction, const std::vector<EndRows>& branches, const EndRows& stem,
  const RowOptions& options);

/// Inserted rows of a capped end and the net of the cap, over four arcs between its corners.
struct CapRows
{
  std::vector<std::vector<ControlRow>> Arcs; ///< [arc][row]
  std::vector<ControlRow> Net; ///< rows along the second arc, columns along the first one
  double Reach = 0.0;
};
/// \param tip height of the cap, as a vector along the axis
CapRows makeCapRows(
  const EndRows& end, const std::vector<int>& corners, const Vec3& tip, const RowOptions& options);

/// Control points of the four (or n) sectors next to a star's arms: W_k between arms k and k + 1.
std::vector<Vec3> starSectors(const Vec3& center, const std::vector<Vec3>& arms);
} // namespace bsr
