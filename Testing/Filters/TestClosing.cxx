#include "FilterTesting.h"

#include "vtkClosing.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFeatureEdges.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkPointDataToCellData.h>
#include <vtkPolyData.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>
#include <cstring>

using namespace bsrtest;

namespace
{
/// An image of a hollow tube along x in gray values around 500, in an array of some type.
vtkSmartPointer<vtkImageData> tubeImage(int type = VTK_FLOAT, int shift = 0)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(shift, shift + 47, -shift, -shift + 25, 2 * shift, 2 * shift + 25);
  vtkSmartPointer<vtkDataArray> a;
  a.TakeReference(vtkDataArray::CreateDataArray(type));
  a->SetName("ct");
  a->SetNumberOfTuples(image->GetNumberOfPoints());
  vtkIdType id = 0;
  for (int k = 0; k < 26; ++k)
  {
    for (int j = 0; j < 26; ++j)
    {
      for (int i = 0; i < 48; ++i)
      {
        const double r = std::hypot(j - 12.3, k - 12.6);
        const double d = std::max({5.0 - r, r - 8.0, 6.0 - i, i - 41.0});
        a->SetComponent(id++, 0, std::round(60.0 - 50.0 * std::min(1.0, std::max(-1.0, 0.5 * d))));
      }
    }
  }
  image->GetPointData()->SetScalars(a);
  return image;
}

vtkDataArray* point(vtkClosing* f, const char* name)
{
  return f->GetOutput()->GetPointData()->GetArray(name);
}

/// Euler characteristic of the zero level of SignedDistance; -999 where it is not a closed surface.
vtkIdType eulerOfSurface(vtkImageData* image)
{
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "SignedDistance");
  contour->SetValue(0, 0.0);
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputConnection(contour->GetOutputPort());
  edges->FeatureEdgesOff();
  edges->Update();
  if (edges->GetOutput()->GetNumberOfLines() > 0)
  {
    return -999;
  }
  vtkPolyData* s = contour->GetOutput();
  return s->GetNumberOfPoints() - s->GetNumberOfPolys() / 2;
}

std::string errorOf(vtkImageData* image, double iso = std::nan(""), double radius = std::nan(""))
{
  vtkNew<vtkClosing> f;
  ErrorLog log(f);
  f->SetInputData(image);
  if (!std::isnan(iso))
  {
    f->AutoIsoValueOff();
    f->SetIsoValue(iso);
  }
  if (!std::isnan(radius))
  {
    f->AutoRadiusOff();
    f->SetRadius(radius);
  }
  f->Update();
  EXPECT_EQ(f->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(f->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
  EXPECT_LE(log.Errors.size(), 1U) << log.text();
  return log.text();
}
} // namespace

TEST(vtkClosing, FillsATubeByDefault)
{
  vtkNew<vtkClosing> f;
  ErrorLog log(f);
  f->SetInputData(tubeImage());
  f->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  ASSERT_NE(point(f, "Closed"), nullptr);
  ASSERT_NE(point(f, "SignedDistance"), nullptr);
  EXPECT_EQ(point(f, "Closed")->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_EQ(point(f, "SignedDistance")->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(f->GetOutput()->GetScalarType(), VTK_FLOAT);
  EXPECT_EQ(eulerOfSurface(f->GetOutput()), 2);
  EXPECT_GT(fieldValue(f->GetOutput(), "ClosingRadius"), 3.9);
  EXPECT_LT(fieldValue(f->GetOutput(), "ClosingRadius"), 8.0);
  EXPECT_NEAR(fieldValue(f->GetOutput(), "IsoValue"), 60.0, 25.0);
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 0), 1.0);
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 1), 0.0);
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 2), 0.0);
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbersBefore", 0, 1), 1.0);
  EXPECT_GT(fieldValue(f->GetOutput(), "VolumeRatio"), 1.2);
}

