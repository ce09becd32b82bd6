#pragma once

#include "Common/Types.h"

namespace bsr
{
/// What was mended at a face: bits of RepairReport::Faces.
enum FaceRepair : std::uint8_t
{
  RepairDegenerate = 1, ///< named a point twice: dropped
  RepairDuplicate = 2,  ///< had the corners of another face: dropped
  RepairTurned = 4,     ///< orientation reversed
  RepairMerged = 8,     ///< a corner was replaced by a coincident point
  RepairSplit = 16,     ///< a corner got a point of its own
  RepairCut = 32,       ///< lies at an edge of three or more faces that was cut
  RepairSpeck = 64      ///< belonged to a component too small to matter: dropped
};

/// What had to be mended to make surfaces of a triangle mesh.
struct RepairReport
{
  Index MergedPoints = 0;    ///< corners moved to a coincident point (only where that closes gaps)
  Index DegenerateFaces = 0; ///< faces that name a point twice, before or after merging
  Index DuplicateFaces = 0;  ///< faces with the corners of another
  Index TurnedFaces = 0;     ///< faces whose orientation was reversed
  Index SplitVertices = 0;   ///< vertices added because faces formed several fans
  Index CutEdges = 0;        ///< edges of three or more faces that were taken apart
  Index Specks = 0;          ///< components dropped: no area, or less than asked for
  Index BoundaryLoops = 0;   ///< of what is left
  std::vector<std::uint8_t> Faces; ///< per face of the input: bits of FaceRepair
};
} // namespace bsr
