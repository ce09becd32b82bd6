#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace bsr
{
/// A point or vector in world units, unless said otherwise.
using Vec3 = Eigen::Vector3d;
using Vec2 = Eigen::Vector2d;
using Vec4 = Eigen::Vector4d;

/// Index of a vertex, face or patch; -1 means "none".
using Index = std::int32_t;
} // namespace bsr
