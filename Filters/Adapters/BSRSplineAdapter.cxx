#include "Adapters/BSRSplineAdapter.h"
#include "Spline/ModelCheck.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
/// A field array with the wanted number of components, or a status that names it.
Result<vtkDataArray*> modelArray(vtkFieldData* field, const char* name, int components)
{
  vtkDataArray* a = field ? field->GetArray(name) : nullptr;
  if (!a)
  {
    return Status::invalidInput(std::string("The input is no spline model: its field data lack ") +
                                name +
                                ". Use the output of BSplineG1Fit or another filter that "
                                "makes a spline model.");
  }
  if (a->GetNumberOfComponents() != components)
  {
    return Status::invalidInput(std::string("Not a valid spline model: the field array ") + name +
                                " has " + std::to_string(a->GetNumberOfComponents()) +
                                " components instead of " + std::to_string(components) + ".");
  }
  return a;
}

/// Integers are exact whatever the array's type (a file or a script may have changed it).
std::int64_t integer(vtkDataArray* a, vtkIdType tuple, int component)
{
  const double v = a->GetComponent(tuple, component);
  return std::abs(v) < 9e15 ? static_cast<std::int64_t>(v)
                            : std::numeric_limits<std::int64_t>::min();
}

int narrow(std::int64_t v)
{
  return v >= 0 && v <= 1000000 ? static_cast<int>(v) : -1;
}

SplinePatch patchFrom(vtkDataArray* a, vtkIdType i)
{
  SplinePatch p;
  const std::int64_t shell = integer(a, i, 0);
  p.Side = static_cast<Shell>(shell >= 0 && shell <= 2 ? shell : 255);
  p.DegreeU = narrow(integer(a, i, 1));
  p.DegreeV = narrow(integer(a, i, 2));
  p.CountU = narrow(integer(a, i, 3));
  p.CountV = narrow(integer(a, i, 4));
  p.FirstControlPoint = integer(a, i, 5);
  p.FirstKnotU = integer(a, i, 6);
  p.FirstKnotV = integer(a, i, 7);
  return p;
}

void fillModel(vtkDataArray* patches, vtkDataArray* points, vtkDataArray* knots,
  vtkDataArray* neighbors, SplineModel& m)
{
  for (vtkIdType i = 0; i < patches->GetNumberOfTuples(); ++i)
  {
    m.Patches.push_back(patchFrom(patches, i));
  }
  m.ControlPoints.resize(static_cast<std::size_t>(points->GetNumberOfTuples()));
  for (std::size_t i = 0; i < m.ControlPoints.size(); ++i)
  {
    points->GetTuple(static_cast<vtkIdType>(i), m.ControlPoints[i].data());
  }
  for (vtkIdType i = 0; i < knots->GetNumberOfTuples(); ++i)
  {
    m.Knots.push_back(knots->GetComponent(i, 0));
  }
  for (vtkIdType i = 0; i < neighbors->GetNumberOfTuples(); ++i)
  {
    m.Neighbors.push_back({integer(neighbors, i, 0), integer(neighbors, i, 1),
      integer(neighbors, i, 2), integer(neighbors, i, 3)});
  }
}

void addSurface(const SplineModel& model, const SampledModel& s, vtkPolyData* out)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const auto n = static_cast<vtkIdType>(s.Points.size());
  points->SetNumberOfPoints(n);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(n);
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  uv->SetNumberOfTuples(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    points->SetPoint(i, s.Points[i].data());
    normals->SetTuple(i, s.Normals[i].data());
    uv->SetTuple(i, s.UV[i].data());
  }
  vtkNew<vtkCellArray> polys;
  vtkNew<vtkIntArray> patchId;
  patchId->SetName("PatchId");
  vtkNew<vtkUnsignedCharArray> shell;
  shell->SetName("Shell");
  const auto cells = static_cast<vtkIdType>(s.Polygons.size());
  polys->AllocateExact(cells, 4 * cells);
  for (vtkIdType i = 0; i < cells; ++i)
  {
    const std::array<Index, 4>& q = s.Polygons[i];
    const vtkIdType ids[4] = {q[0], q[1], q[2], q[3]};
    polys->InsertNextCell(q[3] < 0 ? 3 : 4, ids);
    patchId->InsertNextValue(s.PatchId[i]);
    shell->InsertNextValue(static_cast<unsigned char>(model.Patches[s.PatchId[i]].Side));
  }
  out->SetPoints(points);
  out->SetPolys(polys);
  out->GetPointData()->SetNormals(normals);
  out->GetPointData()->AddArray(uv);
  out->GetCellData()->AddArray(patchId);
  out->GetCellData()->AddArray(shell);
}

void addPointArray(const char* name, const std::vector<double>& values, vtkPolyData* out)
{
  if (values.empty())
  {
    return;
  }
  vtkNew<vtkDoubleArray> a;
  a->SetName(name);
  a->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), a->GetPointer(0));
  out->GetPointData()->AddArray(a);
}
} // namespace

