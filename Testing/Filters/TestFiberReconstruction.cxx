#include "FilterTesting.h"

#include "Common/Types.h"
#include "vtkFiberPhantom.h"
#include "vtkFiberReconstruction.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPointDataToCellData.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>

using namespace bsrtest;

namespace
{
/// A tube along x, open at both ends (outer radius 11, lumen 7, from 8 to 63), 500 outside and 1500
/// inside. `first`: where it begins; 0 or less cuts it off at the border of the image.
vtkSmartPointer<vtkImageData> tube(double first = 8.0, double lumen = 7.0)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(72, 32, 32);
  vtkNew<vtkFloatArray> values;
  values->SetName("ct");
  for (int k = 0; k < 32; ++k)
  {
    for (int j = 0; j < 32; ++j)
    {
      for (int i = 0; i < 72; ++i)
      {
        const double r = std::hypot(j - 15.4, k - 15.7);
        const double d = std::max({lumen - r, r - 11.0, first - i, i - 63.2});
        values->InsertNextValue(
          static_cast<float>(1000.0 - 500.0 * std::min(1.0, std::max(-1.0, d))));
      }
    }
  }
  image->GetPointData()->SetScalars(values);
  return image;
}

vtkSmartPointer<vtkImageData> flat(int size, double value)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size, size, size);
  image->AllocateScalars(VTK_FLOAT, 1);
  image->GetPointData()->GetScalars()->SetName("ct");
  image->GetPointData()->GetScalars()->Fill(value);
  return image;
}

void expectEmpty(vtkFiberReconstruction* fiber)
{
  for (int port = 0; port < fiber->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* out = fiber->GetOutputDataObject(port);
    ASSERT_NE(out, nullptr);
    EXPECT_EQ(out->GetNumberOfElements(vtkDataObject::POINT), 0) << "points of port " << port;
    EXPECT_EQ(out->GetNumberOfElements(vtkDataObject::CELL), 0) << "cells of port " << port;
    EXPECT_EQ(out->GetNumberOfElements(vtkDataObject::ROW), 0) << "rows of port " << port;
    EXPECT_EQ(out->GetFieldData()->GetNumberOfArrays(), 0) << "field arrays of port " << port;
  }
}

/// One error that holds `text`, nothing in any output, and the image as it was.
void expectRefused(
  vtkImageData* image, const char* text,
  const std::function<void(vtkFiberReconstruction*)>& set = [](vtkFiberReconstruction*) {})
{
  SCOPED_TRACE(text);
  vtkNew<vtkImageData> before;
  before->DeepCopy(image);
  vtkNew<vtkFiberReconstruction> fiber;
  ErrorLog log(fiber);
  fiber->SetInputDataObject(image);
  set(fiber);
  fiber->Update();
  EXPECT_TRUE(log.saidOnce(text)) << log.text();
  EXPECT_TRUE(log.Warnings.empty()) << log.text();
  expectEmpty(fiber);
  EXPECT_EQ(
    image->GetPointData()->GetNumberOfArrays(), before->GetPointData()->GetNumberOfArrays());
  EXPECT_EQ(image->GetCellData()->GetNumberOfArrays(), before->GetCellData()->GetNumberOfArrays());
  EXPECT_EQ(image->GetFieldData()->GetNumberOfArrays(), 0);
  if (vtkDataArray* values = image->GetPointData()->GetScalars())
  {
    vtkDataArray* old = before->GetPointData()->GetScalars();
    EXPECT_EQ(std::memcmp(values->GetVoidPointer(0), old->GetVoidPointer(0),
                static_cast<std::size_t>(values->GetDataSize() * values->GetDataTypeSize())),
      0);
  }
}

void iso(vtkFiberReconstruction* fiber, double value)
{
  fiber->AutoIsoValueOff();
  fiber->SetIsoValue(value);
}

using Edges = std::vector<std::array<bsr::Vec3, 2>>;

/// The edges between cells of two values of an array.
Edges bordersOf(vtkPolyData* data, const char* array, double first, double second)
{
  vtkDataArray* value = data->GetCellData()->GetArray(array);
  using Corner = std::array<double, 3>;
  std::map<std::pair<Corner, Corner>, double> seen;
  Edges edges;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    vtkPoints* p = data->GetCell(c)->GetPoints();
    for (vtkIdType k = 0; k < p->GetNumberOfPoints(); ++k)
    {
      Corner a;
      Corner b;
      p->GetPoint(k, a.data());
      p->GetPoint((k + 1) % p->GetNumberOfPoints(), b.data());
      const double mine = value->GetComponent(c, 0);
      const double other = seen.emplace(std::minmax(a, b), mine).first->second;
      if ((mine == first && other == second) || (mine == second && other == first))
      {
        edges.push_back({bsr::Vec3(a.data()), bsr::Vec3(b.data())});
      }
    }
  }
  return edges;
}

