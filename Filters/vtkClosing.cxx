#include "vtkClosing.h"

#include "Adapters/BSRImageAdapter.h"
#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRWholeInputs.h"
#include "Image/Closing.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>

vtkStandardNewMacro(vtkClosing);

namespace
{
bsr::Result<bsr::ClosingResult> closeImage(vtkImageData* image, vtkDataArray* values,
  const bsr::ClosingOptions& options, bsr::Monitor& monitor)
{
  switch (values->GetDataType())
  {
    vtkTemplateMacro(return bsr::closing<VTK_TT>(
      bsr::imageView<const VTK_TT>(image, static_cast<const VTK_TT*>(values->GetVoidPointer(0))),
      options, monitor));
  }
  return bsr::Status::invalidInput("The input array is not of a numeric type.");
}

std::vector<double> numbers(const bsr::BettiNumbers& b)
{
  return {static_cast<double>(b.Components), static_cast<double>(b.Tunnels),
    static_cast<double>(b.Cavities)};
}

void attachNumbers(const bsr::ClosingResult& r, vtkFieldData* field)
{
  bsr::addField(field, "ClosingRadius", r.Radius);
  bsr::addField(field, "IsoValue", r.IsoValue);
  bsr::addField(field, "BettiNumbers", numbers(r.After));
  bsr::addField(field, "BettiNumbersBefore", numbers(r.Before));
  bsr::addField(field, "BettiNumbersSurface", numbers(r.Surface));
  bsr::addField(field, "Components", static_cast<double>(r.Components));
  bsr::addField(field, "VolumeRatio", r.VolumeRatio);
  bsr::addText(field, "ClosingNote", r.Warning);
  if (!r.Curve.Radius.empty())
  {
    vtkNew<vtkDoubleArray> curve;
    curve->SetName("ClosingCurve");
    curve->SetNumberOfComponents(2);
    for (std::size_t i = 0; i < r.Curve.Radius.size(); ++i)
    {
      curve->InsertNextTuple2(r.Curve.Radius[i], r.Curve.Volume[i]);
    }
    field->AddArray(curve);
  }
}
} // namespace

vtkClosing::vtkClosing()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
}

int vtkClosing::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkDataObject::SetPointDataActiveScalarInfo(outputs->GetInformationObject(0), VTK_FLOAT, 1);
  return 1;
}

int vtkClosing::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  bsr::requestWholeExtent(inputs[0]->GetInformationObject(0), outputs);
  return 1;
}

int vtkClosing::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* output = vtkImageData::GetData(outputs);
  output->Initialize();
  const bsr::WholeInputs whole(inputs, 1, outputs);
  const int done = whole.here() ? this->Close(whole.vectors(), output) : 1;
  if (output->GetNumberOfPoints() > 0)
  {
    outputs->GetInformationObject(0)->Set(
      vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), output->GetExtent(), 6);
  }
  bsr::deliverImage(output, outputs);
  return done;
}

int vtkClosing::Close(vtkInformationVector** inputs, vtkImageData* output)
{
  vtkImageData* input = vtkImageData::GetData(inputs[0]);
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* chosen = this->GetInputArrayToProcess(0, inputs, association);
  if (!chosen && bsr::namesNoArray(this->GetInputArrayInformation(0)))
  {
    chosen = input->GetPointData()->GetScalars();
  }
  const auto values = bsr::imageScalars(input, chosen, association);
  if (!values)
  {
    vtkErrorMacro(<< values.status().message());
    return 0;
  }
  bsr::ClosingOptions options;
  options.AutoIsoValue = this->AutoIsoValue;
  options.IsoValue = this->IsoValue;
  options.AutoRadius = this->AutoRadius;
  options.Radius = this->Radius;
  options.LargestComponent = this->LargestComponent;
  bsr::AlgorithmMonitor monitor(this);
  auto closed = closeImage(input, *values, options, monitor);
  if (!closed)
  {
    return bsr::notDelivered(this, closed.status());
  }
  bsr::imageGeometry(input, closed->Closed.Extent, output);
  output->GetPointData()->AddArray(bsr::imageArray<vtkUnsignedCharArray>(closed->Closed, "Closed"));
  output->GetPointData()->SetScalars(
    bsr::imageArray<vtkFloatArray>(closed->SignedDistance, "SignedDistance"));
  attachNumbers(*closed, output->GetFieldData());
  if (!closed->Warning.empty())
  {
    vtkWarningMacro(<< closed->Warning);
  }
  return 1;
}

void vtkClosing::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsoValue: " << this->IsoValue << "\n";
  os << indent << "AutoIsoValue: " << this->AutoIsoValue << "\n";
  os << indent << "Radius: " << this->Radius << "\n";
  os << indent << "AutoRadius: " << this->AutoRadius << "\n";
  os << indent << "LargestComponent: " << this->LargestComponent << "\n";
}
