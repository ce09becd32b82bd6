#include "CubeLayout.h"
#include "FilterTesting.h"

#include "vtkBSplineG1Fit.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <array>
#include <vector>

using bsrtest::cubeLayout;
using bsrtest::spherePoints;

TEST(BSplineG1Fit, ThreePortsAndTheirArrays)
{
  vtkNew<vtkBSplineG1Fit> fit;
  bsrtest::ErrorLog log(fit);
  fit->SetInputData(0, spherePoints(12));
  fit->SetInputData(1, cubeLayout());
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
  fit->SetInputData(0, spherePoints(10));
  fit->SetInputData(1, cubeLayout());
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
  auto p = spherePoints(8);
  p->GetPointData()->RemoveArray("QuadId");
  EXPECT_NE(failure(p, cubeLayout()).find("QuadId"), std::string::npos);
  EXPECT_NE(failure(spherePoints(8), cubeLayout(true)).find("3 corners"), std::string::npos);
  EXPECT_NE(failure(spherePoints(8), cubeLayout(), "Area").find("Area"), std::string::npos);
  EXPECT_NE(failure(spherePoints(1), cubeLayout()).find("points for 6 quads"), std::string::npos);
  auto far = spherePoints(8);
  far->GetPointData()->GetArray("QuadId")->SetComponent(0, 0, 99);
  EXPECT_NE(failure(far, cubeLayout()).find("QuadId 99"), std::string::npos);
}

TEST(BSplineG1Fit, RefusesQuadsThatAreNoManifold)
{
  const auto refused = [](const std::vector<std::array<vtkIdType, 4>>& more)
  {
    auto quads = cubeLayout();
    for (const auto& q : more)
    {
      for (const vtkIdType id : q)
      {
        while (id >= quads->GetNumberOfPoints())
        {
          quads->GetPoints()->InsertNextPoint(
            3.0 + id % 2, 3.0 + id / 2 % 2, quads->GetNumberOfPoints());
        }
      }
      quads->GetPolys()->InsertNextCell(4, q.data());
    }
    vtkNew<vtkBSplineG1Fit> fit;
    bsrtest::ErrorLog log(fit);
    fit->SetInputData(0, spherePoints(8));
    fit->SetInputData(1, quads);
    fit->Update();
    EXPECT_TRUE(log.saidOnce("manifold")) << log.text();
    for (int port = 0; port < 2; ++port)
    {
      EXPECT_EQ(fit->GetOutput(port)->GetNumberOfCells(), 0);
    }
  };
  refused({{0, 1, 9, 8}});                   // a third quad at the side 0 1
  refused({{6, 8, 9, 10}});                  // a second fan at the corner 6
  refused({{0, 1, 2, 3}});                   // one quad twice, turned over
  refused({{6, 8, 9, 10}, {6, 10, 11, 12}}); // a larger second fan
}

TEST(BSplineG1Fit, FewPointsInAPatchFoldNothing)
{
  auto few = spherePoints(12);
  vtkDataArray* quad = few->GetPointData()->GetArray("QuadId");
  vtkNew<vtkPolyData> left;
  vtkNew<vtkPoints> places;
  vtkNew<vtkIntArray> ids;
  ids->SetName("QuadId");
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  for (vtkIdType i = 0; i < few->GetNumberOfPoints(); ++i)
  {
    // Face 0 keeps two points and face 1 none.
    const auto f = static_cast<int>(quad->GetComponent(i, 0));
    if (f > 1 || i == 30 || i == 40)
    {
      places->InsertNextPoint(few->GetPoint(i));
      ids->InsertNextValue(f);
      uv->InsertNextTuple(few->GetPointData()->GetArray("UV")->GetTuple(i));
    }
  }
  left->SetPoints(places);
  left->GetPointData()->AddArray(ids);
  left->GetPointData()->AddArray(uv);
  vtkNew<vtkBSplineG1Fit> fit;
  bsrtest::ErrorLog log(fit);
  fit->SetInputData(0, left);
  fit->SetInputData(1, cubeLayout());
  fit->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkFieldData* field = fit->GetOutput(0)->GetFieldData();
  EXPECT_EQ(field->GetArray("FoldedPatches")->GetComponent(0, 0), 0.0);
  EXPECT_LE(field->GetArray("MaxNormalJump")->GetComponent(0, 0), 1e-6);
}

TEST(BSplineG1Fit, CancelLeavesNothing)
{
  for (const double at : {0.0, 0.5, 0.9})
  {
    vtkNew<vtkBSplineG1Fit> fit;
    fit->SetInputData(0, spherePoints(12));
    fit->SetInputData(1, cubeLayout());
    const bsrtest::AbortAt abort(fit, at);
    bsrtest::ErrorLog log(fit);
    fit->Update();
    EXPECT_TRUE(abort.done()) << at;
    EXPECT_TRUE(log.empty()) << log.text();
    EXPECT_EQ(fit->GetOutput(0)->GetNumberOfPoints(), 0) << at;
    EXPECT_EQ(fit->GetOutput(0)->GetFieldData()->GetNumberOfArrays(), 0) << at;
    EXPECT_EQ(fit->GetOutput(1)->GetNumberOfPoints(), 0) << at;
    EXPECT_EQ(vtkTable::SafeDownCast(fit->GetOutputDataObject(2))->GetNumberOfRows(), 0) << at;
  }
}
