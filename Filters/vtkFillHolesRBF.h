/**
 * @class   vtkFillHolesRBF
 * @brief   close the gaps of a scan smoothly, at its own sampling density
 *
 * Range scans have gaps where the sensor did not see. Each is filled so that the surface goes on
 * with its tangent planes and curvature: radial basis functions (biharmonic splines, Carr et al.
 * 2001, "Reconstruction and representation of 3D objects with radial basis functions") are fitted
 * to the points and normals around the hole; the hole is triangulated with least area, refined to
 * the edge length of its surroundings and moved onto the zero set (Branch, Prieto and Boulanger,
 * section 6.1). vtkFillHolesFilter, in contrast, closes loops with flat large triangles.
 *
 * Input: a vtkPolyData of triangles, consistently oriented. Output: its points and triangles first,
 * bit for bit as they were, with their arrays; then the new ones. A new point has the point data of
 * the boundary point nearest to it, a new triangle the cell data 0.
 *
 * Cell array `Filled` (UInt8): 1 for new triangles. Field data: `FilledHoles`, `LeftHoles`,
 * `Seconds` and, a value a hole in the order found, `HoleSize` (largest diameter, world units),
 * `HoleEdges`, `HoleTriangles` (added), `HoleState` (0 filled, 1 filled by a membrane because the
 * implicit surface did not bridge it, 2 larger than MaximumHoleSize, 3 cut end, 4 no
 * triangulation).
 *
 * Boundaries that are meant stay: those larger than MaximumHoleSize and, with KeepCutEnds, the
 * planar ends of tubes. Where boundaries touch in a point they are told apart.
 *
 * @warning One error and no output for meshes with edges of three triangles, neighbors oriented
 * against each other, NaN, and data without triangles.
 *
 * @sa vtkScanToNURBS, vtkQuadRemesh
 */
#ifndef vtkFillHolesRBF_h
#define vtkFillHolesRBF_h

#include "BSplineReconstructionFiltersModule.h"
#include <vtkPolyDataAlgorithm.h>

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkFillHolesRBF : public vtkPolyDataAlgorithm
{
public:
  static vtkFillHolesRBF* New();
  vtkTypeMacro(vtkFillHolesRBF, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum SizeUnits
  {
    SHARE_OF_DIAGONAL = 0,
    WORLD_UNITS = 1
  };

  ///@{
  /**
   * Holes of a larger diameter stay. A share of the bounding box's diagonal (default, 0.25) or a
   * length in world units, by SizeUnit.
   */
  vtkSetMacro(MaximumHoleSize, double);
  vtkGetMacro(MaximumHoleSize, double);
  vtkSetClampMacro(SizeUnit, int, SHARE_OF_DIAGONAL, WORLD_UNITS);
  vtkGetMacro(SizeUnit, int);
  ///@}

  ///@{
  /**
   * Leave boundaries that lie in a plane (within 2 % of their size) from which the surface rises
   * by more than 60 degrees on average: the ends of a shaft or vessel. Default: on.
   */
  vtkSetMacro(KeepCutEnds, bool);
  vtkGetMacro(KeepCutEnds, bool);
  vtkBooleanMacro(KeepCutEnds, bool);
  ///@}

protected:
  vtkFillHolesRBF() = default;
  ~vtkFillHolesRBF() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double MaximumHoleSize = 0.25;
  int SizeUnit = SHARE_OF_DIAGONAL;
  bool KeepCutEnds = true;

private:
  vtkFillHolesRBF(const vtkFillHolesRBF&) = delete;
  void operator=(const vtkFillHolesRBF&) = delete;
};

#endif