bool hasSplineModel(vtkDataObject* data)
{
  return data && data->GetFieldData() && data->GetFieldData()->GetArray("SplinePatches");
}

Result<SplineModel> splineModelFrom(vtkDataObject* data)
{
  vtkFieldData* field = data ? data->GetFieldData() : nullptr;
  Result<vtkDataArray*> patches = modelArray(field, "SplinePatches", 8);
  Result<vtkDataArray*> points = modelArray(field, "SplineControlPoints", 4);
  Result<vtkDataArray*> knots = modelArray(field, "SplineKnots", 1);
  Result<vtkDataArray*> neighbors = modelArray(field, "SplineNeighbors", 4);
  Result<vtkDataArray*> version = modelArray(field, "SplineVersion", 1);
  for (const auto* a : {&patches, &points, &knots, &neighbors, &version})
  {
    if (!*a)
    {
      return a->status();
    }
  }
  if ((*version)->GetNumberOfTuples() != 1 || integer(*version, 0, 0) != 1)
  {
    return Status::invalidInput(
      "This spline model has an unknown SplineVersion; this program reads version 1.");
  }
  SplineModel model;
  fillModel(*patches, *points, *knots, *neighbors, model);
  if (Status s = checkModel(model); !s)
  {
    return s;
  }
  return model;
}

void splineModelTo(const SplineModel& model, vtkFieldData* field)
{
  vtkNew<vtkTypeInt64Array> patches;
  patches->SetName("SplinePatches");
  patches->SetNumberOfComponents(8);
  for (const SplinePatch& p : model.Patches)
  {
    const vtkTypeInt64 row[8] = {static_cast<vtkTypeInt64>(p.Side), p.DegreeU, p.DegreeV, p.CountU,
      p.CountV, p.FirstControlPoint, p.FirstKnotU, p.FirstKnotV};
    patches->InsertNextTypedTuple(row);
  }
  vtkNew<vtkDoubleArray> points;
  points->SetName("SplineControlPoints");
  points->SetNumberOfComponents(4);
  for (const Vec4& c : model.ControlPoints)
  {
    points->InsertNextTypedTuple(c.data());
  }
  vtkNew<vtkDoubleArray> knots;
  knots->SetName("SplineKnots");
  for (const double k : model.Knots)
  {
    knots->InsertNextValue(k);
  }
  vtkNew<vtkTypeInt64Array> neighbors;
  neighbors->SetName("SplineNeighbors");
  neighbors->SetNumberOfComponents(4);
  for (const auto& n : model.Neighbors)
  {
    const vtkTypeInt64 row[4] = {n[0], n[1], n[2], n[3]};
    neighbors->InsertNextTypedTuple(row);
  }
  vtkNew<vtkTypeInt64Array> version;
  version->SetName("SplineVersion");
  version->InsertNextValue(1);
  vtkDataArray* all[5] = {patches, points, knots, neighbors, version};
  for (vtkDataArray* a : all)
  {
    field->AddArray(a);
  }
}

Status splineSurfaceTo(
  const SplineModel& model, const SampleOptions& options, Monitor& monitor, vtkPolyData* out)
{
  vtkNew<vtkFieldData> kept;
  kept->ShallowCopy(out->GetFieldData());
  out->Initialize();
  Result<SampledModel> s = sampleModel(model, options, monitor);
  if (!s)
  {
    return s.status();
  }
  addSurface(model, *s, out);
  addPointArray("MeanCurvature", s->MeanCurvature, out);
  addPointArray("GaussCurvature", s->GaussCurvature, out);
  out->SetFieldData(kept);
  splineModelTo(model, out->GetFieldData());
  return Status::ok();
}

void controlNetTo(const SplineModel& model, vtkPolyData* out)
{
  out->Initialize();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> weight;
  weight->SetName("Weight");
  for (const Vec4& c : model.ControlPoints)
  {
    points->InsertNextPoint(c.data());
    weight->InsertNextValue(c[3]);
  }
  vtkNew<vtkCellArray> polys;
  vtkNew<vtkIntArray> patchId;
  patchId->SetName("PatchId");
  vtkNew<vtkUnsignedCharArray> shell;
  shell->SetName("Shell");
  for (std::size_t i = 0; i < model.Patches.size(); ++i)
  {
    const SplinePatch& p = model.Patches[i];
    for (int v = 0; v + 1 < p.CountV; ++v)
    {
      for (int u = 0; u + 1 < p.CountU; ++u)
      {
        const vtkIdType c = p.FirstControlPoint + static_cast<vtkIdType>(v) * p.CountU + u;
        const vtkIdType ids[4] = {c, c + 1, c + p.CountU + 1, c + p.CountU};
        polys->InsertNextCell(4, ids);
        patchId->InsertNextValue(static_cast<int>(i));
        shell->InsertNextValue(static_cast<unsigned char>(p.Side));
      }
    }
  }
  out->SetPoints(points);
  out->SetPolys(polys);
  out->GetPointData()->AddArray(weight);
  out->GetCellData()->AddArray(patchId);
  out->GetCellData()->AddArray(shell);
}
} // namespace bsr
