#include "Adapters/BSRSplineAdapter.h"
#include "FilterTesting.h"
#include "SampleModels.h"
#include "Spline/Evaluate.h"
#include "vtkSplineDeviation.h"
#include "vtkSplineSample.h"
#include "vtkSplineToBezier.h"

#include <vtkBezierQuadrilateral.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

using namespace bsr;
using bsrtest::ErrorLog;
using bsrtest::fieldValue;
using bsrtest::surfaceOf;

namespace
{
vtkSmartPointer<vtkPolyData> cloud(const std::vector<Vec3>& points)
{
  auto out = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> p;
  p->SetDataTypeToDouble();
  for (const Vec3& x : points)
  {
    p->InsertNextPoint(x.data());
  }
  out->SetPoints(p);
  return out;
}

/// Largest distance between the Bezier cells, evaluated by VTK, and the model.
double bezierError(const SplineModel& m, vtkUnstructuredGrid* grid)
{
  double worst = 0.0;
  vtkDataArray* patch = grid->GetCellData()->GetArray("PatchId");
  vtkDataArray* domain = grid->GetCellData()->GetArray("Domain");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    vtkCell* cell = grid->GetCell(c);
    std::vector<double> weights(static_cast<std::size_t>(cell->GetNumberOfPoints()));
    for (const auto& st : {Vec2(0, 0), Vec2(1, 0.25), Vec2(0.3, 0.7), Vec2(0.5, 1)})
    {
      double pcoords[3] = {st[0], st[1], 0.0};
      int sub = 0;
      Vec3 x;
      cell->EvaluateLocation(sub, pcoords, x.data(), weights.data());
      const double* d = domain->GetTuple4(c);
      const double u = d[0] + st[0] * (d[1] - d[0]);
      const double v = d[2] + st[1] * (d[3] - d[2]);
      const auto p = static_cast<std::size_t>(patch->GetTuple1(c));
      worst = std::max(worst, (x - evaluatePatch(m, m.Patches[p], u, v).Point).norm());
    }
  }
  return worst;
}
} // namespace

TEST(SplineSample, ResamplesAndKeepsTheModel)
{
  vtkNew<vtkSplineSample> filter;
  filter->SetInputData(surfaceOf(samples::torus()));
  filter->SetResolution(7);
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 16 * 49);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 16 * 49);
  EXPECT_TRUE(splineModelFrom(filter->GetOutput()).isOk());
  vtkDataArray* mean = filter->GetOutput()->GetPointData()->GetArray("MeanCurvature");
  vtkDataArray* gauss = filter->GetOutput()->GetPointData()->GetArray("GaussCurvature");
  ASSERT_TRUE(mean && gauss);
  EXPECT_NEAR(mean->GetRange()[1], 0.5 * (1.0 + 1.0 / 4.0), 1e-3);
  EXPECT_NEAR(gauss->GetRange()[0], -0.5, 1e-2);
  filter->SetTolerance(1e-3);
  filter->CurvaturesOff();
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetNumberOfCells(), 16 * 49);
  EXPECT_FALSE(filter->GetOutput()->GetPointData()->GetArray("MeanCurvature"));
}

TEST(SplineSample, BadInputGivesOneErrorAndNoOutput)
{
  vtkNew<vtkSplineSample> filter;
  filter->SetInputData(vtkNew<vtkPolyData>());
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.saidOnce("spline model")) << log.text();
  for (const auto& [resolution, tolerance] :
    {std::pair<int, double>{0, 0.0}, {1000, 0.0}, {4, -1.0}, {4, NAN}})
  {
    log.clear();
    filter->SetInputData(surfaceOf(samples::ball()));
    filter->SetResolution(resolution);
    filter->SetTolerance(tolerance);
    filter->Update();
    EXPECT_TRUE(log.saidOnce("must be")) << log.text();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  }
}

