#include "Adapters/BSRContourAdapter.h"

#include "Adapters/BSRMeshAdapter.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <deque>
#include <map>

namespace bsr
{
namespace
{
/// A chain of merged points with its override values.
struct Piece
{
  std::deque<Index> Ids;
  int Slice = -1;
  int Component = -1;
  bool Used = false;
};

/// Numbers equal coordinates equally.
std::vector<Index> mergedPoints(const std::vector<Vec3>& points)
{
  std::map<std::array<double, 3>, Index> first;
  std::vector<Index> id;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const std::array<double, 3> key{points[i].x(), points[i].y(), points[i].z()};
    id.push_back(first.emplace(key, static_cast<Index>(i)).first->second);
  }
  return id;
}

/// Joins pieces at ends where exactly two meet.
class Joiner
{
public:
  explicit Joiner(std::vector<Piece>& pieces) : Pieces(pieces)
  {
    for (std::size_t i = 0; i < pieces.size(); ++i)
    {
      if (pieces[i].Ids.front() != pieces[i].Ids.back())
      {
        this->Ends[this->key(pieces[i], pieces[i].Ids.front())].push_back(static_cast<Index>(i));
        this->Ends[this->key(pieces[i], pieces[i].Ids.back())].push_back(static_cast<Index>(i));
      }
    }
  }

  std::vector<Piece> run()
  {
    std::vector<Piece> joined;
    for (Piece& p : this->Pieces)
    {
      if (!p.Used)
      {
        p.Used = true;
        Piece chain = p;
        this->grow(chain, false);
        this->grow(chain, true);
        joined.push_back(std::move(chain));
      }
    }
    return joined;
  }

private:
  using Key = std::array<Index, 3>;
  static Key key(const Piece& p, Index point) { return {point, p.Slice, p.Component}; }

  void grow(Piece& chain, bool front)
  {
    while (chain.Ids.front() != chain.Ids.back())
    {
      const Index end = front ? chain.Ids.front() : chain.Ids.back();
      const auto& meeting = this->Ends[key(chain, end)];
      if (meeting.size() != 2)
      {
        return;
      }
      Piece& next = this->Pieces[this->Pieces[meeting[0]].Used ? meeting[1] : meeting[0]];
      if (next.Used)
      {
        return;
      }
      next.Used = true;
      if (next.Ids.front() != end)
      {
        std::reverse(next.Ids.begin(), next.Ids.end());
      }
      for (std::size_t i = 1; i < next.Ids.size(); ++i)
      {
        front ? chain.Ids.push_front(next.Ids[i]) : chain.Ids.push_back(next.Ids[i]);
      }
    }
  }

  std::vector<Piece>& Pieces;
  std::map<Key, std::vector<Index>> Ends;
};

Result<vtkDataArray*> overrideArray(vtkPolyData* data, const std::string& name)
{
  if (name.empty() || name == "None")
  {
    return static_cast<vtkDataArray*>(nullptr);
  }
  vtkDataArray* a = data->GetCellData()->GetArray(name.c_str());
  if (!a || a->GetNumberOfComponents() != 1)
  {
    return Status::invalidInput(
      "The contours have no cell array " + name + " of one component; choose another, or None.");
  }
  return a;
}

/// Pieces of one cell array of the data set; `first` is its first cell's index in the cell data.
void addPieces(vtkCellArray* cells, bool polygons, vtkIdType first, const std::vector<Index>& id,
  vtkDataArray* slice, vtkDataArray* component, std::vector<Piece>& pieces)
{
  vtkNew<vtkIdList> ids;
  const auto value = [](vtkDataArray* a, vtkIdType c)
  { return a ? static_cast<int>(a->GetComponent(c, 0)) : -1; };
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    cells->GetCellAtId(c, ids);
    Piece p;
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      p.Ids.push_back(id[ids->GetId(k)]);
    }
    if (p.Ids.empty())
    {
      continue;
    }
    if (polygons)
    {
      p.Ids.push_back(p.Ids.front());
    }
    p.Slice = value(slice, first + c);
    p.Component = value(component, first + c);
    pieces.push_back(std::move(p));
  }
}

template <class Array, class Value>
void addColumn(vtkFieldData* data, const char* name, std::size_t count, const Value& value)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i)
  {
    column->SetComponent(static_cast<vtkIdType>(i), 0, static_cast<double>(value(i)));
  }
  data->AddArray(column);
}

void numbersTo(const ContourStack& stack, vtkFieldData* data)
{
  const auto& c = stack.Contours;
  const std::size_t n = c.size();
  addColumn<vtkIntArray>(data, "Slice", n, [&](std::size_t i) { return c[i].Slice; });
  addColumn<vtkIntArray>(data, "Component", n, [&](std::size_t i) { return c[i].Component; });
  addColumn<vtkIntArray>(data, "Branch", n, [&](std::size_t i) { return c[i].Branch; });
  addColumn<vtkIntArray>(data, "LinksBelow", n, [&](std::size_t i) { return c[i].Below.size(); });
  addColumn<vtkIntArray>(data, "LinksAbove", n, [&](std::size_t i) { return c[i].Above.size(); });
  addColumn<vtkIntArray>(data, "Level", n, [&](std::size_t i) { return c[i].Level; });
}

