#include "vtkFillHolesRBF.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRWholeInputs.h"
#include "Mesh/FillHoles.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <chrono>

vtkStandardNewMacro(vtkFillHolesRBF);

namespace
{
/// The input's points with new ones after them; arrays of new points from a point near them.
void pointsTo(const bsr::FilledMesh& filled, vtkPolyData* input, vtkPolyData* output)
{
  const vtkIdType old = input->GetNumberOfPoints();
  const auto all = static_cast<vtkIdType>(filled.Mesh.Points.size());
  vtkNew<vtkPoints> points;
  points->SetDataType(input->GetPoints()->GetDataType());
  points->DeepCopy(input->GetPoints());
  points->Resize(all);
  vtkPointData* from = input->GetPointData();
  vtkPointData* to = output->GetPointData();
  to->CopyAllOn();
  to->CopyAllocate(from, all);
  to->CopyData(from, 0, old, 0);
  for (vtkIdType i = old; i < all; ++i)
  {
    points->InsertNextPoint(filled.Mesh.Points[static_cast<std::size_t>(i)].data());
    to->CopyData(from, filled.NearPoint[static_cast<std::size_t>(i - old)], i);
  }
  output->SetPoints(points);
}

/// The input's triangles (vertices and lines are dropped) with new ones after them.
void trianglesTo(const bsr::FilledMesh& filled, vtkPolyData* input, vtkPolyData* output)
{
  const vtkIdType old = input->GetNumberOfPolys();
  const auto all = static_cast<vtkIdType>(filled.Mesh.Triangles.size());
  vtkNew<vtkCellArray> polys;
  polys->DeepCopy(input->GetPolys());
  for (vtkIdType i = old; i < all; ++i)
  {
    const auto& t = filled.Mesh.Triangles[static_cast<std::size_t>(i)];
    const vtkIdType ids[3] = {t[0], t[1], t[2]};
    polys->InsertNextCell(3, ids);
  }
  output->SetPolys(polys);
  vtkCellData* from = input->GetCellData();
  vtkCellData* to = output->GetCellData();
  to->CopyAllocate(from, all);
  const vtkIdType skipped = input->GetNumberOfVerts() + input->GetNumberOfLines();
  to->CopyData(from, 0, old, skipped);
  for (int a = 0; a < to->GetNumberOfArrays(); ++a)
  {
    if (vtkDataArray* array = to->GetArray(a))
    {
      array->Resize(all);
      array->SetNumberOfTuples(all);
      for (int c = 0; c < array->GetNumberOfComponents(); ++c)
      {
        for (vtkIdType i = old; i < all; ++i)
        {
          array->SetComponent(i, c, 0.0);
        }
      }
    }
  }
  vtkNew<vtkUnsignedCharArray> flag;
  flag->SetName("Filled");
  flag->SetNumberOfValues(all);
  for (vtkIdType i = 0; i < all; ++i)
  {
    flag->SetValue(i, i < old ? 0 : 1);
  }
  to->AddArray(flag);
}

void report(const bsr::FilledMesh& filled, vtkFieldData* field)
{
  std::vector<double> size;
  std::vector<double> edges;
  std::vector<double> triangles;
  std::vector<double> state;
  for (const bsr::HoleReport& h : filled.Holes)
  {
    size.push_back(h.Size);
    edges.push_back(h.Edges);
    triangles.push_back(h.Triangles);
    state.push_back(static_cast<double>(h.State));
  }
  bsr::addField(field, "FilledHoles", filled.filled());
  bsr::addField(field, "LeftHoles", static_cast<double>(filled.Holes.size()) - filled.filled());
  bsr::addField(field, "HoleSize", size);
  bsr::addField(field, "HoleEdges", edges);
  bsr::addField(field, "HoleTriangles", triangles);
  bsr::addField(field, "HoleState", state);
}
} // namespace

int vtkFillHolesRBF::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  const auto start = std::chrono::steady_clock::now();
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  const auto mesh = bsr::triangleMeshFrom(input);
  if (!mesh)
  {
    vtkErrorMacro(<< mesh.status().message());
    return 0;
  }
  bsr::FillHolesOptions options;
  options.MaximumSize = this->MaximumHoleSize;
  options.Relative = this->SizeUnit == SHARE_OF_DIAGONAL;
  options.KeepCutEnds = this->KeepCutEnds;
  bsr::AlgorithmMonitor monitor(this);
  const auto filled = bsr::fillHoles(*mesh, options, monitor);
  if (!filled)
  {
    output->Initialize();
    return bsr::notDelivered(this, filled.status());
  }
  pointsTo(*filled, input, output);
  trianglesTo(*filled, input, output);
  report(*filled, output->GetFieldData());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  bsr::addField(output->GetFieldData(), "Seconds", seconds.count());
  return 1;
}

void vtkFillHolesRBF::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumHoleSize: " << this->MaximumHoleSize << "\n";
  os << indent << "SizeUnit: " << this->SizeUnit << "\n";
  os << indent << "KeepCutEnds: " << this->KeepCutEnds << "\n";
}
