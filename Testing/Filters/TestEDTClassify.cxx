#include "FilterTesting.h"

#include "vtkClosing.h"
#include "vtkEDTClassify.h"
#include "vtkFiberEnds.h"
#include "vtkFiberPhantom.h"

#include <vtkCellData.h>
#include <vtkFeatureEdges.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkStaticCellLocator.h>

#include <algorithm>

using namespace bsrtest;

namespace
{
/// A hollow tube along x (outer radius 13, inner 9, from 8 to 71 voxels) with a hole of radius 3 in
/// its side, anisotropic and off the origin.
vtkSmartPointer<vtkImageData> tubeImage(bool solid = false)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(5, 84, -2, 37, 3, 32);
  image->SetSpacing(0.5, 0.5, 0.65);
  image->SetOrigin(10.0, -3.0, 2.0);
  image->AllocateScalars(VTK_FLOAT, 1);
  for (int k = 0; k < 30; ++k)
  {
    for (int j = 0; j < 40; ++j)
    {
      for (int i = 0; i < 80; ++i)
      {
        const double z = 1.3 * (k - 14.4);
        const double r = std::hypot(j - 19.6, z);
        const double lumen = solid ? -1.0 : 9.0 - r;
        const double hole = solid || j < 20 ? -1.0 : 3.0 - std::hypot(i - 40.0, z);
        const double d = std::max({lumen, hole, r - 13.0, 8.2 - i, i - 71.1});
        static_cast<float*>(image->GetScalarPointer(i + 5, j - 2, k + 3))[0] =
          static_cast<float>(100.0 - 50.0 * std::min(1.0, std::max(-1.0, d)));
      }
    }
  }
  return image;
}

/// The chain from an image to the ends.
struct Chain
{
  vtkNew<vtkClosing> Closing;
  vtkNew<vtkFlyingEdges3D> Raw;
  vtkNew<vtkEDTClassify> Classify;
  vtkNew<vtkFlyingEdges3D> Closed;
  vtkNew<vtkFiberEnds> Ends;

  explicit Chain(vtkImageData* image, double radius = 12.0)
  {
    this->Closing->SetInputData(image);
    this->Closing->SetAutoIsoValue(false);
    this->Closing->SetIsoValue(100.0);
    this->Closing->SetAutoRadius(false);
    this->Closing->SetRadius(radius);
    this->Raw->SetInputData(image);
    this->Raw->SetValue(0, 100.0);
    this->Classify->SetInputConnection(0, this->Raw->GetOutputPort());
    this->Classify->SetInputConnection(1, this->Closing->GetOutputPort());
    this->Closed->SetInputConnection(this->Closing->GetOutputPort());
    this->Closed->SetValue(0, 0.0);
    this->Ends->SetInputConnection(0, this->Closed->GetOutputPort());
    this->Ends->SetInputConnection(1, this->Classify->GetOutputPort());
  }
};

double field(vtkDataObject* data, const char* name)
{
  vtkDataArray* a = data->GetFieldData()->GetArray(name);
  return a && a->GetNumberOfTuples() > 0 ? a->GetComponent(0, 0) : -1.0;
}

/// Share of the points of the tube's walls, away from ends and hole, with the right side.
double rightShare(vtkPolyData* surface)
{
  vtkDataArray* side = surface->GetPointData()->GetArray("Side");
  double right = 0.0;
  double all = 0.0;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    const double x = (p[0] - 10.0) / 0.5 - 5.0;
    const double y = (p[1] + 3.0) / 0.5 + 2.0 - 19.6;
    const double z = 1.3 * ((p[2] - 2.0) / 0.65 - 3.0 - 14.4);
    const double r = std::hypot(y, z);
    if (x < 14.0 || x > 65.0 || (y > 0.0 && std::hypot(x - 40.0, z) < 7.0))
    {
      continue;
    }
    all += 1.0;
    right += side->GetComponent(i, 0) == (r < 11.0 ? 1.0 : 0.0);
  }
  return all > 0.0 ? right / all : 0.0;
}
} // namespace

