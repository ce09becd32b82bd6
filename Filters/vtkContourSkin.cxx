#include "vtkContourSkin.h"

#include "Adapters/BSRContourAdapter.h"
#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRSplineAdapter.h"
#include "Adapters/BSRWholeInputs.h"
#include "Contour/ContourSkin.h"

#include <vtkCellData.h>
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

#include <algorithm>
#include <chrono>
#include <cmath>

vtkStandardNewMacro(vtkContourSkin);

namespace
{
template <class Array, class Value>
void addColumn(
  vtkTable* table, const char* name, const std::vector<bsr::SkinReport>& rows, const Value& value)
{
  vtkNew<Array> column;
  column->SetName(name);
  for (const bsr::SkinReport& r : rows)
  {
    column->InsertNextValue(value(r));
  }
  table->AddColumn(column);
}

void reportTo(const std::vector<bsr::SkinReport>& rows, vtkTable* table)
{
  using R = bsr::SkinReport;
  const auto whole = [&](const char* name, int (*value)(const R&))
  { addColumn<vtkIntArray>(table, name, rows, value); };
  const auto real = [&](const char* name, double (*value)(const R&))
  { addColumn<vtkDoubleArray>(table, name, rows, value); };
  whole("Component", [](const R& r) { return static_cast<int>(r.Component); });
  whole("Shell", [](const R& r) { return static_cast<int>(r.Side); });
  whole("Contours", [](const R& r) { return static_cast<int>(r.Contours); });
  whole("Closed", [](const R& r) { return r.Closed ? 1 : 0; });
  whole("SinglePatch", [](const R& r) { return r.SinglePatch ? 1 : 0; });
  whole("FirstPatch", [](const R& r) { return static_cast<int>(r.FirstPatch); });
  whole("Patches", [](const R& r) { return static_cast<int>(r.Patches); });
  whole("Rows", [](const R& r) { return r.Rows; });
  whole("Columns", [](const R& r) { return r.Columns; });
  whole("ControlPointsU", [](const R& r) { return r.CountU; });
  whole("ControlPointsV", [](const R& r) { return r.CountV; });
  real("Tolerance", [](const R& r) { return r.Tolerance; });
  whole("Reached", [](const R& r) { return r.Reached ? 1 : 0; });
  real("TotalError", [](const R& r) { return r.TotalError; });
  real("AverageError", [](const R& r) { return r.AverageError; });
  real("AverageErrorPerControlPoint", [](const R& r) { return r.AverageErrorPerControlPoint; });
  real("RMS", [](const R& r) { return r.Rms; });
  real("Max", [](const R& r) { return r.Max; });
  real("ResliceRMS", [](const R& r) { return r.Measures.Reslice.RMS; });
  real("ResliceMax", [](const R& r) { return r.Measures.Reslice.max(); });
  real("PointSpacing", [](const R& r) { return r.PointSpacing; });
  real("SecondDerivativeJump", [](const R& r) { return r.Measures.SecondDerivativeJump; });
  real("NormalJump", [](const R& r) { return r.NormalJump; });
  real("EndHeight", [](const R& r) { return r.Measures.EndHeight; });
  real("ConvexShare", [](const R& r) { return r.Measures.ConvexShare; });
  whole("SignChangesData", [](const R& r) { return r.Measures.SignChangesData; });
  whole("SignChangesModel", [](const R& r) { return r.Measures.SignChangesModel; });
  whole("FoldedPatches", [](const R& r) { return r.FoldedPatches; });
}

/// The notes in words, by polyline, at most five.
std::string messageOf(const bsr::ContourSkinResult& result)
{
  std::string text;
  const std::size_t shown = std::min<std::size_t>(5, result.Notes.size());
  for (std::size_t k = 0; k < shown; ++k)
  {
    const bsr::Contour& c = result.Stack.Contours[result.Notes[k].Contour];
    text += (k == 0 ? "Polyline " : " Polyline ") + std::to_string(c.Source) + " (slice " +
            std::to_string(c.Slice) + ") " + result.Notes[k].Text + ".";
  }
  if (result.Notes.size() > shown)
  {
    text += " And " + std::to_string(result.Notes.size() - shown) +
            " more; see Message on the contours of port 3.";
  }
  return text;
}

void totalsTo(const bsr::ContourSkinResult& result, double seconds, vtkFieldData* field)
{
  double contours = 0.0;
  double squares = 0.0;
  double average = 0.0;
  double reslice = 0.0;
  double largest = 0.0;
  double jump = 0.0;
  int folded = 0;
  for (const bsr::SkinReport& r : result.Skins)
  {
    contours += r.Contours;
    squares += r.Contours * r.Rms * r.Rms;
    average += r.Contours * r.AverageError;
    reslice += r.Contours * r.Measures.Reslice.RMS * r.Measures.Reslice.RMS;
    largest = std::max(largest, r.Max);
    jump = std::max(jump, r.NormalJump);
    folded += r.FoldedPatches;
  }
  bsr::addField(field, "RMS", std::sqrt(squares / contours));
  bsr::addField(field, "Max", largest);
  bsr::addField(field, "AverageError", average / contours);
  bsr::addField(field, "ResliceRMS", std::sqrt(reslice / contours));
  bsr::addField(field, "MaxNormalJump", jump);
  bsr::addField(field, "FoldedPatches", folded);
  bsr::addField(field, "Seconds", seconds);
  bsr::addText(field, "Message", messageOf(result));
}

void messagesTo(const bsr::ContourSkinResult& result, vtkPolyData* contours)
{
  vtkNew<vtkStringArray> messages;
  messages->SetName("Message");
  messages->SetNumberOfValues(static_cast<vtkIdType>(result.Stack.Contours.size()));
  for (const bsr::ContourNote& n : result.Notes)
  {
    const std::string before = messages->GetValue(n.Contour);
    messages->SetValue(n.Contour, before.empty() ? n.Text : before + "; " + n.Text);
  }
  contours->GetCellData()->AddArray(messages);
}

void setName(const char* name, std::string& value, vtkObject* object)
{
  const std::string given = name && std::string(name) != "None" ? name : "";
  if (given != value)
  {
    value = given;
    object->Modified();
  }
}
} // namespace

