#include "vtkScanToNURBS.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRStageRunner.h"
#include "Adapters/BSRWholeInputs.h"
#include "Layout/QuadRemesh.h"
#include "vtkBSplineG1Fit.h"
#include "vtkFillHolesRBF.h"
#include "vtkPartitionToQuads.h"
#include "vtkQuadRemesh.h"
#include "vtkSurfaceFromPoints.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFeatureEdges.h>
#include <vtkFieldData.h>
#include <vtkIdFilter.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkPolyDataNormals.h>
#include <vtkSmartPointer.h>
#include <vtkStaticPointLocator.h>
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
constexpr double QuadGrowth = 1.5;     ///< more quads where a layout does not do
constexpr int MostRounds = 3;
constexpr double MostDetours = 0.01; ///< share of a layout's sides

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

/// Points with normals, and those of a mesh around them that hold a model where no points are: on
/// the mesh's boundary, and filled further away from points than two spacings.
vtkSmartPointer<vtkPolyData> withRim(vtkPolyData* cloud, vtkPolyData* mesh)
{
  vtkNew<vtkPolyDataNormals> oriented;
  oriented->SetInputData(mesh);
  oriented->SplittingOff();
  oriented->ConsistencyOff();
  oriented->Update();
  vtkPolyData* surface = oriented->GetOutput();
  vtkNew<vtkIdFilter> numbered;
  numbered->SetInputData(surface);
  numbered->SetPointIdsArrayName("Id");
  numbered->CellIdsOff();
  vtkNew<vtkFeatureEdges> rim;
  rim->SetInputConnection(numbered->GetOutputPort());
  rim->FeatureEdgesOff();
  rim->NonManifoldEdgesOff();
  rim->Update();
  enum Part : char
  {
    Scanned,
    New,
    Border
  };
  std::vector<char> part(static_cast<std::size_t>(surface->GetNumberOfPoints()), Scanned);
  vtkDataArray* filled = surface->GetCellData()->GetArray("Filled");
  for (vtkIdType c = 0; filled && c < filled->GetNumberOfTuples(); ++c)
  {
    vtkIdList* corners = surface->GetCell(c)->GetPointIds();
    for (vtkIdType k = 0; filled->GetComponent(c, 0) > 0.0 && k < corners->GetNumberOfIds(); ++k)
    {
      part[static_cast<std::size_t>(corners->GetId(k))] = New;
    }
  }
  vtkDataArray* ids = rim->GetOutput()->GetPointData()->GetArray("Id");
  for (vtkIdType i = 0; ids && i < ids->GetNumberOfTuples(); ++i)
  {
    part[static_cast<std::size_t>(ids->GetComponent(i, 0))] = Border;
  }
  vtkNew<vtkStaticPointLocator> nearest;
  nearest->SetDataSet(cloud);
  nearest->BuildLocator();
  vtkDataArray* spacing = cloud->GetPointData()->GetArray("Spacing");
  vtkDataArray* from = surface->GetPointData()->GetNormals();
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  places->DeepCopy(cloud->GetPoints());
  vtkNew<vtkDoubleArray> normals;
  normals->DeepCopy(cloud->GetPointData()->GetNormals());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3];
    surface->GetPoint(i, x);
    bool held = part[static_cast<std::size_t>(i)] == Border;
    if (part[static_cast<std::size_t>(i)] == New)
    {
      const vtkIdType k = nearest->FindClosestPoint(x);
      double p[3];
      cloud->GetPoint(k, p);
      const double reach = 2.0 * spacing->GetComponent(k, 0);
      held = vtkMath::Distance2BetweenPoints(x, p) > reach * reach;
    }
    if (held)
    {
      places->InsertNextPoint(x);
      normals->InsertNextTuple(from->GetTuple(i));
    }
  }
  auto out = vtkSmartPointer<vtkPolyData>::New();
  out->SetPoints(places);
  out->GetPointData()->SetNormals(normals);
  return out;
}

