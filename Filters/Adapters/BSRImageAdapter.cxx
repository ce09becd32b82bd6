#include "Adapters/BSRImageAdapter.h"

#include <vtkCellData.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkPointData.h>

namespace bsr
{
bool namesNoArray(vtkInformation* array)
{
  const char* name = array->Get(vtkDataObject::FIELD_NAME());
  return name && !*name;
}

Result<vtkDataArray*> imageScalars(vtkImageData* image, vtkDataArray* chosen, int association)
{
  if (!image || image->GetNumberOfPoints() == 0)
  {
    return Status::invalidInput("The input image is empty.");
  }
  const bool cells = association == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  if ((chosen && cells) || (!chosen && image->GetCellData()->GetNumberOfArrays() > 0 &&
                             image->GetPointData()->GetNumberOfArrays() == 0))
  {
    return Status::invalidInput(
      "The input array is cell data, but the values of the voxels must be "
      "point data; apply the Cell Data to Point Data filter first.");
  }
  if (!chosen)
  {
    return Status::invalidInput(
      image->GetPointData()->GetNumberOfArrays() > 0
        ? "The input array to process was not found among the point arrays; choose another."
        : "The input image has no point array.");
  }
  if (chosen->GetNumberOfComponents() != 1)
  {
    return Status::invalidInput(
      "The input array " + std::string(chosen->GetName() ? chosen->GetName() : "") + " has " +
      std::to_string(chosen->GetNumberOfComponents()) +
      " components, but gray values are needed; extract one (Calculator).");
  }
  if (chosen->GetNumberOfTuples() != image->GetNumberOfPoints())
  {
    return Status::invalidInput("The input array has " +
                                std::to_string(chosen->GetNumberOfTuples()) + " values for " +
                                std::to_string(image->GetNumberOfPoints()) + " voxels.");
  }
  return chosen;
}

void imageGeometry(vtkImageData* like, const Box& extent, vtkImageData* out)
{
  int e[6];
  for (int a = 0; a < 3; ++a)
  {
    e[2 * a] = like->GetExtent()[2 * a] + static_cast<int>(extent.Lo[a]);
    e[2 * a + 1] = e[2 * a] + static_cast<int>(extent.Size[a]) - 1;
  }
  out->Initialize();
  out->SetExtent(e);
  out->SetOrigin(like->GetOrigin());
  out->SetSpacing(like->GetSpacing());
  out->SetDirectionMatrix(like->GetDirectionMatrix());
}
} // namespace bsr
