#ifndef CubeLayout_h
#define CubeLayout_h

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <cmath>

/// The smallest input of a fit: a cube as the layout of partitioned points of the unit sphere.
namespace bsrtest
{
constexpr int CubeFaces[6][4] = {
  {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
constexpr double CubeCorners[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
  {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};

/// The cube as a layout; the last face may be made a triangle.
inline vtkSmartPointer<vtkPolyData> cubeLayout(bool triangle = false)
{
  auto quads = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const auto& c : CubeCorners)
  {
    points->InsertNextPoint(c);
  }
  vtkNew<vtkCellArray> cells;
  for (int f = 0; f < 6; ++f)
  {
    const vtkIdType ids[4] = {CubeFaces[f][0], CubeFaces[f][1], CubeFaces[f][2], CubeFaces[f][3]};
    cells->InsertNextCell(triangle && f == 5 ? 3 : 4, ids);
  }
  quads->SetPoints(points);
  quads->SetPolys(cells);
  return quads;
}

/// n x n points a face of the cube, blown up to the unit sphere, partitioned.
inline vtkSmartPointer<vtkPolyData> spherePoints(int n)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> places;
  vtkNew<vtkIntArray> quad;
  quad->SetName("QuadId");
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  for (int i = 0; i < 6 * n * n; ++i)
  {
    const int f = i / (n * n);
    const double u = (i % n + 0.5) / n;
    const double v = (i / n % n + 0.5) / n;
    double x[3];
    double size = 0.0;
    for (int d = 0; d < 3; ++d)
    {
      x[d] = (1 - v) *
               ((1 - u) * CubeCorners[CubeFaces[f][0]][d] + u * CubeCorners[CubeFaces[f][1]][d]) +
             v * ((1 - u) * CubeCorners[CubeFaces[f][3]][d] + u * CubeCorners[CubeFaces[f][2]][d]);
      size += x[d] * x[d];
    }
    for (double& c : x)
    {
      c /= std::sqrt(size);
    }
    places->InsertNextPoint(x);
    quad->InsertNextValue(f);
    uv->InsertNextTuple2(u, v);
  }
  data->SetPoints(places);
  data->GetPointData()->AddArray(quad);
  data->GetPointData()->AddArray(uv);
  return data;
}
} // namespace bsrtest

#endif
