#include "vtkPartitionToQuads.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRWholeInputs.h"
#include "Layout/GeodesicPartition.h"
#include "Layout/PartitionToQuads.h"
#include "Spline/SideNetwork.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

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
  if (!p.Boundary.empty())
  {
    vtkNew<vtkUnsignedCharArray> boundary;
    boundary->SetName("Boundary");
    boundary->SetNumberOfTuples(n);
    std::copy(p.Boundary.begin(), p.Boundary.end(), boundary->GetPointer(0));
    output->GetPointData()->AddArray(boundary);
  }
  bsr::addField(output->GetFieldData(), "QuadDistanceRMS", p.RMS);
  bsr::addField(output->GetFieldData(), "QuadDistanceMax", p.Max);
  bsr::addField(output->GetFieldData(), "EmptyQuads", static_cast<double>(p.EmptyQuads));
}

/// A polyline a side; cell arrays Side, Corners and SideQuads.
void networkTo(const std::vector<std::vector<bsr::Vec3>>& sides,
  const std::vector<std::array<bsr::Index, 2>>& ends,
  const std::vector<std::array<bsr::Index, 2>>& quads, vtkPolyData* out)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> number;
  number->SetName("Side");
  vtkNew<vtkIntArray> corners;
  corners->SetName("Corners");
  corners->SetNumberOfComponents(2);
  vtkNew<vtkIntArray> neighbors;
  neighbors->SetName("SideQuads");
  neighbors->SetNumberOfComponents(2);
  for (std::size_t s = 0; s < sides.size(); ++s)
  {
    if (sides[s].empty())
    {
      continue;
    }
    lines->InsertNextCell(static_cast<int>(sides[s].size()));
    for (const bsr::Vec3& p : sides[s])
    {
      lines->InsertCellPoint(points->InsertNextPoint(p.data()));
    }
    number->InsertNextValue(static_cast<int>(s));
    corners->InsertNextTypedTuple(ends[s].data());
    neighbors->InsertNextTypedTuple(quads[s].data());
  }
  out->SetPoints(points);
  out->SetLines(lines);
  out->GetCellData()->AddArray(number);
  out->GetCellData()->AddArray(corners);
  out->GetCellData()->AddArray(neighbors);
}

/// What both methods take.
struct Input
{
  std::vector<bsr::Vec3> Points;
  bsr::QuadMesh Quads;
  std::vector<bsr::Vec3> Facing;
};

bsr::Result<Input> inputFrom(vtkPointSet* input, vtkPolyData* layout, bool matchNormals)
{
  auto points = bsr::pointsFrom(input->GetPoints());
  if (!points)
  {
    return points.status();
  }
  auto quads = bsr::quadMeshFrom(layout);
  if (!quads)
  {
    return quads.status();
  }
  Input in;
  in.Points = std::move(*points);
  in.Quads = std::move(*quads);
  if (matchNormals)
  {
    in.Facing = facingFrom(input);
  }
  return in;
}

bsr::Status nearestQuad(const Input& in, bsr::Monitor& monitor, vtkPointSet* output)
{
  bsr::PartitionOptions options;
  options.Facing = in.Facing;
  const auto result = bsr::partitionToQuads(in.Points, in.Quads, options, monitor);
  if (result)
  {
    attach(*result, output);
  }
  return result.status();
}

bsr::Status geodesic(const Input& in, const bsr::TriangleMesh& mesh, int samples,
  bsr::Monitor& monitor, vtkPointSet* output, vtkPolyData* network)
{
  bsr::GeodesicOptions options;
  options.Facing = in.Facing;
  const auto result = bsr::partitionGeodesic(in.Points, mesh, in.Quads, options, monitor);
  if (!result)
  {
    return result.status();
  }
  attach(result->Points, output);
  networkTo(bsr::regularizeSides(result->Sides, samples, mesh), result->SideEnds, result->SideQuads,
    network);
  for (vtkFieldData* field : {output->GetFieldData(), network->GetFieldData()})
  {
    bsr::addField(field, "FailedQuads", result->FailedQuads);
    bsr::addField(field, "RoughSides", result->RoughSides);
    bsr::addField(field, "Detours", result->Detours);
    bsr::addField(field, "FoldedTriangles", result->FoldedTriangles);
    bsr::addField(field, "SideRatio", result->Stretch);
  }
  return bsr::Status::ok();
}
} // namespace

vtkPartitionToQuads::vtkPartitionToQuads()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(2);
}

int vtkPartitionToQuads::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPointSet" : "vtkPolyData");
  if (port == 2)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkPartitionToQuads::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkPointSet" : "vtkPolyData");
  return 1;
}

int vtkPartitionToQuads::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!vtkPolyData::GetData(outputs, 1))
  {
    vtkNew<vtkPolyData> network;
    outputs->GetInformationObject(1)->Set(vtkDataObject::DATA_OBJECT(), network);
  }
  vtkPointSet* input = vtkPointSet::GetData(inputs[0]);
  vtkPointSet* output = vtkPointSet::GetData(outputs, 0);
  if (input && (!output || !output->IsA(input->GetClassName())))
  {
    const auto fresh = vtk::TakeSmartPointer(input->NewInstance());
    outputs->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
  (void)request;
  return 1;
}

vtkPolyData* vtkPartitionToQuads::MeshOf(vtkPointSet* input, vtkInformationVector** inputs)
{
  vtkPolyData* surface = vtkPolyData::GetData(inputs[2]);
  surface = surface ? surface : vtkPolyData::SafeDownCast(input);
  return surface && surface->GetNumberOfPolys() > 0 ? surface : nullptr;
}

int vtkPartitionToQuads::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkPointSet* input = vtkPointSet::GetData(inputs[0]);
  vtkPolyData* layout = vtkPolyData::GetData(inputs[1]);
  vtkPointSet* output = vtkPointSet::GetData(outputs, 0);
  vtkPolyData* network = vtkPolyData::GetData(outputs, 1);
  network->Initialize();
  if (!input || !layout)
  {
    vtkErrorMacro("Connect points to port 0 and a quad layout to port 1 (Quads).");
    return 0;
  }
  const auto in = inputFrom(input, layout, this->MatchNormals);
  bsr::Status status = in.status();
  if (in)
  {
    bsr::AlgorithmMonitor monitor(this);
    output->ShallowCopy(input);
    vtkPolyData* surface = this->Method == GEODESIC ? this->MeshOf(input, inputs) : nullptr;
    if (surface)
    {
      const auto mesh = bsr::triangleMeshFrom(surface);
      status =
        mesh ? geodesic(*in, *mesh, this->SamplesPerSide, monitor, output, network) : mesh.status();
    }
    else
    {
      if (this->Method == GEODESIC)
      {
        vtkWarningMacro("There are no triangles for geodesics: points took their nearest quad. "
                        "Connect the mesh that the layout was made from to Surface.");
      }
      status = nearestQuad(*in, monitor, output);
    }
  }
  if (!status)
  {
    output->Initialize();
    network->Initialize();
    return bsr::notDelivered(this, status);
  }
  return 1;
}

void vtkPartitionToQuads::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "SamplesPerSide: " << this->SamplesPerSide << "\n";
  os << indent << "MatchNormals: " << this->MatchNormals << "\n";
}