TEST(vtkClosing, EveryScalarTypeGivesTheSame)
{
  vtkNew<vtkClosing> reference;
  reference->SetInputData(tubeImage());
  reference->AutoRadiusOff();
  reference->AutoIsoValueOff();
  reference->SetIsoValue(60.0);
  reference->Update();
  for (int type : {VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT,
         VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG,
         VTK_UNSIGNED_LONG_LONG, VTK_DOUBLE, VTK_ID_TYPE})
  {
    vtkNew<vtkClosing> f;
    ErrorLog log(f);
    f->SetInputData(tubeImage(type));
    f->AutoRadiusOff();
    f->AutoIsoValueOff();
    f->SetIsoValue(60.0);
    f->Update();
    ASSERT_NE(point(f, "Closed"), nullptr) << type << log.text();
    EXPECT_EQ(std::memcmp(point(f, "Closed")->GetVoidPointer(0),
                point(reference, "Closed")->GetVoidPointer(0),
                static_cast<std::size_t>(f->GetOutput()->GetNumberOfPoints())),
      0)
      << type;
  }
}

TEST(vtkClosing, KeepsExtentOriginSpacingAndDirection)
{
  const auto image = tubeImage(VTK_FLOAT, 7);
  image->SetSpacing(0.5, 0.7, 0.5);
  image->SetOrigin(-3.0, 4.0, 100.0);
  image->SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1);
  vtkNew<vtkClosing> f;
  f->SetInputData(image);
  f->Update();
  vtkImageData* out = f->GetOutput();
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(out->GetExtent()[i], image->GetExtent()[i]);
  }
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(out->GetOrigin()[i], image->GetOrigin()[i]);
    EXPECT_EQ(out->GetSpacing()[i], image->GetSpacing()[i]);
  }
  for (int i = 0; i < 9; ++i)
  {
    EXPECT_EQ(out->GetDirectionMatrix()->GetData()[i], image->GetDirectionMatrix()->GetData()[i]);
  }
  // The bounds of the surface in the world are those of the tube.
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(out);
  contour->SetValue(0, 0.0);
  contour->Update();
  double tube[3];
  image->TransformContinuousIndexToPhysicalPoint(6.0 + 7, 12.3 - 7, 12.6 + 14, tube);
  const double* b = contour->GetOutput()->GetBounds();
  EXPECT_NEAR(b[2], tube[1], 0.5); // the tube's axis (x) points along world y
  EXPECT_NEAR(0.5 * (b[0] + b[1]), tube[0], 0.5);
  EXPECT_NEAR(0.5 * (b[4] + b[5]), tube[2], 0.5);
}

TEST(vtkClosing, ObjectAtTheBorderGetsAClosedSurface)
{
  const auto image = tubeImage();
  vtkNew<vtkImageData> cut;
  cut->DeepCopy(image);
  cut->Crop(std::array<int, 6>{{15, 30, 4, 25, 0, 12}}.data());
  vtkNew<vtkClosing> f;
  ErrorLog log(f);
  f->SetInputData(cut);
  f->AutoRadiusOff();
  f->SetRadius(6.0);
  f->Update();
  EXPECT_TRUE(log.Errors.empty()) << log.text();
  EXPECT_EQ(f->GetOutput()->GetExtent()[0], 13);
  EXPECT_EQ(f->GetOutput()->GetExtent()[1], 32);
  EXPECT_NE(eulerOfSurface(f->GetOutput()), -999);
  f->Update(); // asking again finds everything done
  EXPECT_EQ(f->GetOutput()->GetExtent()[0], 13);
}

TEST(vtkClosing, SeveralObjects)
{
  const auto image = tubeImage();
  for (int k = 0; k < 26; ++k)
  {
    for (int j = 0; j < 26; ++j)
    {
      image->SetScalarComponentFromDouble(24, j, k, 0, 10.0); // cut in two
      image->SetScalarComponentFromDouble(25, j, k, 0, 10.0);
    }
  }
  vtkNew<vtkClosing> f;
  ErrorLog log(f);
  f->SetInputData(image);
  f->AutoRadiusOff();
  f->SetRadius(0.5);
  f->LargestComponentOff();
  f->Update();
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 0), 2.0);
  f->LargestComponentOn();
  f->Update();
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 0), 1.0);
  EXPECT_EQ(fieldValue(f->GetOutput(), "Components"), 2.0);
}

