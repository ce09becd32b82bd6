#include "FilterTesting.h"
#include "RandomShape.h"
#include "vtkQuadRemesh.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkXMLPolyDataReader.h>

#include <limits>
#include <map>
#include <set>

using bsrtest::ErrorLog;
using bsrtest::fieldValue;

namespace
{
/// Checks, without the code under test, that a mesh is closed, oriented, of quads, without
/// doublets.
void expectClosedQuads(vtkPolyData* mesh)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> directed;
  std::map<vtkIdType, int> quadsAt;
  std::set<std::set<vtkIdType>> corners;
  for (vtkIdType q = 0; q < mesh->GetNumberOfCells(); ++q)
  {
    vtkIdType n = 0;
    const vtkIdType* ids = nullptr;
    mesh->GetPolys()->GetCellAtId(q, n, ids);
    ASSERT_EQ(n, 4);
    corners.insert(std::set<vtkIdType>(ids, ids + 4));
    for (int k = 0; k < 4; ++k)
    {
      EXPECT_EQ(++(directed[{ids[k], ids[(k + 1) % 4]}]), 1);
      ++quadsAt[ids[k]];
    }
  }
  EXPECT_EQ(static_cast<vtkIdType>(corners.size()), mesh->GetNumberOfCells());
  for (const auto& e : directed)
  {
    EXPECT_TRUE(directed.count({e.first.second, e.first.first}));
  }
  for (const auto& v : quadsAt)
  {
    EXPECT_GE(v.second, 3);
    EXPECT_LE(v.second, 8);
  }
  EXPECT_EQ(static_cast<vtkIdType>(quadsAt.size()), mesh->GetNumberOfPoints());
}
} // namespace

TEST(QuadRemeshFilter, RandomShapes)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto surface = bsrtest::randomShape(seed, 48);
    vtkNew<vtkQuadRemesh> remesh;
    remesh->SetInputData(surface);
    remesh->SetNumberOfQuads(150 + 40 * static_cast<int>(seed));
    ErrorLog log(remesh);
    remesh->Update();
    ASSERT_TRUE(log.empty()) << log.text();
    vtkPolyData* out = remesh->GetOutput();
    expectClosedQuads(out);
    EXPECT_EQ(fieldValue(out, "EulerCharacteristic"), bsrtest::eulerOfClosed(surface));
    EXPECT_GT(fieldValue(out, "MinScaledJacobian"), 0.0);
  }
}

TEST(QuadRemeshFilter, AddsItsArrays)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(80);
  sphere->SetPhiResolution(60);
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputConnection(sphere->GetOutputPort());
  remesh->SetNumberOfQuads(120);
  remesh->Update();
  vtkPolyData* out = remesh->GetOutput();
  expectClosedQuads(out);
  EXPECT_NEAR(out->GetNumberOfCells(), 120, 15);
  EXPECT_TRUE(out->GetCellData()->GetArray("ScaledJacobian"));
  EXPECT_TRUE(out->GetPointData()->GetArray("Valence"));
  EXPECT_FALSE(out->GetCellData()->GetArray("EndRegion"));
  EXPECT_GE(fieldValue(out, "Irregular"), 8);
  EXPECT_EQ(fieldValue(out, "EulerCharacteristic"), 2);
  EXPECT_LT(fieldValue(out, "Hausdorff"), 0.1);
}

TEST(QuadRemeshFilter, MorseSmaleGivesCellsAndCriticalPoints)
{
  const auto surface = bsrtest::randomShape(2, 48);
  const double euler = bsrtest::eulerOfClosed(surface);
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputData(surface);
  remesh->SetMethod(vtkQuadRemesh::MORSE_SMALE);
  remesh->SetNumberOfQuads(120);
  ErrorLog log(remesh);
  remesh->Update();
  ASSERT_TRUE(log.empty()) << log.text();
  vtkPolyData* out = remesh->GetOutput(0);
  expectClosedQuads(out);
  EXPECT_EQ(fieldValue(out, "EulerCharacteristic"), euler);
  EXPECT_EQ(fieldValue(out, "LayoutStage"), 2);
  EXPECT_EQ(
    fieldValue(out, "Minima") - fieldValue(out, "Saddles") + fieldValue(out, "Maxima"), euler);
  EXPECT_EQ(fieldValue(out, "MorseCells"), 2 * fieldValue(out, "Saddles"));
  vtkPolyData* cut = remesh->GetOutput(1);
  ASSERT_TRUE(cut->GetCellData()->GetArray("Cell"));
  ASSERT_TRUE(cut->GetPointData()->GetArray("Critical"));
  EXPECT_EQ(cut->GetCellData()->GetArray("Cell")->GetRange()[1] + 1, fieldValue(out, "MorseCells"));
  EXPECT_EQ(cut->GetPointData()->GetArray("Critical")->GetRange()[1], 3);
  EXPECT_LE(cut->GetPointData()->GetArray("Eigenfunction")->GetRange()[1], 1.0);
  EXPECT_EQ(bsrtest::eulerOfClosed(cut), euler);
  remesh->SetEigenfunction(-3);
  remesh->Update();
  EXPECT_TRUE(log.saidOnce("Eigenfunction")) << log.text();
  EXPECT_EQ(remesh->GetOutput(0)->GetNumberOfCells(), 0);
  EXPECT_EQ(remesh->GetOutput(1)->GetNumberOfCells(), 0);
}

