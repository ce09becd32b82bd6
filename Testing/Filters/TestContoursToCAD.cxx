#include "CADFile.h"
#include "vtkBranchedContourSurface.h"
#include "vtkContourSkin.h"

#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

using namespace bsrtest;

namespace
{
/// What a filter makes of the contours of a file comes back valid from STEP, every patch a face.
template <class Filter>
void expectValidFile(const std::string& path)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<Filter> filter;
  filter->SetInputConnection(reader->GetOutputPort());
  ErrorLog log(filter);
  filter->Update();
  ASSERT_TRUE(log.Errors.empty()) << log.text();
  vtkDataObject* output = filter->GetOutputDataObject(0);
  const auto [model, shape] = throughStep(output);
  ASSERT_FALSE(shape.IsNull());
  EXPECT_EQ(countOf(shape, TopAbs_FACE), static_cast<int>(model.Patches.size()));
  EXPECT_EQ(countOf(shape, TopAbs_SHELL), 1);
  EXPECT_TRUE(BRepCheck_Analyzer(shape).IsValid());
}
} // namespace

class ContoursToCAD : public testing::TestWithParam<const char*>
{
};

TEST_P(ContoursToCAD, BranchedContourSurfaceIsASolid)
{
  BSR_SHARED_DATA_OR_SKIP(path, GetParam());
  expectValidFile<vtkBranchedContourSurface>(path);
}

TEST_P(ContoursToCAD, ContourSkinIsASolid)
{
  BSR_SHARED_DATA_OR_SKIP(path, GetParam());
  expectValidFile<vtkContourSkin>(path);
}

INSTANTIATE_TEST_SUITE_P(Contours, ContoursToCAD,
  testing::Values(
    "contours_vmtk_aorta_y.vtp", "contours_femur12_z.vtp", "contours_femurL19_distal.vtp"));
