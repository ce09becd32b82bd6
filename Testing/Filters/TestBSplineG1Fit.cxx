#include "FilterTesting.h"

#include "vtkBSplineG1Fit.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

namespace
{
const int Faces[6][4] = {
  {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
const double Corners[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1},
  {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};

/// The cube as a layout; the last face may be made a triangle.
vtkSmartPointer<vtkPolyData> layout(bool triangle = false)
{
  auto quads = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const auto& c : Corners)
  {
    points->InsertNextPoint(c);
  }
  vtkNew<vtkCellArray> cells;
  for (int f = 0; f < 6; ++f)
  {
    const vtkIdType ids[4] = {Faces[f][0], Faces[f][1], Faces[f][2], Faces[f][3]};
    cells->InsertNextCell(triangle && f == 5 ? 3 : 4, ids);
  }
  quads->SetPoints(points);
  quads->SetPolys(cells);
  return quads;
}

/// n x n points a face of the cube, blown up to the unit sphere, partitioned.
vtkSmartPointer<vtkPolyData> points(int n)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> places;
  vtkNew<vtkIntArray> quad;
  quad->SetName("QuadId");
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  for (int i = 0; i < 6 * n * n; ++i)
  {
    const int f = i / (n * n);
    const double u = (i % n + 0.5) / n;
    const double v = (i / n % n + 0.5) / n;
    double x[3];
    double size = 0.0;
    for (int d = 0; d < 3; ++d)
    {
      x[d] = (1 - v) * ((1 - u) * Corners[Faces[f][0]][d] + u * Corners[Faces[f][1]][d]) +
             v * ((1 - u) * Corners[Faces[f][3]][d] + u * Corners[Faces[f][2]][d]);
      size += x[d] * x[d];
    }
    for (double& c : x)
    {
      c /= std::sqrt(size);
    }
    places->InsertNextPoint(x);
    quad->InsertNextValue(f);
    uv->InsertNextTuple2(u, v);
  }
  data->SetPoints(places);
  data->GetPointData()->AddArray(quad);
  data->GetPointData()->AddArray(uv);
  return data;
}
} // namespace

TEST(BSplineG1Fit, ThreePortsAndTheirArrays)
{
  vtkNew<vtkBSplineG1Fit> fit;
  bsrtest::ErrorLog log(fit);
  fit->SetInputData(0, points(12));
  fit->SetInputData(1, layout());
  fit->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkPolyData* model = vtkPolyData::SafeDownCast(fit->GetOutputDataObject(0));
  ASSERT_GT(model->GetNumberOfCells(), 0);
  vtkFieldData* field = model->GetFieldData();
  for (const char* name : {"SplinePatches", "SplineControlPoints", "SplineKnots", "SplineNeighbors",
         "RMS", "Max", "FoldedPatches", "Seconds", "Unknowns", "Shells", "DataWeight"})
  {
    EXPECT_TRUE(field->GetArray(name)) << name;
  }
  EXPECT_LE(field->GetArray("MaxNormalJump")->GetComponent(0, 0), 1e-6);
  EXPECT_LE(field->GetArray("RMS")->GetComponent(0, 0), 0.01);
  EXPECT_EQ(field->GetArray("FoldedPatches")->GetComponent(0, 0), 0.0);
  EXPECT_TRUE(field->GetAbstractArray("Message"));
  EXPECT_GT(vtkPolyData::SafeDownCast(fit->GetOutputDataObject(1))->GetNumberOfCells(), 0);
  vtkTable* table = vtkTable::SafeDownCast(fit->GetOutputDataObject(2));
  EXPECT_EQ(table->GetNumberOfRows(), 6);
  for (const char* name : {"PatchId", "Shell", "Points", "RMS", "Max", "MinJacobian"})
  {
    EXPECT_TRUE(table->GetColumnByName(name)) << name;
  }
}

TEST(BSplineG1Fit, RationalPatchesAndTheirReport)
{
  vtkNew<vtkBSplineG1Fit> fit;
  bsrtest::ErrorLog log(fit);
  fit->SetInputData(0, points(10));
  fit->SetInputData(1, layout());
  fit->SetDataWeight(1e5);
  fit->RationalOn();
  for (const int optimizer : {vtkBSplineG1Fit::NO_WEIGHTS, vtkBSplineG1Fit::EVOLUTION_STRATEGY,
         vtkBSplineG1Fit::DETERMINISTIC})
  {
    fit->SetOptimizer(optimizer);
    fit->SetGenerations(20);
    fit->Update();
    EXPECT_TRUE(log.empty()) << log.text();
    vtkFieldData* field = fit->GetOutput(0)->GetFieldData();
    EXPECT_LE(field->GetArray("MaxNormalJump")->GetComponent(0, 0), 1e-6);
    EXPECT_EQ(field->GetArray("FoldedPatches")->GetComponent(0, 0), 0.0);
    EXPECT_TRUE(field->GetArray("WeightSeconds"));
    EXPECT_EQ(
      field->GetArray("Convergence") != nullptr, optimizer == vtkBSplineG1Fit::EVOLUTION_STRATEGY);
    vtkTable* table = vtkTable::SafeDownCast(fit->GetOutputDataObject(2));
    ASSERT_EQ(table->GetNumberOfRows(), 6);
    for (vtkIdType i = 0; i < 6; ++i)
    {
      const auto value = [&](const char* name)
      { return table->GetValueByName(i, name).ToDouble(); };
      EXPECT_LE(value("Mean"), value("MeanBefore"));
      EXPECT_LE(value("LeastWeight"), value("LargestWeight"));
      EXPECT_EQ(value("SegmentsU"), 3.0);
      if (optimizer == vtkBSplineG1Fit::NO_WEIGHTS)
      {
        EXPECT_EQ(value("LeastWeight"), 1.0);
        EXPECT_EQ(value("LargestWeight"), 1.0);
      }
    }
  }
}

TEST(BSplineG1Fit, BadInputIsOneErrorAndNoOutput)
{
  const auto failure = [](vtkPolyData* p, vtkPolyData* q, const char* weights = "")
  {
    vtkNew<vtkBSplineG1Fit> fit;
    bsrtest::ErrorLog log(fit);
    fit->SetInputData(0, p);
    fit->SetInputData(1, q);
    fit->SetWeightArray(weights);
    fit->Update();
    EXPECT_EQ(log.Errors.size(), 1u);
    EXPECT_EQ(vtkPolyData::SafeDownCast(fit->GetOutputDataObject(0))->GetNumberOfCells(), 0);
    return log.Errors.empty() ? std::string() : log.Errors.front();
  };
  auto p = points(8);
  p->GetPointData()->RemoveArray("QuadId");
  EXPECT_NE(failure(p, layout()).find("QuadId"), std::string::npos);
  EXPECT_NE(failure(points(8), layout(true)).find("3 corners"), std::string::npos);
  EXPECT_NE(failure(points(8), layout(), "Area").find("Area"), std::string::npos);
  EXPECT_NE(failure(points(1), layout()).find("points for 6 quads"), std::string::npos);
  auto far = points(8);
  far->GetPointData()->GetArray("QuadId")->SetComponent(0, 0, 99);
  EXPECT_NE(failure(far, layout()).find("QuadId 99"), std::string::npos);
}
