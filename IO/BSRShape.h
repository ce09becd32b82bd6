#ifndef BSRShape_h
#define BSRShape_h

#include "Common/Status.h"
#include "Spline/SplineModel.h"

#include <TopoDS_Shape.hxx>

namespace bsr
{
/// What was built of a model.
struct CadShape
{
  TopoDS_Shape Shape;
  int Solids = 0;
  int OpenShells = 0;
};

/**
 * The boundary representation of a model: one B-spline face a patch, coordinates multiplied by
 * `scale`. With `sew`, patches share edges and vertices as their neighbor relations say, without
 * any tolerance: closed components become shells of solids, those within others voids; open
 * components become open shells. Where neighbors have different parametrizations, the faces are
 * sewn by distance instead. Without `sew`, a compound of separate faces.
 * Exceptions of OpenCASCADE become a status.
 * \pre the model is valid (checkModel).
 */
Result<CadShape> cadShape(const SplineModel& model, double scale, bool sew);
} // namespace bsr

#endif
