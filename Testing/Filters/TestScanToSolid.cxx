#include "CADFile.h"
#include "vtkScanToNURBS.h"

#include <vtkPolyData.h>
#include <vtkTable.h>
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

class ScanToSolid : public testing::TestWithParam<Scan>
{
};
} // namespace

/// Of every closed scan one valid solid, of every open one a valid shell comes back from STEP.
TEST_P(ScanToSolid, IsValidInOpenCASCADE)
{
  const Scan scan = GetParam();
  BSR_SHARED_DATA_OR_SKIP(path, std::string(scan.File) + ".vtp");
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkScanToNURBS> filter;
  filter->SetInputConnection(reader->GetOutputPort());
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
  testing::Values(Scan{"stanford-bunny", 2, true}, Scan{"rocker-arm", 0, true},
    Scan{"mechpart_recon", -4, true}, Scan{"femur_12", 1, false}, Scan{"distcap", 1, false}),
  [](const testing::TestParamInfo<Scan>& info)
  {
    std::string name = info.param.File;
    name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return !std::isalnum(c); }),
      name.end());
    return name;
  });
