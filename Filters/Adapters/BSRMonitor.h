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

/**
 * What RequestData returns when Core did not deliver: a failure's message becomes the algorithm's
 * error and 0 is returned; a cancelled run is no error (1). The caller empties its outputs.
 */
int notDelivered(vtkAlgorithm* algorithm, const Status& status);
} // namespace bsr

#endif
