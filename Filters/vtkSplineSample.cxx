#include "vtkSplineSample.h"

#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRSplineAdapter.h"
#include "Adapters/BSRWholeInputs.h"

#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

vtkStandardNewMacro(vtkSplineSample);

int vtkSplineSample::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputs);
  const auto model = bsr::splineModelFrom(input);
  if (!model)
  {
    output->Initialize();
    vtkErrorMacro(<< model.status().message());
    return 0;
  }
  bsr::SampleOptions options;
  options.Resolution = this->Resolution;
  options.Tolerance = this->Tolerance;
  options.Curvatures = this->Curvatures;
  output->GetFieldData()->ShallowCopy(input->GetFieldData());
  bsr::AlgorithmMonitor monitor(this);
  const bsr::Status status = bsr::splineSurfaceTo(*model, options, monitor, output);
  if (!status)
  {
    output->Initialize();
    return bsr::notDelivered(this, status);
  }
  return 1;
}

void vtkSplineSample::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Resolution: " << this->Resolution << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Curvatures: " << this->Curvatures << "\n";
}
