#ifndef CADFile_h
#define CADFile_h

#include "Adapters/BSRSplineAdapter.h"
#include "FilterTesting.h"
#include "Spline/Volume.h"
#include "vtkSTEPWriter.h"

#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Shell.hxx>

#include <gtest/gtest.h>

#include <IFSelect_ReturnStatus.hxx>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

/** Reading back what the CAD writers wrote. */
namespace bsrtest
{
/// A folder that vanishes with its files.
class Folder
{
public:
  Folder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "bsrXXXXXX").string();
    this->Path = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(this->Path); }
  std::string file(const std::string& name) const { return (this->Path / name).string(); }
  std::size_t count() const
  {
    return static_cast<std::size_t>(std::distance(
      std::filesystem::directory_iterator(this->Path), std::filesystem::directory_iterator()));
  }

private:
  std::filesystem::path Path;
};

/// OpenCASCADE's readers print; keep the test's output clean.
struct Quiet
{
  Message_SequenceOfPrinters Printers = Message::DefaultMessenger()->Printers();
  Quiet() { Message::DefaultMessenger()->ChangePrinters().Clear(); }
  ~Quiet() { Message::DefaultMessenger()->ChangePrinters() = this->Printers; }
};

template <class Reader>
TopoDS_Shape readBack(const std::string& name)
{
  const Quiet quiet;
  Reader reader;
  EXPECT_EQ(reader.ReadFile(name.c_str()), IFSelect_RetDone);
  reader.TransferRoots();
  return reader.OneShape();
}

/// The model in a filter's output, written to STEP and read by OpenCASCADE.
inline std::pair<bsr::SplineModel, TopoDS_Shape> throughStep(vtkDataObject* output)
{
  const bsr::Result<bsr::SplineModel> model = bsr::splineModelFrom(output);
  EXPECT_TRUE(model.isOk()) << model.status().message();
  const Folder folder;
  const std::string file = folder.file("model.step");
  vtkNew<vtkSTEPWriter> writer;
  writer->SetInputDataObject(output);
  writer->SetFileName(file.c_str());
  ErrorLog log(writer);
  writer->Write();
  EXPECT_TRUE(log.empty()) << log.text();
  return {model.isOk() ? *model : bsr::SplineModel(), readBack<STEPControl_Reader>(file)};
}

inline int countOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind)
{
  int n = 0;
  for (TopExp_Explorer it(shape, kind); it.More(); it.Next())
  {
    ++n;
  }
  return n;
}

inline double volumeOf(const TopoDS_Shape& shape)
{
  GProp_GProps g;
  BRepGProp::VolumeProperties(shape, g, 1e-9);
  return g.Mass();
}

/// The file holds one valid closed solid of the model's faces and volume.
inline void expectSolid(const bsr::SplineModel& m, const TopoDS_Shape& shape, int shells)
{
  ASSERT_FALSE(shape.IsNull());
  EXPECT_EQ(countOf(shape, TopAbs_SOLID), 1);
  EXPECT_EQ(countOf(shape, TopAbs_SHELL), shells);
  EXPECT_EQ(countOf(shape, TopAbs_FACE), static_cast<int>(m.Patches.size()));
  EXPECT_TRUE(BRepCheck_Analyzer(shape).IsValid());
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next())
  {
    EXPECT_TRUE(BRep_Tool::IsClosed(TopoDS::Shell(it.Current())));
  }
  const double volume = bsr::measureModel(m).Volume;
  EXPECT_GT(volume, 0.0);
  EXPECT_NEAR(volumeOf(shape), volume, 1e-6 * volume);
}

/// The file holds one valid open shell of the model's faces.
inline void expectOpenShell(const bsr::SplineModel& m, const TopoDS_Shape& shape)
{
  ASSERT_FALSE(shape.IsNull());
  EXPECT_EQ(countOf(shape, TopAbs_SOLID), 0);
  EXPECT_EQ(countOf(shape, TopAbs_FACE), static_cast<int>(m.Patches.size()));
  EXPECT_TRUE(BRepCheck_Analyzer(shape).IsValid());
  ASSERT_EQ(countOf(shape, TopAbs_SHELL), 1);
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next())
  {
    EXPECT_FALSE(BRep_Tool::IsClosed(TopoDS::Shell(it.Current())));
  }
}
} // namespace bsrtest

#endif
