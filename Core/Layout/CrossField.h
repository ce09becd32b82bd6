#pragma once

#include "Common/Monitor.h"
#include "Mesh/TriangleSurface.h"

namespace bsr
{
/**
 * A cross (four directions, 90 degrees apart) on each triangle of a part of a surface.
 * Angles are measured in the triangle from its first edge, counter-clockwise.
 */
struct CrossField
{
  std::vector<std::uint8_t> Inside; ///< per triangle: belongs to the domain
  std::vector<double> Angle;        ///< per triangle
};

/// Direction of half-edge h in its own triangle, measured as the angles of a field are.
double edgeAngle(const TriangleSurface& s, Index h);

struct CrossFieldOptions
{
  double Curvature = 0.3; ///< pull towards principal directions, relative to smoothness
  double Size = 1.0;      ///< length that tells bent from flat: the side of a quad
  int Rounds = 30;        ///< of diffusion and normalization
};

/**
 * The smoothest cross field that follows creases and the border of the domain exactly and
 * principal curvature directions where they are distinct: diffusion with normalization
 * (Viertel and Osting 2019) of the complex fourth power (Knoeppel et al. 2013), started from the
 * globally optimal solution of one linear system. `s` should have triangles of even size.
 * Empty angles: the solver failed or was cancelled.
 */
CrossField crossField(const TriangleSurface& s, std::vector<std::uint8_t> inside,
  const CrossFieldOptions& options, Monitor& monitor);
} // namespace bsr
