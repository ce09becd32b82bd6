#include "Adapters/BSRSplineAdapter.h"
#include "CADFile.h"
#include "CubeLayout.h"
#include "FilterTesting.h"
#include "SampleModels.h"
#include "vtkBSplineG1Fit.h"
#include "vtkIGESWriter.h"
#include "vtkSTEPWriter.h"

#include <BRep_Tool.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>

#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>
#include <vtkTable.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace bsr;
using namespace bsrtest;

namespace
{
std::string contents(const std::string& name)
{
  std::ifstream in(name);
  std::stringstream s;
  s << in.rdbuf();
  return s.str();
}

void writeStep(const SplineModel& m, const std::string& name)
{
  vtkNew<vtkSTEPWriter> writer;
  writer->SetInputData(surfaceOf(m));
  writer->SetFileName(name.c_str());
  ErrorLog log(writer);
  writer->Write();
  EXPECT_TRUE(log.empty()) << log.text();
  EXPECT_EQ(writer->GetNumberOfFaces(), static_cast<int>(m.Patches.size()));
}

/// The weights of a patch relative to its largest, of all patches, sorted.
void addWeights(std::vector<double> patch, std::vector<double>& all)
{
  const double largest = *std::max_element(patch.begin(), patch.end());
  for (const double w : patch)
  {
    all.push_back(w / largest);
  }
}

std::vector<double> weightsOf(const SplineModel& m)
{
  std::vector<double> all;
  for (const SplinePatch& p : m.Patches)
  {
    std::vector<double> own;
    for (int i = 0; i < p.CountU * p.CountV; ++i)
    {
      own.push_back(m.ControlPoints[p.FirstControlPoint + i][3]);
    }
    addWeights(own, all);
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<double> weightsOf(const TopoDS_Shape& shape)
{
  std::vector<double> all;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
  {
    const Handle(Geom_BSplineSurface) s =
      GeomConvert::SurfaceToBSplineSurface(BRep_Tool::Surface(TopoDS::Face(it.Current())));
    std::vector<double> own;
    for (int i = 1; i <= s->NbUPoles(); ++i)
    {
      for (int j = 1; j <= s->NbVPoles(); ++j)
      {
        own.push_back(s->Weight(i, j));
      }
    }
    addWeights(own, all);
  }
  std::sort(all.begin(), all.end());
  return all;
}
} // namespace

TEST(STEPWriter, ClosedModelsBecomeOneValidSolid)
{
  const Folder folder;
  const std::string file = folder.file("m.step");
  for (const SplineModel& m : {samples::ball(20.0, 2, 3), samples::tube(6, 4, 3), samples::torus()})
  {
    writeStep(m, file);
    expectSolid(m, readBack<STEPControl_Reader>(file), 1);
  }
  EXPECT_EQ(folder.count(), 1U);
}

TEST(STEPWriter, AClosedInnerShellBecomesAVoid)
{
  const Folder folder;
  const std::string file = folder.file("m.step");
  const SplineModel m = samples::hollowBall();
  writeStep(m, file);
  EXPECT_NE(contents(file).find("BREP_WITH_VOIDS"), std::string::npos);
  expectSolid(m, readBack<STEPControl_Reader>(file), 2);
}

TEST(STEPWriter, PolesAndSeamsAreValid)
{
  const Folder folder;
  const std::string file = folder.file("m.step");
  const SplineModel sphere = samples::octantSphere(2.0);
  writeStep(sphere, file);
  expectSolid(sphere, readBack<STEPControl_Reader>(file), 1);
  // One patch that closes on itself in both directions.
  SplineModel ring;
  samples::addLattice(ring, {1, 1, 3, 3, 6, 6, Shell::Outer},
    [](int i, int j)
    {
      const double a = 2 * samples::Pi * (i % 13) / 13;
      const double b = 2 * samples::Pi * (j % 13) / 13;
      const double r = 3 + std::cos(b);
      return Vec4(r * std::cos(a), r * std::sin(a), std::sin(b), 1.0);
    });
  ring.Neighbors[0] = {2, 3, 0, 1};
  writeStep(ring, file);
  expectSolid(ring, readBack<STEPControl_Reader>(file), 1);
}

TEST(STEPWriter, InconsistentPatchOrientationsAreRepaired)
{
  SplineModel m = samples::hollowBall();
  // Turn every third patch over by mirroring u.
  for (std::size_t p = 0; p < m.Patches.size(); p += 3)
  {
    const SplinePatch& s = m.Patches[p];
    for (int j = 0; j < s.CountV; ++j)
    {
      const auto row = m.ControlPoints.begin() + s.FirstControlPoint + j * s.CountU;
      std::reverse(row, row + s.CountU);
    }
  }
  for (auto& n : m.Neighbors)
  {
    n = {-1, -1, -1, -1};
  }
  samples::connect(m);
  const Folder folder;
  writeStep(m, folder.file("m.step"));
  expectSolid(m, readBack<STEPControl_Reader>(folder.file("m.step")), 2);
}

TEST(STEPWriter, OpenModelsBecomeShells)
{
  SplineModel m;
  samples::addLattice(m, {3, 2, 3, 3, 2, 2, Shell::Outer},
    [](int i, int j) { return Vec4(i, j, 0.05 * i * j, 1.0); });
  samples::connect(m);
  const Folder folder;
  writeStep(m, folder.file("m.step"));
  const TopoDS_Shape shape = readBack<STEPControl_Reader>(folder.file("m.step"));
  EXPECT_EQ(countOf(shape, TopAbs_SOLID), 0);
  EXPECT_EQ(countOf(shape, TopAbs_SHELL), 1);
  EXPECT_EQ(countOf(shape, TopAbs_FACE), 6);
  EXPECT_TRUE(BRepCheck_Analyzer(shape).IsValid());
}

TEST(STEPWriter, DifferentParametrizationsAreSewn)
{
  // Two squares whose common side is cubic here and linear there.
  SplineModel m;
  samples::addLattice(
    m, {1, 1, 3, 3, 1, 1, Shell::Outer}, [](int i, int j) { return Vec4(i / 3.0, j / 3.0, 0, 1); });
  samples::addLattice(
    m, {1, 1, 1, 1, 1, 1, Shell::Outer}, [](int i, int j) { return Vec4(1 + i, j, 0, 1); });
  m.Neighbors[0][1] = 4 * 1 + 3;
  m.Neighbors[1][3] = 1;
  const Folder folder;
  writeStep(m, folder.file("m.step"));
  const TopoDS_Shape shape = readBack<STEPControl_Reader>(folder.file("m.step"));
  EXPECT_EQ(countOf(shape, TopAbs_SHELL), 1);
  EXPECT_EQ(countOf(shape, TopAbs_FACE), 2);
}

TEST(STEPWriter, WithoutSewFacesAreSeparate)
{
  const Folder folder;
  vtkNew<vtkSTEPWriter> writer;
  writer->SetInputData(surfaceOf(samples::ball()));
  writer->SetFileName(folder.file("m.stp").c_str());
  writer->SewOff();
  writer->Write();
  EXPECT_EQ(writer->GetNumberOfSolids(), 0);
  const TopoDS_Shape shape = readBack<STEPControl_Reader>(folder.file("m.stp"));
  EXPECT_EQ(countOf(shape, TopAbs_SOLID), 0);
  EXPECT_EQ(countOf(shape, TopAbs_FACE), 6);
}

TEST(STEPWriter, UnitsAreDeclared)
{
  const Folder folder;
  const std::string file = folder.file("m.step");
  const double inMillimeters[] = {1.0, 1e-3, 10.0, 1e3, 25.4, 304.8};
  const char* marks[] = {"SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT(.MICRO.,.METRE.)",
    "SI_UNIT(.CENTI.,.METRE.)", "SI_UNIT($,.METRE.)", "INCH", "FOOT"};
  const SplineModel m = samples::ball(100.0);
  const double volume = measureModel(m).Volume;
  for (int unit = vtkSTEPWriter::MILLIMETER; unit <= vtkSTEPWriter::FOOT; ++unit)
  {
    vtkNew<vtkSTEPWriter> writer;
    writer->SetInputData(surfaceOf(m));
    writer->SetFileName(file.c_str());
    writer->SetUnits(unit);
    writer->Write();
    EXPECT_NE(contents(file).find(marks[unit]), std::string::npos) << marks[unit];
    const double scale = std::pow(inMillimeters[unit], 3);
    EXPECT_NEAR(volumeOf(readBack<STEPControl_Reader>(file)) / scale, volume, 1e-6 * volume);
  }
}

TEST(STEPWriter, NothingGlobalChangesAndNothingIsPrinted)
{
  const Folder folder;
  writeStep(samples::ball(), folder.file("m.step"));
  Interface_Static::SetCVal("write.step.unit", "KM");
  const auto printers = Message::DefaultMessenger()->Printers().Length();
  testing::internal::CaptureStdout();
  writeStep(samples::ball(), folder.file("m.step"));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_STREQ(Interface_Static::CVal("write.step.unit"), "KM");
  EXPECT_EQ(Message::DefaultMessenger()->Printers().Length(), printers);
  Interface_Static::SetCVal("write.step.unit", "MM");
}

TEST(STEPWriter, FailuresGiveOneErrorAndKeepTheFile)
{
  const Folder folder;
  const std::string file = folder.file("m.step");
  std::ofstream(file) << "precious";
  const auto fails = [&](vtkPolyData* input, const std::string& name, const char* text)
  {
    vtkNew<vtkSTEPWriter> writer;
    writer->SetInputData(input);
    writer->SetFileName(name.empty() ? nullptr : name.c_str());
    ErrorLog log(writer);
    writer->Write();
    EXPECT_TRUE(log.saidOnce(text)) << log.text();
    EXPECT_NE(writer->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
    EXPECT_EQ(writer->GetNumberOfFaces(), 0);
  };
  fails(vtkNew<vtkPolyData>(), file, "no spline model");
  fails(surfaceOf(samples::ball()), "", "FileName");
  fails(surfaceOf(samples::ball()), folder.file("no/such/folder.step"), "Cannot write");
  EXPECT_EQ(contents(file), "precious");
  EXPECT_EQ(folder.count(), 1U);
}

TEST(STEPWriter, RationalFitsKeepTheirWeights)
{
  vtkNew<vtkBSplineG1Fit> fit;
  fit->SetInputData(0, bsrtest::spherePoints(10));
  fit->SetInputData(1, bsrtest::cubeLayout());
  fit->SetDataWeight(1e5);
  fit->RationalOn();
  fit->SetOptimizer(vtkBSplineG1Fit::DETERMINISTIC);
  fit->Update();
  const auto model = splineModelFrom(vtkPolyData::SafeDownCast(fit->GetOutputDataObject(0)));
  ASSERT_TRUE(model) << model.status().message();
  const std::vector<double> weights = weightsOf(*model);
  ASSERT_LT(weights.front(), 0.999 * weights.back());
  const Folder folder;
  vtkNew<vtkSTEPWriter> step;
  step->SetInputConnection(fit->GetOutputPort());
  step->SetFileName(folder.file("m.step").c_str());
  step->Write();
  EXPECT_NE(contents(folder.file("m.step")).find("RATIONAL_B_SPLINE_SURFACE"), std::string::npos);
  vtkNew<vtkIGESWriter> iges;
  iges->SetInputConnection(fit->GetOutputPort());
  iges->SetFileName(folder.file("m.igs").c_str());
  iges->Write();
  for (const TopoDS_Shape& shape : {readBack<STEPControl_Reader>(folder.file("m.step")),
         readBack<IGESControl_Reader>(folder.file("m.igs"))})
  {
    expectSolid(*model, shape, 1);
    const std::vector<double> read = weightsOf(shape);
    ASSERT_EQ(read.size(), weights.size());
    for (std::size_t i = 0; i < read.size(); ++i)
    {
      EXPECT_NEAR(read[i], weights[i], 1e-9);
    }
  }
}

TEST(STEPWriter, GmshMeshesTheSolid)
{
  if (std::system("gmsh --version > /dev/null 2>&1") != 0)
  {
    GTEST_SKIP() << "gmsh is not there";
  }
  const Folder folder;
  writeStep(samples::tube(4, 3, 3), folder.file("m.step"));
  const std::string mesh = folder.file("m.msh");
  const std::string command = "gmsh -3 -v 0 -clmax 0.5 -format msh2 -o " + mesh + " " +
                              folder.file("m.step") + " > /dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::istringstream lines(contents(mesh));
  int tetrahedra = 0;
  for (std::string line; std::getline(lines, line);)
  {
    int id = 0;
    int type = 0;
    int tags = 0;
    std::istringstream fields(line);
    tetrahedra += (fields >> id >> type >> tags) && type == 4 && tags == 2;
  }
  EXPECT_GT(tetrahedra, 100);
}

TEST(IGESWriter, FacesAndVolumeSurvive)
{
  const Folder folder;
  const std::string file = folder.file("m.igs");
  for (const SplineModel& m : {samples::tube(6, 2, 3), samples::torus()})
  {
    vtkNew<vtkIGESWriter> writer;
    writer->SetInputData(surfaceOf(m));
    writer->SetFileName(file.c_str());
    ErrorLog log(writer);
    testing::internal::CaptureStdout();
    writer->Write();
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_TRUE(log.empty()) << log.text();
    const TopoDS_Shape shape = readBack<IGESControl_Reader>(file);
    expectSolid(m, shape, 1);
  }
  EXPECT_EQ(folder.count(), 1U);
}

TEST(IGESWriter, FailuresGiveOneErrorAndKeepTheFile)
{
  const Folder folder;
  std::ofstream(folder.file("m.igs")) << "precious";
  vtkNew<vtkIGESWriter> writer;
  writer->SetInputData(vtkNew<vtkPolyData>());
  writer->SetFileName(folder.file("m.igs").c_str());
  ErrorLog log(writer);
  writer->Write();
  EXPECT_TRUE(log.saidOnce("no spline model")) << log.text();
  EXPECT_EQ(contents(folder.file("m.igs")), "precious");
}
