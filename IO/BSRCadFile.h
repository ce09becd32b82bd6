#ifndef BSRCadFile_h
#define BSRCadFile_h

#include "Common/Status.h"
#include "Spline/SplineModel.h"

#include <string>

namespace bsr
{
enum class CadFormat
{
  STEP,
  IGES
};

/// Unit of length of a model's coordinates; written to the file's header.
enum class LengthUnit
{
  Millimeter,
  Micrometer,
  Centimeter,
  Meter,
  Inch,
  Foot
};

struct CadOptions
{
  CadFormat Format = CadFormat::STEP;
  LengthUnit Unit = LengthUnit::Millimeter;
  bool Sew = true;
};

/// What was written.
struct CadSummary
{
  int Faces = 0;
  int Solids = 0;
  int OpenShells = 0;
};

/**
 * Writes a valid model to a file: to a temporary file beside it first, so that a failure leaves an
 * existing file as it was. The numbers in the file are the model's, in the given unit. Settings of
 * OpenCASCADE, which are global, are put back; nothing is printed. Calls from several threads wait
 * for each other.
 */
Result<CadSummary> writeCadFile(
  const SplineModel& model, const std::string& fileName, const CadOptions& options);
} // namespace bsr

#endif
