#pragma once

#include "Common/Monitor.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
/// Axes of a triangle: X along its first edge, Y to its left.
struct FaceFrame
{
  Vec3 X;
  Vec3 Y;
};
FaceFrame faceFrame(const TriangleSurface& s, Index face);

/**
 * Second fundamental form (a, b, c: a x^2 + 2 b x y + c y^2) of each triangle with `inside`, in its
 * frame, from the differences of its vertex normals (Rusinkiewicz 2004); zero for the others, and
 * incomplete once cancelled.
 */
std::vector<Vec3> faceCurvature(
  const TriangleSurface& s, const std::vector<std::uint8_t>& inside, Monitor& monitor);
} // namespace bsr
