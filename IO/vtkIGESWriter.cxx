#include "vtkIGESWriter.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkIGESWriter);

bool vtkIGESWriter::IsIGES() const
{
  return true;
}

void vtkIGESWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
