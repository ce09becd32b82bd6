#include "vtkScanToNURBS.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRStageRunner.h"
#include "vtkBSplineG1Fit.h"
#include "vtkFillHolesRBF.h"
#include "vtkPartitionToQuads.h"
#include "vtkQuadRemesh.h"

#include <vtkDataArray.h>
#include <vtkExtractSurface.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPCANormalEstimation.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkSignedDistance.h>
#include <vtkStaticPointLocator.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <cmath>
#include <vector>

vtkStandardNewMacro(vtkScanToNURBS);

namespace
{
/// Median distance of points to their sixth neighbors, which stands for the spacing of samples.
double spacingOf(vtkPolyData* points)
{
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(points);
  locator->BuildLocator();
  std::vector<double> distances;
  vtkNew<vtkIdList> near;
  const vtkIdType n = points->GetNumberOfPoints();
  const vtkIdType step = std::max<vtkIdType>(1, n / 2000);
  for (vtkIdType i = 0; i < n; i += step)
  {
    double p[3];
    double q[3];
    points->GetPoint(i, p);
    locator->FindClosestNPoints(7, p, near);
    points->GetPoint(near->GetId(near->GetNumberOfIds() - 1), q);
    distances.push_back(std::sqrt(vtkMath::Distance2BetweenPoints(p, q)));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

/// A surface through points without triangles: normals by principal components, a signed distance,
/// its zero set's largest component.
class PointSurface
{
public:
  PointSurface(vtkPolyData* points, int dimension)
  {
    double b[6];
    points->GetBounds(b);
    const double longest = std::max({b[1] - b[0], b[3] - b[2], b[5] - b[4]});
    const double voxel =
      dimension > 0 ? longest / dimension : std::max(0.7 * spacingOf(points), longest / 400.0);
    const double radius = 3.5 * std::max(voxel, 0.7 * spacingOf(points));
    int dims[3];
    for (int a = 0; a < 3; ++a)
    {
      b[2 * a] -= radius + 2.0 * voxel;
      b[2 * a + 1] += radius + 2.0 * voxel;
      dims[a] = 1 + static_cast<int>(std::ceil((b[2 * a + 1] - b[2 * a]) / voxel));
    }
    this->Normals->SetInputData(points);
    this->Normals->SetSampleSize(16);
    this->Normals->SetNormalOrientationToGraphTraversal();
    this->Distance->SetInputConnection(this->Normals->GetOutputPort());
    this->Distance->SetDimensions(dims);
    this->Distance->SetBounds(b);
    this->Distance->SetRadius(radius);
    this->Surface->SetInputConnection(this->Distance->GetOutputPort());
    this->Surface->SetRadius(0.99 * radius);
    this->Surface->HoleFillingOn();
    this->Surface->ComputeNormalsOff();
    this->Largest->SetInputConnection(this->Surface->GetOutputPort());
    this->Largest->SetExtractionModeToLargestRegion();
  }

  bool run(bsr::StageRunner& stages)
  {
    return stages.run("Normals", this->Normals, 5.0) &&
           stages.run("SignedDistance", this->Distance, 5.0) &&
           stages.run("ExtractSurface", this->Surface, 5.0) &&
           stages.run("LargestComponent", this->Largest, 1.0);
  }

  vtkNew<vtkPCANormalEstimation> Normals;
  vtkNew<vtkSignedDistance> Distance;
  vtkNew<vtkExtractSurface> Surface;
  vtkNew<vtkPolyDataConnectivityFilter> Largest;
};

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
  if (cloud)
  {
    vtkNew<vtkPolyData> bare;
    bare->SetPoints(scan->GetPoints());
    PointSurface surface(bare, this->ReconstructionDimension);
    if (!surface.run(stages))
    {
      return failed();
    }
    if (surface.Largest->GetOutput()->GetNumberOfPolys() == 0)
    {
      return fail("No surface was found through the points; set ReconstructionDimension, or make "
                  "triangles before this filter.");
    }
    points->ShallowCopy(surface.Normals->GetOutput());
    fill->SetInputData(surface.Largest->GetOutput());
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
    fill->SetInputConnection(triangles->GetOutputPort());
  }
  if (!stages.run("FillHolesRBF", fill, 15.0))
  {
    return failed();
  }

  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputConnection(fill->GetOutputPort());
  remesh->SetMethod(this->Method);
  remesh->SetNumberOfQuads(this->NumberOfQuads);
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
     << indent << "FeatureAngle: " << this->FeatureAngle << "\n"
     << indent << "Partition: " << this->Partition << "\n"
     << indent << "RobustWeights: " << this->RobustWeights << "\n"
     << indent << "ReconstructionDimension: " << this->ReconstructionDimension << "\n"
     << indent << "Resolution: " << this->Resolution << "\n";
}
