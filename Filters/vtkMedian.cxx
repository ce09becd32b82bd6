#include "vtkMedian.h"

#include "Adapters/BSRWholeInputs.h"

#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>

#include <string>

vtkStandardNewMacro(vtkMedian);

vtkMedian::vtkMedian()
{
  this->SetKernelSize(5, 5, 5);
}

void vtkMedian::SetInputArrayToProcess(
  int idx, int port, int connection, int fieldAssociation, const char* name)
{
  if (name && *name)
  {
    this->Superclass::SetInputArrayToProcess(idx, port, connection, fieldAssociation, name);
  }
  else
  {
    this->Superclass::SetInputArrayToProcess(idx, port, connection,
      static_cast<int>(vtkDataObject::FIELD_ASSOCIATION_POINTS),
      static_cast<int>(vtkDataSetAttributes::SCALARS));
  }
}

int vtkMedian::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, 1, outputs);
  const int done = whole.here() ? this->Filter(request, whole.vectors(), outputs) : 1;
  bsr::deliverImage(vtkImageData::GetData(outputs), outputs);
  return done;
}

int vtkMedian::Filter(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* input = vtkImageData::GetData(inputs[0]);
  vtkImageData* output = vtkImageData::GetData(outputs);
  vtkDataArray* array = this->GetInputArrayToProcess(0, inputs);
  const int* kernel = this->KernelSize;
  std::string problem;
  if (!array || array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    problem = "The volume has no such point array; choose one under Scalars.";
  }
  else if (kernel[0] < 1 || kernel[1] < 1 || kernel[2] < 1 || kernel[0] > 101 || kernel[1] > 101 ||
           kernel[2] > 101)
  {
    problem = "Kernel Size must be 1 to 101 voxels along each axis.";
  }
  if (!problem.empty())
  {
    vtkErrorMacro(<< problem);
    output->Initialize();
    return 0;
  }
  return this->Superclass::RequestData(request, inputs, outputs);
}
