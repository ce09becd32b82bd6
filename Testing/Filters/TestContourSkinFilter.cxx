#include "ContourStacks.h"
#include "FilterTesting.h"
#include "vtkContourSkin.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkXMLPolyDataReader.h>

using bsrtest::ErrorLog;
using bsrtest::fieldValue;

namespace
{
/// Polylines, or with `segments` loose line segments as the Slice filter gives them.
vtkSmartPointer<vtkPolyData> dataOf(const std::vector<bsr::Polyline>& lines, bool segments = false)
{
  auto out = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const bsr::Polyline& l : lines)
  {
    if (!segments)
    {
      cells->InsertNextCell(static_cast<vtkIdType>(l.Points.size()));
    }
    for (std::size_t i = 0; i < l.Points.size(); ++i)
    {
      const vtkIdType id = points->InsertNextPoint(l.Points[i].data());
      if (!segments)
      {
        cells->InsertCellPoint(id);
      }
      else if (i > 0)
      {
        const vtkIdType ids[2] = {id - 1, id};
        cells->InsertNextCell(2, ids);
      }
    }
  }
  out->SetPoints(points);
  out->SetLines(cells);
  return out;
}

double reported(vtkContourSkin* skin, const char* name, vtkIdType row = 0)
{
  vtkTable* table = vtkTable::SafeDownCast(skin->GetOutputDataObject(2));
  return table->GetValueByName(row, name).ToDouble();
}
} // namespace

TEST(ContourSkinFilter, ObjectOfThePaper)
{
  for (const bool segments : {false, true})
  {
    vtkNew<vtkContourSkin> skin;
    skin->SetInputData(dataOf(bsrtest::circleBasedObject(), segments));
    skin->SetControlPoints(19, 21);
    ErrorLog log(skin);
    skin->Update();
    EXPECT_TRUE(log.empty()) << log.text();
    EXPECT_GT(skin->GetOutput()->GetNumberOfPolys(), 1000);
    EXPECT_EQ(reported(skin, "ControlPointsU"), 19);
    EXPECT_EQ(reported(skin, "ControlPointsV"), 21);
    EXPECT_LE(reported(skin, "AverageError"), 2.0);
    EXPECT_LT(reported(skin, "SecondDerivativeJump"), 1e-6);
    EXPECT_LT(reported(skin, "EndHeight"), 1.0);
    EXPECT_EQ(fieldValue(skin->GetOutput(), "FoldedPatches"), 0.0);
    auto* contours = vtkPolyData::SafeDownCast(skin->GetOutputDataObject(3));
    EXPECT_EQ(contours->GetNumberOfLines(), 21);
    EXPECT_TRUE(contours->GetCellData()->GetAbstractArray("Message"));
    EXPECT_EQ(contours->GetFieldData()->GetArray("ContourLinks")->GetNumberOfTuples(), 20);
    EXPECT_EQ(vtkPolyData::SafeDownCast(skin->GetOutputDataObject(4))->GetNumberOfLines(), 20);
    EXPECT_EQ(vtkPolyData::SafeDownCast(skin->GetOutputDataObject(1))->GetNumberOfPoints(), 399);
  }
}

TEST(ContourSkinFilter, FemurCondyles)
{
  BSR_SHARED_DATA_OR_SKIP(path, "contours_femurL19_distal.vtp");
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkContourSkin> skin;
  skin->SetInputConnection(reader->GetOutputPort());
  skin->SetControlPoints(16, 19);
  skin->Update();
  const double diameter = 55.7;
  EXPECT_LE(fieldValue(skin->GetOutput(), "RMS"), 0.01 * diameter);
  EXPECT_EQ(fieldValue(skin->GetOutput(), "FoldedPatches"), 0.0);
  skin->SetControlPoints(0, 0);
  skin->SetTolerance(0.001 * diameter);
  skin->Update();
  EXPECT_EQ(reported(skin, "Reached"), 1);
  EXPECT_EQ(reported(skin, "SinglePatch"), 1);
  EXPECT_LE(fieldValue(skin->GetOutput(), "RMS"), 0.001 * diameter);
  EXPECT_LE(reported(skin, "ResliceRMS"), 0.25 * reported(skin, "PointSpacing"));
  EXPECT_LE(reported(skin, "SignChangesModel"), reported(skin, "SignChangesData"));
  EXPECT_LT(reported(skin, "EndHeight"), 1.0);
  EXPECT_EQ(fieldValue(skin->GetOutput(), "FoldedPatches"), 0.0);
}

TEST(ContourSkinFilter, OverridesByArrays)
{
  auto data = dataOf(bsrtest::circleBasedObject());
  vtkNew<vtkIntArray> component;
  component->SetName("Part");
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    component->InsertNextValue(c < 14 && c % 2 == 1 ? -2 : -1); // without the right leg
  }
  data->GetCellData()->AddArray(component);
  vtkNew<vtkContourSkin> skin;
  skin->SetInputData(data);
  skin->SetComponentArray("Part");
  skin->Update();
  EXPECT_EQ(reported(skin, "Contours"), 14);
  auto* contours = vtkPolyData::SafeDownCast(skin->GetOutputDataObject(3));
  EXPECT_EQ(contours->GetFieldData()->GetArray("DroppedContours")->GetNumberOfTuples(), 7);
  skin->SetComponentArray("Nothing");
  ErrorLog log(skin);
  skin->Update();
  EXPECT_TRUE(log.saidOnce("no cell array Nothing")) << log.text();
  EXPECT_EQ(skin->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(ContourSkinFilter, BadInputIsOneClearError)
{
  const auto says = [](vtkPolyData* data, const char* text)
  {
    vtkNew<vtkContourSkin> skin;
    skin->SetInputData(data);
    ErrorLog log(skin);
    skin->Update();
    EXPECT_TRUE(log.saidOnce(text)) << text << ": " << log.text();
    for (const int port : {0, 1, 3, 4})
    {
      EXPECT_EQ(vtkPolyData::SafeDownCast(skin->GetOutputDataObject(port))->GetNumberOfPoints(), 0);
    }
  };
  vtkNew<vtkPolyData> empty;
  says(empty, "no polyline");
  says(dataOf({bsrtest::ellipseAt(bsr::Vec3::Zero(), 1, 1)}), "two slices");
  bsr::Polyline point;
  point.Points.emplace_back(0, 0, 0);
  says(dataOf({point}), "No contour is left");
  auto lines = bsrtest::circleBasedObject();
  std::swap(lines[0].Points[5], lines[0].Points[25]);
  says(dataOf(lines), "crosses itself");
  lines = bsrtest::circleBasedObject();
  lines.push_back(bsrtest::ellipseAt(bsr::Vec3(3, 0, 0.2), 5, 5));
  says(dataOf(lines), "cross each other");
  lines = bsrtest::circleBasedObject();
  for (bsr::Vec3& p : lines[3].Points)
  {
    p.z() += 0.3 * p.y();
  }
  for (std::size_t k = 0; k < lines[4].Points.size(); ++k)
  {
    lines[4].Points[k].z() += 0.5 * std::sin(lines[4].Points[k].x() * lines[4].Points[k].y());
  }
  says(dataOf(lines), "not planar");
}