void droppedTo(const ContourStack& stack, vtkFieldData* field)
{
  addColumn<vtkIntArray>(field, "DroppedContours", stack.Dropped.size(),
    [&](std::size_t i) { return stack.Dropped[i].Source; });
  vtkNew<vtkStringArray> reasons;
  reasons->SetName("DroppedReasons");
  for (const DroppedContour& d : stack.Dropped)
  {
    reasons->InsertNextValue(d.Reason);
  }
  field->AddArray(reasons);
  vtkNew<vtkIntArray> links;
  links->SetName("ContourLinks");
  links->SetNumberOfComponents(2);
  for (const ContourLink& l : stack.Links)
  {
    const int pair[2] = {l.Lower, l.Upper};
    links->InsertNextTypedTuple(pair);
  }
  field->AddArray(links);
  addColumn<vtkDoubleArray>(field, "LinkOverlap", stack.Links.size(),
    [&](std::size_t i) { return stack.Links[i].Overlap; });
}

void contourCellsTo(const ContourStack& stack, vtkPolyData* out)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  for (const Contour& c : stack.Contours)
  {
    const vtkIdType first = points->GetNumberOfPoints();
    lines->InsertNextCell(static_cast<vtkIdType>(c.Points.size() + (c.Closed ? 1 : 0)));
    for (const Vec3& p : c.Points)
    {
      lines->InsertCellPoint(points->InsertNextPoint(p.data()));
    }
    if (c.Closed)
    {
      lines->InsertCellPoint(first);
    }
  }
  out->SetPoints(points);
  out->SetLines(lines);
  const auto& c = stack.Contours;
  vtkCellData* data = out->GetCellData();
  numbersTo(stack, data);
  addColumn<vtkIntArray>(data, "Inside", c.size(), [&](std::size_t i) { return c[i].Parent; });
  addColumn<vtkIntArray>(data, "Source", c.size(), [&](std::size_t i) { return c[i].Source; });
  addColumn<vtkUnsignedCharArray>(
    data, "Closed", c.size(), [&](std::size_t i) { return c[i].Closed ? 1 : 0; });
  addColumn<vtkDoubleArray>(data, "SlicePosition", c.size(),
    [&](std::size_t i) { return stack.Slices[c[i].Slice].Position; });
  data->SetActiveScalars("Branch");
}

void graphCellsTo(const ContourStack& stack, vtkPolyData* out)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkCellArray> vertices;
  for (const Contour& c : stack.Contours)
  {
    Vec3 center = Vec3::Zero();
    for (const Vec3& p : c.Points)
    {
      center += p / static_cast<double>(c.Points.size());
    }
    const vtkIdType id = points->InsertNextPoint(center.data());
    vertices->InsertNextCell(1, &id);
  }
  for (const ContourLink& l : stack.Links)
  {
    const vtkIdType ids[2] = {l.Lower, l.Upper};
    lines->InsertNextCell(2, ids);
  }
  out->SetPoints(points);
  out->SetVerts(vertices);
  out->SetLines(lines);
  numbersTo(stack, out->GetPointData());
  addColumn<vtkIntArray>(
    out->GetPointData(), "Contour", stack.Contours.size(), [](std::size_t i) { return i; });
}
} // namespace

Result<ContourInput> contoursFrom(
  vtkPolyData* data, const std::string& sliceArray, const std::string& componentArray)
{
  if (!data)
  {
    return Status::invalidInput("Connect polylines (vtkPolyData): the contours of a stack.");
  }
  ContourInput input;
  if (data->GetNumberOfPoints() == 0)
  {
    return input;
  }
  const auto points = pointsFrom(data->GetPoints());
  const auto slice = overrideArray(data, sliceArray);
  const auto component = overrideArray(data, componentArray);
  if (!points || !slice || !component)
  {
    return !points ? points.status() : !slice ? slice.status() : component.status();
  }
  const std::vector<Index> id = mergedPoints(*points);
  std::vector<Piece> pieces;
  const vtkIdType firstLine = data->GetNumberOfVerts();
  addPieces(data->GetLines(), false, firstLine, id, *slice, *component, pieces);
  addPieces(
    data->GetPolys(), true, firstLine + data->GetNumberOfLines(), id, *slice, *component, pieces);
  for (const Piece& p : Joiner(pieces).run())
  {
    Polyline line;
    line.Closed = p.Ids.size() > 2 && p.Ids.front() == p.Ids.back();
    for (const Index i : p.Ids)
    {
      line.Points.push_back((*points)[i]);
    }
    input.Lines.push_back(std::move(line));
    if (*slice)
    {
      input.SliceOf.push_back(p.Slice);
    }
    if (*component)
    {
      input.ComponentOf.push_back(p.Component);
    }
  }
  return input;
}

void stackTo(const ContourStack& stack, vtkPolyData* contours, vtkPolyData* graph)
{
  if (contours)
  {
    contourCellsTo(stack, contours);
    droppedTo(stack, contours->GetFieldData());
  }
  if (graph)
  {
    graphCellsTo(stack, graph);
  }
}
} // namespace bsr
