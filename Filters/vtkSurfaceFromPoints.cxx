#include "vtkSurfaceFromPoints.h"

#include "Adapters/BSRMeshAdapter.h"
#include "Adapters/BSRMonitor.h"
#include "Adapters/BSRWholeInputs.h"
#include "Mesh/BuildSurface.h"
#include "Mesh/Decimate.h"
#include "Mesh/PointDistance.h"

#include <vtkClipPolyData.h>
#include <vtkDoubleArray.h>
#include <vtkExtractSurface.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkReverseSense.h>
#include <vtkTriangleFilter.h>

#include <algorithm>

vtkStandardNewMacro(vtkSurfaceFromPoints);

namespace
{
constexpr double VoxelShare = 0.5; ///< of the finer quarter's spacing
constexpr int MostVoxels = 400;    ///< along the longest side, unless asked for
constexpr double MostReach = 3.0;
constexpr double RimReach = 0.35; ///< spacings about a point in which the surface is never cut
constexpr std::size_t TrianglesPerPoint = 4;

double voxelSize(const bsr::OrientedPoints& points, int dimension)
{
  bsr::Vec3 low = points.Points.front();
  bsr::Vec3 high = low;
  for (const bsr::Vec3& p : points.Points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double longest = (high - low).maxCoeff();
  std::vector<double> spacing = points.Spacing;
  const auto fine = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 4);
  std::nth_element(spacing.begin(), fine, spacing.end());
  return dimension > 0 ? longest / dimension : std::max(VoxelShare * *fine, longest / MostVoxels);
}

/// The zero set where the distance is known.
vtkSmartPointer<vtkPolyData> contour(bsr::DistanceGrid& grid)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.Size.data());
  image->SetOrigin(grid.Origin.data());
  image->SetSpacing(grid.Voxel, grid.Voxel, grid.Voxel);
  vtkNew<vtkFloatArray> values;
  values->SetArray(grid.Values.data(), static_cast<vtkIdType>(grid.Values.size()), 1);
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkExtractSurface> surface;
  surface->SetInputData(image);
  surface->SetRadius(0.999 * grid.Unknown);
  surface->HoleFillingOff();
  surface->ComputeNormalsOff();
  surface->Update();
  return surface->GetOutput();
}

/// The part of a surface within `reach` spacings of points that does not stand out over their rims.
vtkSmartPointer<vtkPolyData> trim(
  vtkPolyData* surface, const bsr::PointDistance& distance, double reach)
{
  vtkNew<vtkDoubleArray> remote;
  remote->SetNumberOfValues(surface->GetNumberOfPoints());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    const bsr::Vec3 p(surface->GetPoint(i));
    const double away = distance.remoteness(p);
    remote->SetValue(i, std::max(away / reach, std::min(distance.overhang(p), away / RimReach)));
  }
  surface->GetPointData()->SetScalars(remote);
  vtkNew<vtkClipPolyData> clip;
  clip->SetInputData(surface);
  clip->SetValue(1.0);
  clip->InsideOutOn();
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(clip->GetOutputPort());
  vtkNew<vtkReverseSense> outward; // the extraction looks along the gradient
  outward->SetInputConnection(triangles->GetOutputPort());
  outward->ReverseCellsOn();
  outward->Update();
  return outward->GetOutput();
}

/// The largest connected surface with about TrianglesPerPoint triangles a point.
bsr::Status simplify(
  vtkPolyData* surface, std::size_t points, bsr::Monitor& monitor, vtkPolyData* out)
{
  auto mesh = bsr::triangleMeshFrom(surface);
  if (!mesh)
  {
    return mesh.status();
  }
  bsr::RepairReport report;
  bsr::SubMonitor building(monitor, 0.0, 0.4);
  auto parts = bsr::buildSurfaces(*mesh, {}, report, building);
  if (!parts)
  {
    return parts.status();
  }
  bsr::DecimateOptions options;
  options.Target = static_cast<bsr::Index>(TrianglesPerPoint * points);
  bsr::SubMonitor decimating(monitor, 0.4, 1.0);
  if (bsr::Status s = bsr::decimate(parts->front(), options, decimating); !s)
  {
    return s;
  }
  bsr::triangleMeshTo(parts->front().toMesh(), out);
  return bsr::Status::ok();
}

void pointsTo(const bsr::OrientedPoints& points, vtkPolyData* out)
{
  const auto n = static_cast<vtkIdType>(points.Points.size());
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  places->SetNumberOfPoints(n);
  vtkNew<vtkDoubleArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(n);
  vtkNew<vtkDoubleArray> spacing;
  spacing->SetName("Spacing");
  spacing->SetNumberOfValues(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    places->SetPoint(i, points.Points[i].data());
    normals->SetTuple(i, points.Normals[i].data());
    spacing->SetValue(i, points.Spacing[i]);
  }
  out->SetPoints(places);
  out->GetPointData()->SetNormals(normals);
  out->GetPointData()->AddArray(spacing);
}
} // namespace

vtkSurfaceFromPoints::vtkSurfaceFromPoints()
{
  this->SetNumberOfOutputPorts(2);
}

int vtkSurfaceFromPoints::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  return 1;
}

int vtkSurfaceFromPoints::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bsr::WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
  if (!whole.here())
  {
    return 1;
  }
  inputs = whole.vectors();
  vtkPolyData* surface = vtkPolyData::GetData(outputs, SURFACE);
  vtkPolyData* cloud = vtkPolyData::GetData(outputs, POINTS);
  const auto fail = [&](const bsr::Status& status)
  {
    surface->Initialize();
    cloud->Initialize();
    return bsr::notDelivered(this, status);
  };
  if (!(this->Reach > 0.0) || this->Reach > MostReach)
  {
    return fail(bsr::Status::invalidParameter("Reach must be above 0 and at most 3 spacings."));
  }
  const auto places = bsr::pointsFrom(vtkPointSet::GetData(inputs[0])->GetPoints());
  if (!places)
  {
    return fail(places.status());
  }
  bsr::AlgorithmMonitor normals(this, 0.0, 0.4);
  const auto points = bsr::orientPoints(*places, this->NeighborCount, normals);
  if (!points)
  {
    return fail(points.status());
  }
  bsr::AlgorithmMonitor sampling(this, 0.4, 0.8);
  const bsr::PointDistance distance(*points);
  const double voxel = voxelSize(*points, this->Dimension);
  auto grid = bsr::sampleDistance(*points, distance, voxel, this->Reach + 1.0, sampling);
  if (!grid)
  {
    return fail(grid.status());
  }
  const auto trimmed = trim(contour(*grid), distance, this->Reach);
  if (trimmed->GetNumberOfPolys() == 0)
  {
    return fail(bsr::Status::failed(
      "No surface was found through the points; set Dimension or Reach, or make triangles before "
      "this filter."));
  }
  bsr::AlgorithmMonitor simplifying(this, 0.8, 1.0);
  if (const bsr::Status s = simplify(trimmed, points->Points.size(), simplifying, surface); !s)
  {
    return fail(s);
  }
  pointsTo(*points, cloud);
  return 1;
}

void vtkSurfaceFromPoints::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NeighborCount: " << this->NeighborCount << "\n"
     << indent << "Dimension: " << this->Dimension << "\n"
     << indent << "Reach: " << this->Reach << "\n";
}
