#ifndef BSRMonitor_h
#define BSRMonitor_h

#include "Common/Monitor.h"
#include "Common/Status.h"

class vtkAlgorithm;

namespace bsr
{
/// Reports Core's progress through a vtkAlgorithm and passes the abort flag on.
class AlgorithmMonitor : public Monitor
{
public:
  explicit AlgorithmMonitor(vtkAlgorithm* algorithm, double from = 0.0, double to = 1.0)
      : Algorithm(algorithm), From(from), To(to)
  {
  }
  void progress(double share) override;
  bool cancelled() override;

private:
  vtkAlgorithm* Algorithm;
  double From;
  double To;
};
} // namespace bsr

#endif
