#pragma once

#include "Common/Status.h"
#include "Spline/SplineModel.h"

namespace bsr
{
/// Area and enclosed volume of a model.
struct ModelMeasure
{
  double Area = 0.0;
  double Volume = 0.0; ///< 0 where an open component encloses none
  bool Closed = true;  ///< every component is closed
};

/**
 * Volume by the divergence theorem on the patches, exact for polynomial patches (Gauss quadrature
 * of sufficient order), to some 1e-12 relative for rational ones; the area by the same points. A
 * closed component that lies within an odd number of others is a void and is subtracted.
 * \pre the model is valid (checkModel).
 */
ModelMeasure measureModel(const SplineModel& model);

/// How the components of a model lie within each other.
struct Nesting
{
  std::vector<Index> Component; ///< of each patch
  std::vector<char> Closed;     ///< of each component
  std::vector<int> Depth;       ///< number of closed components around each
  std::vector<Index> Parent;    ///< the innermost of these; -1: none
  std::vector<double> Volume;   ///< signed volume of each component (componentVolumes)
};

/// Finds which components enclose which by winding numbers about sampled polygons.
Nesting findNesting(const SplineModel& model);

/**
 * One flag a patch: turn it over so that the normals of closed components point out of the
 * material: outward on bodies, inward on voids. Open components are as orientationFlips has them.
 */
std::vector<char> outwardFlips(const SplineModel& model);

/// Signed volume of each component (patchComponents), by orientationFlips: positive where the
/// normals point outward. Meaningless for open components.
std::vector<double> componentVolumes(const SplineModel& model);
} // namespace bsr
