#include "Adapters/BSRMonitor.h"

#include <vtkAlgorithm.h>
#include <vtkSetGet.h>
#include <vtkVersionMacros.h>

namespace bsr
{
void AlgorithmMonitor::progress(double share)
{
  this->Algorithm->UpdateProgress(this->From + share * (this->To - this->From));
}

bool AlgorithmMonitor::cancelled()
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20230111)
  return this->Algorithm->CheckAbort();
#else
  return this->Algorithm->GetAbortExecute() != 0;
#endif
}

int notDelivered(vtkAlgorithm* algorithm, const Status& status)
{
  if (status.code() == StatusCode::Cancelled)
  {
    return 1;
  }
  vtkErrorWithObjectMacro(algorithm, << status.message());
  return 0;
}
} // namespace bsr
