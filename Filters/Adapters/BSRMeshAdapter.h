#ifndef BSRMeshAdapter_h
#define BSRMeshAdapter_h

#include "Common/Status.h"
#include "Mesh/Meshes.h"

#include <string>

class vtkDataArray;
class vtkDataSetAttributes;
class vtkFieldData;
class vtkPoints;
class vtkPolyData;

namespace bsr
{
/// All points of a data set, in double precision; fails on NaN or infinite coordinates.
Result<std::vector<Vec3>> pointsFrom(vtkPoints* points);

/// The triangles of a surface (strips and larger polygons are an error that names the Triangulate
/// filter; lines and vertices are ignored). Region from the cell array `regionArray` where present.
Result<TriangleMesh> triangleMeshFrom(vtkPolyData* surface, const std::string& regionArray = "");

/// The quads of a layout; any other polygon is an error that gives its size and index.
Result<QuadMesh> quadMeshFrom(vtkPolyData* layout, const std::string& regionArray = "");

/// Replaces the points and polygons of `out`.
void quadMeshTo(const QuadMesh& mesh, vtkPolyData* out);
void triangleMeshTo(const TriangleMesh& mesh, vtkPolyData* out);

/// Adds a field array of one tuple under `name` (of none without values).
void addField(vtkFieldData* field, const char* name, double value);
void addField(vtkFieldData* field, const char* name, const std::vector<double>& values);

/// Adds a field array of one string under `name`.
void addText(vtkFieldData* field, const char* name, const std::string& text);
} // namespace bsr

#endif
