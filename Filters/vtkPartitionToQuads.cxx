#include "vtkPartitionToQuads.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Layout/PartitionToQuads.h"

#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>

vtkStandardNewMacro(vtkPartitionToQuads);

namespace
{
/// The direction that a point's quad must face: its normal, turned over on the inner wall. None
/// without normals.
std::vector<bsr::Vec3> facingFrom(vtkPointSet* input)
{
  vtkDataArray* normals = input->GetPointData()->GetNormals();
  if (!normals)
  {
    return {};
  }
  vtkDataArray* side = input->GetPointData()->GetArray("Side");
  std::vector<bsr::Vec3> facing(static_cast<std::size_t>(normals->GetNumberOfTuples()));
  for (std::size_t i = 0; i < facing.size(); ++i)
  {
    const auto id = static_cast<vtkIdType>(i);
    normals->GetTuple(id, facing[i].data());
    if (side && side->GetComponent(id, 0) == 1.0)
    {
      facing[i] = -facing[i];
    }
    if (!facing[i].allFinite())
    {
      facing[i].setZero();
    }
  }
  return facing;
}

void attach(const bsr::Partition& p, vtkPointSet* output)
{
  const auto n = static_cast<vtkIdType>(p.QuadId.size());
  vtkNew<vtkIntArray> quad;
  quad->SetName("QuadId");
  quad->SetNumberOfTuples(n);
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  uv->SetNumberOfTuples(n);
  vtkNew<vtkDoubleArray> distance;
  distance->SetName("QuadDistance");
  distance->SetNumberOfTuples(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    quad->SetValue(i, p.QuadId[i]);
    uv->SetTypedTuple(i, p.UV[i].data());
    distance->SetValue(i, p.Distance[i]);
  }
  output->GetPointData()->AddArray(quad);
  output->GetPointData()->AddArray(uv);
  output->GetPointData()->AddArray(distance);
  bsr::addField(output->GetFieldData(), "QuadDistanceRMS", p.RMS);
  bsr::addField(output->GetFieldData(), "QuadDistanceMax", p.Max);
  bsr::addField(output->GetFieldData(), "EmptyQuads", static_cast<double>(p.EmptyQuads));
}

bsr::Result<bsr::Partition> partition(
  vtkPointSet* input, vtkPolyData* layout, bool matchNormals, bsr::Monitor& monitor)
{
  const auto points = bsr::pointsFrom(input->GetPoints());
  if (!points)
  {
    return points.status();
  }
  const auto quads = bsr::quadMeshFrom(layout);
  if (!quads)
  {
    return quads.status();
  }
  bsr::PartitionOptions options;
  if (matchNormals)
  {
    options.Facing = facingFrom(input);
  }
  return bsr::partitionToQuads(*points, *quads, options, monitor);
}
} // namespace

vtkPartitionToQuads::vtkPartitionToQuads()
{
  this->SetNumberOfInputPorts(2);
}

int vtkPartitionToQuads::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPointSet" : "vtkPolyData");
  return 1;
}

int vtkPartitionToQuads::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0]);
  vtkPolyData* layout = vtkPolyData::GetData(inputs[1]);
  vtkPointSet* output = vtkPointSet::GetData(outputs);
  if (!input || !layout)
  {
    vtkErrorMacro("Connect points to port 0 and a quad layout to port 1 (Quads).");
    return 0;
  }
  bsr::AlgorithmMonitor monitor(this);
  const auto result = partition(input, layout, this->MatchNormals, monitor);
  if (!result)
  {
    output->Initialize();
    return bsr::notDelivered(this, result.status());
  }
  output->ShallowCopy(input);
  attach(*result, output);
  return 1;
}

void vtkPartitionToQuads::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "MatchNormals: " << this->MatchNormals << "\n";
}
