#include "vtkBSplineG1Fit.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRSplineAdapter.h"
#include "Adapters/BSRWholeInputs.h"
#include "Spline/G1Fit.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
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
#include <vtkSmartPointer.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <chrono>

vtkStandardNewMacro(vtkBSplineG1Fit);

namespace
{
/// A point array of the given number of components, or an error that names the cure.
bsr::Result<vtkDataArray*> arrayOf(
  vtkPointSet* input, const char* name, int components, const char* cure)
{
  vtkDataArray* a = input->GetPointData()->GetArray(name);
  if (!a || a->GetNumberOfComponents() != components)
  {
    return bsr::Status::invalidInput(std::string("The points have no array ") + name + " of " +
                                     std::to_string(components) + " component(s); " + cure);
  }
  return a;
}

bsr::Result<bsr::PartitionedPoints> pointsOf(vtkPointSet* input, const std::string& weightArray)
{
  auto points = bsr::pointsFrom(input->GetPoints());
  const char* cure = "apply PartitionToQuads to them first.";
  auto quad = arrayOf(input, "QuadId", 1, cure);
  auto uv = arrayOf(input, "UV", 2, cure);
  if (!points || !quad || !uv)
  {
    return !points ? points.status() : !quad ? quad.status() : uv.status();
  }
  bsr::PartitionedPoints p;
  p.Points = std::move(*points);
  const auto n = static_cast<vtkIdType>(p.Points.size());
  vtkDataArray* side = input->GetPointData()->GetArray("Side");
  for (vtkIdType i = 0; i < n; ++i)
  {
    p.QuadId.push_back(static_cast<bsr::Index>((*quad)->GetComponent(i, 0)));
    p.UV.emplace_back((*uv)->GetComponent(i, 0), (*uv)->GetComponent(i, 1));
    if (side)
    {
      p.Side.push_back(static_cast<std::uint8_t>(side->GetComponent(i, 0)));
    }
  }
  if (vtkDataArray* normals = input->GetPointData()->GetNormals())
  {
    for (vtkIdType i = 0; i < n && normals->GetNumberOfComponents() == 3; ++i)
    {
      double v[3];
      normals->GetTuple(i, v);
      const bsr::Vec3 normal(v[0], v[1], v[2]);
      p.Normals.push_back(normal.allFinite() ? normal : bsr::Vec3(bsr::Vec3::Zero()));
    }
  }
  if (vtkDataArray* boundary = input->GetPointData()->GetArray("Boundary"))
  {
    for (vtkIdType i = 0; i < n; ++i)
    {
      p.Boundary.push_back(static_cast<std::uint8_t>(boundary->GetComponent(i, 0)));
    }
  }
  if (!weightArray.empty())
  {
    auto weights = arrayOf(
      input, weightArray.c_str(), 1, "choose another WeightArray, or None for equal weights.");
    if (!weights)
    {
      return weights.status();
    }
    for (vtkIdType i = 0; i < n; ++i)
    {
      p.Weights.push_back((*weights)->GetComponent(i, 0));
    }
  }
  return p;
}

/// The closed polylines.
std::vector<std::vector<bsr::Vec3>> rimsOf(vtkPolyData* input)
{
  std::vector<std::vector<bsr::Vec3>> rims;
  const auto lines = vtk::TakeSmartPointer(input->GetLines()->NewIterator());
  for (lines->GoToFirstCell(); !lines->IsDoneWithTraversal(); lines->GoToNextCell())
  {
    vtkIdType n = 0;
    const vtkIdType* ids = nullptr;
    lines->GetCurrentCell(n, ids);
    if (n < 4 || ids[0] != ids[n - 1])
    {
      continue;
    }
    std::vector<bsr::Vec3> rim(static_cast<std::size_t>(n - 1));
    for (vtkIdType i = 0; i + 1 < n; ++i)
    {
      input->GetPoint(ids[i], rim[static_cast<std::size_t>(i)].data());
    }
    if (std::all_of(rim.begin(), rim.end(), [](const bsr::Vec3& p) { return p.allFinite(); }))
    {
      rims.push_back(std::move(rim));
    }
  }
  return rims;
}

bsr::Result<bsr::G1FitResult> fit(vtkPointSet* input, vtkPolyData* layout, vtkPolyData* rims,
  const std::string& weightArray, const bsr::G1FitOptions& options, bsr::Monitor& monitor)
{
  auto points = pointsOf(input, weightArray);
  if (!points)
  {
    return points.status();
  }
  if (rims)
  {
    points->Rims = rimsOf(rims);
  }
  const auto quads = bsr::quadMeshFrom(layout, "EndRegion");
  if (!quads)
  {
    return quads.status();
  }
  return bsr::fitG1(*points, *quads, options, monitor);
}

template <class Array, class Value>
void addColumn(vtkTable* table, const char* name, const std::vector<bsr::PatchReport>& patches,
  const Value& value)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->SetNumberOfTuples(static_cast<vtkIdType>(patches.size()));
  for (std::size_t i = 0; i < patches.size(); ++i)
  {
    column->SetComponent(static_cast<vtkIdType>(i), 0, static_cast<double>(value(i)));
  }
  table->AddColumn(column);
}

