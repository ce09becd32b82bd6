/**
 * @class vtkEDTClassify
 * @brief Tells the outer from the inner wall of a raw fiber surface, and both from what is neither.
 *
 * The raw isosurface of a hollow fiber shows its outer wall, its inner wall and much that is
 * neither: debris, pits, pores, cavities, the walls of holes. vtkEDTClassify labels every point.
 * Unlike vtkConnectivityFilter it does not need the walls to be separate: holes and open ends may
 * connect them. It needs the closed image that vtkClosing makes of the same raw image.
 *
 * Facing Void (the default): from the voxels of the void near and within the object rays are cast;
 * where few escape is the lumen, which is then followed to its open ends. Both walls are estimated
 * smoothly (half of a Gaussian neighborhood is void), and a point belongs to the wall within 1.7
 * voxels (outer) or 1.1 voxels (inner) of it, or to neither.
 *
 * Depth (Mosbach et al., section 3, the distance transform of the closed object): inner is what
 * lies deeper below the closed surface than DepthThreshold, all else is outer. Quick, but pits and
 * debris are never neither, and concave parts of the outer wall count as inner.
 *
 * Ports: 0, `Input`: the triangle surface of the raw image (points in world coordinates);
 * 1, `ClosedImage`: image with the point arrays `Closed` and `SignedDistance`.
 *
 * Point arrays of the output (the surface with its other arrays):
 * - `Depth` (float): voxels (multiples of the smallest spacing) below the closed surface,
 * sub-voxel; negative above it.
 * - `Side` (unsigned char): 0 outer wall, 1 inner wall, 255 neither.
 *
 * Field data: `Lumen` (1 when a lumen was found, else 0 and no point is 1), `LumenRadius` (median
 * radius of the inscribed balls, voxels), `PoreRadius` (voxels, the one used), `DepthThreshold`
 * (voxels, the one used by the method Depth), `LumenMouths` (Float64, 7 components, a tuple for
 * each open end of the lumen: center, direction outwards, radius, in world units; from Facing Void
 * only; vtkFiberEnds uses it).
 *
 * @warning The walls of Facing Void follow features wider than some 5 voxels; a lumen narrower than
 * 3.5 voxels in radius is not found.
 * @warning Works on the whole image at once: about 30 bytes a voxel of the closed object's box.
 * @sa vtkClosing vtkFiberEnds vtkBSplineG1Fit
 */
#ifndef vtkEDTClassify_h
#define vtkEDTClassify_h

#include "BSplineReconstructionFiltersModule.h"
#include "vtkPolyDataAlgorithm.h"

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkEDTClassify : public vtkPolyDataAlgorithm
{
public:
  static vtkEDTClassify* New();
  vtkTypeMacro(vtkEDTClassify, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Values of Method.
  enum Methods
  {
    FACING_VOID = 0,
    DEPTH = 1
  };

  ///@{
  /// How the sides are told apart. Default FACING_VOID.
  vtkSetClampMacro(Method, int, FACING_VOID, DEPTH);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /// Method Depth: depth in voxels from which a point is inner. Default 2.
  vtkSetMacro(DepthThreshold, double);
  vtkGetMacro(DepthThreshold, double);
  ///@}

  ///@{
  /// Method Depth: take the valley of the histogram of depths instead of DepthThreshold (which is
  /// used where there is no valley). Default off.
  vtkSetMacro(AutoDepthThreshold, bool);
  vtkGetMacro(AutoDepthThreshold, bool);
  vtkBooleanMacro(AutoDepthThreshold, bool);
  ///@}

  ///@{
  /// Method Facing Void: radius in voxels of a ball that does not pass through the holes of the
  /// wall, but through the lumen. Default 0: 0.65 of the lumen's median radius.
  vtkSetMacro(PoreRadius, double);
  vtkGetMacro(PoreRadius, double);
  ///@}

protected:
  vtkEDTClassify();
  ~vtkEDTClassify() override = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkEDTClassify(const vtkEDTClassify&) = delete;
  void operator=(const vtkEDTClassify&) = delete;

  int Method = FACING_VOID;
  double DepthThreshold = 2.0;
  bool AutoDepthThreshold = false;
  double PoreRadius = 0.0;
};

#endif
