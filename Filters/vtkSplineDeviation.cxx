#include "vtkSplineDeviation.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRSplineAdapter.h"
#include "Adapters/BSRWholeInputs.h"
#include "Spline/ClosestPoint.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>

vtkStandardNewMacro(vtkSplineDeviation);

namespace
{
bsr::Result<std::vector<int>> shellsFrom(vtkPointSet* input)
{
  vtkDataArray* side = input->GetPointData()->GetArray("Side");
  if (!side)
  {
    return bsr::Status::invalidInput("MatchSides is on, but the input has no point array Side; "
                                     "apply EDTClassify or turn it off.");
  }
  std::vector<int> shells(static_cast<std::size_t>(side->GetNumberOfTuples()));
  for (std::size_t i = 0; i < shells.size(); ++i)
  {
    const double v = side->GetComponent(static_cast<vtkIdType>(i), 0);
    shells[i] = v == 0.0 ? 0 : v == 1.0 ? 1 : 255;
  }
  return shells;
}

bsr::Result<bsr::Deviation> measure(
  vtkPointSet* input, vtkPolyData* modelData, bool matchSides, bsr::Monitor& monitor)
{
  const auto model = bsr::splineModelFrom(modelData);
  if (!model)
  {
    return model.status();
  }
  const auto points = bsr::pointsFrom(input->GetPoints());
  if (!points)
  {
    return points.status();
  }
  bsr::DeviationOptions options;
  if (matchSides)
  {
    auto shells = shellsFrom(input);
    if (!shells)
    {
      return shells.status();
    }
    options.ShellOfPoint = std::move(*shells);
  }
  return bsr::measureDeviation(*model, *points, options, monitor);
}

void attach(const bsr::Deviation& d, vtkPointSet* output)
{
  vtkNew<vtkDoubleArray> deviation;
  deviation->SetName("Deviation");
  vtkNew<vtkIntArray> patch;
  patch->SetName("DeviationPatch");
  for (std::size_t i = 0; i < d.Distance.size(); ++i)
  {
    deviation->InsertNextValue(d.Distance[i]);
    patch->InsertNextValue(d.PatchId[i]);
  }
  output->GetPointData()->AddArray(deviation);
  output->GetPointData()->AddArray(patch);
  output->GetPointData()->SetActiveScalars("Deviation");
  vtkFieldData* field = output->GetFieldData();
  bsr::addField(field, "RMS", d.RMS);
  bsr::addField(field, "Mean", d.Mean);
  bsr::addField(field, "Max", d.Max);
  bsr::addField(field, "Percentiles", {d.Percentiles.begin(), d.Percentiles.end()});
  const char* names[5] = {"50 %", "75 %", "90 %", "95 %", "99 %"};
  for (int k = 0; k < 5; ++k)
  {
    field->GetArray("Percentiles")->SetComponentName(k, names[k]);
  }
  bsr::addField(field, "Points", static_cast<double>(d.Counted));
}
} // namespace

vtkSplineDeviation::vtkSplineDeviation()
{
  this->SetNumberOfInputPorts(2);
}

int vtkSplineDeviation::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPointSet" : "vtkPolyData");
  return 1;
}

int vtkSplineDeviation::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkPointSet* input = vtkPointSet::GetData(inputs[0]);
  vtkPolyData* model = vtkPolyData::GetData(inputs[1]);
  vtkPointSet* output = vtkPointSet::GetData(outputs);
  if (!input || !model)
  {
    vtkErrorMacro("Connect points to port 0 and a spline model to port 1 (Model).");
    return 0;
  }
  bsr::AlgorithmMonitor monitor(this);
  const auto result = measure(input, model, this->MatchSides, monitor);
  if (!result)
  {
    output->Initialize();
    return bsr::notDelivered(this, result.status());
  }
  output->ShallowCopy(input);
  attach(*result, output);
  return 1;
}

void vtkSplineDeviation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MatchSides: " << this->MatchSides << "\n";
}