vtkContourSkin::vtkContourSkin()
{
  this->SetNumberOfOutputPorts(5);
}

void vtkContourSkin::SetSliceArray(const char* name)
{
  setName(name, this->SliceArray, this);
}

void vtkContourSkin::SetComponentArray(const char* name)
{
  setName(name, this->ComponentArray, this);
}

int vtkContourSkin::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkContourSkin::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 2 ? "vtkTable" : "vtkPolyData");
  return 1;
}

int vtkContourSkin::RequestData(
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
  vtkTable* table = vtkTable::GetData(outputs, 2);
  for (const int port : {0, 1, 3, 4})
  {
    vtkPolyData::GetData(outputs, port)->Initialize();
  }
  table->Initialize();
  auto input =
    bsr::contoursFrom(vtkPolyData::GetData(inputs[0]), this->SliceArray, this->ComponentArray);
  if (!input)
  {
    return bsr::notDelivered(this, input.status());
  }
  bsr::ContourSkinOptions o;
  o.Stack.PlaneTolerance = this->PlaneTolerance;
  o.Stack.MinimumOverlap = this->MinimumOverlap;
  o.Stack.MatchDistance = this->MatchDistance;
  o.Stack.SliceOf = std::move(input->SliceOf);
  o.Stack.ComponentOf = std::move(input->ComponentOf);
  o.Fit.Parameters = static_cast<bsr::SkinParameters>(this->Parameters);
  o.Fit.Degree = this->Degree;
  o.Fit.Tolerance = this->Tolerance;
  o.Fit.ControlPointLimit = this->ControlPointLimit;
  o.Fit.CountU = this->ControlPoints[0];
  o.Fit.CountV = this->ControlPoints[1];
  o.Fit.Fairing = this->Fairing;
  o.Base = static_cast<bsr::SkinBase>(this->Base);
  o.Layout = static_cast<bsr::SkinLayout>(this->Layout);
  o.ConvexEnds = this->ConvexEnds;
  o.CorePoints = this->CorePoints;
  o.PatchSpans = this->PatchSpans;
  bsr::AlgorithmMonitor monitor(this, 0.0, 0.9);
  const auto result = bsr::skinContours(input->Lines, o, monitor);
  bsr::SampleOptions sampling;
  sampling.Resolution = this->Resolution;
  sampling.Outward = false; // turned already, open ones too
  bsr::AlgorithmMonitor rest(this, 0.9, 1.0);
  const bsr::Status status =
    result ? bsr::splineSurfaceTo(result->Model, sampling, rest, model) : result.status();
  if (!status)
  {
    model->Initialize();
    return bsr::notDelivered(this, status);
  }
  bsr::controlNetTo(result->Model, vtkPolyData::GetData(outputs, 1));
  reportTo(result->Skins, table);
  vtkPolyData* contours = vtkPolyData::GetData(outputs, 3);
  bsr::stackTo(result->Stack, contours, vtkPolyData::GetData(outputs, 4));
  messagesTo(*result, contours);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  totalsTo(*result, seconds.count(), model->GetFieldData());
  totalsTo(*result, seconds.count(), table->GetFieldData());
  return 1;
}

void vtkContourSkin::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "ConvexEnds: " << this->ConvexEnds << "\n";
  os << indent << "ControlPointLimit: " << this->ControlPointLimit << "\n";
  os << indent << "ControlPoints: " << this->ControlPoints[0] << " " << this->ControlPoints[1]
     << "\n";
  os << indent << "Parameters: " << this->Parameters << "\n";
  os << indent << "Degree: " << this->Degree << "\n";
  os << indent << "Base: " << this->Base << "\n";
  os << indent << "Layout: " << this->Layout << "\n";
  os << indent << "CorePoints: " << this->CorePoints << "\n";
  os << indent << "Fairing: " << this->Fairing << "\n";
  os << indent << "PatchSpans: " << this->PatchSpans << "\n";
  os << indent << "PlaneTolerance: " << this->PlaneTolerance << "\n";
  os << indent << "MinimumOverlap: " << this->MinimumOverlap << "\n";
  os << indent << "MatchDistance: " << this->MatchDistance << "\n";
  os << indent << "SliceArray: " << this->SliceArray << "\n";
  os << indent << "ComponentArray: " << this->ComponentArray << "\n";
  os << indent << "Resolution: " << this->Resolution << "\n";
}
