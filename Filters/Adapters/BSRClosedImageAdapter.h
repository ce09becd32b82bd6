#ifndef BSRClosedImageAdapter_h
#define BSRClosedImageAdapter_h

#include "Common/Status.h"
#include "Image/FiberSides.h"

class vtkImageData;

namespace bsr
{
/// The arrays Closed and SignedDistance of an image that the Closing filter made. The views point
/// into the image.
Result<ClosedObject> closedObjectFrom(vtkImageData* image);

/// Replaces world coordinates by voxel indices, counted from the first voxel of the image.
void toVoxels(vtkImageData* image, std::vector<Vec3>& points);
/// The inverse.
void fromVoxels(vtkImageData* image, std::vector<Vec3>& points);
} // namespace bsr

#endif
