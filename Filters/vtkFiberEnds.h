/**
 * @class vtkFiberEnds
 * @brief Marks the open ends of a fiber on its closed surface.
 *
 * The closed surface of a hollow fiber covers each open end of the lumen by a cap, and the end face
 * of the wall lies around it like a ring. vtkFiberEnds marks cap and ring together, up to the outer
 * rim where the fiber's outer wall begins. Holes and slits of the wall are no ends, and a fiber
 * whose lumen is closed has none; what is uncertain is left unmarked.
 *
 * Where the lumen opens is known from vtkEDTClassify. The rim around each opening is the closed
 * surface's outermost convex edge, sought in all directions around the opening's axis, moved to
 * where the raw outer wall ends; the surface is cut along it.
 *
 * Ports: 0, `Input`: the closed triangle surface (SignedDistance of vtkClosing contoured at 0);
 * 1, `RawSurface`: the output of vtkEDTClassify (method Facing Void) for the same image:
 * its triangles, the point array `Side` (without it all is outer wall) and the field array
 * `LumenMouths` are used.
 *
 * Output port 0: the surface, its triangles split along the rims, with
 * - cell array `EndRegion` (Int32): 0 body, k the k-th open end; each end is a disc bounded by one
 *   loop of edges;
 * - field data `OpenEnds` (number of ends), `EndsNote` (string: which openings were left out, why).
 * Point and cell arrays of the input are not passed, as its points change.
 *
 * Output port 1 (`Rims`): the loop around each end as one closed polyline, with the cell array
 * `EndRegion`.
 *
 * @warning The rim must be seen from the opening's axis: an end face far from flat, or one whose
 * wall flares by more than 45 degrees just behind it, is not followed.
 * @sa vtkEDTClassify vtkClosing vtkQuadRemesh
 */
#ifndef vtkFiberEnds_h
#define vtkFiberEnds_h

#include "BSplineReconstructionFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkFiberEnds : public vtkPolyDataAlgorithm
{
public:
  static vtkFiberEnds* New();
  vtkTypeMacro(vtkFiberEnds, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkFiberEnds();
  ~vtkFiberEnds() override = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkFiberEnds(const vtkFiberEnds&) = delete;
  void operator=(const vtkFiberEnds&) = delete;
};

#endif
