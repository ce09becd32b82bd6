#include "vtkScanToNURBS.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRStageRunner.h"
#include "vtkBSplineG1Fit.h"
#include "vtkFillHolesRBF.h"
#include "vtkPartitionToQuads.h"
#include "vtkQuadRemesh.h"
#include "vtkSurfaceFromPoints.h"

#include <vtkCell.h>
#include <vtkCleanPolyData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>
#include <vtkTriangle.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <cmath>
#include <vector>

vtkStandardNewMacro(vtkScanToNURBS);

namespace
{
constexpr double SmallestPart = 0.005; ///< of a scan's area

/// The parts of a surface of at least SmallestPart of its area; the number of parts left out.
int dropSpecks(vtkPolyData* surface, vtkPolyData* out)
{
  vtkNew<vtkPolyDataConnectivityFilter> parts;
  parts->SetInputData(surface);
  parts->SetExtractionModeToAllRegions();
  parts->ColorRegionsOn();
  parts->Update();
  const int count = parts->GetNumberOfExtractedRegions();
  out->ShallowCopy(surface);
  if (count < 2)
  {
    return 0;
  }
  vtkPolyData* colored = parts->GetOutput();
  vtkDataArray* part = colored->GetPointData()->GetArray("RegionId");
  std::vector<double> area(static_cast<std::size_t>(count), 0.0);
  double whole = 0.0;
  for (vtkIdType c = 0; c < colored->GetNumberOfCells(); ++c)
  {
    auto* triangle = vtkTriangle::SafeDownCast(colored->GetCell(c));
    const double size = triangle ? triangle->ComputeArea() : 0.0;
    const vtkIdType corner = colored->GetCell(c)->GetPointId(0);
    area[static_cast<std::size_t>(part->GetComponent(corner, 0))] += size;
    whole += size;
  }
  parts->SetExtractionModeToSpecifiedRegions();
  int dropped = count;
  for (int r = 0; r < count; ++r)
  {
    if (area[static_cast<std::size_t>(r)] >= SmallestPart * whole)
    {
      parts->AddSpecifiedRegion(r);
      --dropped;
    }
  }
  vtkNew<vtkCleanPolyData> used;
  used->SetInputConnection(parts->GetOutputPort());
  used->PointMergingOff();
  used->ConvertPolysToLinesOff(); // keeps triangles without area, which hold others together
  used->Update();
  if (dropped > 0 && used->GetOutput()->GetNumberOfPolys() > 0)
  {
    out->ShallowCopy(used->GetOutput());
    out->GetPointData()->RemoveArray("RegionId");
  }
  return dropped;
}

void copyFields(vtkDataObject* from, vtkFieldData* to, std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    if (vtkAbstractArray* a = from->GetFieldData()->GetAbstractArray(name))
    {
      to->AddArray(a);
    }
  }
}
} // namespace

vtkScanToNURBS::vtkScanToNURBS()
{
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(7);
}

int vtkScanToNURBS::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkScanToNURBS::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == REPORT ? "vtkTable" : "vtkPolyData");
  return 1;
}

