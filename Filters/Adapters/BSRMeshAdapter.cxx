#include "Adapters/BSRMeshAdapter.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <limits>

namespace bsr
{
namespace
{
/// The polygons of exactly N corners of a surface; anything else is an error.
template <std::size_t N>
Status facesFrom(vtkPolyData* surface, const char* kind, const char* cure,
  std::vector<std::array<Index, N>>& faces)
{
  if (surface->GetNumberOfStrips() > 0)
  {
    return Status::invalidInput(std::string("The input has triangle strips; ") + cure);
  }
  if (surface->GetNumberOfPoints() > std::numeric_limits<Index>::max())
  {
    return Status::invalidInput("The input has more than 2^31 points; reduce it first.");
  }
  faces.reserve(static_cast<std::size_t>(surface->GetNumberOfPolys()));
  auto it = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
  for (it->GoToFirstCell(); !it->IsDoneWithTraversal(); it->GoToNextCell())
  {
    vtkIdType n = 0;
    const vtkIdType* ids = nullptr;
    it->GetCurrentCell(n, ids);
    if (n != static_cast<vtkIdType>(N))
    {
      return Status::invalidInput("Polygon " + std::to_string(it->GetCurrentCellId()) + " has " +
                                  std::to_string(n) + " corners, but only " + kind +
                                  " are allowed; " + cure);
    }
    std::array<Index, N> f{};
    for (std::size_t i = 0; i < N; ++i)
    {
      f[i] = static_cast<Index>(ids[i]);
    }
    faces.push_back(f);
  }
  return Status::ok();
}

std::vector<Index> regionFrom(vtkPolyData* surface, const std::string& name, std::size_t faces)
{
  std::vector<Index> region;
  vtkDataArray* a = name.empty() ? nullptr : surface->GetCellData()->GetArray(name.c_str());
  // Cell ids count vertices and lines first; the polygons follow.
  const vtkIdType first = surface->GetNumberOfVerts() + surface->GetNumberOfLines();
  if (a && a->GetNumberOfTuples() >= first + static_cast<vtkIdType>(faces))
  {
    region.resize(faces);
    for (std::size_t i = 0; i < faces; ++i)
    {
      region[i] = static_cast<Index>(a->GetComponent(first + static_cast<vtkIdType>(i), 0));
    }
  }
  return region;
}

template <std::size_t N>
void facesTo(
  const std::vector<Vec3>& points, const std::vector<std::array<Index, N>>& faces, vtkPolyData* out)
{
  vtkNew<vtkPoints> p;
  p->SetDataTypeToDouble();
  p->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    p->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  vtkNew<vtkCellArray> polys;
  const auto count = static_cast<vtkIdType>(faces.size());
  polys->AllocateExact(count, count * static_cast<vtkIdType>(N));
  for (const auto& f : faces)
  {
    vtkIdType ids[N];
    std::copy(f.begin(), f.end(), ids);
    polys->InsertNextCell(static_cast<vtkIdType>(N), ids);
  }
  out->SetPoints(p);
  out->SetPolys(polys);
}
} // namespace

Result<std::vector<Vec3>> pointsFrom(vtkPoints* points)
{
  std::vector<Vec3> out(points ? static_cast<std::size_t>(points->GetNumberOfPoints()) : 0);
  for (std::size_t i = 0; i < out.size(); ++i)
  {
    points->GetPoint(static_cast<vtkIdType>(i), out[i].data());
    if (!out[i].allFinite())
    {
      return Status::invalidInput(
        "Point " + std::to_string(i) +
        " has a NaN or infinite coordinate; remove such points first (Clean, Threshold).");
    }
  }
  return out;
}

Result<TriangleMesh> triangleMeshFrom(vtkPolyData* surface, const std::string& regionArray)
{
  auto points = pointsFrom(surface->GetPoints());
  if (!points)
  {
    return points.status();
  }
  TriangleMesh mesh;
  mesh.Points = std::move(*points);
  Status s = facesFrom<3>(surface, "triangles", "apply the Triangulate filter.", mesh.Triangles);
  if (!s)
  {
    return s;
  }
  mesh.Region = regionFrom(surface, regionArray, mesh.Triangles.size());
  return mesh;
}

Result<QuadMesh> quadMeshFrom(vtkPolyData* layout, const std::string& regionArray)
{
  auto points = pointsFrom(layout->GetPoints());
  if (!points)
  {
    return points.status();
  }
  QuadMesh mesh;
  mesh.Points = std::move(*points);
  Status s =
    facesFrom<4>(layout, "quads", "use a pure quad mesh, as QuadRemesh makes.", mesh.Quads);
  if (!s)
  {
    return s;
  }
  mesh.Region = regionFrom(layout, regionArray, mesh.Quads.size());
  return mesh;
}

void quadMeshTo(const QuadMesh& mesh, vtkPolyData* out)
{
  facesTo<4>(mesh.Points, mesh.Quads, out);
}

void triangleMeshTo(const TriangleMesh& mesh, vtkPolyData* out)
{
  facesTo<3>(mesh.Points, mesh.Triangles, out);
}

void addField(vtkFieldData* field, const char* name, double value)
{
  addField(field, name, std::vector<double>{value});
}

void addField(vtkFieldData* field, const char* name, const std::vector<double>& values)
{
  vtkNew<vtkDoubleArray> a;
  a->SetName(name);
  a->SetNumberOfComponents(std::max(1, static_cast<int>(values.size())));
  if (!values.empty())
  {
    a->InsertNextTuple(values.data());
  }
  field->AddArray(a);
}

void addText(vtkFieldData* field, const char* name, const std::string& text)
{
  vtkNew<vtkStringArray> a;
  a->SetName(name);
  a->InsertNextValue(text);
  field->AddArray(a);
}
} // namespace bsr
