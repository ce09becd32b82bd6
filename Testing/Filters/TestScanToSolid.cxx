#include "CADFile.h"
#include "vtkScanToNURBS.h"

#include <vtkCleanPolyData.h>
#include <vtkFlyingEdges3D.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkTable.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cctype>

using namespace bsrtest;

namespace
{
struct Scan
{
  const char* File;
  int Euler;
  bool Closed;
};

void PrintTo(const Scan& s, std::ostream* out)
{
  *out << s.File;
}

/// The largest isosurface of a volume.
vtkSmartPointer<vtkPolyData> isosurface(const std::string& path, double value)
{
  vtkNew<vtkXMLImageDataReader> volume;
  volume->SetFileName(path.c_str());
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputConnection(volume->GetOutputPort());
  surface->SetValue(0, value);
  surface->ComputeNormalsOff();
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  largest->SetInputConnection(surface->GetOutputPort());
  largest->SetExtractionModeToLargestRegion();
  vtkNew<vtkCleanPolyData> used;
  used->SetInputConnection(largest->GetOutputPort());
  used->PointMergingOff();
  used->ConvertPolysToLinesOff();
  used->Update();
  return used->GetOutput();
}

vtkSmartPointer<vtkPolyData> surfaceOf(const std::string& path)
{
  if (path.substr(path.size() - 4) == ".vti")
  {
    return isosurface(path, 560.0);
  }
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

class ScanToSolid : public testing::TestWithParam<Scan>
{
};
} // namespace

/// Of every closed scan one valid solid, of every open one a valid shell comes back from STEP.
TEST_P(ScanToSolid, IsValidInOpenCASCADE)
{
  const Scan scan = GetParam();
  BSR_SHARED_DATA_OR_SKIP(path, scan.File);
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputDataObject(0, surfaceOf(path));
  filter->SetNumberOfQuads(120);
  ErrorLog log(filter);
  filter->Update();
  ASSERT_TRUE(log.empty()) << log.text();

  auto* report = filter->GetOutputDataObject(vtkScanToNURBS::REPORT);
  EXPECT_EQ(fieldValue(report, "EulerCharacteristic"), scan.Euler);
  EXPECT_EQ(fieldValue(report, "FoldedPatches"), 0.0);
  EXPECT_EQ(fieldValue(report, "FailedQuads"), 0.0);
  EXPECT_LE(fieldValue(report, "MaxNormalJump"), 0.01);
  EXPECT_LE(fieldValue(report, "RelativeRMS"), 5e-3);
  vtkDataObject* output = filter->GetOutputDataObject(vtkScanToNURBS::MODEL);
  const auto [model, shape] = throughStep(output);
  scan.Closed ? expectSolid(model, shape, 1) : expectOpenShell(model, shape);
}

INSTANTIATE_TEST_SUITE_P(Samples, ScanToSolid,
  testing::Values(Scan{"stanford-bunny.vtp", 2, true}, Scan{"rocker-arm.vtp", 0, true},
    Scan{"mechpart_recon.vtp", -4, true}, Scan{"femur_12.vtp", 1, false},
    Scan{"distcap.vtp", 1, false}, Scan{"tooth.vti", 2, true}),
  [](const testing::TestParamInfo<Scan>& info)
  {
    std::string name(info.param.File, std::string(info.param.File).rfind('.'));
    name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return !std::isalnum(c); }),
      name.end());
    return name;
  });