/// Of the layout: nobody shall wait for the holes to be filled to be told of them.
bsr::Status checkParameters(vtkScanToNURBS& filter)
{
  bsr::QuadRemeshOptions layout;
  layout.NumberOfQuads = filter.GetNumberOfQuads();
  layout.FeatureAngle = filter.GetFeatureAngle();
  return bsr::checkOptions(layout);
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

/// The stages, kept so that their results can be given out.
struct vtkScanToNURBS::Stages
{
  Stages(vtkScanToNURBS* self, vtkPolyData* scan) : Self(self), Scan(scan), Run(self, 116.0) {}

  /// The scan's surface without specks and holes.
  bool close()
  {
    this->Cloud = this->Scan->GetNumberOfPolys() == 0 && this->Scan->GetNumberOfStrips() == 0;
    if (this->Cloud)
    {
      this->Surface->SetInputData(this->Scan);
      this->Surface->SetDimension(this->Self->ReconstructionDimension);
      if (!this->Run.run("SurfaceFromPoints", this->Surface, 15.0))
      {
        return false;
      }
      this->Fill->SetInputConnection(this->Surface->GetOutputPort(vtkSurfaceFromPoints::SURFACE));
    }
    else
    {
      this->Triangles->SetInputData(this->Scan);
      this->Triangles->PassVertsOff();
      this->Triangles->PassLinesOff();
      if (!this->Run.run("Triangulate", this->Triangles, 1.0))
      {
        return false;
      }
      this->Specks = dropSpecks(this->Triangles->GetOutput(), this->Whole);
      this->Fill->SetInputData(this->Whole);
    }
    this->Fill->SetMaximumHoleSize(this->Self->MaximumHoleSize);
    return this->Run.run("FillHolesRBF", this->Fill, 15.0);
  }

  void connect()
  {
    this->Remesh->SetInputConnection(this->Fill->GetOutputPort());
    this->Remesh->SetMethod(this->Self->Method);
    this->Remesh->SetSizing(this->Self->Sizing);
    this->Remesh->SetFeatureAngle(this->Self->FeatureAngle);
    if (this->Cloud)
    {
      this->Partition->SetInputData(
        0, withRim(vtkPolyData::SafeDownCast(
                     this->Surface->GetOutputDataObject(vtkSurfaceFromPoints::POINTS)),
             this->Fill->GetOutput()));
    }
    else
    {
      this->Partition->SetInputConnection(0, this->Fill->GetOutputPort());
    }
    this->Partition->SetInputConnection(1, this->Remesh->GetOutputPort());
    this->Partition->SetInputConnection(2, this->Fill->GetOutputPort());
    this->Partition->SetMethod(this->Self->Partition);
    this->Fit->SetInputConnection(0, this->Partition->GetOutputPort(0));
    this->Fit->SetInputConnection(1, this->Remesh->GetOutputPort());
    this->Fit->SetSegmentsPerSide(this->Self->SegmentsPerSide);
    this->Fit->SetRobustWeights(this->Self->RobustWeights);
    this->Fit->SetCreaseAngle(std::min(this->Self->FeatureAngle, 180.0));
    this->Fit->SetCorrelatedNoise(false);
    this->Fit->SetRational(this->Self->Optimizer > 0 || this->Self->Tolerance > 0.0);
    this->Fit->SetOptimizer(this->Self->Optimizer);
    this->Fit->SetTolerance(this->Self->Tolerance * this->Scan->GetLength());
    this->Fit->SetResolution(this->Self->Resolution);
  }

  /// Layout, parameters and fit; again with more quads where regions are no discs, sides take long
  /// ways round, or patches fold.
  bool model()
  {
    this->connect();
    int quads = this->Self->NumberOfQuads;
    for (int more = this->Self->MoreQuads ? MostRounds : 0;; --more)
    {
      const double share = quads == this->Self->NumberOfQuads ? 1.0 : 0.0;
      this->Remesh->SetNumberOfQuads(quads);
      if (!this->Run.run("QuadRemesh", this->Remesh, 25.0 * share) ||
          !this->Run.run("PartitionToQuads", this->Partition, 25.0 * share))
      {
        return false;
      }
      const bool last = more == 0;
      const double sides = 2.0 * this->Remesh->GetOutput()->GetNumberOfCells();
      if (last || (this->count(this->Partition, 0, "FailedQuads") == 0.0 &&
                    this->count(this->Partition, 0, "Detours") <= MostDetours * sides))
      {
        if (!this->Run.run("BSplineG1Fit", this->Fit, 33.0))
        {
          return false;
        }
        if (last || this->count(this->Fit, REPORT, "FoldedPatches") == 0.0)
        {
          return true;
        }
      }
      quads = static_cast<int>(std::ceil(QuadGrowth * quads));
      ++this->Rounds;
    }
  }

  /// A value of an output's field data; 0 where it is absent.
  static double count(vtkAlgorithm* stage, int port, const char* name)
  {
    vtkDataArray* a = stage->GetOutputDataObject(port)->GetFieldData()->GetArray(name);
    return a ? a->GetComponent(0, 0) : 0.0;
  }

  void giveOut(vtkInformationVector* outputs)
  {
    for (int port = 0; port < 3; ++port)
    {
      vtkDataObject::GetData(outputs, port)->ShallowCopy(this->Fit->GetOutputDataObject(port));
    }
    vtkDataObject* parameters = this->Partition->GetOutputDataObject(0);
    vtkPolyData::GetData(outputs, CLOSED_MESH)->ShallowCopy(this->Fill->GetOutput());
    vtkPolyData::GetData(outputs, LAYOUT)->ShallowCopy(this->Remesh->GetOutput());
    vtkPolyData::GetData(outputs, POINTS)->ShallowCopy(parameters);
    vtkPolyData::GetData(outputs, NETWORK)->ShallowCopy(this->Partition->GetOutputDataObject(1));
    vtkFieldData* report = vtkTable::GetData(outputs, REPORT)->GetFieldData();
    this->Run.addTimes(report);
    bsr::copyFields(
      this->Fill->GetOutput(), report, {"FilledHoles", "LeftHoles", "HoleSize", "HoleState"});
    bsr::copyFields(this->Remesh->GetOutput(), report, {"Irregular", "EulerCharacteristic"});
    bsr::copyFields(
      parameters, report, {"FailedQuads", "RoughSides", "Detours", "FoldedTriangles"});
    const double diagonal = this->Scan->GetLength();
    bsr::addField(report, "DroppedParts", this->Specks);
    bsr::addField(report, "MoreQuadsRounds", this->Rounds);
    bsr::addField(report, "RelativeRMS", this->count(this->Fit, REPORT, "RMS") / diagonal);
    bsr::addField(report, "RelativeMax", this->count(this->Fit, REPORT, "Max") / diagonal);
  }

  vtkScanToNURBS* Self;
  vtkPolyData* Scan;
  bsr::StageRunner Run;
  bool Cloud = false;
  int Specks = 0;
  int Rounds = 0; ///< with more quads
  vtkNew<vtkPolyData> Whole;
  vtkNew<vtkTriangleFilter> Triangles;
  vtkNew<vtkSurfaceFromPoints> Surface;
  vtkNew<vtkFillHolesRBF> Fill;
  vtkNew<vtkQuadRemesh> Remesh;
  vtkNew<vtkPartitionToQuads> Partition;
  vtkNew<vtkBSplineG1Fit> Fit;
};

int vtkScanToNURBS::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkNew<vtkPolyData> scan;
  scan->ShallowCopy(vtkPolyData::GetData(inputs[0]));
  const auto fail = [&](const bsr::Status& status)
  {
    bsr::emptyOutputs(outputs);
    return bsr::notDelivered(this, status);
  };
  const auto checked = bsr::pointsFrom(scan->GetPoints());
  if (!checked)
  {
    return fail(checked.status());
  }
  if (checked->size() < 8)
  {
    return fail(
      bsr::Status::invalidInput("The input has fewer than 8 points; check the filters above."));
  }
  if (const bsr::Status s = checkParameters(*this); !s)
  {
    return fail(s);
  }
  Stages stages(this, scan);
  if (!stages.close() || !stages.model())
  {
    return fail(stages.Run.status());
  }
  stages.giveOut(outputs);
  return 1;
}

void vtkScanToNURBS::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n"
     << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n"
     << indent << "MoreQuads: " << this->MoreQuads << "\n"
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
