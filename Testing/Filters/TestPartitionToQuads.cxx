#include "FilterTesting.h"
#include "vtkPartitionToQuads.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkPlaneSource.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkUnstructuredGrid.h>

using bsrtest::ErrorLog;

namespace
{
/// A unit square of n x n quads in z = 0.
vtkSmartPointer<vtkPolyData> plane(int n)
{
  vtkNew<vtkPlaneSource> source;
  source->SetResolution(n, n);
  source->SetOrigin(0, 0, 0);
  source->SetPoint1(1, 0, 0);
  source->SetPoint2(0, 1, 0);
  source->Update();
  return source->GetOutput();
}

template <class DataSet>
vtkSmartPointer<DataSet> onePoint(double x, double y, double z)
{
  auto d = vtkSmartPointer<DataSet>::New();
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(x, y, z);
  d->SetPoints(points);
  vtkNew<vtkIntArray> a;
  a->SetName("Side");
  a->InsertNextValue(1);
  d->GetPointData()->AddArray(a);
  return d;
}
} // namespace

TEST(PartitionToQuadsFilter, AddsArraysAndKeepsTheInput)
{
  vtkNew<vtkPartitionToQuads> filter;
  filter->SetInputData(0, onePoint<vtkPolyData>(0.55, 0.30, 0.25));
  filter->SetInputData(1, plane(4));
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkPointData* pd = filter->GetOutput()->GetPointData();
  ASSERT_TRUE(pd->GetArray("Side") && pd->GetArray("QuadId") && pd->GetArray("UV"));
  EXPECT_EQ(pd->GetArray("QuadId")->GetDataType(), VTK_INT);
  EXPECT_EQ(pd->GetArray("QuadId")->GetTuple1(0), 1 * 4 + 2);
  EXPECT_NEAR(pd->GetArray("UV")->GetComponent(0, 0), 0.2, 1e-6);
  EXPECT_NEAR(pd->GetArray("UV")->GetComponent(0, 1), 0.2, 1e-6);
  EXPECT_NEAR(pd->GetArray("QuadDistance")->GetTuple1(0), 0.25, 1e-12);
  EXPECT_EQ(bsrtest::fieldValue(filter->GetOutput(), "EmptyQuads"), 15.0);
}

TEST(PartitionToQuadsFilter, TakesAnyPointSet)
{
  vtkNew<vtkPartitionToQuads> filter;
  filter->SetInputData(0, onePoint<vtkUnstructuredGrid>(0.55, 0.30, 0.25));
  filter->SetInputData(1, plane(2));
  filter->Update();
  auto* out = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(out);
  EXPECT_TRUE(out->GetPointData()->GetArray("QuadId"));
}

TEST(PartitionToQuadsFilter, MatchNormalsTurnsTheInnerWall)
{
  auto point = onePoint<vtkPolyData>(0.5, 0.5, -0.8);
  vtkNew<vtkDoubleArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->InsertNextTuple3(0, 0, -1);
  point->GetPointData()->SetNormals(normals);
  vtkNew<vtkPolyData> walls;
  vtkNew<vtkPoints> corners;
  vtkNew<vtkCellArray> quads;
  for (const double z : {0.0, -1.0})
  {
    corners->InsertNextPoint(0, 0, z);
    corners->InsertNextPoint(1, 0, z);
    corners->InsertNextPoint(1, 1, z);
    corners->InsertNextPoint(0, 1, z);
  }
  const vtkIdType up[4] = {0, 1, 2, 3};
  const vtkIdType down[4] = {7, 6, 5, 4};
  quads->InsertNextCell(4, up);
  quads->InsertNextCell(4, down);
  walls->SetPoints(corners);
  walls->SetPolys(quads);
  vtkNew<vtkPartitionToQuads> filter;
  filter->SetInputData(0, point);
  filter->SetInputData(1, walls);
  filter->MatchNormalsOff();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("QuadId")->GetTuple1(0), 1.0);
  filter->MatchNormalsOn();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("QuadId")->GetTuple1(0), 0.0);
}