TEST(QuadRemeshFilter, SaysWhatIsWrong)
{
  vtkNew<vtkQuadRemesh> remesh;
  ErrorLog log(remesh);
  vtkNew<vtkPolyData> empty;
  remesh->SetInputData(empty);
  remesh->Update();
  EXPECT_TRUE(log.saidOnce("no triangles")) << log.text();
  EXPECT_EQ(remesh->GetOutput()->GetNumberOfCells(), 0);
  log.clear();
  vtkNew<vtkSphereSource> sphere;
  remesh->SetInputConnection(sphere->GetOutputPort());
  remesh->SetSizing(vtkQuadRemesh::SIZE_BY_ARRAY);
  remesh->SetSizeArray("Sizes");
  remesh->Update();
  EXPECT_TRUE(log.saidOnce("Sizes")) << log.text();
  EXPECT_EQ(remesh->GetOutput()->GetNumberOfCells(), 0);
}

TEST(QuadRemeshFilter, WarnsOfSharpEdgesWithoutRoom)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(30);
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputConnection(sphere->GetOutputPort());
  remesh->SetNumberOfQuads(60);
  int warnings = 0;
  vtkNew<vtkCallbackCommand> heard;
  heard->SetClientData(&warnings);
  heard->SetCallback(
    [](vtkObject*, unsigned long, void* count, void*) { ++*static_cast<int*>(count); });
  remesh->AddObserver(vtkCommand::WarningEvent, heard);
  remesh->Update();
  EXPECT_EQ(warnings, 0);
  EXPECT_EQ(fieldValue(remesh->GetOutput(), "FollowedFeatures"), 0);
  remesh->SetFeatureAngle(2.0); // every edge is sharp
  remesh->Update();
  EXPECT_EQ(warnings, 1);
  EXPECT_EQ(fieldValue(remesh->GetOutput(), "FollowedFeatures"), 1);
  expectClosedQuads(remesh->GetOutput());
}

TEST(QuadRemeshFilter, TakesPolygonsStripsAndUnusedPoints)
{
  // A box: one strip of four sides, one quad, two triangles, a vertex cell and a point at infinity.
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 8; ++i)
  {
    points->InsertNextPoint(i & 1, i >> 1 & 1, i >> 2);
  }
  points->InsertNextPoint(std::numeric_limits<double>::infinity(), 0, 0);
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({0, 4, 1, 5, 3, 7, 2, 6, 0, 4});
  vtkNew<vtkCellArray> polys;
  polys->InsertNextCell({0, 1, 3, 2});
  polys->InsertNextCell({4, 5, 7});
  polys->InsertNextCell({4, 6, 7}); // the wrong way round
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({3});
  vtkNew<vtkPolyData> box;
  box->SetPoints(points);
  box->SetPolys(polys);
  box->SetStrips(strips);
  box->SetVerts(verts);
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputData(box);
  remesh->SetNumberOfQuads(60);
  ErrorLog log(remesh);
  remesh->Update();
  ASSERT_TRUE(log.empty()) << log.text();
  expectClosedQuads(remesh->GetOutput());
  EXPECT_EQ(fieldValue(remesh->GetOutput(), "EulerCharacteristic"), 2);
  EXPECT_EQ(fieldValue(remesh->GetOutput(), "MinimumQuads"), 6);
  vtkPolyData* repairs = remesh->GetOutput(2);
  ASSERT_EQ(repairs->GetNumberOfCells(), 12);
  vtkDataArray* repair = repairs->GetCellData()->GetArray("Repair");
  ASSERT_TRUE(repair);
  int turned = 0;
  for (vtkIdType i = 0; i < 12; ++i)
  {
    turned += repair->GetTuple1(i) == 4.0;
  }
  vtkDataArray* counts =
    vtkDataArray::SafeDownCast(remesh->GetOutput()->GetFieldData()->GetAbstractArray("Repairs"));
  EXPECT_GT(turned, 0);
  EXPECT_EQ(counts->GetComponent(0, 3), turned);
  EXPECT_STREQ(counts->GetComponentName(3), "TurnedFaces");
}

