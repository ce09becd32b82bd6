#include "FilterTesting.h"
#include "vtkSurfaceFromPoints.h"

#include <vtkCell.h>
#include <vtkFeatureEdges.h>
#include <vtkMath.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

using bsrtest::ErrorLog;

namespace
{
/// Points of a torus of radii 1 and 0.4, without those of x > `cut`.
vtkSmartPointer<vtkPolyData> torus(double cut)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 120; ++i)
  {
    for (int j = 0; j < 48; ++j)
    {
      const double a = 2.0 * M_PI * (i + 0.5 * (j % 2)) / 120;
      const double b = 2.0 * M_PI * j / 48;
      const double r = 1.0 + 0.4 * std::cos(b);
      if (r * std::cos(a) <= cut)
      {
        points->InsertNextPoint(r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b));
      }
    }
  }
  vtkNew<vtkPolyData> p;
  p->SetPoints(points);
  return p;
}

vtkIdType edges(vtkPolyData* p, bool boundary)
{
  vtkNew<vtkFeatureEdges> e;
  e->SetInputData(p);
  e->FeatureEdgesOff();
  e->SetBoundaryEdges(boundary);
  e->SetNonManifoldEdges(!boundary);
  e->Update();
  return e->GetOutput()->GetNumberOfCells();
}
} // namespace

TEST(SurfaceFromPointsFilter, MakesAClosedTorusThatFacesOutward)
{
  vtkNew<vtkSurfaceFromPoints> filter;
  filter->SetInputDataObject(0, torus(9.0));
  ErrorLog log(filter);
  filter->Update();
  EXPECT_TRUE(log.empty()) << log.text();
  vtkPolyData* surface = filter->GetOutput(vtkSurfaceFromPoints::SURFACE);
  ASSERT_GT(surface->GetNumberOfPolys(), 1000);
  EXPECT_EQ(edges(surface, true), 0);
  EXPECT_EQ(edges(surface, false), 0);
  // Closed, of triangles: E = 3 F / 2, so V - F / 2 is the Euler characteristic.
  EXPECT_EQ(2 * surface->GetNumberOfPoints(), surface->GetNumberOfPolys());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    EXPECT_NEAR(std::hypot(std::hypot(p[0], p[1]) - 1.0, p[2]), 0.4, 0.01);
  }
  double volume = 0.0;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkCell* t = surface->GetCell(c);
    double x[3][3];
    for (int k = 0; k < 3; ++k)
    {
      t->GetPoints()->GetPoint(k, x[k]);
    }
    volume += vtkMath::Determinant3x3(x[0], x[1], x[2]) / 6.0;
  }
  EXPECT_NEAR(volume, 2.0 * M_PI * M_PI * 0.16, 0.05);
  vtkPolyData* points = filter->GetOutput(vtkSurfaceFromPoints::POINTS);
  EXPECT_EQ(points->GetNumberOfPoints(), 120 * 48);
  EXPECT_TRUE(points->GetPointData()->GetNormals());
  EXPECT_TRUE(points->GetPointData()->GetArray("Spacing"));
}

TEST(SurfaceFromPointsFilter, EndsWhereThePointsEnd)
{
  vtkNew<vtkSurfaceFromPoints> filter;
  filter->SetInputDataObject(0, torus(0.0));
  filter->Update();
  vtkPolyData* surface = filter->GetOutput(vtkSurfaceFromPoints::SURFACE);
  EXPECT_GT(edges(surface, true), 20);
  EXPECT_EQ(edges(surface, false), 0);
  // About half a sample (0.05) over the last points.
  EXPECT_LT(surface->GetBounds()[1], 0.06);
  EXPECT_GT(surface->GetBounds()[1], -0.07);
}

TEST(SurfaceFromPointsFilter, UnevenPointsGiveASurfaceOfSmallGapsAtMost)
{
  // Five times as far from each other on one half of a sphere, as on a grid of golden angles.
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const int count : {20000, 800})
  {
    for (int i = 0; i < count; ++i)
    {
      const double z = 1.0 - 2.0 * (i + 0.5) / count;
      const double r = std::sqrt(1.0 - z * z);
      const double a = 2.399963229728653 * i;
      if ((z > 0.0) == (count == 20000))
      {
        points->InsertNextPoint(r * std::cos(a), r * std::sin(a), z);
      }
    }
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkSurfaceFromPoints> filter;
  filter->SetInputData(cloud);
  filter->Update();
  vtkPolyData* surface = filter->GetOutput(vtkSurfaceFromPoints::SURFACE);
  ASSERT_GT(surface->GetNumberOfPolys(), 1000);
  EXPECT_LE(edges(surface, true), 12);
  EXPECT_EQ(edges(surface, false), 0);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    EXPECT_NEAR(vtkMath::Norm(p), 1.0, 0.02);
  }
}

TEST(SurfaceFromPointsFilter, BadInputGivesOneErrorAndNoOutput)
{
  const auto refused = [](vtkPolyData* input, double reach, const char* text)
  {
    vtkNew<vtkSurfaceFromPoints> filter;
    filter->SetInputDataObject(0, input);
    filter->SetReach(reach);
    ErrorLog log(filter);
    filter->Update();
    EXPECT_TRUE(log.saidOnce(text)) << log.text();
    EXPECT_EQ(filter->GetOutput(0)->GetNumberOfPoints(), 0);
    EXPECT_EQ(filter->GetOutput(1)->GetNumberOfPoints(), 0);
  };
  refused(vtkNew<vtkPolyData>(), 1.2, "fewer than 8");
  refused(torus(0.0), -1.0, "Reach");
  const auto nan = torus(0.0);
  nan->GetPoints()->SetPoint(3, NAN, 0, 0);
  refused(nan, 1.2, "NaN");
}
