#ifndef BSRStageRunner_h
#define BSRStageRunner_h

#include "Common/Status.h"

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkFieldData;
class vtkObject;

namespace bsr
{
/**
 * Runs the stages of a compound filter one after the other: passes their progress and errors
 * on to the compound and the compound's abort flag to them, and keeps the time of each.
 */
class StageRunner
{
public:
  /// \param total sum of the stages' shares
  StageRunner(vtkAlgorithm* owner, double total) : Owner(owner), Total(total) {}

  /// Updates a filter; false when it failed or was aborted. `share`: its part of the whole work.
  bool run(const char* name, vtkAlgorithm* stage, double share);

  /// Why run() was false: the stage that failed and its message, or cancelled.
  Status status() const;

  /// Adds `StageNames` and `StageSeconds`.
  void addTimes(vtkFieldData* field) const;

private:
  std::string message() const;
  std::pair<unsigned long, unsigned long> observeErrors(vtkAlgorithm* stage);
  void onProgress(vtkObject* caller, unsigned long, void* data);
  void onError(vtkObject*, unsigned long, void* data);

  vtkAlgorithm* Owner;
  double Total;
  double Done = 0.0;
  double Begin = 0.0;
  double Share = 0.0;
  std::string Stage;
  std::string Message;
  std::vector<std::string> Names;
  std::vector<double> Seconds;
};

/// Adds those of the named arrays that the field data of `from` has.
void copyFields(vtkDataObject* from, vtkFieldData* to, std::initializer_list<const char*> names);
} // namespace bsr

#endif
