#include "Adapters/BSRStageRunner.h"

#include <vtkAlgorithm.h>
#include <vtkCommand.h>
#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkStringArray.h>

#include <chrono>

namespace bsr
{
bool StageRunner::run(const char* name, vtkAlgorithm* stage, double share)
{
  this->Stage = name;
  this->Begin = this->Done;
  this->Share = share;
  const auto progress =
    stage->AddObserver(vtkCommand::ProgressEvent, this, &StageRunner::onProgress);
  const auto error = this->observeErrors(stage);
  const auto start = std::chrono::steady_clock::now();
  stage->Update();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  this->Names.emplace_back(name);
  this->Seconds.push_back(seconds.count());
  stage->RemoveObserver(progress);
  stage->RemoveObserver(error.first);
  stage->GetExecutive()->RemoveObserver(error.second);
  this->Done += share;
  this->Owner->UpdateProgress(this->Done / this->Total);
  return this->Message.empty() && !this->Owner->GetAbortExecute();
}

Status StageRunner::status() const
{
  return this->Message.empty() ? Status::cancelled()
                               : Status::failed(this->Stage + ": " + this->message());
}

/// Without VTK's "ERROR: In file ..." in front.
std::string StageRunner::message() const
{
  const auto at = this->Message.find("): ");
  std::string plain = at == std::string::npos ? this->Message : this->Message.substr(at + 3);
  while (!plain.empty() && (plain.back() == '\n' || plain.back() == ' '))
  {
    plain.pop_back();
  }
  return plain;
}

void StageRunner::addTimes(vtkFieldData* field) const
{
  vtkNew<vtkStringArray> names;
  names->SetName("StageNames");
  vtkNew<vtkDoubleArray> seconds;
  seconds->SetName("StageSeconds");
  for (std::size_t i = 0; i < this->Names.size(); ++i)
  {
    names->InsertNextValue(this->Names[i]);
    seconds->InsertNextValue(this->Seconds[i]);
  }
  field->AddArray(names);
  field->AddArray(seconds);
}

std::pair<unsigned long, unsigned long> StageRunner::observeErrors(vtkAlgorithm* stage)
{
  return {stage->AddObserver(vtkCommand::ErrorEvent, this, &StageRunner::onError),
    stage->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this, &StageRunner::onError)};
}

void StageRunner::onProgress(vtkObject* caller, unsigned long, void* data)
{
  const double share = data ? *static_cast<double*>(data) : 0.0;
  this->Owner->UpdateProgress((this->Begin + share * this->Share) / this->Total);
  if (this->Owner->GetAbortExecute())
  {
    vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
  }
}

void StageRunner::onError(vtkObject*, unsigned long, void* data)
{
  if (this->Message.empty())
  {
    this->Message = data ? static_cast<const char*>(data) : "unknown error";
  }
}

void copyFields(vtkDataObject* from, vtkFieldData* to, std::initializer_list<const char*> names)
{
  for (const char* name : names)
  {
    if (vtkAbstractArray* a = from->GetFieldData()->GetAbstractArray(name))
    {
      to->AddArray(a);
    }
  }
}
} // namespace bsr
