#ifndef BSRContourAdapter_h
#define BSRContourAdapter_h

#include "Common/Status.h"
#include "Contour/ContourStack.h"

#include <string>

class vtkPolyData;

namespace bsr
{
/// Polylines with the two manual overrides of StackOptions (empty where not asked for).
struct ContourInput
{
  std::vector<Polyline> Lines;
  std::vector<int> SliceOf;
  std::vector<int> ComponentOf;
};

/**
 * The contours of a data set: its polylines and polygons. Cells of lines that end at the same place
 * as exactly one other (loose segments of Slice and Contour, open pieces) are joined, as long as
 * they have equal values in the override arrays. Vertices are ignored. Fails with InvalidInput on a
 * missing data set, an override array that is not there, or coordinates that are not finite.
 */
Result<ContourInput> contoursFrom(
  vtkPolyData* data, const std::string& sliceArray = "", const std::string& componentArray = "");

/**
 * The stack for the eye and for scripts. `contours` (may be null): oriented polylines with the cell
 * arrays Slice, SlicePosition, Closed (UInt8), Level, Inside, Component, Branch, LinksBelow,
 * LinksAbove, Source (Int32 unless said; Inside is the cell of the enclosing contour or -1, Source
 * the polyline of the input) and the field arrays ContourLinks (Int32, L x 2: lower, upper cell),
 * LinkOverlap (Float64, L), DroppedContours (Int32), DroppedReasons (strings). `graph` (may be
 * null): a line from center to center for each link, a vertex for each contour; point arrays
 * Contour, Slice, Component, Branch, LinksBelow, LinksAbove.
 */
void stackTo(const ContourStack& stack, vtkPolyData* contours, vtkPolyData* graph);
} // namespace bsr

#endif
