#include "vtkSplineCADWriter.h"

#include "Adapters/BSRSplineAdapter.h"
#include "BSRCadFile.h"

#include <vtkErrorCode.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

static_assert(static_cast<int>(bsr::LengthUnit::Foot) == vtkSplineCADWriter::FOOT,
  "the units are in the same order");

vtkSplineCADWriter::~vtkSplineCADWriter()
{
  this->SetFileName(nullptr);
}

int vtkSplineCADWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

vtkTypeBool vtkSplineCADWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  if (all && request->Has(Pipeline::REQUEST_UPDATE_EXTENT()))
  {
    vtkInformation* input = inputs[0]->GetInformationObject(0);
    input->Set(Pipeline::UPDATE_PIECE_NUMBER(), all->GetLocalProcessId());
    input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), all->GetNumberOfProcesses());
    input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    return 1;
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

void vtkSplineCADWriter::WriteData()
{
  this->NumberOfFaces = 0;
  this->NumberOfSolids = 0;
  if (!this->FileName || !*this->FileName)
  {
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
    vtkErrorMacro("Set a FileName to write to.");
    return;
  }
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  if (all && all->GetLocalProcessId() > 0)
  {
    this->SetErrorCode(vtkErrorCode::NoError);
    return;
  }
  const auto model = bsr::splineModelFrom(this->GetInput());
  if (!model)
  {
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro(<< model.status().message());
    return;
  }
  bsr::CadOptions options;
  options.Format = this->IsIGES() ? bsr::CadFormat::IGES : bsr::CadFormat::STEP;
  options.Unit = static_cast<bsr::LengthUnit>(this->Units);
  options.Sew = this->Sew;
  const auto summary = bsr::writeCadFile(*model, this->FileName, options);
  if (!summary)
  {
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    vtkErrorMacro(<< summary.status().message());
    return;
  }
  this->SetErrorCode(vtkErrorCode::NoError);
  this->NumberOfFaces = summary->Faces;
  this->NumberOfSolids = summary->Solids;
}

void vtkSplineCADWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Units: " << this->Units << "\n";
  os << indent << "Sew: " << this->Sew << "\n";
}
