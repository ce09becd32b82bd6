#include "vtkBranchedContourSurface.h"

#include "Adapters/BSRContourAdapter.h"
#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRSplineAdapter.h"
#include "Adapters/BSRWholeInputs.h"
#include "Contour/BranchedReport.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <chrono>

vtkStandardNewMacro(vtkBranchedContourSurface);

namespace
{
void setName(std::string& own, const char* name, vtkObject* object)
{
  const std::string value = name && std::string(name) != "None" ? name : "";
  if (value != own)
  {
    own = value;
    object->Modified();
  }
}

template <class Array, class Value>
void addColumn(vtkTable* table, const char* name, std::size_t count, const Value& value)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    column->SetComponent(static_cast<vtkIdType>(i), 0, static_cast<double>(value(i)));
  }
  table->AddColumn(column);
}

void reportTo(const bsr::BranchedSurface& s, const bsr::BranchedReport& r, vtkTable* table)
{
  const std::size_t n = s.Origins.size();
  addColumn<vtkIntArray>(table, "PatchId", n, [](std::size_t i) { return i; });
  addColumn<vtkUnsignedCharArray>(
    table, "Shell", n, [&](std::size_t i) { return static_cast<int>(s.Model.Patches[i].Side); });
  addColumn<vtkIntArray>(table, "Points", n, [&](std::size_t i) { return r.Input.Points[i]; });
  addColumn<vtkDoubleArray>(table, "RMS", n, [&](std::size_t i) { return r.Input.RMS[i]; });
  addColumn<vtkDoubleArray>(table, "Max", n, [&](std::size_t i) { return r.Input.Max[i]; });
  addColumn<vtkDoubleArray>(table, "MinJacobian", n, [&](std::size_t i) { return s.Jacobians[i]; });
  addColumn<vtkDoubleArray>(table, "NormalJump", n, [&](std::size_t i) { return r.NormalJump[i]; });
  addColumn<vtkIntArray>(table, "Tube", n, [&](std::size_t i) { return s.Origins[i].Tube; });
  addColumn<vtkIntArray>(table, "Cap", n, [&](std::size_t i) { return s.Origins[i].Cap; });
  addColumn<vtkIntArray>(
    table, "Component", n, [&](std::size_t i) { return s.Origins[i].Component; });
}

std::vector<double> listOf(const bsr::Percentiles& p)
{
  return {p.Value.begin(), p.Value.end()};
}

void totalsTo(
  const bsr::BranchedSurface& s, const bsr::BranchedReport& r, double seconds, vtkFieldData* field)
{
  bsr::addField(field, "RMS", r.Input.TotalRMS);
  bsr::addField(field, "Max", r.Input.TotalMax);
  bsr::addField(field, "MaxNormalJump", r.MaxNormalJump);
  bsr::addField(field, "JunctionNormalJump", r.JunctionNormalJump);
  bsr::addField(field, "FoldedPatches", s.FoldedPatches);
  bsr::addField(field, "Tubes", static_cast<double>(s.Network.Tubes.size()));
  bsr::addField(field, "Junctions", static_cast<double>(s.Network.Junctions.size()));
  bsr::addField(field, "OpenSides", static_cast<double>(r.OpenSides));
  bsr::addField(field, "ResliceThere", listOf(r.Reslice.There));
  bsr::addField(field, "ResliceBack", listOf(r.Reslice.Back));
  bsr::addField(field, "Seconds", seconds);
  vtkNew<vtkIntArray> source;
  source->SetName("LeftOutContours");
  vtkNew<vtkStringArray> reasons;
  reasons->SetName("LeftOutReasons");
  for (const bsr::NetworkNote& n : r.LeftOut)
  {
    source->InsertNextValue(n.Source);
    reasons->InsertNextValue(n.Text);
  }
  field->AddArray(source);
  field->AddArray(reasons);
}

/// A surface with its report.
struct Made
{
  bsr::BranchedSurface Surface;
  bsr::BranchedReport Report;
};

