#ifndef BSRStageRunner_h
#define BSRStageRunner_h

#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
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

  /// Of the stage that failed, without VTK's "ERROR: In file ..." in front; empty: none did.
  std::string message() const;
  /// The stage that ran last.
  const std::string& stage() const { return this->Stage; }

  /// Adds `StageNames` and `StageSeconds`.
  void addTimes(vtkFieldData* field) const;

private:
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
} // namespace bsr

#endif
