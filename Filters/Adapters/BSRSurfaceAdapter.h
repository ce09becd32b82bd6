#ifndef BSRSurfaceAdapter_h
#define BSRSurfaceAdapter_h

#include "Common/Status.h"
#include "Mesh/Meshes.h"

#include <vtkSmartPointer.h>

#include <string>

class vtkPolyData;

namespace bsr
{
/// Any surface as triangles.
struct SurfaceInput
{
  vtkSmartPointer<vtkPolyData> Triangles; ///< what Mesh was made of, with all its arrays
  TriangleMesh Mesh;                      ///< points as they are: NaN where the input has NaN
  bool RegionsOfPoints = false;           ///< Mesh.Region came from a point array
};

/**
 * The triangles of a surface; strips and larger polygons are triangulated, vertices and lines left
 * out. Region from the cell array `regionArray`, else from the point array of that name (a
 * triangle takes the value of two of its points, else the least), where there is one.
 */
Result<SurfaceInput> surfaceFrom(vtkPolyData* surface, const std::string& regionArray);

/// The values of a point array of one component; an error that names what is there if it is absent.
Result<std::vector<double>> pointArrayFrom(vtkPolyData* surface, const std::string& name);
} // namespace bsr

#endif