TEST(SplineToBezier, CellsEqualTheModel)
{
  for (const SplineModel& m : {samples::tube(6, 2, 3), samples::torus(), samples::octantSphere()})
  {
    vtkNew<vtkSplineToBezier> filter;
    filter->SetInputData(surfaceOf(m));
    ErrorLog log(filter);
    filter->Update();
    EXPECT_TRUE(log.empty()) << log.text();
    EXPECT_LT(bezierError(m, filter->GetOutput()), 1e-12);
    EXPECT_EQ(filter->GetOutput()->GetCellType(0), VTK_BEZIER_QUADRILATERAL);
    EXPECT_TRUE(splineModelFrom(filter->GetOutput()).isOk());
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(filter->GetOutput());
    writer->WriteToOutputStringOn();
    writer->Write();
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->ReadFromInputStringOn();
    reader->SetInputString(writer->GetOutputString());
    reader->Update();
    EXPECT_LT(bezierError(m, reader->GetOutput()), 1e-12);
  }
}

TEST(SplineToBezier, PiecesShareTheirControlPoints)
{
  vtkNew<vtkSplineToBezier> filter;
  filter->SetInputData(surfaceOf(samples::ball(1.0, 2, 3)));
  filter->Update();
  // A cube of 6 x 6 bicubic pieces a face: as many points as its 18 x 18 lattice.
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 6 * 36);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 6 * 18 * 18 + 2);
}

TEST(SplineToBezier, BadInputGivesOneError)
{
  vtkNew<vtkSplineToBezier> filter;
  filter->SetInputData(vtkNew<vtkPolyData>());
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.saidOnce("spline model")) << log.text();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST(SplineDeviation, SignedDistancesAndFieldData)
{
  vtkNew<vtkSplineDeviation> filter;
  filter->SetInputData(0, cloud({Vec3(4.5, 0, 0), Vec3(3, 0, 0.25), Vec3(0, 0, 0)}));
  filter->SetInputData(1, surfaceOf(samples::torus()));
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkDataArray* d = filter->GetOutput()->GetPointData()->GetArray("Deviation");
  ASSERT_TRUE(d);
  EXPECT_NEAR(d->GetTuple1(0), 0.5, 1e-12);
  EXPECT_NEAR(d->GetTuple1(1), -0.75, 1e-12);
  EXPECT_NEAR(d->GetTuple1(2), 2.0, 1e-12);
  EXPECT_NEAR(fieldValue(filter->GetOutput(), "Max"), 2.0, 1e-12);
  EXPECT_NEAR(fieldValue(filter->GetOutput(), "RMS"), std::sqrt((0.25 + 0.5625 + 4) / 3), 1e-12);
  EXPECT_NEAR(fieldValue(filter->GetOutput(), "Percentiles"), 0.75, 1e-12);
}

TEST(SplineDeviation, MatchSidesKeepsToTheShell)
{
  auto points = cloud({Vec3(0.9, 0, 0), Vec3(0.9, 0, 0), Vec3(0.9, 0, 0)});
  vtkNew<vtkIntArray> side;
  side->SetName("Side");
  for (const int s : {0, 1, 255})
  {
    side->InsertNextValue(s);
  }
  points->GetPointData()->AddArray(side);
  vtkNew<vtkSplineDeviation> filter;
  filter->SetInputData(0, points);
  filter->SetInputData(1, surfaceOf(samples::hollowBall()));
  filter->MatchSidesOn();
  filter->Update();
  EXPECT_GT(
    std::abs(filter->GetOutput()->GetPointData()->GetArray("Deviation")->GetTuple1(1)), 0.3);
  EXPECT_EQ(fieldValue(filter->GetOutput(), "Points"), 2.0);
}

TEST(SplineDeviation, BadInputGivesOneErrorAndNoOutput)
{
  const auto refused = [](vtkPolyData* points, vtkPolyData* model, const char* text, bool match)
  {
    vtkNew<vtkSplineDeviation> filter;
    filter->SetInputData(0, points);
    filter->SetInputData(1, model);
    filter->SetMatchSides(match);
    ErrorLog log(filter);
    filter->Update();
    EXPECT_TRUE(log.saidOnce(text)) << log.text();
    auto* out = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
    EXPECT_TRUE(!out || out->GetNumberOfPoints() == 0);
  };
  const auto model = surfaceOf(samples::ball());
  const auto point = cloud({Vec3(0, 0, 0)});
  refused(vtkNew<vtkPolyData>(), model, "no point", false);
  refused(cloud({Vec3(NAN, 0, 0)}), model, "NaN", false);
  refused(point, point, "spline model", false);
  refused(point, model, "Side", true);
}
