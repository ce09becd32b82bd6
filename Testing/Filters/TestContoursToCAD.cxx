#include "Adapters/BSRSplineAdapter.h"
#include "CADFile.h"
#include "FilterTesting.h"
#include "vtkBranchedContourSurface.h"
#include "vtkContourSkin.h"
#include "vtkSTEPWriter.h"

#include <STEPControl_Reader.hxx>

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
  const bsr::Result<bsr::SplineModel> model = bsr::splineModelFrom(output);
  ASSERT_TRUE(model.isOk()) << model.status().message();
  const Folder folder;
  const std::string file = folder.file("model.step");
  vtkNew<vtkSTEPWriter> writer;
  writer->SetInputDataObject(output);
  writer->SetFileName(file.c_str());
  ErrorLog writing(writer);
  writer->Write();
  EXPECT_TRUE(writing.empty()) << writing.text();
  const TopoDS_Shape shape = readBack<STEPControl_Reader>(file);
  ASSERT_FALSE(shape.IsNull());
  EXPECT_EQ(countOf(shape, TopAbs_FACE), static_cast<int>(model->Patches.size()));
  EXPECT_EQ(countOf(shape, TopAbs_SHELL), 1);
  EXPECT_TRUE(BRepCheck_Analyzer(shape).IsValid());
}
} // namespace

TEST(ContoursToCAD, BranchedContourSurfaceOfAVessel)
{
  BSR_SHARED_DATA_OR_SKIP(path, "contours_vmtk_aorta_y.vtp");
  expectValidFile<vtkBranchedContourSurface>(path);
}

TEST(ContoursToCAD, BranchedContourSurfaceOfABone)
{
  BSR_SHARED_DATA_OR_SKIP(path, "contours_femur12_z.vtp");
  expectValidFile<vtkBranchedContourSurface>(path);
}

TEST(ContoursToCAD, ContourSkinOfAVessel)
{
  BSR_SHARED_DATA_OR_SKIP(path, "contours_vmtk_aorta_y.vtp");
  expectValidFile<vtkContourSkin>(path);
}

TEST(ContoursToCAD, ContourSkinOfCondyles)
{
  BSR_SHARED_DATA_OR_SKIP(path, "contours_femurL19_distal.vtp");
  expectValidFile<vtkContourSkin>(path);
}
