#include "CADFile.h"
#include "vtkFiberReconstruction.h"

#include <vtkPolyData.h>
#include <vtkXMLImageDataReader.h>

using namespace bsrtest;

namespace
{
struct Volume
{
  const char* File;
  double IsoValue;
};

/// Names the cases of the test.
void PrintTo(const Volume& v, std::ostream* out)
{
  *out << v.File;
}

class VolumeToSolid : public testing::TestWithParam<Volume>
{
};
} // namespace

/// Of every volume one valid closed solid comes back from the STEP file.
TEST_P(VolumeToSolid, IsOneValidSolid)
{
  const Volume volume = GetParam();
  BSR_SHARED_DATA_OR_SKIP(path, std::string(volume.File) + ".vti");
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkFiberReconstruction> fiber;
  fiber->SetInputConnection(reader->GetOutputPort());
  fiber->AutoIsoValueOff();
  fiber->SetIsoValue(volume.IsoValue);
  ErrorLog log(fiber);
  fiber->Update();
  ASSERT_TRUE(log.Errors.empty()) << log.text();

  vtkDataObject* output = fiber->GetOutputDataObject(vtkFiberReconstruction::MODEL);
  EXPECT_EQ(fieldValue(output, "FoldedPatches"), 0.0);
  EXPECT_LE(fieldValue(output, "MaxNormalJump"), 0.01);
  const auto [model, shape] = throughStep(output);
  expectSolid(model, shape, 1);
  std::printf("%s: %zu faces, volume off by %.1e\n", volume.File, model.Patches.size(),
    volumeOf(shape) / bsr::measureModel(model).Volume - 1.0);
}

INSTANTIATE_TEST_SUITE_P(Samples, VolumeToSolid,
  testing::Values(Volume{"dev_long", 19500}, Volume{"dev_f128", 19500}, Volume{"tooth", 560},
    Volume{"vmtk_aorta", 900}, Volume{"100_fiberform", 110}),
  [](const testing::TestParamInfo<Volume>& info)
  {
    const std::string name = info.param.File;
    return name.substr(name.find_first_not_of("0123456789_"));
  });
