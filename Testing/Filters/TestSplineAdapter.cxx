#include "Adapters/BSRSplineAdapter.h"
#include "SampleModels.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFeatureEdges.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <gtest/gtest.h>

#include <limits>

using namespace bsr;

namespace
{
void fill(const SplineModel& m, vtkPolyData* out)
{
  Monitor monitor;
  const Status s = splineSurfaceTo(m, {}, monitor, out);
  ASSERT_TRUE(s.isOk()) << s.message();
}

void expectSame(const SplineModel& a, const SplineModel& b)
{
  ASSERT_EQ(a.Patches.size(), b.Patches.size());
  for (std::size_t i = 0; i < a.Patches.size(); ++i)
  {
    EXPECT_EQ(a.Patches[i].Side, b.Patches[i].Side);
    EXPECT_EQ(a.Patches[i].CountV, b.Patches[i].CountV);
    EXPECT_EQ(a.Patches[i].FirstKnotV, b.Patches[i].FirstKnotV);
  }
  EXPECT_EQ(a.ControlPoints, b.ControlPoints);
  EXPECT_EQ(a.Knots, b.Knots);
  EXPECT_EQ(a.Neighbors, b.Neighbors);
}
} // namespace

TEST(SplineAdapter, RoundTripThroughAFileIsExact)
{
  const SplineModel m = samples::tube();
  vtkNew<vtkPolyData> surface;
  fill(m, surface);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(surface);
  writer->WriteToOutputStringOn();
  writer->Write();
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(writer->GetOutputString());
  reader->Update();
  const auto back = splineModelFrom(reader->GetOutput());
  ASSERT_TRUE(back.isOk()) << back.status().message();
  expectSame(m, *back);
}

TEST(SplineAdapter, SurfaceCarriesTheContractsArrays)
{
  const SplineModel m = samples::tube();
  vtkNew<vtkPolyData> surface;
  vtkNew<vtkDoubleArray> other;
  other->SetName("RMS");
  other->InsertNextValue(3.0);
  surface->GetFieldData()->AddArray(other);
  fill(m, surface);
  EXPECT_TRUE(surface->GetFieldData()->GetArray("RMS"));
  ASSERT_TRUE(surface->GetPointData()->GetNormals());
  EXPECT_STREQ(surface->GetPointData()->GetNormals()->GetName(), "Normals");
  ASSERT_TRUE(surface->GetPointData()->GetArray("UV"));
  EXPECT_EQ(surface->GetPointData()->GetArray("UV")->GetNumberOfComponents(), 2);
  vtkDataArray* patch = surface->GetCellData()->GetArray("PatchId");
  vtkDataArray* shell = surface->GetCellData()->GetArray("Shell");
  ASSERT_TRUE(patch && shell);
  EXPECT_EQ(patch->GetDataType(), VTK_INT);
  EXPECT_EQ(shell->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_EQ(shell->GetRange()[1], 2.0);
  EXPECT_EQ(patch->GetRange()[1], static_cast<double>(m.Patches.size() - 1));
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->FeatureEdgesOff();
  edges->BoundaryEdgesOn();
  edges->NonManifoldEdgesOn();
  edges->Update();
  EXPECT_EQ(edges->GetOutput()->GetNumberOfCells(), 0);
}

TEST(SplineAdapter, ControlNetHasAQuadForEachMeshOfTheNet)
{
  const SplineModel m = samples::ball();
  vtkNew<vtkPolyData> net;
  controlNetTo(m, net);
  EXPECT_EQ(net->GetNumberOfPoints(), 6 * 16);
  EXPECT_EQ(net->GetNumberOfPolys(), 6 * 9);
  EXPECT_TRUE(net->GetCellData()->GetArray("PatchId") && net->GetCellData()->GetArray("Shell"));
}

TEST(SplineAdapter, WhatIsNoModelIsRefused)
{
  EXPECT_FALSE(hasSplineModel(nullptr));
  EXPECT_FALSE(splineModelFrom(nullptr).isOk());
  vtkNew<vtkPolyData> plain;
  EXPECT_FALSE(hasSplineModel(plain));
  const auto none = splineModelFrom(plain);
  EXPECT_NE(none.status().message().find("SplinePatches"), std::string::npos);
  for (const char* name :
    {"SplinePatches", "SplineControlPoints", "SplineKnots", "SplineNeighbors", "SplineVersion"})
  {
    vtkNew<vtkPolyData> surface;
    fill(samples::ball(), surface);
    surface->GetFieldData()->RemoveArray(name);
    const auto lacking = splineModelFrom(surface);
    EXPECT_EQ(lacking.status().code(), StatusCode::InvalidInput);
    EXPECT_NE(lacking.status().message().find(name), std::string::npos);
    vtkNew<vtkFloatArray> wrong;
    wrong->SetName(name);
    wrong->SetNumberOfComponents(3);
    wrong->SetNumberOfTuples(2);
    wrong->Fill(std::numeric_limits<float>::quiet_NaN());
    surface->GetFieldData()->AddArray(wrong);
    EXPECT_EQ(splineModelFrom(surface).status().code(), StatusCode::InvalidInput);
  }
}

TEST(SplineAdapter, AbsurdNumbersAreRefused)
{
  for (const double v : {-1.0, 1e300, std::numeric_limits<double>::quiet_NaN(), 4e9})
  {
    for (int component = 0; component < 8; ++component)
    {
      vtkNew<vtkPolyData> surface;
      fill(samples::ball(), surface);
      vtkDataArray* patches = surface->GetFieldData()->GetArray("SplinePatches");
      vtkNew<vtkDoubleArray> harmed;
      harmed->DeepCopy(patches);
      harmed->SetName("SplinePatches");
      harmed->SetComponent(2, component, v);
      surface->GetFieldData()->AddArray(harmed);
      EXPECT_EQ(splineModelFrom(surface).status().code(), StatusCode::InvalidInput);
    }
  }
}