TEST(vtkClosing, BadInputGivesOneClearError)
{
  vtkNew<vtkPointDataToCellData> toCells;
  toCells->SetInputData(tubeImage());
  toCells->Update();
  EXPECT_NE(errorOf(vtkImageData::SafeDownCast(toCells->GetOutput())).find("Cell Data to Point"),
    std::string::npos);

  vtkNew<vtkImageData> bare;
  bare->SetDimensions(4, 4, 4);
  EXPECT_NE(errorOf(bare).find("no point array"), std::string::npos);

  vtkNew<vtkImageData> vectors;
  vectors->SetDimensions(4, 4, 4);
  vectors->AllocateScalars(VTK_FLOAT, 3);
  EXPECT_NE(errorOf(vectors).find("components"), std::string::npos);

  vtkNew<vtkImageData> constant;
  constant->SetDimensions(4, 4, 4);
  constant->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
  std::fill_n(static_cast<unsigned short*>(constant->GetScalarPointer()), 64, 5);
  EXPECT_NE(errorOf(constant).find("constant"), std::string::npos);

  vtkNew<vtkImageData> voxel;
  voxel->SetDimensions(1, 1, 1);
  voxel->AllocateScalars(VTK_FLOAT, 1);
  voxel->SetScalarComponentFromDouble(0, 0, 0, 0, 3.0);
  EXPECT_NE(errorOf(voxel).find("constant"), std::string::npos);

  EXPECT_NE(errorOf(tubeImage(), 1e9).find("iso value"), std::string::npos);
  EXPECT_NE(errorOf(tubeImage(), 60.0, 1e3).find("radius"), std::string::npos);
  EXPECT_NE(errorOf(tubeImage(), 60.0, -1.0).find("radius"), std::string::npos);
  const auto nan = tubeImage();
  nan->SetScalarComponentFromDouble(3, 3, 3, 0, std::nan(""));
  EXPECT_NE(errorOf(nan).find("NaN"), std::string::npos);
}

TEST(vtkClosing, EmptyImageGivesNothing)
{
  vtkNew<vtkClosing> f;
  ErrorLog log(f);
  vtkNew<vtkImageData> empty;
  f->SetInputData(empty);
  f->Update();
  EXPECT_EQ(f->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_LE(log.Errors.size(), 1U) << log.text();
}

TEST(vtkClosing, CancelLeavesNothing)
{
  for (const double at : {0.0, 0.5, 0.9})
  {
    vtkNew<vtkClosing> f;
    ErrorLog log(f);
    f->SetInputData(tubeImage());
    const AbortAt abort(f, at);
    f->Update();
    EXPECT_TRUE(abort.done());
    EXPECT_EQ(f->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(f->GetOutput()->GetPointData()->GetNumberOfArrays(), 0);
    EXPECT_EQ(f->GetOutput()->GetFieldData()->GetNumberOfArrays(), 0);
    EXPECT_TRUE(log.empty()) << log.text();
  }
}

TEST(vtkClosing, ProgressGrows)
{
  vtkNew<vtkClosing> f;
  f->SetInputData(tubeImage());
  std::vector<double> seen;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&seen);
  watch->SetCallback(
    [](vtkObject* caller, unsigned long, void* data, void*)
    {
      static_cast<std::vector<double>*>(data)->push_back(
        vtkAlgorithm::SafeDownCast(caller)->GetProgress());
    });
  f->AddObserver(vtkCommand::ProgressEvent, watch);
  f->Update();
  EXPECT_GT(seen.size(), 20U);
  EXPECT_LE(*std::max_element(seen.begin(), seen.end()), 1.0);
}

TEST(vtkClosing, LongFiberBecomesABall)
{
  BSR_SHARED_DATA_OR_SKIP(path, "dev_long.vti");
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkClosing> f;
  f->SetInputConnection(reader->GetOutputPort());
  f->AutoIsoValueOff();
  f->SetIsoValue(19500.0);
  f->Update();
  EXPECT_NEAR(fieldValue(f->GetOutput(), "ClosingRadius"), 16.0, 2.5);
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 0), 1.0);
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 1), 0.0);
  EXPECT_EQ(fieldValue(f->GetOutput(), "BettiNumbers", 0, 2), 0.0);
  EXPECT_EQ(eulerOfSurface(f->GetOutput()), 2);
}
