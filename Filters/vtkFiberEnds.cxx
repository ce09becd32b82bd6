#include "vtkFiberEnds.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRWholeInputs.h"
#include "Mesh/FiberEnds.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

vtkStandardNewMacro(vtkFiberEnds);

namespace
{
bsr::Result<std::vector<bsr::EndMouth>> mouthsFrom(vtkPolyData* raw)
{
  vtkDataArray* array = raw->GetFieldData()->GetArray("LumenMouths");
  if (!array || array->GetNumberOfComponents() != 7)
  {
    return bsr::Status::invalidInput("The raw surface lacks the field array LumenMouths. Connect "
                                     "the output of EDT Classify, method Facing Void.");
  }
  std::vector<bsr::EndMouth> mouths;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    double t[7];
    array->GetTuple(i, t);
    mouths.push_back({{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, t[6]});
  }
  return mouths;
}

constexpr std::uint8_t Neither = 2; ///< wall: debris, pores, or a value that is no side

/// The raw surface with its sides; without the array Side all of it is outer wall.
bsr::Result<bsr::FiberWall> wallFrom(vtkPolyData* raw)
{
  bsr::FiberWall wall;
  if (raw->GetNumberOfPoints() == 0)
  {
    return wall;
  }
  if (raw->GetNumberOfPolys() + raw->GetNumberOfStrips() > 0)
  {
    auto mesh = bsr::triangleMeshFrom(raw);
    if (!mesh)
    {
      return mesh.status();
    }
    wall.Surface = std::move(*mesh);
  }
  else
  {
    auto points = bsr::pointsFrom(raw->GetPoints());
    if (!points)
    {
      return points.status();
    }
    wall.Surface.Points = std::move(*points);
  }
  wall.Side.assign(wall.Surface.Points.size(), 0);
  if (vtkDataArray* side = raw->GetPointData()->GetArray("Side"))
  {
    for (std::size_t i = 0; i < wall.Side.size(); ++i)
    {
      const double value = side->GetComponent(static_cast<vtkIdType>(i), 0);
      wall.Side[i] = value == 0.0 ? 0 : value == 1.0 ? 1 : Neither;
    }
  }
  return wall;
}

bsr::Result<bsr::FiberEnds> findEnds(vtkPolyData* surface, vtkPolyData* raw, bsr::Monitor& monitor)
{
  const auto mesh = bsr::triangleMeshFrom(surface);
  if (!mesh)
  {
    return mesh.status();
  }
  const auto mouths = mouthsFrom(raw);
  if (!mouths)
  {
    return mouths.status();
  }
  const auto wall = wallFrom(raw);
  if (!wall)
  {
    return wall.status();
  }
  return bsr::findFiberEnds(*mesh, *mouths, *wall, monitor);
}

void attach(const bsr::FiberEnds& ends, vtkPolyData* output)
{
  vtkNew<vtkIntArray> region;
  region->SetName("EndRegion");
  region->SetNumberOfTuples(static_cast<vtkIdType>(ends.Surface.Region.size()));
  std::copy(ends.Surface.Region.begin(), ends.Surface.Region.end(), region->GetPointer(0));
  output->GetCellData()->SetScalars(region);
  bsr::addField(output->GetFieldData(), "OpenEnds", static_cast<double>(ends.Rims.size()));
  bsr::addText(output->GetFieldData(), "EndsNote", ends.Note);
}

/// The rims as closed polylines with points of their own.
void rimsTo(const bsr::FiberEnds& ends, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> region;
  region->SetName("EndRegion");
  for (std::size_t k = 0; k < ends.Rims.size(); ++k)
  {
    const auto& rim = ends.Rims[k];
    lines->InsertNextCell(static_cast<int>(rim.size()) + 1);
    const vtkIdType first = points->GetNumberOfPoints();
    for (const bsr::Index v : rim)
    {
      lines->InsertCellPoint(points->InsertNextPoint(ends.Surface.Points[v].data()));
    }
    lines->InsertCellPoint(first);
    region->InsertNextValue(static_cast<int>(k) + 1);
  }
  output->SetPoints(points);
  output->SetLines(lines);
  output->GetCellData()->SetScalars(region);
}
} // namespace

vtkFiberEnds::vtkFiberEnds()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

int vtkFiberEnds::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkPolyData* surface = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* raw = vtkPolyData::GetData(inputs[1]);
  vtkPolyData* output = vtkPolyData::GetData(outputs, 0);
  vtkPolyData* rims = vtkPolyData::GetData(outputs, 1);
  output->Initialize();
  rims->Initialize();
  bsr::AlgorithmMonitor monitor(this);
  const auto ends = findEnds(surface, raw, monitor);
  if (!ends)
  {
    return bsr::notDelivered(this, ends.status());
  }
  output->GetFieldData()->ShallowCopy(surface->GetFieldData());
  bsr::triangleMeshTo(ends->Surface, output);
  attach(*ends, output);
  rimsTo(*ends, rims);
  return 1;
}

void vtkFiberEnds::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
