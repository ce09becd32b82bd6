#include "vtkSplineToBezier.h"

#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRSplineAdapter.h"
#include "Adapters/BSRWholeInputs.h"
#include "Spline/Bezier.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkSplineToBezier);

namespace
{
using bsr::BezierPatch;

/// Grid positions of a Bezier quadrilateral's points in VTK's order: corners, sides, interior.
std::vector<std::array<int, 2>> cellOrder(int n, int m)
{
  std::vector<std::array<int, 2>> order = {{0, 0}, {n, 0}, {n, m}, {0, m}};
  for (int i = 1; i < n; ++i)
  {
    order.push_back({i, 0});
  }
  for (int j = 1; j < m; ++j)
  {
    order.push_back({n, j});
  }
  for (int i = 1; i < n; ++i)
  {
    order.push_back({i, m});
  }
  for (int j = 1; j < m; ++j)
  {
    order.push_back({0, j});
  }
  for (int j = 1; j < m; ++j)
  {
    for (int i = 1; i < n; ++i)
    {
      order.push_back({i, j});
    }
  }
  return order;
}

/// The arrays of the grid while it grows.
struct Builder
{
  vtkNew<vtkDoubleArray> Degrees;
  vtkNew<vtkIntArray> PatchId;
  vtkNew<vtkUnsignedCharArray> Shell;
  vtkNew<vtkDoubleArray> Domain;

  Builder()
  {
    this->Degrees->SetName("HigherOrderDegrees");
    this->Degrees->SetNumberOfComponents(3);
    this->PatchId->SetName("PatchId");
    this->Shell->SetName("Shell");
    this->Domain->SetName("Domain");
    this->Domain->SetNumberOfComponents(4);
  }

  void addPatch(const BezierPatch& b, const bsr::Index* ids, int patch, bsr::Shell shell,
    vtkUnstructuredGrid* out)
  {
    const auto order = cellOrder(b.DegreeU, b.DegreeV);
    std::vector<vtkIdType> cell(order.size());
    const std::int64_t width = b.size()[0];
    for (std::size_t j = 0; j + 1 < b.EndsV.size(); ++j)
    {
      for (std::size_t i = 0; i + 1 < b.EndsU.size(); ++i)
      {
        const bsr::Index* corner = ids + static_cast<std::int64_t>(j) * b.DegreeV * width +
                                   static_cast<std::int64_t>(i) * b.DegreeU;
        for (std::size_t k = 0; k < order.size(); ++k)
        {
          cell[k] = corner[order[k][1] * width + order[k][0]];
        }
        out->InsertNextCell(
          VTK_BEZIER_QUADRILATERAL, static_cast<vtkIdType>(cell.size()), cell.data());
        this->Degrees->InsertNextTuple3(b.DegreeU, b.DegreeV, 0);
        this->PatchId->InsertNextValue(patch);
        this->Shell->InsertNextValue(static_cast<unsigned char>(shell));
        this->Domain->InsertNextTuple4(b.EndsU[i], b.EndsU[i + 1], b.EndsV[j], b.EndsV[j + 1]);
      }
    }
  }
};

void addPoints(
  const std::vector<BezierPatch>& pieces, const bsr::StitchedGrids& grids, vtkUnstructuredGrid* out)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> weights;
  weights->SetName("RationalWeights");
  std::size_t patch = 0;
  for (const std::int64_t owner : grids.Owner)
  {
    while (patch + 1 < grids.First.size() && owner >= grids.First[patch + 1])
    {
      ++patch;
    }
    const bsr::Vec4& p = pieces[patch].Points[owner - grids.First[patch]];
    points->InsertNextPoint(p.data());
    weights->InsertNextValue(p[3]);
  }
  out->SetPoints(points);
  out->GetPointData()->SetRationalWeights(weights);
}

bool fill(const bsr::SplineModel& model, bsr::Monitor& monitor, vtkUnstructuredGrid* out)
{
  std::vector<BezierPatch> pieces;
  std::vector<bsr::GridSize> sizes;
  for (const bsr::SplinePatch& p : model.Patches)
  {
    if (monitor.cancelled())
    {
      return false;
    }
    pieces.push_back(bsr::bezierPieces(model, p));
    sizes.push_back(pieces.back().size());
    monitor.progress(
      static_cast<double>(pieces.size()) / static_cast<double>(model.Patches.size()));
  }
  const bsr::StitchedGrids grids = bsr::stitchGrids(model, sizes, false);
  addPoints(pieces, grids, out);
  Builder builder;
  const auto count = static_cast<vtkIdType>(pieces.size());
  out->AllocateExact(count, 16 * count);
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    builder.addPatch(
      pieces[p], grids.Id.data() + grids.First[p], static_cast<int>(p), model.Patches[p].Side, out);
  }
  out->GetCellData()->SetHigherOrderDegrees(builder.Degrees);
  out->GetCellData()->AddArray(builder.PatchId);
  out->GetCellData()->AddArray(builder.Shell);
  out->GetCellData()->AddArray(builder.Domain);
  return true;
}
} // namespace

int vtkSplineToBezier::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkSplineToBezier::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputs);
  const auto model = bsr::splineModelFrom(input);
  if (!model)
  {
    output->Initialize();
    vtkErrorMacro(<< model.status().message());
    return 0;
  }
  bsr::AlgorithmMonitor monitor(this);
  if (!fill(*model, monitor, output))
  {
    output->Initialize();
    return 0;
  }
  output->GetFieldData()->ShallowCopy(input->GetFieldData());
  return 1;
}

void vtkSplineToBezier::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
