#include "vtkFiberReconstruction.h"

#include "Adapters/BSRImageAdapter.h"
#include "Adapters/BSRStageRunner.h"
#include "Layout/QuadRemesh.h"
#include "Spline/G1Fit.h"
#include "vtkBSplineG1Fit.h"
#include "vtkClosing.h"
#include "vtkEDTClassify.h"
#include "vtkFiberEnds.h"
#include "vtkPartitionToQuads.h"
#include "vtkQuadRemesh.h"

#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>
#include <vtkUnsignedCharArray.h>

vtkStandardNewMacro(vtkFiberReconstruction);

namespace
{
void copyField(vtkFieldData* from, vtkFieldData* to, std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    if (vtkAbstractArray* a = from->GetAbstractArray(name))
    {
      to->AddArray(a);
    }
  }
}

/// Replaces a value of the array Side, e.g. by 255: neither wall.
void relabelSide(vtkPolyData* surface, unsigned char from, unsigned char to)
{
  auto* old = surface->GetPointData()->GetArray("Side");
  vtkNew<vtkUnsignedCharArray> side;
  side->SetName("Side");
  side->SetNumberOfValues(old->GetNumberOfTuples());
  for (vtkIdType i = 0; i < old->GetNumberOfTuples(); ++i)
  {
    const auto s = static_cast<unsigned char>(old->GetComponent(i, 0));
    side->SetValue(i, s == from ? to : s);
  }
  surface->GetPointData()->AddArray(side);
}

/// Of the late stages: nobody shall wait for the early ones to be told of them.
bsr::Status checkParameters(vtkFiberReconstruction& filter)
{
  bsr::QuadRemeshOptions layout;
  layout.NumberOfQuads = filter.GetNumberOfQuads();
  if (bsr::Status s = bsr::checkOptions(layout); !s)
  {
    return s;
  }
  bsr::G1FitOptions fit;
  fit.Segments = filter.GetSegmentsPerSide();
  return bsr::checkOptions(fit);
}
} // namespace

vtkFiberReconstruction::vtkFiberReconstruction()
{
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(6);
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

int vtkFiberReconstruction::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int vtkFiberReconstruction::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == REPORT ? "vtkTable" : "vtkPolyData");
  return 1;
}

vtkTypeBool vtkFiberReconstruction::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  if (request->Has(vtkStreamingDemandDrivenPipeline::REQUEST_UPDATE_EXTENT()))
  {
    // The object is found in the whole volume.
    bsr::requestWholeExtent(input[0]->GetInformationObject(0));
    return 1;
  }
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    return this->RequestData(request, input, output);
  }
  return this->Superclass::ProcessRequest(request, input, output);
}

