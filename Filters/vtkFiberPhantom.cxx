#include "vtkFiberPhantom.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Image/FiberPhantom.h"

#include <vtkCellArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedShortArray.h>

#include <algorithm>
#include <array>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkFiberPhantom);

/// What needs Core's types.
class vtkFiberPhantom::Internals
{
public:
  static bsr::FiberPhantomOptions options(const vtkFiberPhantom* f)
  {
    bsr::FiberPhantomOptions o;
    std::copy_n(f->Dimensions, 3, o.Dimensions.begin());
    std::copy_n(f->Spacing, 3, o.Spacing.begin());
    o.Seed = f->Seed;
    o.Holes = f->Holes;
    o.Pits = f->Pits;
    o.Tunnels = f->Tunnels;
    o.Cavities = f->Cavities;
    o.Debris = f->Debris;
    o.Roughness = f->Roughness;
    o.Noise = f->Noise;
    o.Rings = f->Rings;
    o.Shading = f->Shading;
    o.Blur = f->Blur;
    o.Collapse = f->Collapse;
    o.Bend = f->Bend;
    o.Twist = f->Twist;
    o.WallThickness = f->WallThickness;
    o.Length = f->Length;
    o.OpenEnds = f->OpenEnds;
    o.AirValue = f->AirValue;
    o.WallValue = f->WallValue;
    return o;
  }

  static void fields(const bsr::FiberPhantom& phantom, vtkDataObject* out)
  {
    const bsr::FiberPhantomOptions& o = phantom.Options;
    vtkFieldData* field = out->GetFieldData();
    bsr::addField(field, "IsoValue", phantom.isoValue());
    bsr::addField(field, "Seed", static_cast<double>(o.Seed));
    bsr::addField(field, "Holes", o.Holes);
    bsr::addField(field, "Roughness", o.Roughness);
    bsr::addField(field, "Noise", o.Noise);
    bsr::addField(field, "Blur", o.Blur);
    bsr::addField(field, "Collapse", o.Collapse);
    bsr::addField(field, "OpenEnds", o.OpenEnds ? 1.0 : 0.0);
    bsr::addField(field, "MeanRadius", phantom.Shape.meanRadius());
    bsr::addField(field, "MeanThickness", phantom.Shape.wallThickness());
  }

  static void image(const std::vector<std::uint16_t>& values, const std::array<int, 6>& extent,
    const double spacing[3], vtkImageData* out)
  {
    int e[6];
    std::copy(extent.begin(), extent.end(), e);
    out->SetExtent(e);
    out->SetOrigin(0.0, 0.0, 0.0);
    out->SetSpacing(spacing);
    vtkNew<vtkUnsignedShortArray> ct;
    ct->SetName("CT");
    ct->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
    std::copy(values.begin(), values.end(), ct->GetPointer(0));
    out->GetPointData()->SetScalars(ct);
  }

  static void truth(const bsr::FiberTruth& walls, vtkPolyData* out)
  {
    const auto n = static_cast<vtkIdType>(walls.Points.size());
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(n);
    vtkNew<vtkUnsignedCharArray> side;
    side->SetName("Side");
    side->SetNumberOfTuples(n);
    vtkNew<vtkIntArray> end;
    end->SetName("End");
    end->SetNumberOfTuples(n);
    for (vtkIdType i = 0; i < n; ++i)
    {
      points->SetPoint(i, walls.Points[i].data());
      side->SetValue(i, walls.Side[i]);
      end->SetValue(i, walls.End[i]);
    }
    vtkNew<vtkCellArray> polys;
    for (const auto& q : walls.Quads)
    {
      const vtkIdType ids[4] = {q[0], q[1], q[2], q[3]};
      polys->InsertNextCell(q[2] == q[3] ? 3 : 4, ids);
    }
    out->SetPoints(points);
    out->SetPolys(polys);
    out->GetPointData()->SetScalars(side);
    out->GetPointData()->AddArray(end);
  }
};

vtkFiberPhantom::vtkFiberPhantom()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

