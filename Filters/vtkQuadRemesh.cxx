#include "vtkQuadRemesh.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRSurfaceAdapter.h"
#include "Adapters/BSRWholeInputs.h"
#include "Layout/QuadRemesh.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <chrono>

vtkStandardNewMacro(vtkQuadRemesh);

namespace
{
template <class Array, class Value>
void addArray(vtkDataSetAttributes* to, const char* name, const std::vector<Value>& values)
{
  vtkNew<Array> a;
  a->SetName(name);
  a->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), a->GetPointer(0));
  to->AddArray(a);
}

/// One value of each component's Morse-Smale complex as a field array.
template <class Value>
void addMorse(vtkFieldData* field, const char* name, const bsr::QuadLayout& layout,
  Value bsr::MorseReport::*member)
{
  std::vector<double> values;
  for (const bsr::MorseReport& r : layout.Morse)
  {
    values.push_back(static_cast<double>(r.*member));
  }
  bsr::addField(field, name, values);
}

void reportMorse(const bsr::QuadLayout& layout, vtkFieldData* field)
{
  addMorse(field, "EigenfunctionTaken", layout, &bsr::MorseReport::Eigenfunction);
  addMorse(field, "Eigenvalue", layout, &bsr::MorseReport::Eigenvalue);
  addMorse(field, "Minima", layout, &bsr::MorseReport::Minima);
  addMorse(field, "Saddles", layout, &bsr::MorseReport::Saddles);
  addMorse(field, "Maxima", layout, &bsr::MorseReport::Maxima);
  addMorse(field, "MorseCells", layout, &bsr::MorseReport::Cells);
  addMorse(field, "CancelledPairs", layout, &bsr::MorseReport::Cancelled);
  addMorse(field, "CellSubdivisions", layout, &bsr::MorseReport::Subdivisions);
}

void surfaceTo(const bsr::PartitionedSurface& surface, vtkPolyData* output)
{
  bsr::triangleMeshTo(surface.Mesh, output);
  if (!surface.Cell.empty())
  {
    addArray<vtkIntArray>(output->GetCellData(), "Cell", surface.Cell);
    addArray<vtkDoubleArray>(output->GetPointData(), "Eigenfunction", surface.Eigenfunction);
    std::vector<unsigned char> critical;
    for (bsr::CriticalPoint c : surface.Critical)
    {
      critical.push_back(static_cast<unsigned char>(c));
    }
    addArray<vtkUnsignedCharArray>(output->GetPointData(), "Critical", critical);
  }
}

using Named = std::vector<std::pair<const char*, double>>;

/// One tuple of named components.
void addNamed(vtkFieldData* field, const char* name, const Named& values)
{
  vtkNew<vtkDoubleArray> a;
  a->SetName(name);
  a->SetNumberOfComponents(static_cast<int>(values.size()));
  a->SetNumberOfTuples(1);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    a->SetComponentName(static_cast<vtkIdType>(i), values[i].first);
    a->SetComponent(0, static_cast<int>(i), values[i].second);
  }
  field->AddArray(a);
}

void reportRepairs(const bsr::RepairReport& r, vtkFieldData* field)
{
  const auto number = [](bsr::Index n) { return static_cast<double>(n); };
  addNamed(field, "Repairs",
    {{"MergedPoints", number(r.MergedPoints)}, {"DegenerateFaces", number(r.DegenerateFaces)},
      {"DuplicateFaces", number(r.DuplicateFaces)}, {"TurnedFaces", number(r.TurnedFaces)},
      {"SplitVertices", number(r.SplitVertices)}, {"CutEdges", number(r.CutEdges)},
      {"Specks", number(r.Specks)}});
}

void report(const bsr::QuadLayout& layout, vtkFieldData* field)
{
  const bsr::LayoutReport& r = layout.Report;
  bsr::addField(field, "Irregular", r.Irregular);
  bsr::addField(
    field, "ValenceCounts", std::vector<double>(r.ByValence.begin(), r.ByValence.end()));
  bsr::addField(field, "EulerCharacteristic", r.Euler);
  bsr::addField(field, "BoundaryLoops", r.BoundaryLoops);
  bsr::addField(field, "Components", r.Components);
  bsr::addField(field, "MinimumQuads", layout.MinimumQuads);
  bsr::addField(field, "Hausdorff", layout.Distance.Maximum);
  bsr::addField(field, "MeanDistance", layout.Distance.Mean);
  bsr::addField(field, "MinScaledJacobian", r.MinJacobian);
  bsr::addField(field, "MeanScaledJacobian", r.MeanJacobian);
  bsr::addField(field, "FlippedQuads", r.Flipped);
  bsr::addField(field, "MeanAngleDeviation", r.MeanAngleDeviation);
  bsr::addField(field, "MaxAngleDeviation", r.MaxAngleDeviation);
  std::vector<double> stages;
  for (bsr::LayoutStage s : layout.Stages)
  {
    stages.push_back(static_cast<double>(s));
  }
  bsr::addField(field, "LayoutStage", stages);
  std::vector<double> followed;
  for (bsr::FollowedFeatures f : layout.Followed)
  {
    followed.push_back(static_cast<double>(f));
  }
  bsr::addField(field, "FollowedFeatures", followed);
  const bsr::LayoutSeconds& s = layout.Seconds;
  addNamed(field, "StageSeconds",
    {{"Repair", s.Repair}, {"Decimation", s.Decimation}, {"Layout", s.Layout},
      {"Measure", s.Measure}});
  reportRepairs(layout.Repairs, field);
}
} // namespace

