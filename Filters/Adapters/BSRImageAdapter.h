#ifndef BSRImageAdapter_h
#define BSRImageAdapter_h

#include "Common/Status.h"
#include "Image/ImageView.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <string>

class vtkInformation;

namespace bsr
{
/// The point array of one component that a filter is to work on: `chosen` (what
/// GetInputArrayToProcess gave, may be null). Cell arrays, missing arrays and several components
/// are errors that name the cure.
Result<vtkDataArray*> imageScalars(vtkImageData* image, vtkDataArray* chosen, int association);

/// True if an algorithm's input array information names no array (as ParaView leaves it for a
/// source that has not run yet): the active scalars are meant then.
bool namesNoArray(vtkInformation* array);

/// The voxels of an image as Core sees them; `values` is a point array of type T.
template <class T>
ImageView<T> imageView(vtkImageData* image, T* values)
{
  ImageView<T> view;
  view.Data = values;
  for (int a = 0; a < 3; ++a)
  {
    view.Dims[a] = image->GetDimensions()[a];
    view.Spacing[a] = image->GetSpacing()[a];
  }
  return view;
}

/// Makes `out` an image of the voxels `extent` (indices relative to the first voxel of `like`),
/// with origin, spacing and direction of `like` and no arrays.
void imageGeometry(vtkImageData* like, const Box& extent, vtkImageData* out);

/// Hands the memory of a volume to a new VTK array, without a copy.
template <class Array, class T>
vtkSmartPointer<Array> imageArray(Volume<T>& volume, const char* name)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetArray(volume.Data.release(), volume.Extent.volume(), 0,
    vtkAOSDataArrayTemplate<T>::VTK_DATA_ARRAY_DELETE);
  return array;
}
} // namespace bsr

#endif
