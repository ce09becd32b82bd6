#include "FilterTesting.h"

#include "vtkFiberPhantom.h"
#include "vtkMedian.h"

#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

namespace
{
/// 5 x 5 x 5 zeros with a spike in the middle.
vtkNew<vtkImageData> spike()
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(5, 5, 5);
  vtkNew<vtkDoubleArray> values;
  values->SetName("Values");
  values->SetNumberOfTuples(125);
  values->Fill(0.0);
  values->SetValue(62, 100.0);
  image->GetPointData()->SetScalars(values);
  return image;
}
} // namespace

TEST(Median, RemovesASpike)
{
  const auto image = spike();
  vtkNew<vtkMedian> f;
  f->SetInputData(image);
  f->Update();
  EXPECT_EQ(f->GetKernelSize()[0], 5);
  EXPECT_EQ(f->GetOutput()->GetScalarRange()[1], 0.0);
  EXPECT_STREQ(f->GetOutput()->GetPointData()->GetScalars()->GetName(), "Values");
}

TEST(Median, EmptyNameIsTheActiveArray)
{
  const auto image = spike();
  vtkNew<vtkMedian> f;
  f->SetInputData(image);
  f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
  bsrtest::ErrorLog log(f);
  f->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  EXPECT_EQ(f->GetOutput()->GetScalarRange()[1], 0.0);
}

TEST(Median, MissingArrayIsOneError)
{
  const auto image = spike();
  vtkNew<vtkMedian> f;
  f->SetInputData(image);
  f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Nothing");
  bsrtest::ErrorLog log(f);
  f->Update();
  EXPECT_TRUE(log.saidOnce("no such point array")) << log.text();
  EXPECT_EQ(f->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
}

TEST(Median, AbsurdBoxIsOneError)
{
  const auto image = spike();
  vtkNew<vtkMedian> f;
  f->SetInputData(image);
  f->SetKernelSize(0, 5, 5);
  bsrtest::ErrorLog log(f);
  f->Update();
  EXPECT_TRUE(log.saidOnce("Kernel Size must be")) << log.text();
}

TEST(Median, EmptyVolumeIsOneError)
{
  vtkNew<vtkImageData> image;
  vtkNew<vtkMedian> f;
  f->SetInputData(image);
  bsrtest::ErrorLog log(f);
  f->Update();
  EXPECT_LE(log.Errors.size(), 1U) << log.text();
  EXPECT_EQ(f->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(Median, WorksOnAPiece)
{
  vtkNew<vtkFiberPhantom> source;
  source->SetDimensions(48, 32, 32);
  vtkNew<vtkMedian> whole;
  whole->SetInputConnection(source->GetOutputPort());
  whole->Update();
  vtkNew<vtkFiberPhantom> other;
  other->SetDimensions(48, 32, 32);
  vtkNew<vtkMedian> part;
  part->SetInputConnection(other->GetOutputPort());
  const int extent[6] = {10, 20, 5, 25, 0, 31};
  part->UpdateExtent(extent);
  for (int i = 10; i <= 20; ++i)
  {
    EXPECT_EQ(part->GetOutput()->GetScalarComponentAsDouble(i, 12, 20, 0),
      whole->GetOutput()->GetScalarComponentAsDouble(i, 12, 20, 0));
  }
}