void rationalTo(const std::vector<bsr::PatchReport>& p, vtkTable* table)
{
  const auto number = [&](const char* name, const auto& value)
  { addColumn<vtkDoubleArray>(table, name, p, value); };
  const auto count = [&](const char* name, const auto& value)
  { addColumn<vtkIntArray>(table, name, p, value); };
  number("MeanBefore", [&](std::size_t i) { return p[i].Gain.MeanBefore; });
  number("Mean", [&](std::size_t i) { return p[i].Gain.MeanAfter; });
  number("LeastWeight", [&](std::size_t i) { return p[i].Gain.LeastWeight; });
  number("LargestWeight", [&](std::size_t i) { return p[i].Gain.LargestWeight; });
  count("Generations", [&](std::size_t i) { return p[i].Gain.Generations; });
  count("SegmentsU", [&](std::size_t i) { return p[i].SegmentsU; });
  count("SegmentsV", [&](std::size_t i) { return p[i].SegmentsV; });
}

void reportTo(const std::vector<bsr::PatchReport>& p, vtkTable* table)
{
  addColumn<vtkIntArray>(table, "PatchId", p, [](std::size_t i) { return i; });
  addColumn<vtkUnsignedCharArray>(
    table, "Shell", p, [&](std::size_t i) { return static_cast<int>(p[i].Side); });
  addColumn<vtkIntArray>(table, "Points", p, [&](std::size_t i) { return p[i].Points; });
  addColumn<vtkDoubleArray>(table, "RMS", p, [&](std::size_t i) { return p[i].Rms; });
  addColumn<vtkDoubleArray>(table, "Max", p, [&](std::size_t i) { return p[i].Max; });
  addColumn<vtkDoubleArray>(
    table, "MinJacobian", p, [&](std::size_t i) { return p[i].MinJacobian; });
}

void totalsTo(const bsr::G1FitResult& r, double seconds, bool rational, vtkFieldData* field)
{
  bsr::addField(field, "RMS", r.Rms);
  bsr::addField(field, "Max", r.Max);
  bsr::addField(field, "MaxNormalJump", r.MaxNormalJump);
  bsr::addField(field, "CreaseEdges", r.CreaseEdges);
  bsr::addField(field, "FoldedPatches", r.FoldedPatches);
  bsr::addField(field, "Unknowns", static_cast<double>(r.Unknowns));
  bsr::addField(field, "OpenEnds", r.OpenEndCount);
  bsr::addField(field, "MinimumWall", r.MinimumWall);
  bsr::addField(field, "Seconds", seconds);
  bsr::addField(field, "Shells", static_cast<double>(r.Shells.size()));
  std::vector<double> weight;
  std::vector<double> scale;
  std::vector<double> outliers;
  for (const bsr::ShellSummary& s : r.Shells)
  {
    weight.push_back(s.DataWeight);
    scale.push_back(s.RobustScale);
    outliers.push_back(static_cast<double>(s.Outliers));
  }
  bsr::addField(field, "DataWeight", weight);
  bsr::addField(field, "RobustScale", scale);
  bsr::addField(field, "Outliers", outliers);
  if (rational)
  {
    double weightSeconds = 0.0;
    std::vector<double> convergence;
    for (const bsr::ShellSummary& s : r.Shells)
    {
      weightSeconds += s.WeightSeconds;
      convergence.insert(convergence.end(), s.Convergence.begin(), s.Convergence.end());
    }
    if (!convergence.empty())
    {
      bsr::addField(field, "Convergence", convergence);
    }
    bsr::addField(field, "WeightSeconds", weightSeconds);
    bsr::addField(field, "PatchesAboveTolerance", r.PatchesAboveTolerance);
  }
  bsr::addText(field, "Message", r.Message);
}
} // namespace

vtkBSplineG1Fit::vtkBSplineG1Fit()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(3);
}

