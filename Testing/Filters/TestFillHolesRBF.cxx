#include "FilterTesting.h"
#include "vtkFillHolesRBF.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFeatureEdges.h>
#include <vtkFloatArray.h>
#include <vtkPlaneSource.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>

using bsrtest::ErrorLog;
using bsrtest::openEdges;

namespace
{
/// A sphere without the cap around its south pole; point array Height, cell array Number.
vtkSmartPointer<vtkPolyData> cappedSphere()
{
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(40);
  source->SetPhiResolution(30);
  source->SetEndPhi(150);
  source->Update();
  vtkSmartPointer<vtkPolyData> p = source->GetOutput();
  vtkNew<vtkFloatArray> height;
  height->SetName("Height");
  for (vtkIdType i = 0; i < p->GetNumberOfPoints(); ++i)
  {
    height->InsertNextValue(static_cast<float>(p->GetPoint(i)[2]));
  }
  vtkNew<vtkFloatArray> number;
  number->SetName("Number");
  for (vtkIdType i = 0; i < p->GetNumberOfCells(); ++i)
  {
    number->InsertNextValue(static_cast<float>(i + 1));
  }
  p->GetPointData()->AddArray(height);
  p->GetCellData()->AddArray(number);
  return p;
}
} // namespace

TEST(FillHolesFilter, KeepsWhatIsThereAndMarksWhatIsNew)
{
  const auto input = cappedSphere();
  vtkNew<vtkFillHolesRBF> filter;
  filter->SetInputData(input);
  filter->SetMaximumHoleSize(0.6);
  filter->SetSizeUnit(vtkFillHolesRBF::WORLD_UNITS);
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkPolyData* out = filter->GetOutput();
  EXPECT_EQ(bsrtest::fieldValue(out, "FilledHoles"), 1.0);
  EXPECT_EQ(bsrtest::fieldValue(out, "LeftHoles"), 0.0);
  EXPECT_EQ(openEdges(out), 0);
  EXPECT_EQ(out->GetPoints()->GetDataType(), input->GetPoints()->GetDataType());
  const vtkIdType oldPoints = input->GetNumberOfPoints();
  ASSERT_GT(out->GetNumberOfPoints(), oldPoints);
  for (vtkIdType i = 0; i < oldPoints; ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      ASSERT_EQ(out->GetPoint(i)[c], input->GetPoint(i)[c]);
    }
    ASSERT_EQ(out->GetPointData()->GetArray("Height")->GetTuple1(i),
      input->GetPointData()->GetArray("Height")->GetTuple1(i));
  }
  EXPECT_LT(out->GetPointData()->GetArray("Height")->GetTuple1(oldPoints), -0.4);
  const vtkIdType oldCells = input->GetNumberOfCells();
  for (vtkIdType i = 0; i < out->GetNumberOfCells(); ++i)
  {
    ASSERT_EQ(out->GetCellData()->GetArray("Filled")->GetTuple1(i), i < oldCells ? 0.0 : 1.0);
    ASSERT_EQ(out->GetCellData()->GetArray("Number")->GetTuple1(i),
      i < oldCells ? static_cast<double>(i + 1) : 0.0);
  }
}

TEST(FillHolesFilter, ASizeBelowTheHolesLeavesIt)
{
  vtkNew<vtkFillHolesRBF> filter;
  filter->SetInputData(cappedSphere());
  filter->SetMaximumHoleSize(0.2);
  filter->Update();
  EXPECT_EQ(bsrtest::fieldValue(filter->GetOutput(), "FilledHoles"), 0.0);
  EXPECT_EQ(bsrtest::fieldValue(filter->GetOutput(), "HoleState"), 2.0);
  EXPECT_EQ(openEdges(filter->GetOutput()), 40);
}

TEST(FillHolesFilter, BadInputGivesOneErrorAndNoOutput)
{
  const auto refused = [](vtkPolyData* input, const char* text)
  {
    vtkNew<vtkFillHolesRBF> filter;
    filter->SetInputData(input);
    ErrorLog log(filter);
    filter->Update();
    EXPECT_TRUE(log.saidOnce(text)) << log.text();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  };
  vtkNew<vtkPlaneSource> quads;
  quads->Update();
  refused(quads->GetOutput(), "corners");
  refused(vtkNew<vtkPolyData>(), "no triangles");
  vtkNew<vtkPolyData> points;
  vtkNew<vtkPoints> p;
  p->InsertNextPoint(0, 0, 0);
  points->SetPoints(p);
  refused(points, "no triangles");
  auto nan = cappedSphere();
  nan->GetPoints()->SetPoint(5, NAN, 0, 0);
  refused(nan, "NaN");
}
