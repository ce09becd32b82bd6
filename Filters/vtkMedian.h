/**
 * @class vtkMedian
 * @brief Removes the noise of a volume by the median of a box of voxels.
 *
 * vtkImageMedian3D with what a person at the keyboard needs on top of it: an array name that is
 * left empty means the active scalars, and a missing array or an absurd box is one clear error
 * (the superclass reads through a null pointer).
 *
 * The output has the filtered array under the same name and type. Mosbach et al., section 1, use
 * the default box of 5 x 5 x 5 voxels before segmentation.
 *
 * @warning Walls thinner than half of the box vanish.
 *
 * @sa vtkClosing vtkImageMedian3D
 */
#ifndef vtkMedian_h
#define vtkMedian_h

#include "BSplineReconstructionFiltersModule.h" // For export macro
#include "vtkImageMedian3D.h"

class BSPLINERECONSTRUCTIONFILTERS_EXPORT vtkMedian : public vtkImageMedian3D
{
public:
  static vtkMedian* New();
  vtkTypeMacro(vtkMedian, vtkImageMedian3D);

  /// An empty name selects the active scalars.
  using Superclass::SetInputArrayToProcess;
  void SetInputArrayToProcess(
    int idx, int port, int connection, int fieldAssociation, const char* name) override;

protected:
  vtkMedian();
  ~vtkMedian() override = default;

  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  /// Fills the output; the return value of RequestData.
  int Filter(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs);

  vtkMedian(const vtkMedian&) = delete;
  void operator=(const vtkMedian&) = delete;
};

#endif
