/**
 * @class   vtkIGESWriter
 * @brief   Write a spline model to a IGES file
 *
 * Writes the exact B-spline patches of a model to IGES 5.3; extensions igs, iges. See
 * vtkSplineCADWriter for what is written and how failures are handled.
 *
 * With Sew the file holds manifold solid B-rep objects (entity 186), else trimmed surfaces (entity
 * 144). Prefer STEP where the receiving program reads it.
 *
 * @sa vtkSplineCADWriter
 */
#ifndef vtkIGESWriter_h
#define vtkIGESWriter_h

#include "BSplineReconstructionIOModule.h"
#include "vtkSplineCADWriter.h"

class BSPLINERECONSTRUCTIONIO_EXPORT vtkIGESWriter : public vtkSplineCADWriter
{
public:
  static vtkIGESWriter* New();
  vtkTypeMacro(vtkIGESWriter, vtkSplineCADWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkIGESWriter() = default;
  ~vtkIGESWriter() override = default;

  bool IsIGES() const override;

private:
  vtkIGESWriter(const vtkIGESWriter&) = delete;
  void operator=(const vtkIGESWriter&) = delete;
};

#endif
