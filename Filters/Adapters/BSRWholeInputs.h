#ifndef BSRWholeInputs_h
#define BSRWholeInputs_h

#include <vtkSmartPointer.h>

#include <vector>

class vtkImageData;
class vtkInformation;
class vtkInformationVector;

namespace bsr
{
/// Empties the outputs of every port.
void emptyOutputs(vtkInformationVector* outputs);

/// Asks for the whole image at an input, whatever is wanted of the outputs, where WholeInputs will
/// not put it together; an input without an image does nothing.
void requestWholeExtent(vtkInformation* input, vtkInformationVector* outputs);

/**
 * The inputs of a filter that needs all of them at once, where the processes of an MPI run have a
 * piece each.
 *
 * A filter that is asked for one piece of as many as there are processes runs on all of them at the
 * same time: the first process gets the pieces of all and does the work, the others are to give
 * empty outputs. A filter that is asked for piece 0 of 1 (one process; a stage of a compound
 * filter) works on its inputs as they are.
 *
 * Pieces of polygons are appended without their ghost cells and joined at coincident points, other
 * points are appended, pieces of images are put together by their extents. Field data comes from
 * the first piece that is not empty, for a spline model has one home.
 *
 * @code
 * const WholeInputs whole(inputs, this->GetNumberOfInputPorts(), outputs);
 * if (!whole.here())
 * {
 *   return 1;
 * }
 * inputs = whole.vectors();
 * @endcode
 */
class WholeInputs
{
public:
  /// Waits for the other processes; empties the outputs where no work is to be done.
  WholeInputs(vtkInformationVector** inputs, int ports, vtkInformationVector* outputs);
  WholeInputs(const WholeInputs&) = delete;
  WholeInputs& operator=(const WholeInputs&) = delete;

  /// Whether this process does the work.
  bool here() const { return this->Here; }
  /// In place of the filter's inputs; valid as long as this object.
  vtkInformationVector** vectors() const { return this->Vectors; }

private:
  bool Here = true;
  vtkInformationVector** Vectors;
  std::vector<vtkSmartPointer<vtkInformationVector>> Whole;
  std::vector<vtkInformationVector*> Plain;
};

/**
 * Gives each process its piece of the image that the first one has made; all of those that work
 * together must call it. One process keeps its image.
 *
 * @param image in the first process the whole, empty if there is none; afterwards the piece
 */
void deliverImage(vtkImageData* image, vtkInformationVector* outputs);
} // namespace bsr

#endif