vtkQuadRemesh::vtkQuadRemesh()
{
  this->SetNumberOfOutputPorts(3);
}

int vtkQuadRemesh::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const bsr::WholeInputs whole(inputVector, this->GetNumberOfInputPorts(), outputVector);
  if (!whole.here())
  {
    return 1;
  }
  inputVector = whole.vectors();
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0], 0);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, 0);
  vtkPolyData* surface = vtkPolyData::GetData(outputVector, 1);
  output->Initialize();
  vtkPolyData* repairs = vtkPolyData::GetData(outputVector, 2);
  surface->Initialize();
  repairs->Initialize();
  const auto start = std::chrono::steady_clock::now();
  auto mesh = bsr::surfaceFrom(input, this->RegionArray);
  if (!mesh)
  {
    vtkErrorMacro(<< mesh.status().message());
    return 0;
  }
  const bool regions = !mesh->Mesh.Region.empty();
  bsr::QuadRemeshOptions options;
  if (this->Sizing == SIZE_BY_ARRAY)
  {
    auto values = bsr::pointArrayFrom(mesh->Triangles, this->SizeArray);
    if (!values)
    {
      vtkErrorMacro(<< values.status().message());
      return 0;
    }
    options.SizeField = std::move(*values);
  }
  options.Sizing = static_cast<bsr::QuadSizing>(this->Sizing);
  options.SmallestComponent = this->SmallestComponent;
  options.NumberOfQuads = this->NumberOfQuads;
  options.FeatureAngle = this->FeatureAngle;
  options.Seed = this->Seed;
  options.FitMoves = this->FitMoves;
  options.FitRelaxation = this->FitRelaxation;
  options.Method = static_cast<bsr::LayoutMethod>(this->Method);
  options.Eigenfunction = this->Eigenfunction;
  options.Persistence = this->Persistence;
  bsr::AlgorithmMonitor monitor(this);
  auto layout = bsr::quadRemesh(mesh->Mesh, options, monitor);
  if (!layout)
  {
    return bsr::notDelivered(this, layout.status());
  }
  bsr::quadMeshTo(layout->Mesh, output);
  addArray<vtkDoubleArray>(output->GetCellData(), "ScaledJacobian", layout->Report.Jacobian);
  addArray<vtkIntArray>(output->GetPointData(), "Valence", layout->Report.Valence);
  if (regions && this->Method == FIELD_ALIGNED)
  {
    addArray<vtkIntArray>(output->GetCellData(), this->RegionArray.c_str(), layout->Mesh.Region);
  }
  report(*layout, output->GetFieldData());
  if (const auto given = std::count_if(layout->Followed.begin(), layout->Followed.end(),
        [](bsr::FollowedFeatures f) { return f != bsr::FollowedFeatures::All; });
      given > 0)
  {
    vtkWarningMacro(
      "Sharp edges or borders of regions leave no room for "
      << this->NumberOfQuads << " quads and are not followed on " << given << " of "
      << layout->Followed.size()
      << " components (field array FollowedFeatures). More quads or a larger FeatureAngle give "
         "them room.");
  }
  if (this->Method == MORSE_SMALE)
  {
    reportMorse(*layout, output->GetFieldData());
  }
  surfaceTo(layout->Surface, surface);
  repairs->ShallowCopy(mesh->Triangles);
  addArray<vtkUnsignedCharArray>(repairs->GetCellData(), "Repair", layout->Repairs.Faces);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  bsr::addField(output->GetFieldData(), "Seconds", seconds.count());
  return 1;
}

void vtkQuadRemesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "Sizing: " << this->Sizing << "\n";
  os << indent << "SizeArray: " << this->SizeArray << "\n";
  os << indent << "SmallestComponent: " << this->SmallestComponent << "\n";
  os << indent << "FitMoves: " << this->FitMoves << "\n";
  os << indent << "FitRelaxation: " << this->FitRelaxation << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Eigenfunction: " << this->Eigenfunction << "\n";
  os << indent << "Persistence: " << this->Persistence << "\n";
  os << indent << "RegionArray: " << this->RegionArray << "\n";
}