TEST(QuadRemeshFilter, RegionsOfPointsAndSizesByArray)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(80);
  sphere->SetPhiResolution(60);
  sphere->Update();
  vtkPolyData* surface = sphere->GetOutput();
  vtkNew<vtkIntArray> region;
  region->SetName("Part");
  vtkNew<vtkDoubleArray> size;
  size->SetName("Sizes");
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    const double z = surface->GetPoint(i)[2];
    region->InsertNextValue(z > 0.3 ? 1 : 0);
    size->InsertNextValue(z > 0.0 ? 1.0 : 2.0);
  }
  surface->GetPointData()->AddArray(region);
  surface->GetPointData()->AddArray(size);
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetInputData(surface);
  remesh->SetNumberOfQuads(200);
  remesh->SetRegionArray("Part");
  remesh->SetSizing(vtkQuadRemesh::SIZE_BY_ARRAY);
  remesh->SetSizeArray("Sizes");
  ErrorLog log(remesh);
  remesh->Update();
  ASSERT_TRUE(log.empty()) << log.text();
  vtkPolyData* out = remesh->GetOutput();
  expectClosedQuads(out);
  vtkDataArray* part = out->GetCellData()->GetArray("Part");
  ASSERT_TRUE(part);
  int above = 0;
  for (vtkIdType i = 0; i < out->GetNumberOfCells(); ++i)
  {
    above += part->GetTuple1(i) == 1.0;
  }
  EXPECT_GT(above, 4);
  EXPECT_LT(above, out->GetNumberOfCells());
}

TEST(QuadRemeshFilter, CancelLeavesNothing)
{
  const auto surface = bsrtest::randomShape(2, 32);
  for (const int method : {vtkQuadRemesh::FIELD_ALIGNED, vtkQuadRemesh::MORSE_SMALE})
  {
    for (const double at : {0.0, 0.5})
    {
      vtkNew<vtkQuadRemesh> remesh;
      remesh->SetInputData(surface);
      remesh->SetMethod(method);
      remesh->SetNumberOfQuads(120);
      const bsrtest::AbortAt abort(remesh, at);
      ErrorLog log(remesh);
      remesh->Update();
      EXPECT_TRUE(abort.done());
      EXPECT_TRUE(log.empty()) << log.text();
      for (int port = 0; port < remesh->GetNumberOfOutputPorts(); ++port)
      {
        vtkDataObject* out = remesh->GetOutputDataObject(port);
        EXPECT_EQ(out->GetNumberOfElements(vtkDataObject::POINT), 0) << port;
        EXPECT_EQ(out->GetNumberOfElements(vtkDataObject::ROW), 0) << port;
        EXPECT_EQ(out->GetFieldData()->GetNumberOfArrays(), 0) << port;
      }
    }
  }
}

TEST(QuadRemeshFilter, ScansOfSharedData)
{
  const std::map<std::string, double> shapes = {{"tubeS", 2}, {"rocker-arm", 0}};
  for (const auto& [name, euler] : shapes)
  {
    const std::string path = "../shared/data/" + name + ".vtp";
    if (!std::ifstream(path))
    {
      GTEST_SKIP() << path << " is absent";
    }
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    vtkNew<vtkQuadRemesh> remesh;
    remesh->SetInputConnection(reader->GetOutputPort());
    remesh->SetNumberOfQuads(300);
    remesh->Update();
    expectClosedQuads(remesh->GetOutput());
    EXPECT_EQ(fieldValue(remesh->GetOutput(), "EulerCharacteristic"), euler);
    EXPECT_GT(fieldValue(remesh->GetOutput(), "MinScaledJacobian"), 0.3);
    EXPECT_LT(fieldValue(remesh->GetOutput(), "MeanAngleDeviation"), 10);
  }
}