vtkTypeBool vtkScanToNURBS::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    return this->RequestData(request, input, output);
  }
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkScanToNURBS::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkNew<vtkPolyData> scan;
  scan->ShallowCopy(vtkPolyData::GetData(inputs[0]));
  bsr::StageRunner stages(this, 116.0);
  const auto fail = [&](const std::string& message)
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject::GetData(outputs, port)->Initialize();
    }
    if (message.empty())
    {
      return 1; // cancelled
    }
    vtkErrorMacro(<< message);
    return 0;
  };
  const auto failed = [&]()
  {
    const std::string why = stages.message();
    return fail(why.empty() ? why : stages.stage() + ": " + why);
  };
  const auto checked = bsr::pointsFrom(scan->GetPoints());
  if (!checked || checked->size() < 8)
  {
    return fail(checked ? "The input has fewer than 8 points; check the filters above."
                        : checked.status().message());
  }

  vtkNew<vtkFillHolesRBF> fill;
  fill->SetMaximumHoleSize(this->MaximumHoleSize);
  const bool cloud = scan->GetNumberOfPolys() == 0 && scan->GetNumberOfStrips() == 0;
  vtkNew<vtkPolyData> points;
  vtkNew<vtkTriangleFilter> triangles;
  int specks = 0;
  if (cloud)
  {
    vtkNew<vtkSurfaceFromPoints> surface;
    surface->SetInputData(scan);
    surface->SetDimension(this->ReconstructionDimension);
    if (!stages.run("SurfaceFromPoints", surface, 15.0))
    {
      return failed();
    }
    points->ShallowCopy(surface->GetOutput(vtkSurfaceFromPoints::POINTS));
    fill->SetInputData(surface->GetOutput(vtkSurfaceFromPoints::SURFACE));
  }
  else
  {
    triangles->SetInputData(scan);
    triangles->PassVertsOff();
    triangles->PassLinesOff();
    if (!stages.run("Triangulate", triangles, 1.0))
    {
      return failed();
    }
    vtkNew<vtkPolyData> whole;
    specks = dropSpecks(triangles->GetOutput(), whole);
    fill->SetInputData(whole);
  }
  if (!stages.run("FillHolesRBF", fill, 15.0))
  {
    return failed();
  }

  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputConnection(fill->GetOutputPort());
  remesh->SetMethod(this->Method);
  remesh->SetNumberOfQuads(this->NumberOfQuads);
  remesh->SetSizing(this->Sizing);
  remesh->SetFeatureAngle(this->FeatureAngle);
  if (!stages.run("QuadRemesh", remesh, 25.0))
  {
    return failed();
  }

  vtkNew<vtkPartitionToQuads> partition;
  if (cloud)
  {
    partition->SetInputData(0, points);
  }
  else
  {
    partition->SetInputConnection(0, fill->GetOutputPort());
  }
  partition->SetInputConnection(1, remesh->GetOutputPort());
  partition->SetInputConnection(2, fill->GetOutputPort());
  partition->SetMethod(this->Partition);
  if (!stages.run("PartitionToQuads", partition, 25.0))
  {
    return failed();
  }

  const double diagonal = scan->GetLength();
  vtkNew<vtkBSplineG1Fit> fit;
  fit->SetInputConnection(0, partition->GetOutputPort(0));
  fit->SetInputConnection(1, remesh->GetOutputPort());
  fit->SetSegmentsPerSide(this->SegmentsPerSide);
  fit->SetRobustWeights(this->RobustWeights);
  fit->SetCreaseAngle(std::min(this->FeatureAngle, 180.0));
  fit->SetCorrelatedNoise(false);
  fit->SetRational(this->Optimizer > 0 || this->Tolerance > 0.0);
  fit->SetOptimizer(this->Optimizer);
  fit->SetTolerance(this->Tolerance * diagonal);
  fit->SetResolution(this->Resolution);
  if (!stages.run("BSplineG1Fit", fit, 33.0))
  {
    return failed();
  }

  for (int port = 0; port < 3; ++port)
  {
    vtkDataObject::GetData(outputs, port)->ShallowCopy(fit->GetOutputDataObject(port));
  }
  vtkPolyData::GetData(outputs, CLOSED_MESH)->ShallowCopy(fill->GetOutput());
  vtkPolyData::GetData(outputs, LAYOUT)->ShallowCopy(remesh->GetOutput());
  vtkPolyData::GetData(outputs, POINTS)->ShallowCopy(partition->GetOutputDataObject(0));
  vtkPolyData::GetData(outputs, NETWORK)->ShallowCopy(partition->GetOutputDataObject(1));

  vtkFieldData* report = vtkTable::GetData(outputs, REPORT)->GetFieldData();
  stages.addTimes(report);
  copyFields(fill->GetOutput(), report, {"FilledHoles", "LeftHoles", "HoleSize", "HoleState"});
  copyFields(remesh->GetOutput(), report, {"Irregular", "EulerCharacteristic"});
  copyFields(
    partition->GetOutputDataObject(0), report, {"FailedQuads", "RoughSides", "FoldedTriangles"});
  bsr::addField(report, "DroppedParts", specks);
  bsr::addField(report, "RelativeRMS", report->GetArray("RMS")->GetComponent(0, 0) / diagonal);
  bsr::addField(report, "RelativeMax", report->GetArray("Max")->GetComponent(0, 0) / diagonal);
  return 1;
}

void vtkScanToNURBS::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n"
     << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n"
     << indent << "MaximumHoleSize: " << this->MaximumHoleSize << "\n"
     << indent << "Optimizer: " << this->Optimizer << "\n"
     << indent << "Tolerance: " << this->Tolerance << "\n"
     << indent << "SegmentsPerSide: " << this->SegmentsPerSide << "\n"
     << indent << "Sizing: " << this->Sizing << "\n"
     << indent << "FeatureAngle: " << this->FeatureAngle << "\n"
     << indent << "Partition: " << this->Partition << "\n"
     << indent << "RobustWeights: " << this->RobustWeights << "\n"
     << indent << "ReconstructionDimension: " << this->ReconstructionDimension << "\n"
     << indent << "Resolution: " << this->Resolution << "\n";
}
