#include "FilterTesting.h"
#include "vtkScanToNURBS.h"

#include <vtkAppendPolyData.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
#include <vtkFeatureEdges.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkTable.h>

using bsrtest::ErrorLog;
using bsrtest::openEdges;

namespace
{
/// A sphere without a cap of `open` degrees around its south pole.
vtkSmartPointer<vtkPolyData> scan(double open)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(48);
  sphere->SetPhiResolution(40);
  sphere->SetRadius(1.0);
  sphere->SetEndPhi(180.0 - open);
  sphere->Update();
  return sphere->GetOutput();
}

/// `rms`: bound, over the scan's diagonal.
void updateAndExpectModel(vtkScanToNURBS* filter, double rms, double euler)
{
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  auto* report = vtkTable::SafeDownCast(filter->GetOutputDataObject(vtkScanToNURBS::REPORT));
  ASSERT_GT(report->GetNumberOfRows(), 0);
  EXPECT_LT(bsrtest::fieldValue(report, "RelativeRMS"), rms);
  EXPECT_EQ(bsrtest::fieldValue(report, "FoldedPatches"), 0.0);
  EXPECT_LT(bsrtest::fieldValue(report, "MaxNormalJump"), 0.01);
  EXPECT_EQ(bsrtest::fieldValue(report, "EulerCharacteristic"), euler);
  EXPECT_TRUE(report->GetFieldData()->GetAbstractArray("StageNames"));
  auto* model = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(vtkScanToNURBS::MODEL));
  EXPECT_TRUE(model->GetFieldData()->GetArray("SplinePatches"));
}
} // namespace

TEST(ScanToNURBSFilter, ClosesGapsAndGivesEveryStage)
{
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputDataObject(0, scan(12.0));
  filter->SetNumberOfQuads(30);
  updateAndExpectModel(filter, 1e-3, 2.0);
  const auto output = [&](int port)
  { return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(port)); };
  EXPECT_EQ(openEdges(output(vtkScanToNURBS::MODEL)), 0);
  EXPECT_TRUE(output(vtkScanToNURBS::CLOSED_MESH)->GetCellData()->GetArray("Filled"));
  EXPECT_GT(output(vtkScanToNURBS::LAYOUT)->GetNumberOfPolys(), 20);
  EXPECT_TRUE(output(vtkScanToNURBS::POINTS)->GetPointData()->GetArray("UV"));
  EXPECT_GT(output(vtkScanToNURBS::NETWORK)->GetNumberOfLines(), 40);
}

TEST(ScanToNURBSFilter, KeepsAnOpenBoundary)
{
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputDataObject(0, scan(70.0));
  filter->SetNumberOfQuads(30);
  updateAndExpectModel(filter, 1e-3, 1.0);
  auto* model = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(vtkScanToNURBS::MODEL));
  EXPECT_GT(openEdges(model), 0);
  // The model ends where the scan does.
  EXPECT_NEAR(model->GetBounds()[4], scan(70.0)->GetBounds()[4], 5e-3);
}

TEST(ScanToNURBSFilter, TakesPointsWithoutTriangles)
{
  vtkNew<vtkPolyData> points;
  points->SetPoints(scan(0.0)->GetPoints());
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputDataObject(0, points);
  filter->SetNumberOfQuads(30);
  updateAndExpectModel(filter, 2e-3, 2.0);
}

TEST(ScanToNURBSFilter, ARimOfPointsIsHeld)
{
  vtkNew<vtkPolyData> points;
  points->SetPoints(scan(70.0)->GetPoints());
  double bounds[6];
  points->GetBounds(bounds);
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputDataObject(0, points);
  filter->SetNumberOfQuads(30);
  updateAndExpectModel(filter, 2e-3, 1.0);
  auto* model = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(vtkScanToNURBS::MODEL));
  EXPECT_GT(openEdges(model), 0);
  // Half a sample (0.13 along the rim) beyond the points at most.
  EXPECT_NEAR(model->GetBounds()[4], bounds[4], 0.065);
}

TEST(ScanToNURBSFilter, LeavesSpecksOut)
{
  vtkNew<vtkSphereSource> speck;
  speck->SetCenter(3.0, 0.0, 0.0);
  speck->SetRadius(0.02);
  vtkNew<vtkAppendPolyData> both;
  both->AddInputData(scan(0.0));
  both->AddInputConnection(speck->GetOutputPort());
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputConnection(both->GetOutputPort());
  filter->SetNumberOfQuads(30);
  updateAndExpectModel(filter, 1e-3, 2.0);
  EXPECT_EQ(
    bsrtest::fieldValue(filter->GetOutputDataObject(vtkScanToNURBS::REPORT), "DroppedParts"), 1.0);
}

