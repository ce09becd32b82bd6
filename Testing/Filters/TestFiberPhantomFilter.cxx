#include "FilterTesting.h"

#include "vtkFiberPhantom.h"

#include <vtkCallbackCommand.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedShortArray.h>

#include <sstream>

namespace
{
void makeSmall(vtkFiberPhantom* f)
{
  f->SetDimensions(96, 48, 48);
}

vtkPolyData* walls(vtkFiberPhantom* f)
{
  return vtkPolyData::SafeDownCast(f->GetOutputDataObject(1));
}
} // namespace

TEST(FiberPhantomFilter, DefaultIsAnImageAndItsWalls)
{
  vtkNew<vtkFiberPhantom> f;
  bsrtest::ErrorLog log(f);
  f->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkImageData* image = f->GetOutput();
  int d[3];
  image->GetDimensions(d);
  EXPECT_EQ(d[0], 192);
  EXPECT_EQ(d[1], 96);
  EXPECT_EQ(d[2], 96);
  auto* ct = vtkUnsignedShortArray::SafeDownCast(image->GetPointData()->GetScalars());
  ASSERT_NE(ct, nullptr);
  EXPECT_STREQ(ct->GetName(), "CT");
  EXPECT_EQ(ct->GetNumberOfTuples(), 192 * 96 * 96);
  EXPECT_EQ(bsrtest::fieldValue(image, "IsoValue"), 19500.0);
  EXPECT_EQ(bsrtest::fieldValue(walls(f), "Seed"), 1.0);

  vtkPolyData* truth = walls(f);
  EXPECT_EQ(truth->GetPointData()->GetArray("Side")->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_EQ(truth->GetPointData()->GetArray("Side")->GetRange()[1], 1.0);
  EXPECT_EQ(truth->GetPointData()->GetArray("End")->GetDataType(), VTK_INT);
  EXPECT_EQ(truth->GetPointData()->GetArray("End")->GetRange()[1], 2.0);
  EXPECT_GT(truth->GetNumberOfPolys(), 10000);
}

TEST(FiberPhantomFilter, SpacingScalesImageAndWalls)
{
  vtkNew<vtkFiberPhantom> one;
  makeSmall(one);
  one->Update();
  vtkNew<vtkFiberPhantom> half;
  makeSmall(half);
  half->SetSpacing(0.5, 0.5, 0.5);
  half->Update();
  EXPECT_EQ(half->GetOutput()->GetSpacing()[0], 0.5);
  double a[6];
  double b[6];
  walls(one)->GetBounds(a);
  walls(half)->GetBounds(b);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_NEAR(b[i], 0.5 * a[i], 1e-9);
  }
}

TEST(FiberPhantomFilter, PieceHasTheVoxelsOfTheWhole)
{
  vtkNew<vtkFiberPhantom> f;
  makeSmall(f);
  f->Update();
  vtkNew<vtkImageData> whole;
  whole->DeepCopy(f->GetOutput());

  vtkNew<vtkFiberPhantom> g;
  makeSmall(g);
  const int extent[6] = {10, 50, 0, 47, 20, 30};
  EXPECT_TRUE(g->UpdateExtent(extent));
  int got[6];
  g->GetOutput()->GetExtent(got);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(got[i], extent[i]);
  }
  for (int k = extent[4]; k <= extent[5]; ++k)
  {
    for (int j = extent[2]; j <= extent[3]; ++j)
    {
      for (int i = extent[0]; i <= extent[1]; ++i)
      {
        ASSERT_EQ(g->GetOutput()->GetScalarComponentAsDouble(i, j, k, 0),
          whole->GetScalarComponentAsDouble(i, j, k, 0));
      }
    }
  }
}

TEST(FiberPhantomFilter, TwoPiecesTogetherAreTheWhole)
{
  vtkIdType voxels = 0;
  vtkIdType points = 0;
  for (int piece = 0; piece < 2; ++piece)
  {
    vtkNew<vtkFiberPhantom> f;
    makeSmall(f);
    bsrtest::ErrorLog log(f);
    f->UpdatePiece(piece, 2, 0);
    EXPECT_TRUE(log.empty()) << log.text();
    voxels += f->GetOutput()->GetNumberOfCells();
    vtkNew<vtkFiberPhantom> g;
    makeSmall(g);
    g->UpdateInformation();
    g->GetOutputInformation(1)->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), 2);
    g->GetOutputInformation(1)->Set(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER(), piece);
    g->Update(1);
    points += walls(g)->GetNumberOfPoints();
  }
  EXPECT_EQ(voxels, 95 * 47 * 47);
  vtkNew<vtkFiberPhantom> f;
  makeSmall(f);
  f->Update();
  EXPECT_EQ(points, walls(f)->GetNumberOfPoints());
}

TEST(FiberPhantomFilter, ClosedEndsHaveNoRim)
{
  vtkNew<vtkFiberPhantom> f;
  makeSmall(f);
  f->OpenEndsOff();
  f->Update();
  EXPECT_EQ(walls(f)->GetPointData()->GetArray("End")->GetRange()[1], 0.0);
}

TEST(FiberPhantomFilter, AbsurdPropertiesGiveOneErrorAndNoOutput)
{
  vtkNew<vtkFiberPhantom> f;
  makeSmall(f);
  f->Update();
  bsrtest::ErrorLog log(f);
  f->SetDimensions(-5, 48, 48);
  f->Update();
  EXPECT_TRUE(log.saidOnce("Dimensions is -5; choose 24 to 8192")) << log.text();
  EXPECT_EQ(f->GetOutput()->GetNumberOfPoints(), 0);
  log.clear();
  makeSmall(f);
  f->SetNoise(std::nan(""));
  f->Update();
  EXPECT_TRUE(log.saidOnce("Noise is nan")) << log.text();
  log.clear();
  f->SetNoise(0.1);
  f->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  EXPECT_EQ(f->GetOutput()->GetNumberOfPoints(), 96 * 48 * 48);
}

TEST(FiberPhantomFilter, ReportsProgressAndStopsOnAbort)
{
  vtkNew<vtkFiberPhantom> f;
  makeSmall(f);
  struct Seen
  {
    int Events = 0;
    double Last = 0.0;
    bool Grows = true;
  } seen;
  vtkNew<vtkCallbackCommand> note;
  note->SetClientData(&seen);
  note->SetCallback(
    [](vtkObject*, unsigned long, void* client, void* data)
    {
      auto* s = static_cast<Seen*>(client);
      const double share = *static_cast<double*>(data);
      ++s->Events;
      s->Grows = s->Grows && share >= s->Last - 1e-12;
      s->Last = share;
    });
  f->AddObserver(vtkCommand::ProgressEvent, note);
  f->Update();
  EXPECT_GT(seen.Events, 10);
  EXPECT_TRUE(seen.Grows);

  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1); });
  f->AddObserver(vtkCommand::ProgressEvent, stop);
  f->SetSeed(9);
  bsrtest::ErrorLog log(f);
  f->Update();
  EXPECT_EQ(f->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
  EXPECT_TRUE(log.Errors.empty()) << log.text();
}

TEST(FiberPhantomFilter, PrintsItsProperties)
{
  vtkNew<vtkFiberPhantom> f;
  std::ostringstream text;
  f->Print(text);
  EXPECT_NE(text.str().find("WallThickness: 0.28"), std::string::npos);
}