void vtkBSplineG1Fit::SetWeightArray(const char* name)
{
  const std::string value = name && std::string(name) != "None" ? name : "";
  if (value != this->WeightArray)
  {
    this->WeightArray = value;
    this->Modified();
  }
}

int vtkBSplineG1Fit::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPointSet" : "vtkPolyData");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), port == 2 ? 1 : 0);
  return 1;
}

int vtkBSplineG1Fit::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 2 ? "vtkTable" : "vtkPolyData");
  return 1;
}

int vtkBSplineG1Fit::RequestData(
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
  vtkPointSet* input = vtkPointSet::GetData(inputs[0]);
  vtkPolyData* layout = vtkPolyData::GetData(inputs[1]);
  vtkPolyData* rims = vtkPolyData::GetData(inputs[2]);
  model->Initialize();
  net->Initialize();
  table->Initialize();
  if (!input || !layout)
  {
    vtkErrorMacro("Connect partitioned points to port 0 and their quad layout to port 1 (Quads).");
    return 0;
  }
  bsr::G1FitOptions o;
  o.Smoothness = static_cast<bsr::Continuity>(this->Continuity);
  o.Segments = this->SegmentsPerSide;
  o.Fairing.assign(this->Fairing, this->Fairing + 3);
  o.Correction = static_cast<bsr::CorrectionMethod>(this->ParameterCorrection);
  o.Ends = static_cast<bsr::OpenEnds>(this->OpenEnds);
  o.DataWeight = this->DataWeight;
  o.CreaseAngle = this->CreaseAngle;
  o.CorrelatedNoise = this->CorrelatedNoise;
  o.Robust = this->RobustWeights;
  o.Reassign = this->MovePoints;
  o.Rational = this->Rational;
  o.Weights.Optimizer = static_cast<bsr::WeightOptimizer>(this->Optimizer);
  o.Weights.Evolution.Parents = this->Parents;
  o.Weights.Evolution.Offspring = this->Offspring;
  o.Weights.Evolution.Generations = this->Generations;
  o.Weights.Evolution.Seed = static_cast<std::uint64_t>(this->Seed);
  o.Weights.Tolerance = this->Tolerance;
  bsr::AlgorithmMonitor monitor(this, 0.0, 0.9);
  const auto result = fit(input, layout, rims, this->WeightArray, o, monitor);
  bsr::SampleOptions sampling;
  sampling.Resolution = this->Resolution;
  bsr::AlgorithmMonitor rest(this, 0.9, 1.0);
  bsr::Status status =
    result ? bsr::splineSurfaceTo(result->Model, sampling, rest, model) : result.status();
  if (status && rest.cancelled())
  {
    status = bsr::Status::cancelled(); // said at the last step
  }
  if (!status)
  {
    model->Initialize();
    return bsr::notDelivered(this, status);
  }
  bsr::controlNetTo(result->Model, net);
  reportTo(result->Patches, table);
  if (o.Rational)
  {
    rationalTo(result->Patches, table);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  totalsTo(*result, seconds.count(), o.Rational, model->GetFieldData());
  totalsTo(*result, seconds.count(), o.Rational, table->GetFieldData());
  return 1;
}

void vtkBSplineG1Fit::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Continuity: " << this->Continuity << "\n";
  os << indent << "SegmentsPerSide: " << this->SegmentsPerSide << "\n";
  os << indent << "Fairing: " << this->Fairing[0] << " " << this->Fairing[1] << " "
     << this->Fairing[2] << "\n";
  os << indent << "ParameterCorrection: " << this->ParameterCorrection << "\n";
  os << indent << "OpenEnds: " << this->OpenEnds << "\n";
  os << indent << "DataWeight: " << this->DataWeight << "\n";
  os << indent << "CreaseAngle: " << this->CreaseAngle << "\n";
  os << indent << "CorrelatedNoise: " << this->CorrelatedNoise << "\n";
  os << indent << "RobustWeights: " << this->RobustWeights << "\n";
  os << indent << "MovePoints: " << this->MovePoints << "\n";
  os << indent << "WeightArray: " << this->WeightArray << "\n";
  os << indent << "Rational: " << this->Rational << "\n";
  os << indent << "Optimizer: " << this->Optimizer << "\n";
  os << indent << "Parents: " << this->Parents << "\n";
  os << indent << "Offspring: " << this->Offspring << "\n";
  os << indent << "Generations: " << this->Generations << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Resolution: " << this->Resolution << "\n";
}