int vtkFiberPhantom::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkPolyData");
  return 1;
}

int vtkFiberPhantom::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  // Absurd properties make an empty image here; RequestData says why and empties the outputs.
  const bool valid = bsr::makeFiberPhantom(Internals::options(this)).isOk();
  vtkInformation* info = outputs->GetInformationObject(0);
  const int none[3] = {0, 0, 0};
  const int* d = valid ? this->Dimensions : none;
  const int whole[6] = {0, d[0] - 1, 0, d[1] - 1, 0, d[2] - 1};
  const double origin[3] = {0.0, 0.0, 0.0};
  info->Set(Pipeline::WHOLE_EXTENT(), whole, 6);
  info->Set(vtkDataObject::SPACING(), this->Spacing, 3);
  info->Set(vtkDataObject::ORIGIN(), origin, 3);
  info->Set(CAN_PRODUCE_SUB_EXTENT(), 1);
  vtkDataObject::SetPointDataActiveScalarInfo(info, VTK_UNSIGNED_SHORT, 1);
  outputs->GetInformationObject(1)->Set(CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

int vtkFiberPhantom::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkImageData* image = vtkImageData::GetData(outputs, 0);
  vtkPolyData* walls = vtkPolyData::GetData(outputs, 1);
  image->Initialize();
  walls->Initialize();
  const auto phantom = bsr::makeFiberPhantom(Internals::options(this));
  if (!phantom)
  {
    vtkErrorMacro(<< phantom.status().message());
    return 0;
  }
  std::array<int, 6> extent{};
  outputs->GetInformationObject(0)->Get(Pipeline::UPDATE_EXTENT(), extent.data());
  if (extent[0] <= extent[1] && extent[2] <= extent[3] && extent[4] <= extent[5])
  {
    bsr::AlgorithmMonitor monitor(this, 0.0, 0.95);
    const auto values = bsr::fiberImage(*phantom, extent, monitor);
    if (!values)
    {
      return bsr::notDelivered(this, values.status());
    }
    Internals::image(*values, extent, this->Spacing, image);
  }
  vtkInformation* info = outputs->GetInformationObject(1);
  if (!info->Has(Pipeline::UPDATE_PIECE_NUMBER()) ||
      info->Get(Pipeline::UPDATE_PIECE_NUMBER()) == 0)
  {
    Internals::truth(bsr::fiberTruth(*phantom), walls);
  }
  Internals::fields(*phantom, image);
  Internals::fields(*phantom, walls);
  return 1;
}

void vtkFiberPhantom::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Dimensions: " << this->Dimensions[0] << " " << this->Dimensions[1] << " "
     << this->Dimensions[2] << "\n"
     << indent << "Spacing: " << this->Spacing[0] << " " << this->Spacing[1] << " "
     << this->Spacing[2] << "\n"
     << indent << "Seed: " << this->Seed << "\n"
     << indent << "OpenEnds: " << this->OpenEnds << "\n"
     << indent << "Holes: " << this->Holes << "\n"
     << indent << "Pits: " << this->Pits << "\n"
     << indent << "Tunnels: " << this->Tunnels << "\n"
     << indent << "Cavities: " << this->Cavities << "\n"
     << indent << "Debris: " << this->Debris << "\n"
     << indent << "Roughness: " << this->Roughness << "\n"
     << indent << "Noise: " << this->Noise << "\n"
     << indent << "Rings: " << this->Rings << "\n"
     << indent << "Shading: " << this->Shading << "\n"
     << indent << "Blur: " << this->Blur << "\n"
     << indent << "Collapse: " << this->Collapse << "\n"
     << indent << "Bend: " << this->Bend << "\n"
     << indent << "Twist: " << this->Twist << "\n"
     << indent << "WallThickness: " << this->WallThickness << "\n"
     << indent << "Length: " << this->Length << "\n"
     << indent << "AirValue: " << this->AirValue << "\n"
     << indent << "WallValue: " << this->WallValue << "\n";
}
