// The test helpers themselves: errors are collected once, from the algorithm and its executive.
#include "FilterTesting.h"

#include <vtkImageMedian3D.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkPolyDataAlgorithm.h>

namespace
{
class Complainer : public vtkPolyDataAlgorithm
{
public:
  static Complainer* New();
  vtkTypeMacro(Complainer, vtkPolyDataAlgorithm);

protected:
  Complainer() { this->SetNumberOfInputPorts(0); }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override
  {
    vtkErrorMacro("The moon is full; wait a week.");
    return 0;
  }
};
vtkStandardNewMacro(Complainer);
} // namespace

TEST(FilterTesting, ErrorsOfTheAlgorithmAreKept)
{
  vtkNew<Complainer> c;
  bsrtest::ErrorLog log(c);
  c->Update();
  EXPECT_TRUE(log.saidOnce("The moon is full")) << log.text();
  EXPECT_FALSE(log.saidOnce("The sun"));
  log.clear();
  EXPECT_TRUE(log.empty());
}

TEST(FilterTesting, ErrorsOfTheExecutiveAreKept)
{
  vtkNew<vtkImageMedian3D> median; // no input
  bsrtest::ErrorLog log(median);
  median->Update();
  EXPECT_TRUE(log.saidOnce("has 0 connections")) << log.text();
}

TEST(FilterTesting, MissingFieldValueIsNaN)
{
  vtkNew<vtkPolyData> data;
  EXPECT_TRUE(std::isnan(bsrtest::fieldValue(data, "Nothing")));
  EXPECT_TRUE(std::isnan(bsrtest::fieldValue(nullptr, "Nothing")));
}

TEST(FilterTesting, SharedDataSkipsWhereAbsent)
{
  EXPECT_TRUE(bsrtest::sharedData("no such file").empty());
  BSR_SHARED_DATA_OR_SKIP(path, "dev_long.vti");
  EXPECT_NE(path.find("dev_long.vti"), std::string::npos);
}
