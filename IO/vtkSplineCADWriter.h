/**
 * @class   vtkSplineCADWriter
 * @brief   What the writers of CAD files have in common
 *
 * Writes the exact spline model in the field data of a vtkPolyData, not its polygons: one B-spline
 * face a patch (rational where its weights differ). With Sew (default) neighboring faces share
 * their edges and vertices exactly, as the model's neighbor relations say; a closed component
 * becomes a solid, a closed component within it a void of that solid, an open component an open
 * shell. Without Sew the file holds separate faces.
 *
 * The file is written under a temporary name beside the target and renamed at the end: a failure
 * leaves an existing file untouched. An input that is no spline model gives one error.
 *
 * In an MPI run all processes must call Write(): the filters before the writer work together. The
 * first process writes, for that is where they leave their models; the others write nothing.
 *
 * @warning Components that touch or cross each other are not united.
 *
 * @sa vtkSTEPWriter, vtkIGESWriter, vtkBSplineG1Fit
 */
#ifndef vtkSplineCADWriter_h
#define vtkSplineCADWriter_h

#include "BSplineReconstructionIOModule.h"
#include <vtkWriter.h>

class BSPLINERECONSTRUCTIONIO_EXPORT vtkSplineCADWriter : public vtkWriter
{
public:
  vtkTypeMacro(vtkSplineCADWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum LengthUnits
  {
    MILLIMETER = 0,
    MICROMETER,
    CENTIMETER,
    METER,
    INCH,
    FOOT
  };

  ///@{
  /** Name of the file to write. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Unit of the model's coordinates (MILLIMETER by default). It is declared in the file; the
   * numbers stay as they are.
   */
  vtkSetClampMacro(Units, int, MILLIMETER, FOOT);
  vtkGetMacro(Units, int);
  ///@}

  ///@{
  /** Let neighboring faces share edges and make shells and solids; on by default. */
  vtkSetMacro(Sew, bool);
  vtkGetMacro(Sew, bool);
  vtkBooleanMacro(Sew, bool);
  ///@}

  ///@{
  /** What the last Write() wrote; 0 after a failure. */
  vtkGetMacro(NumberOfFaces, int);
  vtkGetMacro(NumberOfSolids, int);
  ///@}

protected:
  vtkSplineCADWriter() = default;
  ~vtkSplineCADWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  void WriteData() override;
  /** Whether the file is IGES rather than STEP. */
  virtual bool IsIGES() const = 0;

  char* FileName = nullptr;
  int Units = MILLIMETER;
  bool Sew = true;
  int NumberOfFaces = 0;
  int NumberOfSolids = 0;

private:
  vtkSplineCADWriter(const vtkSplineCADWriter&) = delete;
  void operator=(const vtkSplineCADWriter&) = delete;
};

#endif
