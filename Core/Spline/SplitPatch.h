#pragma once

#include "Spline/TensorFit.h"

namespace bsr
{
/**
 * The same surface in blocks of at most `spans` polynomial pieces a side (knots are inserted where
 * blocks meet, which moves nothing), neighbors joined, shared control points equal bit for bit.
 * spans < 1: one patch.
 */
SplineModel splitPatch(const TensorShape& shape, const std::vector<Vec3>& control, int spans);

/// Turns a patch over: u runs the other way.
void flipPatch(TensorShape& shape, std::vector<Vec3>& control);

/// Exchanges u and v of every patch: turns a model inside out.
void transposePatches(SplineModel& model);

/// Appends a model's patches.
void appendModel(const SplineModel& part, SplineModel& whole);

/// On a grid of 25 x 25 points: neighboring normals turn by more than 90 degrees, or one vanishes.
bool patchFolded(const SplineModel& model, const SplinePatch& patch);
} // namespace bsr