TEST(PartitionToQuadsFilter, BadInputGivesOneErrorAndNoOutput)
{
  const auto refused = [](vtkPointSet* points, vtkPolyData* quads, const char* text)
  {
    vtkNew<vtkPartitionToQuads> filter;
    filter->SetInputData(0, points);
    filter->SetInputData(1, quads);
    ErrorLog log(filter);
    filter->Update();
    EXPECT_TRUE(log.saidOnce(text)) << log.text();
    auto* out = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
    EXPECT_TRUE(!out || out->GetNumberOfPoints() == 0);
  };
  vtkNew<vtkSphereSource> triangles;
  triangles->Update();
  const auto point = onePoint<vtkPolyData>(0, 0, 0);
  refused(point, triangles->GetOutput(), "corners");
  refused(point, vtkNew<vtkPolyData>(), "no quads");
  refused(vtkNew<vtkPolyData>(), plane(2), "no point");
  refused(onePoint<vtkPolyData>(NAN, 0, 0), plane(2), "NaN");
}

namespace
{
/// A sphere of triangles and the six quads of a cube around it.
std::pair<vtkSmartPointer<vtkPolyData>, vtkSmartPointer<vtkPolyData>> sphereAndCube()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(30);
  sphere->SetRadius(1.0);
  sphere->Update();
  auto cube = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> corners;
  vtkNew<vtkCellArray> quads;
  for (int k = 0; k < 8; ++k)
  {
    const double s = 1.0 / std::sqrt(3.0);
    corners->InsertNextPoint(k & 1 ? s : -s, k & 2 ? s : -s, k & 4 ? s : -s);
  }
  const vtkIdType q[6][4] = {
    {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& c : q)
  {
    quads->InsertNextCell(4, c);
  }
  cube->SetPoints(corners);
  cube->SetPolys(quads);
  return {sphere->GetOutput(), cube};
}
} // namespace

TEST(PartitionToQuadsFilter, GeodesicGivesANetworkOfEvenSides)
{
  const auto [sphere, cube] = sphereAndCube();
  vtkNew<vtkPartitionToQuads> filter;
  filter->SetMethod(vtkPartitionToQuads::GEODESIC);
  filter->SetSamplesPerSide(9);
  filter->SetInputData(0, sphere);
  filter->SetInputData(1, cube);
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkPointSet* out = filter->GetOutput();
  EXPECT_EQ(out->GetNumberOfPoints(), sphere->GetNumberOfPoints());
  for (const char* name : {"FailedQuads", "FoldedTriangles", "EmptyQuads"})
  {
    EXPECT_EQ(bsrtest::fieldValue(out, name), 0.0) << name;
  }
  EXPECT_LT(bsrtest::fieldValue(out, "QuadDistanceMax"), 1e-6);
  auto* network = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_TRUE(network);
  EXPECT_EQ(network->GetNumberOfLines(), 12);
  EXPECT_EQ(network->GetNumberOfPoints(), 12 * 9);
}

TEST(PartitionToQuadsFilter, GeodesicTakesPointsOverASurface)
{
  const auto [sphere, cube] = sphereAndCube();
  vtkNew<vtkPartitionToQuads> filter;
  filter->SetMethod(vtkPartitionToQuads::GEODESIC);
  filter->SetInputData(0, onePoint<vtkUnstructuredGrid>(0.1, 0.2, 1.3));
  filter->SetInputData(1, cube);
  filter->SetInputData(2, sphere);
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  auto* out = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(out);
  EXPECT_EQ(out->GetPointData()->GetArray("QuadId")->GetTuple1(0), 1.0);
  // Without triangles the nearest quad is taken, and a warning says so.
  vtkNew<vtkPartitionToQuads> bare;
  bare->SetMethod(vtkPartitionToQuads::GEODESIC);
  bare->SetInputData(0, onePoint<vtkPolyData>(0.1, 0.2, 1.3));
  bare->SetInputData(1, cube);
  ErrorLog warned(bare);
  bare->Update();
  ASSERT_EQ(warned.Warnings.size(), 1U);
  EXPECT_NE(warned.Warnings[0].find("Surface"), std::string::npos);
  EXPECT_EQ(bare->GetOutput()->GetPointData()->GetArray("QuadId")->GetTuple1(0), 1.0);
}

TEST(PartitionToQuadsFilter, CancelLeavesNothing)
{
  const auto [sphere, cube] = sphereAndCube();
  for (const int method : {vtkPartitionToQuads::NEAREST_QUAD, vtkPartitionToQuads::GEODESIC})
  {
    vtkNew<vtkPartitionToQuads> filter;
    filter->SetMethod(method);
    filter->SetInputData(0, sphere);
    filter->SetInputData(1, cube);
    const bsrtest::AbortAt abort(filter, 0.0);
    ErrorLog log(filter);
    filter->Update();
    EXPECT_TRUE(abort.done());
    EXPECT_TRUE(log.empty()) << log.text();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
    EXPECT_EQ(vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1))->GetNumberOfPoints(), 0);
  }
}
