#include "Adapters/BSRSurfaceAdapter.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <limits>

namespace bsr
{
namespace
{
bool onlyTriangles(vtkPolyData* surface)
{
  if (surface->GetNumberOfVerts() + surface->GetNumberOfLines() + surface->GetNumberOfStrips() > 0)
  {
    return false;
  }
  const vtkIdType size = surface->GetPolys()->IsHomogeneous();
  return size == 3 || size == 0;
}

vtkSmartPointer<vtkPolyData> triangulated(vtkPolyData* surface)
{
  auto out = vtkSmartPointer<vtkPolyData>::New();
  if (onlyTriangles(surface))
  {
    out->ShallowCopy(surface);
    return out;
  }
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(surface);
  triangulate->PassVertsOff();
  triangulate->PassLinesOff();
  triangulate->Update();
  out->ShallowCopy(triangulate->GetOutput());
  return out;
}

std::vector<Index> regionsFrom(
  vtkPolyData* surface, const TriangleMesh& mesh, const std::string& name, bool& ofPoints)
{
  std::vector<Index> region;
  if (name.empty())
  {
    return region;
  }
  vtkDataArray* cells = surface->GetCellData()->GetArray(name.c_str());
  vtkDataArray* points = surface->GetPointData()->GetArray(name.c_str());
  ofPoints = !cells && points;
  const auto valueAt = [](vtkDataArray* a, Index i)
  { return static_cast<Index>(a->GetComponent(i, 0)); };
  for (std::size_t t = 0; (cells || points) && t < mesh.Triangles.size(); ++t)
  {
    if (cells)
    {
      region.push_back(valueAt(cells, static_cast<Index>(t)));
      continue;
    }
    const auto& c = mesh.Triangles[t];
    const Index a = valueAt(points, c[0]);
    const Index b = valueAt(points, c[1]);
    const Index d = valueAt(points, c[2]);
    region.push_back(a == b || a == d ? a : b == d ? b : std::min({a, b, d}));
  }
  return region;
}
} // namespace

Result<SurfaceInput> surfaceFrom(vtkPolyData* surface, const std::string& regionArray)
{
  if (surface->GetNumberOfPoints() > std::numeric_limits<Index>::max() / 6)
  {
    return Status::invalidInput("The surface has too many points; reduce it first (Decimate).");
  }
  SurfaceInput input;
  input.Triangles = triangulated(surface);
  vtkPolyData* from = input.Triangles;
  TriangleMesh& mesh = input.Mesh;
  mesh.Points.resize(static_cast<std::size_t>(from->GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    from->GetPoint(static_cast<vtkIdType>(i), mesh.Points[i].data());
  }
  mesh.Triangles.reserve(static_cast<std::size_t>(from->GetNumberOfPolys()));
  auto it = vtk::TakeSmartPointer(from->GetPolys()->NewIterator());
  for (it->GoToFirstCell(); !it->IsDoneWithTraversal(); it->GoToNextCell())
  {
    vtkIdType n = 0;
    const vtkIdType* ids = nullptr;
    it->GetCurrentCell(n, ids);
    mesh.Triangles.push_back(
      {static_cast<Index>(ids[0]), static_cast<Index>(ids[1]), static_cast<Index>(ids[2])});
  }
  mesh.Region = regionsFrom(from, mesh, regionArray, input.RegionsOfPoints);
  return input;
}

Result<std::vector<double>> pointArrayFrom(vtkPolyData* surface, const std::string& name)
{
  vtkDataArray* a = surface->GetPointData()->GetArray(name.c_str());
  if (!a || a->GetNumberOfComponents() != 1)
  {
    std::string there;
    for (int i = 0; i < surface->GetPointData()->GetNumberOfArrays(); ++i)
    {
      const char* n = surface->GetPointData()->GetArrayName(i);
      there += n ? " " + std::string(n) : "";
    }
    return Status::invalidInput(
      "The surface has no point array \"" + name +
      "\" of one component; there are:" + (there.empty() ? " none" : there) + ".");
  }
  std::vector<double> values(static_cast<std::size_t>(a->GetNumberOfTuples()));
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = a->GetComponent(static_cast<vtkIdType>(i), 0);
  }
  return values;
}
} // namespace bsr