TEST(EDTClassify, TellsTheWallsOfATubeWithAHole)
{
  Chain chain(tubeImage());
  chain.Ends->Update();
  vtkPolyData* surface = chain.Classify->GetOutput();
  ASSERT_NE(surface->GetPointData()->GetArray("Side"), nullptr);
  EXPECT_EQ(surface->GetPointData()->GetArray("Side")->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_EQ(surface->GetPointData()->GetArray("Depth")->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(field(surface, "Lumen"), 1.0);
  EXPECT_NEAR(field(surface, "LumenRadius"), 9.0, 1.0);
  EXPECT_GT(rightShare(surface), 0.98);
}

TEST(EDTClassify, DepthTellsTheWallsToo)
{
  Chain chain(tubeImage());
  chain.Classify->SetMethod(vtkEDTClassify::DEPTH);
  chain.Classify->Update();
  EXPECT_GT(rightShare(chain.Classify->GetOutput()), 0.98);
  chain.Classify->AutoDepthThresholdOn();
  chain.Classify->Update();
  EXPECT_GT(rightShare(chain.Classify->GetOutput()), 0.98);
}

TEST(EDTClassify, ASolidRodHasNoLumenAndNoEnds)
{
  Chain chain(tubeImage(true), 3.0);
  chain.Ends->Update();
  EXPECT_EQ(field(chain.Classify->GetOutput(), "Lumen"), 0.0);
  double range[2];
  chain.Classify->GetOutput()->GetPointData()->GetArray("Side")->GetRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_NE(range[1], 1.0);
  EXPECT_EQ(field(chain.Ends->GetOutput(), "OpenEnds"), 0.0);
}

TEST(EDTClassify, NamesWhatIsWrongWithItsInput)
{
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkEDTClassify> filter;
  filter->SetInputConnection(0, sphere->GetOutputPort());
  filter->SetInputData(1, tubeImage());
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.saidOnce("SignedDistance")) << log.text();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(EDTClassify, AnEmptySurfaceIsAnError)
{
  Chain chain(tubeImage());
  vtkNew<vtkPolyData> empty;
  chain.Classify->SetInputData(0, empty);
  ErrorLog log(chain.Classify);
  chain.Classify->Update();
  EXPECT_FALSE(log.empty());
  EXPECT_EQ(chain.Classify->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(EDTClassify, CancelLeavesNothing)
{
  for (const double at : {0.0, 0.4, 0.8})
  {
    Chain chain(tubeImage());
    chain.Closing->Update();
    const AbortAt abort(chain.Classify, at);
    ErrorLog log(chain.Classify);
    chain.Classify->Update();
    EXPECT_TRUE(abort.done());
    EXPECT_TRUE(log.empty()) << log.text();
    EXPECT_EQ(chain.Classify->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(chain.Classify->GetOutput()->GetFieldData()->GetNumberOfArrays(), 0);
  }
}

TEST(FiberEndsFilter, CancelLeavesNothing)
{
  Chain chain(tubeImage());
  chain.Classify->Update();
  const AbortAt abort(chain.Ends, 0.0);
  ErrorLog log(chain.Ends);
  chain.Ends->Update();
  EXPECT_TRUE(abort.done());
  EXPECT_TRUE(log.empty()) << log.text();
  for (int port = 0; port < 2; ++port)
  {
    EXPECT_EQ(chain.Ends->GetOutput(port)->GetNumberOfPoints(), 0);
    EXPECT_EQ(chain.Ends->GetOutput(port)->GetFieldData()->GetNumberOfArrays(), 0);
  }
}

TEST(FiberEndsFilter, MarksTheTwoEndsButNotTheHole)
{
  Chain chain(tubeImage());
  chain.Ends->Update();
  vtkPolyData* out = chain.Ends->GetOutput(0);
  EXPECT_EQ(field(out, "OpenEnds"), 2.0);
  vtkDataArray* region = out->GetCellData()->GetArray("EndRegion");
  ASSERT_NE(region, nullptr);
  EXPECT_EQ(region->GetDataType(), VTK_INT);
  double range[2];
  region->GetRange(range);
  EXPECT_EQ(range[1], 2.0);
  EXPECT_EQ(chain.Ends->GetOutput(1)->GetNumberOfLines(), 2);
  vtkNew<vtkFeatureEdges> open;
  open->SetInputData(out);
  open->FeatureEdgesOff();
  open->Update();
  EXPECT_EQ(open->GetOutput()->GetNumberOfCells(), 0); // closed and manifold
}

TEST(FiberEndsFilter, NeedsTheClassifiedSurface)
{
  Chain chain(tubeImage());
  chain.Ends->SetInputConnection(1, chain.Raw->GetOutputPort());
  ErrorLog log(chain.Ends);
  chain.Ends->Update();
  EXPECT_TRUE(log.saidOnce("LumenMouths")) << log.text();
}

TEST(FiberEnds, RimsFollowTheTrueRims)
{
  vtkNew<vtkFiberPhantom> phantom;
  phantom->SetSeed(14); // a deep cap at one end, a fibril behind the rim of the other
  phantom->Update();
  auto* image = vtkImageData::SafeDownCast(phantom->GetOutputDataObject(0));
  auto* walls = vtkPolyData::SafeDownCast(phantom->GetOutputDataObject(1));
  Chain chain(image);
  const double iso = field(image, "IsoValue");
  chain.Closing->SetIsoValue(iso);
  chain.Closing->SetAutoRadius(true);
  chain.Raw->SetValue(0, iso);
  chain.Ends->Update();
  ASSERT_EQ(field(chain.Ends->GetOutput(), "OpenEnds"), 2.0);
  vtkNew<vtkStaticCellLocator> rims;
  rims->SetDataSet(vtkPolyData::SafeDownCast(chain.Ends->GetOutputDataObject(1)));
  rims->BuildLocator();
  for (const double end : {1.0, 2.0})
  {
    double squares = 0.0;
    double count = 0.0;
    for (vtkIdType i = 0; i < walls->GetNumberOfPoints(); ++i)
    {
      if (walls->GetPointData()->GetArray("End")->GetComponent(i, 0) == end &&
          walls->GetPointData()->GetArray("Side")->GetComponent(i, 0) == 0.0)
      {
        double closest[3];
        vtkIdType cell = -1;
        int sub = 0;
        double square = 0.0;
        rims->FindClosestPoint(walls->GetPoint(i), closest, cell, sub, square);
        squares += square;
        count += 1.0;
      }
    }
    ASSERT_GT(count, 0.0);
    EXPECT_LE(std::sqrt(squares / count), 0.85) << "voxels, end " << end;
    RecordProperty(
      "RimRMS" + std::to_string(static_cast<int>(end)), std::to_string(std::sqrt(squares / count)));
  }
}
