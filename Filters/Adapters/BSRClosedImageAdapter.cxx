#include "Adapters/BSRClosedImageAdapter.h"

#include "Adapters/BSRImageAdapter.h"

#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

namespace bsr
{
Result<ClosedObject> closedObjectFrom(vtkImageData* image)
{
  if (!image || image->GetNumberOfPoints() == 0)
  {
    return Status::invalidInput(
      "The closed image is empty. Connect the output of the Closing filter as Closed Image.");
  }
  auto* closed =
    vtkUnsignedCharArray::SafeDownCast(image->GetPointData()->GetAbstractArray("Closed"));
  auto* distance =
    vtkFloatArray::SafeDownCast(image->GetPointData()->GetAbstractArray("SignedDistance"));
  if (!closed || !distance || closed->GetNumberOfComponents() != 1 ||
      distance->GetNumberOfComponents() != 1)
  {
    return Status::invalidInput("The closed image lacks the point arrays Closed (unsigned char) "
                                "and SignedDistance (float). Connect the output of the Closing "
                                "filter as Closed Image.");
  }
  ClosedObject object;
  object.Mask = imageView<const std::uint8_t>(image, closed->GetPointer(0));
  object.SignedDistance = imageView<const float>(image, distance->GetPointer(0));
  return object;
}

void toVoxels(vtkImageData* image, std::vector<Vec3>& points)
{
  const int* const extent = image->GetExtent();
  const Vec3 first(extent[0], extent[2], extent[4]);
  for (Vec3& p : points)
  {
    Vec3 index;
    image->TransformPhysicalPointToContinuousIndex(p.data(), index.data());
    p = index - first;
  }
}

void fromVoxels(vtkImageData* image, std::vector<Vec3>& points)
{
  const int* const extent = image->GetExtent();
  const Vec3 first(extent[0], extent[2], extent[4]);
  for (Vec3& p : points)
  {
    const Vec3 index = p + first;
    image->TransformContinuousIndexToPhysicalPoint(index.data(), p.data());
  }
}
} // namespace bsr
