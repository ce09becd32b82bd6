#include "vtkFiberReconstruction.h"

#include "Adapters/BSRImageAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRStageRunner.h"
#include "Adapters/BSRWholeInputs.h"
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
    bsr::requestWholeExtent(input[0]->GetInformationObject(0), output);
    return 1;
  }
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    return this->RequestData(request, input, output);
  }
  return this->Superclass::ProcessRequest(request, input, output);
}

/// The stages, kept so that their results can be given out.
struct vtkFiberReconstruction::Stages
{
  Stages(vtkFiberReconstruction* self, vtkImageData* image, vtkInformation* array)
      : Self(self), Open(self->OpenEnds == 0), Run(self, 100.0)
  {
    this->Closing->SetInputData(image);
    this->Closing->SetInputArrayToProcess(0, array);
    this->Closing->SetIsoValue(self->IsoValue);
    this->Closing->SetAutoIsoValue(self->AutoIsoValue);
    this->Closing->SetRadius(self->Radius);
    this->Closing->SetAutoRadius(self->AutoRadius);
    this->ClosedSurface->SetInputConnection(this->Closing->GetOutputPort());
    this->ClosedSurface->SetInputArrayToProcess(
      0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "SignedDistance");
    this->ClosedSurface->SetValue(0, 0.0);
    this->ClosedSurface->ComputeScalarsOff();
    this->RawSurface->SetInputData(image);
    this->RawSurface->SetInputArrayToProcess(0, array);
    this->RawSurface->ComputeScalarsOff();
    this->Classify->SetInputConnection(0, this->RawSurface->GetOutputPort());
    this->Classify->SetInputConnection(1, this->Closing->GetOutputPort());
  }

  /// The closed and the raw surface, the walls told apart.
  bool surfaces()
  {
    if (!this->Run.run("Closing", this->Closing, 25.0))
    {
      return false;
    }
    vtkFieldData* numbers = this->Closing->GetOutput()->GetFieldData();
    this->RawSurface->SetValue(0, numbers->GetArray("IsoValue")->GetComponent(0, 0));
    return this->Run.run("Closed surface", this->ClosedSurface, 2.0) &&
           this->Run.run("Raw surface", this->RawSurface, 3.0) &&
           this->Run.run("EDTClassify", this->Classify, 15.0);
  }

  /// The quads, with borders at the open ends.
  bool layout()
  {
    this->Remesh->SetNumberOfQuads(this->Self->NumberOfQuads);
    // A fit through both walls is not helped by a layout that follows the outer.
    this->Remesh->FitRelaxationOff();
    this->Remesh->SetInputConnection(this->ClosedSurface->GetOutputPort());
    if (this->Open)
    {
      this->Ends->SetInputConnection(0, this->ClosedSurface->GetOutputPort());
      this->Ends->SetInputConnection(1, this->Classify->GetOutputPort());
      this->Remesh->SetInputConnection(this->Ends->GetOutputPort());
      if (!this->Run.run("FiberEnds", this->Ends, 5.0))
      {
        return false;
      }
    }
    return this->Run.run("QuadRemesh", this->Remesh, 20.0);
  }

  /// The patches of the walls asked for.
  bool model()
  {
    vtkNew<vtkPolyData> sides;
    sides->ShallowCopy(this->Classify->GetOutput());
    if (this->Self->Sides != BOTH)
    {
      relabelSide(sides, this->Self->Sides == OUTER_ONLY ? 1 : 0, 255);
    }
    this->Partition->SetInputData(0, sides);
    this->Partition->SetInputConnection(1, this->Remesh->GetOutputPort());
    if (!this->Run.run("PartitionToQuads", this->Partition, 5.0))
    {
      return false;
    }
    vtkNew<vtkPolyData> partitioned;
    partitioned->ShallowCopy(this->Partition->GetOutputDataObject(0));
    if (this->Self->Sides == INNER_ONLY)
    {
      relabelSide(partitioned, 1, 0); // the one shell of a fit is its outer one
    }
    this->Fit->SetInputData(0, partitioned);
    this->Fit->SetInputConnection(1, this->Remesh->GetOutputPort());
    if (this->Open)
    {
      this->Fit->SetInputConnection(2, this->Ends->GetOutputPort(1));
    }
    this->Fit->SetContinuity(this->Self->Continuity);
    this->Fit->SetSegmentsPerSide(this->Self->SegmentsPerSide);
    this->Fit->SetOpenEnds(this->Self->OpenEnds);
    this->Fit->SetResolution(this->Self->Resolution);
    return this->Run.run("BSplineG1Fit", this->Fit, 25.0);
  }

  void giveOut(vtkInformationVector* outputs)
  {
    for (int port = 0; port < 3; ++port)
    {
      vtkDataObject::GetData(outputs, port)->ShallowCopy(this->Fit->GetOutputDataObject(port));
    }
    vtkDataObject* closed =
      this->Open ? this->Ends->GetOutputDataObject(0) : this->ClosedSurface->GetOutput();
    vtkPolyData::GetData(outputs, CLOSED_SURFACE)->ShallowCopy(closed);
    vtkPolyData::GetData(outputs, LAYOUT)->ShallowCopy(this->Remesh->GetOutput());
    vtkPolyData::GetData(outputs, RAW_SURFACE)
      ->ShallowCopy(this->Partition->GetOutputDataObject(0));
    vtkFieldData* report = vtkTable::GetData(outputs, REPORT)->GetFieldData();
    this->Run.addTimes(report);
    bsr::copyFields(
      this->Closing->GetOutput(), report, {"IsoValue", "ClosingRadius", "BettiNumbers"});
    bsr::copyFields(closed, report, {"OpenEnds", "EndsNote"});
  }

  vtkFiberReconstruction* Self;
  bool Open; ///< ends are looked for
  bsr::StageRunner Run;
  vtkNew<vtkClosing> Closing;
  vtkNew<vtkFlyingEdges3D> ClosedSurface;
  vtkNew<vtkFlyingEdges3D> RawSurface;
  vtkNew<vtkEDTClassify> Classify;
  vtkNew<vtkFiberEnds> Ends;
  vtkNew<vtkQuadRemesh> Remesh;
  vtkNew<vtkPartitionToQuads> Partition;
  vtkNew<vtkBSplineG1Fit> Fit;
};

int vtkFiberReconstruction::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkNew<vtkImageData> image;
  image->ShallowCopy(vtkImageData::GetData(inputs[0]));
  if (bsr::namesNoArray(this->GetInputArrayInformation(0)))
  {
    this->SetInputArrayToProcess(
      0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  }
  const auto fail = [&](const bsr::Status& status)
  {
    bsr::emptyOutputs(outputs);
    return bsr::notDelivered(this, status);
  };
  if (const bsr::Status s = checkParameters(*this); !s)
  {
    return fail(s);
  }
  Stages stages(this, image, this->GetInputArrayInformation(0));
  if (!stages.surfaces() || !stages.layout() || !stages.model())
  {
    return fail(stages.Run.status());
  }
  stages.giveOut(outputs);
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
