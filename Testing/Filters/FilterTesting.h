#ifndef FilterTesting_h
#define FilterTesting_h

#include "Adapters/BSRSplineAdapter.h"

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkExecutive.h>
#include <vtkFeatureEdges.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

/**
 * Helpers for the tests of the VTK classes.
 *
 * @code
 * vtkNew<vtkClosing> closing;
 * ErrorLog log(closing);                 // from now on errors are kept, not printed
 * closing->Update();                     // no input
 * EXPECT_TRUE(log.saidOnce("input"));    // one error that names the cause
 * @endcode
 */
namespace bsrtest
{
/// Keeps the errors and warnings of an algorithm and of its executive instead of printing them.
class ErrorLog
{
public:
  explicit ErrorLog(vtkAlgorithm* algorithm)
  {
    this->Collector->Log = this;
    for (vtkObject* o :
      {static_cast<vtkObject*>(algorithm), static_cast<vtkObject*>(algorithm->GetExecutive())})
    {
      this->Watched.push_back({o, o->AddObserver(vtkCommand::ErrorEvent, this->Collector)});
      this->Watched.push_back({o, o->AddObserver(vtkCommand::WarningEvent, this->Collector)});
    }
  }
  ~ErrorLog()
  {
    for (const auto& w : this->Watched)
    {
      w.Object->RemoveObserver(w.Tag);
    }
  }
  ErrorLog(const ErrorLog&) = delete;
  ErrorLog& operator=(const ErrorLog&) = delete;

  /// The errors of the algorithm itself; the executive repeats each ("... returned failure").
  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
  /// What the executive said.
  std::vector<std::string> Pipeline;

  bool empty() const
  {
    return this->Errors.empty() && this->Warnings.empty() && this->Pipeline.empty();
  }
  /// Exactly one error, of the algorithm or of the executive, and it contains `text`.
  bool saidOnce(const std::string& text) const
  {
    const auto& said = this->Errors.empty() ? this->Pipeline : this->Errors;
    return said.size() == 1 && said.front().find(text) != std::string::npos;
  }
  std::string text() const
  {
    std::string all;
    for (const auto* list : {&this->Errors, &this->Warnings, &this->Pipeline})
    {
      for (const std::string& s : *list)
      {
        all += s + "\n";
      }
    }
    return all;
  }
  void clear()
  {
    this->Errors.clear();
    this->Warnings.clear();
    this->Pipeline.clear();
  }

private:
  class Command : public vtkCommand
  {
  public:
    static Command* New() { return new Command; }
    void Execute(vtkObject* caller, unsigned long event, void* data) override
    {
      const char* message = static_cast<const char*>(data);
      auto& list = event == vtkCommand::WarningEvent    ? this->Log->Warnings
                   : vtkExecutive::SafeDownCast(caller) ? this->Log->Pipeline
                                                        : this->Log->Errors;
      list.emplace_back(message ? message : "");
    }
    ErrorLog* Log = nullptr;
  };
  struct Watch
  {
    vtkSmartPointer<vtkObject> Object;
    unsigned long Tag;
  };
  vtkNew<Command> Collector;
  std::vector<Watch> Watched;
};

/**
 * Sets an algorithm's abort flag as soon as its progress reaches a share, as ParaView's button
 * does.
 *
 * @code
 * const AbortAt abort(closing, 0.5);
 * closing->Update();
 * EXPECT_TRUE(abort.done()); // the progress came that far
 * @endcode
 */
class AbortAt
{
public:
  AbortAt(vtkAlgorithm* algorithm, double share) : Algorithm(algorithm)
  {
    this->Stopper->Share = share;
    this->Tag = algorithm->AddObserver(vtkCommand::ProgressEvent, this->Stopper);
  }
  ~AbortAt() { this->Algorithm->RemoveObserver(this->Tag); }
  AbortAt(const AbortAt&) = delete;
  AbortAt& operator=(const AbortAt&) = delete;

  bool done() const { return this->Stopper->Done; }

private:
  class Command : public vtkCommand
  {
  public:
    static Command* New() { return new Command; }
    void Execute(vtkObject* caller, unsigned long, void* data) override
    {
      if (data && *static_cast<double*>(data) >= this->Share)
      {
        static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
        this->Done = true;
      }
    }
    double Share = 0.0;
    bool Done = false;
  };
  vtkSmartPointer<vtkAlgorithm> Algorithm;
  vtkNew<Command> Stopper;
  unsigned long Tag = 0;
};

/// Path of a file of ../shared/data (tests run from the source root), empty where it is absent.
inline std::string sharedData(const std::string& name)
{
  const std::string path = "../shared/data/" + name;
  return std::ifstream(path).good() ? path : std::string();
}

/// A number of the output's field data; NaN where the array or the tuple is missing.
inline double fieldValue(vtkDataObject* data, const char* name, vtkIdType tuple = 0, int comp = 0)
{
  vtkDataArray* a = data ? data->GetFieldData()->GetArray(name) : nullptr;
  if (!a || tuple >= a->GetNumberOfTuples() || comp >= a->GetNumberOfComponents())
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return a->GetComponent(tuple, comp);
}

/// Edges of one cell.
inline vtkIdType openEdges(vtkPolyData* surface)
{
  vtkNew<vtkFeatureEdges> edges;
  edges->SetInputData(surface);
  edges->FeatureEdgesOff();
  edges->Update();
  return edges->GetOutput()->GetNumberOfCells();
}

/// A spline model as the filters give it.
inline vtkSmartPointer<vtkPolyData> surfaceOf(const bsr::SplineModel& model)
{
  auto out = vtkSmartPointer<vtkPolyData>::New();
  bsr::Monitor monitor;
  const bsr::Status s = bsr::splineSurfaceTo(model, {}, monitor, out);
  EXPECT_TRUE(s.isOk()) << s.message();
  return out;
}
} // namespace bsrtest

/// Declares `const std::string var`, the path of a shared file; skips the test where it is absent.
#define BSR_SHARED_DATA_OR_SKIP(var, name)                                                         \
  const std::string var = bsrtest::sharedData(name);                                               \
  if (var.empty())                                                                                 \
  {                                                                                                \
    GTEST_SKIP() << "../shared/data/" << (name) << " is not there";                                \
  }

#endif