int vtkFiberReconstruction::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkNew<vtkImageData> image;
  image->ShallowCopy(vtkImageData::GetData(inputs[0]));
  if (bsr::namesNoArray(this->GetInputArrayInformation(0)))
  {
    this->SetInputArrayToProcess(
      0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  }
  vtkInformation* array = this->GetInputArrayInformation(0);
  bsr::StageRunner stages(this, 100.0);
  const auto refuse = [&](const std::string& message)
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject::GetData(outputs, port)->Initialize();
    }
    if (message.empty())
    {
      return 1; // cancelled
    }
    vtkErrorMacro(<< message);
    return 0;
  };
  const auto fail = [&]()
  { return refuse(stages.message().empty() ? "" : stages.stage() + ": " + stages.message()); };
  if (const bsr::Status s = checkParameters(*this); !s)
  {
    return refuse(s.message());
  }

  vtkNew<vtkClosing> closing;
  closing->SetInputData(image);
  closing->SetInputArrayToProcess(0, array);
  closing->SetIsoValue(this->IsoValue);
  closing->SetAutoIsoValue(this->AutoIsoValue);
  closing->SetRadius(this->Radius);
  closing->SetAutoRadius(this->AutoRadius);
  if (!stages.run("Closing", closing, 25.0))
  {
    return fail();
  }
  vtkFieldData* closingNumbers = closing->GetOutput()->GetFieldData();

  vtkNew<vtkFlyingEdges3D> closedSurface;
  closedSurface->SetInputConnection(closing->GetOutputPort());
  closedSurface->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "SignedDistance");
  closedSurface->SetValue(0, 0.0);
  closedSurface->ComputeScalarsOff();
  vtkNew<vtkFlyingEdges3D> rawSurface;
  rawSurface->SetInputData(image);
  rawSurface->SetInputArrayToProcess(0, array);
  rawSurface->SetValue(0, closingNumbers->GetArray("IsoValue")->GetComponent(0, 0));
  rawSurface->ComputeScalarsOff();
  if (!stages.run("Closed surface", closedSurface, 2.0) ||
      !stages.run("Raw surface", rawSurface, 3.0))
  {
    return fail();
  }

  vtkNew<vtkEDTClassify> classify;
  classify->SetInputConnection(0, rawSurface->GetOutputPort());
  classify->SetInputConnection(1, closing->GetOutputPort());
  if (!stages.run("EDTClassify", classify, 15.0))
  {
    return fail();
  }
  vtkNew<vtkPolyData> classified;
  classified->ShallowCopy(classify->GetOutput());
  vtkNew<vtkPolyData> sides;
  sides->ShallowCopy(classified);
  if (this->Sides != BOTH)
  {
    relabelSide(sides, this->Sides == OUTER_ONLY ? 1 : 0, 255);
  }

  vtkNew<vtkFiberEnds> ends;
  ends->SetInputConnection(0, closedSurface->GetOutputPort());
  ends->SetInputData(1, classified);
  vtkNew<vtkQuadRemesh> remesh;
  remesh->SetNumberOfQuads(this->NumberOfQuads);
  remesh
    ->FitRelaxationOff(); // a fit through both walls is not helped by one that follows the outer
  if (this->OpenEnds == 0)
  {
    if (!stages.run("FiberEnds", ends, 5.0))
    {
      return fail();
    }
    remesh->SetInputConnection(ends->GetOutputPort());
  }
  else
  {
    remesh->SetInputConnection(closedSurface->GetOutputPort());
  }
  if (!stages.run("QuadRemesh", remesh, 20.0))
  {
    return fail();
  }

  vtkNew<vtkPartitionToQuads> partition;
  partition->SetInputData(0, sides);
  partition->SetInputConnection(1, remesh->GetOutputPort());
  if (!stages.run("PartitionToQuads", partition, 5.0))
  {
    return fail();
  }

  vtkNew<vtkPolyData> partitioned;
  partitioned->ShallowCopy(partition->GetOutputDataObject(0));
  if (this->Sides == INNER_ONLY)
  {
    relabelSide(partitioned, 1, 0); // the one shell of a fit is its outer one
  }
  vtkNew<vtkBSplineG1Fit> fit;
  fit->SetInputData(0, partitioned);
  fit->SetInputConnection(1, remesh->GetOutputPort());
  if (this->OpenEnds == 0)
  {
    fit->SetInputConnection(2, ends->GetOutputPort(1));
  }
  fit->SetContinuity(this->Continuity);
  fit->SetSegmentsPerSide(this->SegmentsPerSide);
  fit->SetOpenEnds(this->OpenEnds);
  fit->SetResolution(this->Resolution);
  if (!stages.run("BSplineG1Fit", fit, 25.0))
  {
    return fail();
  }

  for (int port = 0; port < 3; ++port)
  {
    vtkDataObject::GetData(outputs, port)->ShallowCopy(fit->GetOutputDataObject(port));
  }
  vtkPolyData::GetData(outputs, CLOSED_SURFACE)
    ->ShallowCopy(this->OpenEnds == 0 ? ends->GetOutputDataObject(0) : closedSurface->GetOutput());
  vtkPolyData::GetData(outputs, LAYOUT)->ShallowCopy(remesh->GetOutput());
  vtkPolyData::GetData(outputs, RAW_SURFACE)->ShallowCopy(partition->GetOutputDataObject(0));

  vtkFieldData* report = vtkTable::GetData(outputs, REPORT)->GetFieldData();
  stages.addTimes(report);
  copyField(closingNumbers, report, {"IsoValue", "ClosingRadius", "BettiNumbers"});
  if (this->OpenEnds == 0)
  {
    copyField(ends->GetOutputDataObject(0)->GetFieldData(), report, {"OpenEnds", "EndsNote"});
  }
  return 1;
}

void vtkFiberReconstruction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsoValue: " << this->IsoValue << (this->AutoIsoValue ? " (automatic)\n" : "\n")
     << indent << "Radius: " << this->Radius << (this->AutoRadius ? " (automatic)\n" : "\n")
     << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n"
     << indent << "Sides: " << this->Sides << "\n"
     << indent << "OpenEnds: " << this->OpenEnds << "\n"
     << indent << "Continuity: " << this->Continuity << "\n"
     << indent << "SegmentsPerSide: " << this->SegmentsPerSide << "\n"
     << indent << "Resolution: " << this->Resolution << "\n";
}