/// Root mean square distance of the edges' middles to the other edges.
double distance(const Edges& from, const Edges& to)
{
  double squares = 0.0;
  for (const auto& [a, b] : from)
  {
    const bsr::Vec3 p = 0.5 * (a + b);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [c, d] : to)
    {
      const double t =
        std::clamp((p - c).dot(d - c) / std::max((d - c).squaredNorm(), 1e-300), 0.0, 1.0);
      least = std::min(least, (c + t * (d - c) - p).squaredNorm());
    }
    squares += least;
  }
  return std::sqrt(squares / static_cast<double>(from.size()));
}

vtkPolyData* model(vtkFiberReconstruction* fiber)
{
  return vtkPolyData::SafeDownCast(fiber->GetOutputDataObject(vtkFiberReconstruction::MODEL));
}
} // namespace

TEST(FiberReconstruction, RefusesImagesWithoutAnObject)
{
  expectRefused(flat(8, 5.0), "constant");
  expectRefused(flat(1, 3.0), "constant");
  expectRefused(flat(1, 3.0), "", [](auto* f) { iso(f, 1.0); });
  expectRefused(tube(), "iso value", [](auto* f) { iso(f, 1e9); });
  expectRefused(tube(), "iso value", [](auto* f) { iso(f, -1e9); });
  expectRefused(tube(), "iso value", [](auto* f) { iso(f, std::nan("")); });
}

TEST(FiberReconstruction, RefusesWhatIsNoVolumeOfGrayValues)
{
  const auto nan = tube();
  nan->SetScalarComponentFromDouble(3, 3, 3, 0, std::nan(""));
  expectRefused(nan, "NaN");
  vtkNew<vtkPointDataToCellData> toCells;
  toCells->SetInputData(tube());
  toCells->Update();
  expectRefused(vtkImageData::SafeDownCast(toCells->GetOutput()), "Cell Data to Point Data");
  vtkNew<vtkImageData> bare;
  bare->SetDimensions(4, 4, 4);
  expectRefused(bare, "no point array");
  const auto vectors = flat(4, 1.0);
  vectors->AllocateScalars(VTK_FLOAT, 3);
  vectors->GetPointData()->GetScalars()->Fill(1.0);
  expectRefused(vectors, "components");
  expectRefused(tube(), "not found",
    [](auto* f)
    { f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "density"); });
}

TEST(FiberReconstruction, RefusesAbsurdProperties)
{
  const auto radius = [](double r)
  {
    return [r](vtkFiberReconstruction* f)
    {
      f->AutoRadiusOff();
      f->SetRadius(r);
    };
  };
  expectRefused(tube(), "radius", radius(1e3)); // larger than the image by far
  expectRefused(tube(), "radius", radius(-1.0));
  expectRefused(tube(), "radius", radius(std::nan("")));
  expectRefused(tube(), "NumberOfQuads", [](auto* f) { f->SetNumberOfQuads(-3); });
  expectRefused(tube(), "SegmentsPerSide", [](auto* f) { f->SetSegmentsPerSide(1); });
}

TEST(FiberReconstruction, RefusesTheParametersOfLateStagesBeforeTheFirst)
{
  // Of two things wrong, that of the last stage is named: none has run.
  const auto image = tube();
  image->SetScalarComponentFromDouble(3, 3, 3, 0, std::nan(""));
  expectRefused(image, "NumberOfQuads", [](auto* f) { f->SetNumberOfQuads(-3); });
  expectRefused(image, "SegmentsPerSide", [](auto* f) { f->SetSegmentsPerSide(1); });
}

TEST(FiberReconstruction, AnEmptyImageIsOneErrorAtMost)
{
  vtkNew<vtkFiberReconstruction> fiber;
  ErrorLog log(fiber);
  vtkNew<vtkImageData> empty;
  fiber->SetInputDataObject(empty);
  fiber->Update();
  EXPECT_LE(log.Errors.size(), 1U) << log.text();
  expectEmpty(fiber);
}

TEST(FiberReconstruction, ATubeAtTheBorderOfTheImage)
{
  vtkNew<vtkFiberReconstruction> fiber;
  ErrorLog log(fiber);
  fiber->SetNumberOfQuads(80);
  fiber->SetResolution(2);
  fiber->SetInputDataObject(tube(-5.0));
  fiber->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  EXPECT_LE(fieldValue(model(fiber), "MaxNormalJump"), 0.01);
  EXPECT_EQ(fieldValue(model(fiber), "FoldedPatches"), 0.0);
}

