#include "vtkSTEPWriter.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSTEPWriter);

bool vtkSTEPWriter::IsIGES() const
{
  return false;
}

void vtkSTEPWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
