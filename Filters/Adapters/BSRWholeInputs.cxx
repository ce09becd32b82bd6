#include "Adapters/BSRWholeInputs.h"

#include <vtkAppendFilter.h>
#include <vtkAppendPolyData.h>
#include <vtkCleanPolyData.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkExtentTranslator.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>

namespace bsr
{
namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;
using Pieces = std::vector<vtkSmartPointer<vtkDataObject>>;
constexpr int PieceTag = 86201; ///< of messages that carry a piece

/// The processes that work together on the outputs; none if the pieces are not theirs.
vtkMultiProcessController* processesOf(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  const int pieces = info && info->Has(Pipeline::UPDATE_NUMBER_OF_PIECES())
                       ? info->Get(Pipeline::UPDATE_NUMBER_OF_PIECES())
                       : 1;
  return all && pieces > 1 && all->GetNumberOfProcesses() == pieces ? all : nullptr;
}

vtkSmartPointer<vtkDataObject> wholePolygons(const Pieces& pieces)
{
  vtkNew<vtkAppendPolyData> append;
  for (const auto& piece : pieces)
  {
    vtkPolyData::SafeDownCast(piece)->RemoveGhostCells();
    append->AddInputDataObject(piece);
  }
  append->Update();
  if (append->GetOutput()->GetNumberOfPolys() == 0)
  {
    return append->GetOutput();
  }
  vtkNew<vtkCleanPolyData> join;
  join->SetInputConnection(append->GetOutputPort());
  join->SetTolerance(0.0);
  join->ConvertLinesToPointsOff();
  join->ConvertPolysToLinesOff();
  join->ConvertStripsToPolysOff();
  join->Update();
  return join->GetOutput();
}

vtkSmartPointer<vtkDataObject> wholePoints(const Pieces& pieces)
{
  vtkNew<vtkAppendFilter> append;
  for (const auto& piece : pieces)
  {
    if (auto* grid = vtkUnstructuredGrid::SafeDownCast(piece))
    {
      grid->RemoveGhostCells();
    }
    append->AddInputDataObject(piece);
  }
  append->Update();
  return append->GetOutput();
}

vtkSmartPointer<vtkDataObject> wholeImage(const Pieces& pieces)
{
  auto whole = vtkSmartPointer<vtkImageData>::New();
  auto* first = vtkImageData::SafeDownCast(pieces.front());
  whole->CopyStructure(first);
  std::array<int, 6> all{};
  first->GetExtent(all.data());
  for (const auto& piece : pieces)
  {
    const int* e = vtkImageData::SafeDownCast(piece)->GetExtent();
    for (int a = 0; a < 3; ++a)
    {
      all[2 * a] = std::min(all[2 * a], e[2 * a]);
      all[2 * a + 1] = std::max(all[2 * a + 1], e[2 * a + 1]);
    }
  }
  whole->SetExtent(all.data());
  vtkPointData* values = whole->GetPointData();
  values->CopyAllOn();
  values->CopyAllocate(first->GetPointData(), whole->GetNumberOfPoints());
  values->SetNumberOfTuples(whole->GetNumberOfPoints());
  for (const auto& piece : pieces)
  {
    auto* image = vtkImageData::SafeDownCast(piece);
    values->CopyStructuredData(image->GetPointData(), image->GetExtent(), all.data(), false);
  }
  return whole;
}

vtkSmartPointer<vtkDataObject> wholeOf(const Pieces& all)
{
  Pieces pieces;
  for (const auto& piece : all)
  {
    if (piece && piece->GetNumberOfElements(vtkDataObject::POINT) > 0)
    {
      pieces.push_back(piece);
    }
  }
  if (pieces.empty())
  {
    return all.front();
  }
  if (pieces.size() == 1)
  {
    return pieces.front();
  }
  auto whole = vtkPolyData::SafeDownCast(pieces.front())    ? wholePolygons(pieces)
               : vtkImageData::SafeDownCast(pieces.front()) ? wholeImage(pieces)
                                                            : wholePoints(pieces);
  whole->GetFieldData()->ShallowCopy(pieces.front()->GetFieldData());
  whole->GetAttributes(vtkDataObject::POINT)->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  return whole;
}

/// A part of an image, with all its arrays.
vtkSmartPointer<vtkImageData> partOf(vtkImageData* whole, const int* extent)
{
  auto part = vtkSmartPointer<vtkImageData>::New();
  part->ShallowCopy(whole);
  part->Crop(extent);
  part->GetFieldData()->ShallowCopy(whole->GetFieldData());
  return part;
}
} // namespace

void emptyOutputs(vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject::GetData(outputs, port)->Initialize();
  }
}

void requestWholeExtent(vtkInformation* input, vtkInformationVector* outputs)
{
  if (!processesOf(outputs) && input && input->Has(Pipeline::WHOLE_EXTENT()))
  {
    input->Set(Pipeline::UPDATE_EXTENT(), input->Get(Pipeline::WHOLE_EXTENT()), 6);
  }
}

WholeInputs::WholeInputs(vtkInformationVector** inputs, int ports, vtkInformationVector* outputs)
    : Vectors(inputs)
{
  vtkMultiProcessController* processes = processesOf(outputs);
  if (!processes)
  {
    return;
  }
  this->Here = processes->GetLocalProcessId() == 0;
  for (int port = 0; port < ports; ++port)
  {
    auto vector = vtkSmartPointer<vtkInformationVector>::New();
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* own = inputs[port]->GetInformationObject(i);
      Pieces pieces;
      processes->Gather(own->Get(vtkDataObject::DATA_OBJECT()), pieces, 0);
      vtkNew<vtkInformation> info;
      info->Copy(own);
      if (this->Here)
      {
        info->Set(vtkDataObject::DATA_OBJECT(), wholeOf(pieces));
      }
      vector->Append(info);
    }
    this->Plain.push_back(vector);
    this->Whole.push_back(vector);
  }
  this->Vectors = this->Plain.data();
  if (!this->Here)
  {
    emptyOutputs(outputs);
  }
}

void deliverImage(vtkImageData* image, vtkInformationVector* outputs)
{
  vtkMultiProcessController* processes = processesOf(outputs);
  if (!processes)
  {
    return;
  }
  std::array<int, 6> all{};
  image->GetExtent(all.data());
  processes->Broadcast(all.data(), 6, 0);
  if (all[0] > all[1])
  {
    return; // nothing was made
  }
  outputs->GetInformationObject(0)->Set(Pipeline::WHOLE_EXTENT(), all.data(), 6);
  if (processes->GetLocalProcessId() != 0)
  {
    processes->Receive(image, 0, PieceTag);
    return;
  }
  const int count = processes->GetNumberOfProcesses();
  for (int to = count - 1; to >= 0; --to)
  {
    std::array<int, 6> extent{};
    vtkNew<vtkExtentTranslator> translator;
    translator->PieceToExtentThreadSafe(
      to, count, 0, all.data(), extent.data(), vtkExtentTranslator::BLOCK_MODE, 0);
    const auto piece = partOf(image, extent.data());
    if (to == 0)
    {
      image->ShallowCopy(piece);
    }
    else
    {
      processes->Send(piece, to, PieceTag);
    }
  }
}
} // namespace bsr
