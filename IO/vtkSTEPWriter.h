/**
 * @class   vtkSTEPWriter
 * @brief   Write a spline model to a STEP file
 *
 * Writes the exact B-spline patches of a model to STEP (ISO 10303-21, AP214); extensions step, stp.
 * See vtkSplineCADWriter for what is written and how failures are handled.
 *
 * A closed model becomes one MANIFOLD_SOLID_BREP, or a BREP_WITH_VOIDS where a closed shell lies
 * within it. The numbers are written with 15 digits or so; the header declares the unit.
 *
 * @sa vtkSplineCADWriter
 */
#ifndef vtkSTEPWriter_h
#define vtkSTEPWriter_h

#include "BSplineReconstructionIOModule.h"
#include "vtkSplineCADWriter.h"

class BSPLINERECONSTRUCTIONIO_EXPORT vtkSTEPWriter : public vtkSplineCADWriter
{
public:
  static vtkSTEPWriter* New();
  vtkTypeMacro(vtkSTEPWriter, vtkSplineCADWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkSTEPWriter() = default;
  ~vtkSTEPWriter() override = default;

  bool IsIGES() const override;

private:
  vtkSTEPWriter(const vtkSTEPWriter&) = delete;
  void operator=(const vtkSTEPWriter&) = delete;
};

#endif