bsr::Result<Made> make(vtkPolyData* input, const std::string& slices, const std::string& components,
  bsr::StackOptions stackOptions, const bsr::BranchedOptions& options, vtkAlgorithm* self)
{
  auto contours = bsr::contoursFrom(input, slices, components);
  if (!contours)
  {
    return contours.status();
  }
  stackOptions.SliceOf = std::move(contours->SliceOf);
  stackOptions.ComponentOf = std::move(contours->ComponentOf);
  bsr::AlgorithmMonitor first(self, 0.0, 0.1);
  const auto stack = bsr::buildStack(contours->Lines, stackOptions, first);
  if (!stack)
  {
    return stack.status();
  }
  bsr::AlgorithmMonitor second(self, 0.1, 0.6);
  auto surface = bsr::makeBranchedSurface(*stack, options, second);
  if (!surface)
  {
    return surface.status();
  }
  bsr::AlgorithmMonitor third(self, 0.6, 0.9);
  auto report = bsr::reportBranched(*surface, *stack, third);
  if (!report)
  {
    return report.status();
  }
  return Made{std::move(*surface), std::move(*report)};
}
} // namespace

vtkBranchedContourSurface::vtkBranchedContourSurface()
{
  this->SetNumberOfOutputPorts(3);
}

void vtkBranchedContourSurface::SetSliceArray(const char* name)
{
  setName(this->SliceArray, name, this);
}

void vtkBranchedContourSurface::SetComponentArray(const char* name)
{
  setName(this->ComponentArray, name, this);
}

int vtkBranchedContourSurface::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 2 ? "vtkTable" : "vtkPolyData");
  return 1;
}

int vtkBranchedContourSurface::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  const auto start = std::chrono::steady_clock::now();
  vtkPolyData* model = vtkPolyData::GetData(outputs, 0);
  vtkPolyData* net = vtkPolyData::GetData(outputs, 1);
  vtkTable* table = vtkTable::GetData(outputs, 2);
  model->Initialize();
  net->Initialize();
  table->Initialize();
  bsr::StackOptions stack;
  stack.MinimumOverlap = this->MinimumOverlap;
  stack.MatchDistance = this->MatchDistance;
  stack.PlaneTolerance = this->PlaneTolerance;
  bsr::BranchedOptions o;
  o.OrderU = this->OrderU;
  o.OrderV = this->OrderV;
  o.Kind = static_cast<bsr::JunctionKind>(this->Junction);
  o.Tangency = static_cast<bsr::JunctionTangency>(this->Tangency);
  o.PeriodicKnots = this->Knots == PERIODIC;
  o.Interpolate = this->Interpolate;
  o.Caps = static_cast<bsr::EndCaps>(this->EndCaps);
  o.PointsPerSection = this->PointsPerSection;
  o.JunctionPosition = this->JunctionPosition;
  const auto made =
    make(vtkPolyData::GetData(inputs[0]), this->SliceArray, this->ComponentArray, stack, o, this);
  bsr::SampleOptions sampling;
  sampling.Resolution = this->Resolution;
  bsr::AlgorithmMonitor rest(this, 0.9, 1.0);
  const bsr::Status status =
    made ? bsr::splineSurfaceTo(made->Surface.Model, sampling, rest, model) : made.status();
  if (!status)
  {
    model->Initialize();
    return bsr::notDelivered(this, status);
  }
  bsr::controlNetTo(made->Surface.Model, net);
  reportTo(made->Surface, made->Report, table);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  totalsTo(made->Surface, made->Report, seconds.count(), model->GetFieldData());
  totalsTo(made->Surface, made->Report, seconds.count(), table->GetFieldData());
  return 1;
}

void vtkBranchedContourSurface::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "OrderU: " << this->OrderU << "\n";
  os << indent << "OrderV: " << this->OrderV << "\n";
  os << indent << "Junction: " << this->Junction << "\n";
  os << indent << "Tangency: " << this->Tangency << "\n";
  os << indent << "Knots: " << this->Knots << "\n";
  os << indent << "Interpolate: " << this->Interpolate << "\n";
  os << indent << "EndCaps: " << this->EndCaps << "\n";
  os << indent << "PointsPerSection: " << this->PointsPerSection << "\n";
  os << indent << "JunctionPosition: " << this->JunctionPosition << "\n";
  os << indent << "SliceArray: " << this->SliceArray << "\n";
  os << indent << "ComponentArray: " << this->ComponentArray << "\n";
  os << indent << "MinimumOverlap: " << this->MinimumOverlap << "\n";
  os << indent << "MatchDistance: " << this->MatchDistance << "\n";
  os << indent << "PlaneTolerance: " << this->PlaneTolerance << "\n";
  os << indent << "Resolution: " << this->Resolution << "\n";
}
