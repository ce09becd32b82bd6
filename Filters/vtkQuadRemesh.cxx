#include "vtkQuadRemesh.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
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

void report(const bsr::QuadLayout& layout, vtkFieldData* field)
{
  const bsr::LayoutReport& r = layout.Report;
  bsr::addField(field, "Irregular", r.Irregular);
  bsr::addField(field, "EulerCharacteristic", r.Euler);
  bsr::addField(field, "Hausdorff", layout.Distance.Maximum);
  bsr::addField(field, "MeanDistance", layout.Distance.Mean);
  bsr::addField(field, "MinScaledJacobian", r.MinJacobian);
  bsr::addField(field, "MeanAngleDeviation", r.MeanAngleDeviation);
  std::vector<double> stages;
  for (bsr::LayoutStage s : layout.Stages)
  {
    stages.push_back(static_cast<double>(s));
  }
  bsr::addField(field, "LayoutStage", stages);
  const bsr::RepairReport& repairs = layout.Repairs;
  bsr::addField(field, "Repairs",
    {static_cast<double>(repairs.MergedPoints), static_cast<double>(repairs.DegenerateFaces),
      static_cast<double>(repairs.DuplicateFaces), static_cast<double>(repairs.TurnedFaces),
      static_cast<double>(repairs.SplitVertices)});
}
} // namespace

vtkQuadRemesh::vtkQuadRemesh()
{
  this->SetNumberOfOutputPorts(2);
}

int vtkQuadRemesh::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0], 0);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, 0);
  vtkPolyData* surface = vtkPolyData::GetData(outputVector, 1);
  output->Initialize();
  surface->Initialize();
  const auto start = std::chrono::steady_clock::now();
  auto mesh = bsr::triangleMeshFrom(input, this->RegionArray);
  if (!mesh)
  {
    vtkErrorMacro(<< mesh.status().message());
    return 0;
  }
  const bool regions = !mesh->Region.empty();
  bsr::QuadRemeshOptions options;
  options.NumberOfQuads = this->NumberOfQuads;
  options.FeatureAngle = this->FeatureAngle;
  options.Seed = this->Seed;
  options.Method = static_cast<bsr::LayoutMethod>(this->Method);
  options.Eigenfunction = this->Eigenfunction;
  options.Persistence = this->Persistence;
  bsr::AlgorithmMonitor monitor(this);
  auto layout = bsr::quadRemesh(*mesh, options, monitor);
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
  if (this->Method == MORSE_SMALE)
  {
    reportMorse(*layout, output->GetFieldData());
  }
  surfaceTo(layout->Surface, surface);
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
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Eigenfunction: " << this->Eigenfunction << "\n";
  os << indent << "Persistence: " << this->Persistence << "\n";
  os << indent << "RegionArray: " << this->RegionArray << "\n";
}
