#include "vtkEDTClassify.h"

#include "Adapters/BSRClosedImageAdapter.h"
#include "Adapters/BSRImageAdapter.h"
#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRWholeInputs.h"
#include "Image/FiberSides.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

vtkStandardNewMacro(vtkEDTClassify);

namespace
{
bsr::Result<bsr::FiberSides> classify(vtkPolyData* surface, vtkImageData* image,
  const bsr::FiberSidesOptions& options, bsr::Monitor& monitor)
{
  auto mesh = bsr::triangleMeshFrom(surface);
  if (!mesh)
  {
    return mesh.status();
  }
  const auto object = bsr::closedObjectFrom(image);
  if (!object)
  {
    return object.status();
  }
  bsr::toVoxels(image, mesh->Points);
  return bsr::classifySides(*mesh, *object, options, monitor);
}

/// One tuple (center, direction, radius) in world units for each open end of the lumen.
void attachMouths(
  const std::vector<bsr::LumenMouth>& mouths, vtkImageData* image, vtkFieldData* field)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName("LumenMouths");
  array->SetNumberOfComponents(7);
  const double* const h = image->GetSpacing();
  const double unit = std::min({h[0], h[1], h[2]});
  for (const bsr::LumenMouth& m : mouths)
  {
    const bsr::Vec3 step = m.Direction.cwiseQuotient(bsr::Vec3(h[0], h[1], h[2]));
    std::vector<bsr::Vec3> ends{m.Center, m.Center + step};
    bsr::fromVoxels(image, ends);
    const bsr::Vec3 direction = (ends[1] - ends[0]).normalized();
    const bsr::Vec3& c = ends[0];
    const double tuple[7] = {
      c.x(), c.y(), c.z(), direction.x(), direction.y(), direction.z(), m.Radius * unit};
    array->InsertNextTuple(tuple);
  }
  field->AddArray(array);
}

void attach(const bsr::FiberSides& sides, vtkPolyData* output)
{
  const auto n = static_cast<vtkIdType>(sides.Side.size());
  vtkNew<vtkFloatArray> depth;
  depth->SetName("Depth");
  depth->SetNumberOfTuples(n);
  std::copy(sides.Depth.begin(), sides.Depth.end(), depth->GetPointer(0));
  vtkNew<vtkUnsignedCharArray> side;
  side->SetName("Side");
  side->SetNumberOfTuples(n);
  std::copy(sides.Side.begin(), sides.Side.end(), side->GetPointer(0));
  output->GetPointData()->AddArray(depth);
  output->GetPointData()->AddArray(side);
  output->GetPointData()->SetActiveScalars("Side");
  bsr::addField(output->GetFieldData(), "Lumen", sides.Lumen ? 1.0 : 0.0);
  bsr::addField(output->GetFieldData(), "LumenRadius", sides.LumenRadius);
  bsr::addField(output->GetFieldData(), "PoreRadius", sides.PoreRadius);
  bsr::addField(output->GetFieldData(), "DepthThreshold", sides.DepthThreshold);
}
} // namespace

vtkEDTClassify::vtkEDTClassify()
{
  this->SetNumberOfInputPorts(2);
}

int vtkEDTClassify::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPolyData" : "vtkImageData");
  return 1;
}

int vtkEDTClassify::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Superclass::RequestUpdateExtent(request, inputs, outputs);
  bsr::requestWholeExtent(inputs[1]->GetInformationObject(0), outputs);
  return 1;
}

int vtkEDTClassify::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkPolyData* surface = vtkPolyData::GetData(inputs[0]);
  vtkImageData* image = vtkImageData::GetData(inputs[1]);
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  bsr::FiberSidesOptions options;
  options.ByDepth = this->Method == DEPTH;
  options.DepthThreshold = this->DepthThreshold;
  options.AutoDepthThreshold = this->AutoDepthThreshold;
  options.PoreRadius = this->PoreRadius;
  bsr::AlgorithmMonitor monitor(this);
  const auto sides = classify(surface, image, options, monitor);
  if (!sides)
  {
    output->Initialize();
    return bsr::notDelivered(this, sides.status());
  }
  output->ShallowCopy(surface);
  attach(*sides, output);
  attachMouths(sides->Mouths, image, output->GetFieldData());
  return 1;
}

void vtkEDTClassify::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "DepthThreshold: " << this->DepthThreshold << "\n";
  os << indent << "AutoDepthThreshold: " << this->AutoDepthThreshold << "\n";
  os << indent << "PoreRadius: " << this->PoreRadius << "\n";
}
