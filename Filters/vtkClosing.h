/**
 * @class vtkClosing
 * @brief Closes a gray-value object in an image by a ball of any radius.
 *
 * The first stage from a CT volume to a B-spline model: the object is what lies at or above an iso
 * value (by default halfway between the two materials), of it the largest
 * component (connectivity 26). It is closed by a ball: dilated and then eroded. With a radius as
 * large as the object's lumen is wide, holes, pits and the lumen itself fill, and what is left is a
 * solid whose surface is the fiber's outer wall with caps over its open ends (Mosbach et al.,
 * section 3).
 *
 * The radius is in voxels (multiples of the smallest spacing); anisotropic spacing is honored: the
 * ball is round in world units. The time does not depend on the radius, as two exact Euclidean
 * distance transforms do the work, cropped to the object; nothing is clipped at the border of the
 * image.
 *
 * The automatic radius (AutoRadius) is where the volume of the closing stops rising steeply and
 * begins to creep: there the lumen has just filled (see closingRadius in
 * Core/Image/ClosingRadius.h). An object without a lumen, a branching one or a network gets the
 * smallest radius that makes it a ball, or leaves it the fewest holes; a warning says so.
 *
 * Point arrays of the output image:
 * - `Closed` (unsigned char): 1 in the closed object, 0 outside; voxel by voxel the dilation and
 * erosion by {distance of voxel centers <= radius}.
 * - `SignedDistance` (float, the active scalars): distance to the closed object's surface in
 * voxels, negative inside. It starts from the gray values' sub-voxel crossing of the iso value, so
 * that its zero level is smooth; it agrees with `Closed` within a voxel and has no stray bubbles.
 * Depths inside are exact; outside the value never exceeds the distance within the radius from the
 * object.
 *
 * Field data: `ClosingRadius` (voxels), `IsoValue`, `BettiNumbers` (components, tunnels, cavities
 * of `Closed`), `BettiNumbersBefore` (of the object), `BettiNumbersSurface` (of SignedDistance <
 * 0), `Components` (of the thresholded image), `VolumeRatio` (closed to object), `ClosingCurve`
 * (radius, relative volume; with AutoRadius), `ClosingNote` (string; what a person should know,
 * empty when all is well).
 *
 * The output has the input's extent, widened where the object comes within two voxels of the
 * border, so that the surface of the closed object is closed; origin, spacing and direction are the
 * input's.
 *
 * @warning Needs a point array of one component; for cell data apply the Cell Data to Point Data
 * filter.
 * @warning Works on the whole image at once, on every rank: about 20 bytes a voxel of the object's
 * box widened by the radius, plus 5 bytes a voxel of the output.
 * @sa vtkEDTClassify, vtkFlyingEdges3D, vtkImageOpenClose3D
 */
#ifndef vtkClosing_h
#define vtkClosing_h

#include "BSplineReconstructionFiltersModule.h"
#include "vtkImageAlgorithm.h"

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkClosing : public vtkImageAlgorithm
{
public:
  static vtkClosing* New();
  vtkTypeMacro(vtkClosing, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Gray value of the object's surface, used where AutoIsoValue is off. Default 0.
  vtkSetMacro(IsoValue, double);
  vtkGetMacro(IsoValue, double);
  ///@}

  ///@{
  /// Find the iso value: halfway between the gray values of the voxels deep
  /// inside the object and outside of it, from Otsu's threshold on: there a blurred edge lies.
  /// Default on.
  vtkSetMacro(AutoIsoValue, bool);
  vtkGetMacro(AutoIsoValue, bool);
  vtkBooleanMacro(AutoIsoValue, bool);
  ///@}

  ///@{
  /// Radius of the ball in voxels (multiples of the smallest spacing), any real number >= 0, used
  /// where AutoRadius is off. Below 1 nothing is closed. Default 5.
  vtkSetMacro(Radius, double);
  vtkGetMacro(Radius, double);
  ///@}

  ///@{
  /// Find the radius at which the lumen is just filled. Default on.
  vtkSetMacro(AutoRadius, bool);
  vtkGetMacro(AutoRadius, bool);
  vtkBooleanMacro(AutoRadius, bool);
  ///@}

  ///@{
  /// Keep only the largest component of the object before it is closed. Default on.
  vtkSetMacro(LargestComponent, bool);
  vtkGetMacro(LargestComponent, bool);
  vtkBooleanMacro(LargestComponent, bool);
  ///@}

protected:
  vtkClosing();
  ~vtkClosing() override = default;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  /// Fills the output; the return value of RequestData.
  int Close(vtkInformationVector** inputs, vtkImageData* output);

  vtkClosing(const vtkClosing&) = delete;
  void operator=(const vtkClosing&) = delete;

  double IsoValue = 0.0;
  bool AutoIsoValue = true;
  double Radius = 5.0;
  bool AutoRadius = true;
  bool LargestComponent = true;
};

#endif
