#include "BSRCadFile.h"
#include "BSRShape.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <TCollection_HAsciiString.hxx>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

namespace bsr
{
namespace
{
namespace fs = std::filesystem;

struct UnitFacts
{
  const char* Name; ///< as OpenCASCADE calls it
  double InMillimeters;
};

UnitFacts unitFacts(LengthUnit unit)
{
  switch (unit)
  {
  case LengthUnit::Micrometer:
    return {"UM", 1e-3};
  case LengthUnit::Centimeter:
    return {"CM", 10.0};
  case LengthUnit::Meter:
    return {"M", 1000.0};
  case LengthUnit::Inch:
    return {"INCH", 25.4};
  case LengthUnit::Foot:
    return {"FT", 304.8};
  default:
    return {"MM", 1.0};
  }
}

/// Sets global parameters of OpenCASCADE and puts the old values back.
class StaticSettings
{
public:
  StaticSettings() = default;
  StaticSettings(const StaticSettings&) = delete;
  StaticSettings& operator=(const StaticSettings&) = delete;
  ~StaticSettings()
  {
    for (auto it = this->Old.rbegin(); it != this->Old.rend(); ++it)
    {
      Interface_Static::SetCVal(it->first.c_str(), it->second.c_str());
    }
  }
  bool set(const char* name, const std::string& value)
  {
    if (!Interface_Static::IsPresent(name))
    {
      return false;
    }
    this->Old.emplace_back(name, Interface_Static::CVal(name));
    return Interface_Static::SetCVal(name, value.c_str());
  }

private:
  std::vector<std::pair<std::string, std::string>> Old;
};

/// Takes the printers away from OpenCASCADE's messenger for a while.
class Silence
{
public:
  Silence() : Printers(Message::DefaultMessenger()->Printers())
  {
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  ~Silence() { Message::DefaultMessenger()->ChangePrinters() = this->Printers; }

private:
  Message_SequenceOfPrinters Printers;
};

/// A file beside the target that replaces it on success and vanishes otherwise.
class TemporaryFile
{
public:
  explicit TemporaryFile(fs::path target) : Target(std::move(target))
  {
    static std::atomic<unsigned> counter{0};
    fs::path name = this->Target.filename();
    name += ".part" + std::to_string(++counter);
    this->Path = this->Target.parent_path() / name;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile()
  {
    std::error_code ignored;
    fs::remove(this->Path, ignored);
  }
  std::string name() const { return this->Path.string(); }
  Status commit() const
  {
    std::error_code error;
    if (!fs::is_regular_file(this->Path, error) || fs::file_size(this->Path, error) == 0)
    {
      return this->failure("nothing was written");
    }
    fs::rename(this->Path, this->Target, error);
    return error ? this->failure(error.message()) : Status::ok();
  }
  Status failure(const std::string& why) const
  {
    return Status::failed("Cannot write " + this->Target.string() + " (" + why +
                          "); check the folder, its permissions and the free space.");
  }

private:
  fs::path Target;
  fs::path Path;
};

Status writeStep(const TopoDS_Shape& shape, const UnitFacts& unit, bool solid,
  const fs::path& target, const TemporaryFile& file)
{
  STEPControl_Controller::Init();
  StaticSettings settings;
  const std::string product = target.stem().string();
  if (!settings.set("write.step.unit", unit.Name) || !settings.set("xstep.cascade.unit", "MM"))
  {
    return Status::failed("This OpenCASCADE does not know the unit; choose another.");
  }
  settings.set("write.step.product.name", product);
  settings.set("write.step.schema", "AP214IS");
  settings.set("write.precision.mode", "Average");
  STEPControl_Writer writer;
  const STEPControl_StepModelType type = solid ? STEPControl_ManifoldSolidBrep : STEPControl_AsIs;
  if (writer.Transfer(shape, type) != IFSelect_RetDone)
  {
    return Status::failed("OpenCASCADE could not translate the model to STEP.");
  }
  APIHeaderSection_MakeHeader header(writer.Model());
  const auto text = [](const std::string& s) { return new TCollection_HAsciiString(s.c_str()); };
  header.SetName(text(target.filename().string()));
  header.SetOriginatingSystem(text("BSplineReconstruction"));
  return writer.Write(file.name().c_str()) == IFSelect_RetDone ? Status::ok()
                                                               : file.failure("writing failed");
}

Status writeIges(
  const TopoDS_Shape& shape, const UnitFacts& unit, bool sewn, const TemporaryFile& file)
{
  IGESControl_Controller::Init();
  StaticSettings settings;
  settings.set("xstep.cascade.unit", "MM");
  settings.set("write.iges.header.product", "BSplineReconstruction");
  IGESControl_Writer writer(unit.Name, sewn ? 1 : 0);
  if (!writer.AddShape(shape))
  {
    return Status::failed("OpenCASCADE could not translate the model to IGES.");
  }
  writer.ComputeModel();
  return writer.Write(file.name().c_str()) ? Status::ok() : file.failure("writing failed");
}
} // namespace

Result<CadSummary> writeCadFile(
  const SplineModel& model, const std::string& fileName, const CadOptions& options)
{
  static std::mutex oneAtATime;
  const std::lock_guard<std::mutex> lock(oneAtATime);
  const UnitFacts unit = unitFacts(options.Unit);
  const Result<CadShape> shape = cadShape(model, unit.InMillimeters, options.Sew);
  if (!shape)
  {
    return shape.status();
  }
  const fs::path target(fileName);
  const TemporaryFile file(target);
  try
  {
    const Silence silence;
    const bool oneSolid = shape->Solids == 1 && shape->OpenShells == 0;
    const Status written = options.Format == CadFormat::STEP
                             ? writeStep(shape->Shape, unit, oneSolid, target, file)
                             : writeIges(shape->Shape, unit, options.Sew, file);
    if (!written)
    {
      return written;
    }
  }
  catch (const Standard_Failure& e)
  {
    return file.failure(std::string("OpenCASCADE: ") + e.GetMessageString());
  }
  if (Status s = file.commit(); !s)
  {
    return s;
  }
  return CadSummary{static_cast<int>(model.Patches.size()), shape->Solids, shape->OpenShells};
}
} // namespace bsr