TEST(FiberReconstruction, RimsOfOpenEndsAreFollowedWithinHalfAVoxel)
{
  for (int seed : {3, 8})
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    vtkNew<vtkFiberPhantom> phantom;
    phantom->SetDimensions(128, 64, 64);
    phantom->SetSeed(seed);
    phantom->SetHoles(4);
    phantom->SetCollapse(0.9);
    phantom->SetTwist(1.0);
    vtkNew<vtkFiberReconstruction> fiber;
    fiber->SetInputConnection(phantom->GetOutputPort());
    fiber->SetNumberOfQuads(100);
    ErrorLog log(fiber);
    fiber->Update();
    ASSERT_TRUE(log.empty()) << log.text();
    auto* closed =
      vtkPolyData::SafeDownCast(fiber->GetOutputDataObject(vtkFiberReconstruction::CLOSED_SURFACE));
    Edges wanted = bordersOf(closed, "EndRegion", 0.0, 1.0);
    const Edges second = bordersOf(closed, "EndRegion", 0.0, 2.0);
    ASSERT_FALSE(wanted.empty());
    ASSERT_FALSE(second.empty());
    wanted.insert(wanted.end(), second.begin(), second.end());
    const Edges got = bordersOf(model(fiber), "Shell", 0.0, 2.0);
    ASSERT_FALSE(got.empty());
    EXPECT_LE(distance(got, wanted), 0.5);
    EXPECT_LE(distance(wanted, got), 0.5);
    std::printf("rims: %.2f and back %.2f voxels\n", distance(got, wanted), distance(wanted, got));
  }
}

TEST(FiberReconstruction, ARadiusOfHalfTheImageWorks)
{
  vtkNew<vtkFiberReconstruction> fiber;
  ErrorLog log(fiber);
  fiber->SetNumberOfQuads(80);
  fiber->SetResolution(2);
  fiber->AutoRadiusOff();
  fiber->SetRadius(40.0); // larger than the image across the tube
  fiber->SetInputDataObject(tube());
  fiber->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  EXPECT_GT(model(fiber)->GetNumberOfCells(), 0);
  EXPECT_EQ(fieldValue(model(fiber), "FoldedPatches"), 0.0);
}

TEST(FiberReconstruction, OfSeveralObjectsTheLargestIsTaken)
{
  const auto image = tube();
  for (int k = 0; k < 4; ++k)
  {
    for (int j = 0; j < 4; ++j)
    {
      for (int i = 0; i < 4; ++i)
      {
        image->SetScalarComponentFromDouble(66 + i, 1 + j, 1 + k, 0, 1500.0);
      }
    }
  }
  vtkNew<vtkFiberReconstruction> fiber;
  ErrorLog log(fiber);
  fiber->SetNumberOfQuads(80);
  fiber->SetResolution(2);
  fiber->SetInputDataObject(image);
  fiber->Update();
  EXPECT_TRUE(log.Errors.empty()) << log.text();
  ASSERT_GT(model(fiber)->GetNumberOfCells(), 0);
  double box[6];
  model(fiber)->GetBounds(box);
  EXPECT_LT(box[1], 65.0); // the speck is no part of the model
  EXPECT_EQ(fieldValue(model(fiber), "FoldedPatches"), 0.0);
}

TEST(FiberReconstruction, ASolidRodGetsTheOuterShellAndSaysSo)
{
  vtkNew<vtkFiberReconstruction> fiber;
  ErrorLog log(fiber);
  fiber->SetNumberOfQuads(80);
  fiber->SetResolution(2);
  fiber->SetInputDataObject(tube(8.0, -1.0));
  fiber->Update();
  EXPECT_TRUE(log.Errors.empty()) << log.text();
  EXPECT_EQ(fieldValue(model(fiber), "Shells"), 1.0);
}

TEST(FiberReconstruction, CanBeCancelledInEveryStage)
{
  // The stages' shares of the progress: Closing to 0.25, the surfaces to 0.3, EDTClassify to 0.45,
  // FiberEnds to 0.5, QuadRemesh to 0.7, PartitionToQuads to 0.75, BSplineG1Fit to 1.
  for (const double at : {0.0, 0.1, 0.26, 0.31, 0.46, 0.52, 0.71, 0.76, 0.98})
  {
    SCOPED_TRACE(at);
    vtkNew<vtkFiberReconstruction> fiber;
    fiber->SetNumberOfQuads(80);
    fiber->SetResolution(2);
    fiber->SetInputDataObject(tube());
    const AbortAt abort(fiber, at);
    ErrorLog log(fiber);
    fiber->Update();
    EXPECT_TRUE(abort.done());
    EXPECT_TRUE(log.empty()) << log.text();
    expectEmpty(fiber);
  }
}