TEST(ScanToNURBSFilter, TakesMoreQuadsWhereTooFewWereAskedFor)
{
  // A chain of two rings cannot be had from 10 quads.
  vtkNew<vtkImageData> image;
  image->SetDimensions(65, 42, 18);
  image->SetOrigin(-1.55, -1.55, -0.55);
  image->SetSpacing(0.08, 0.08, 0.065);
  image->AllocateScalars(VTK_FLOAT, 1);
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double p[3];
    image->GetPoint(i, p);
    double least = 10.0;
    for (const double x : {0.0, 2.0})
    {
      least = std::min(least, std::hypot(std::hypot(p[0] - x, p[1]) - 1.0, p[2]) - 0.4);
    }
    image->GetPointData()->GetScalars()->SetComponent(i, 0, least);
  }
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputData(image);
  surface->SetValue(0, 0.0);
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputConnection(surface->GetOutputPort());
  filter->SetNumberOfQuads(10);
  updateAndExpectModel(filter, 2e-2, -2.0);
  auto* report = filter->GetOutputDataObject(vtkScanToNURBS::REPORT);
  EXPECT_EQ(bsrtest::fieldValue(report, "FailedQuads"), 0.0);
  EXPECT_GE(bsrtest::fieldValue(report, "MoreQuadsRounds"), 1.0);
}

TEST(ScanToNURBSFilter, DisconnectedScansBecomeAShellEach)
{
  vtkNew<vtkSphereSource> second;
  second->SetThetaResolution(40);
  second->SetPhiResolution(30);
  second->SetRadius(0.8);
  second->SetCenter(3.0, 0.0, 0.0);
  vtkNew<vtkAppendPolyData> both;
  both->AddInputData(scan(0.0));
  both->AddInputConnection(second->GetOutputPort());
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputConnection(both->GetOutputPort());
  filter->SetNumberOfQuads(60);
  updateAndExpectModel(filter, 1e-3, 4.0);
  EXPECT_EQ(
    openEdges(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(vtkScanToNURBS::MODEL))), 0);
}

/// Two spheres that share one vertex: no manifold there.
TEST(ScanToNURBSFilter, NonManifoldVerticesAreTakenApart)
{
  vtkNew<vtkSphereSource> lower;
  lower->SetThetaResolution(40);
  lower->SetPhiResolution(30);
  lower->SetRadius(0.8);
  lower->SetCenter(0.0, 0.0, -1.8); // its north pole is the other's south pole
  vtkNew<vtkAppendPolyData> both;
  both->AddInputData(scan(0.0));
  both->AddInputConnection(lower->GetOutputPort());
  vtkNew<vtkCleanPolyData> pinched;
  pinched->SetInputConnection(both->GetOutputPort());
  pinched->SetTolerance(1e-6);
  pinched->Update();
  ASSERT_EQ(pinched->GetOutput()->GetNumberOfPoints() + 1, both->GetOutput()->GetNumberOfPoints());
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputConnection(pinched->GetOutputPort());
  filter->SetNumberOfQuads(60);
  updateAndExpectModel(filter, 1e-3, 4.0);
}

TEST(ScanToNURBSFilter, HolesThatAreTooLargeStay)
{
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputDataObject(0, scan(20.0));
  filter->SetNumberOfQuads(30);
  filter->SetMaximumHoleSize(0.05);
  updateAndExpectModel(filter, 1e-3, 1.0);
  EXPECT_EQ(
    bsrtest::fieldValue(filter->GetOutputDataObject(vtkScanToNURBS::REPORT), "LeftHoles"), 1.0);
}

TEST(ScanToNURBSFilter, AnUnreachableToleranceIsABestEffort)
{
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputDataObject(0, scan(0.0));
  filter->SetNumberOfQuads(24);
  filter->SetTolerance(1e-12);
  updateAndExpectModel(filter, 1e-3, 2.0);
  auto* report = vtkTable::SafeDownCast(filter->GetOutputDataObject(vtkScanToNURBS::REPORT));
  EXPECT_EQ(bsrtest::fieldValue(report, "PatchesAboveTolerance"),
    static_cast<double>(report->GetNumberOfRows()));
}

TEST(ScanToNURBSFilter, BadInputGivesOneErrorAndNoOutput)
{
  const auto refused = [](vtkPolyData* input, const char* text)
  {
    vtkNew<vtkScanToNURBS> filter;
    filter->SetInputDataObject(0, input);
    ErrorLog log(filter);
    filter->Update();
    EXPECT_TRUE(log.saidOnce(text)) << log.text();
    EXPECT_EQ(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfPoints(), 0);
  };
  refused(vtkNew<vtkPolyData>(), "fewer than 8 points");
  const auto nan = scan(0.0);
  nan->GetPoints()->SetPoint(3, NAN, 0, 0);
  refused(nan, "NaN");
}
