#include "Layout/QuadRemesh.h"

#include "Layout/BoxLayout.h"
#include "Layout/ComponentShares.h"
#include "Layout/FitLayout.h"
#include "Layout/FitMoves.h"
#include "Mesh/Decimate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <tuple>

namespace bsr
{
namespace
{
constexpr int MostQuads = 200000;
constexpr int SpeckQuads = 11; ///< spheres of no more quads become boxes
constexpr int DiscQuads = 3;   ///< discs of no more quads become one
} // namespace

Status checkOptions(const QuadRemeshOptions& o)
{
  if (o.NumberOfQuads < 6 || o.NumberOfQuads > MostQuads)
  {
    return Status::invalidParameter("NumberOfQuads is " + std::to_string(o.NumberOfQuads) +
                                    "; choose 6 to " + std::to_string(MostQuads) + ".");
  }
  if (!(o.FeatureAngle > 0.0))
  {
    return Status::invalidParameter("FeatureAngle must be above 0 degrees (180: no features).");
  }
  if (o.Eigenfunction < 0)
  {
    return Status::invalidParameter("Eigenfunction must be 0 (automatic) or a place in the "
                                    "spectrum from 1.");
  }
  if (!(o.Persistence >= 0.0 && o.Persistence < 1.0))
  {
    return Status::invalidParameter("Persistence must be a share of the range from 0 to below 1.");
  }
  if (!(o.SmallestComponent >= 0.0))
  {
    return Status::invalidParameter("SmallestComponent must be 0 (none is dropped) or more.");
  }
  return Status::ok();
}

namespace
{
Status checkSizeField(const TriangleMesh& mesh, const QuadRemeshOptions& o)
{
  if (o.Sizing != QuadSizing::Array)
  {
    return Status::ok();
  }
  const bool sound = std::all_of(o.SizeField.begin(), o.SizeField.end(),
    [](double value) { return std::isfinite(value) && value > 0.0; });
  if (o.SizeField.size() != mesh.Points.size() || !sound)
  {
    return Status::invalidParameter(
      "Sizing by an array needs a value above 0 at each point of the surface; choose another array "
      "or Uniform sizing.");
  }
  return Status::ok();
}

/// Negative regions as numbers that are not in use (holes of surfaces are regions below 0): pairs
/// of new and old ones, both growing.
std::vector<std::array<Index, 2>> renumberRegions(std::vector<Index>& regions)
{
  std::vector<std::array<Index, 2>> renamed;
  if (std::none_of(regions.begin(), regions.end(), [](Index r) { return r < 0; }))
  {
    return renamed;
  }
  std::vector<Index> used = regions;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  Index next = 1;
  for (std::size_t i = 0; i < used.size() && used[i] < 0; ++i, ++next)
  {
    while (std::binary_search(used.begin(), used.end(), next))
    {
      ++next;
    }
    renamed.push_back({next, used[i]});
  }
  for (Index& r : regions)
  {
    r = r < 0 ? renamed[std::lower_bound(used.begin(), used.end(), r) - used.begin()][0] : r;
  }
  return renamed;
}

/// The value at the nearest point of the mesh.
Sizing::Field sizeField(const TriangleMesh& mesh, const QuadRemeshOptions& o)
{
  if (o.Sizing != QuadSizing::Array)
  {
    return {};
  }
  std::vector<Vec3> points;
  std::vector<std::array<Index, 3>> corners;
  std::vector<double> value;
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    if (mesh.Points[i].allFinite()) // others are used by no triangle
    {
      corners.emplace_back().fill(static_cast<Index>(points.size()));
      points.push_back(mesh.Points[i]);
      value.push_back(o.SizeField[i]);
    }
  }
  const auto tree = std::make_shared<TriangleTree>(std::move(points), std::move(corners));
  return [tree, value = std::move(value)](const Vec3& p)
  { return value[tree->nearest(p).Triangle]; };
}

/// Passes progress on only where it grows: how many roads are tried is not known before.
class GrowingMonitor : public Monitor
{
public:
  explicit GrowingMonitor(Monitor& parent) : Parent(parent) {}
  void progress(double share) override
  {
    if (share > this->Told)
    {
      this->Told = share;
      this->Parent.progress(share);
    }
  }
  bool cancelled() override { return this->Parent.cancelled(); }

private:
  Monitor& Parent;
  double Told = 0.0;
};

/// Wall time since the last call.
class Clock
{
public:
  double lap()
  {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> seconds = now - this->Last;
    this->Last = now;
    return seconds.count();
  }

private:
  std::chrono::steady_clock::time_point Last = std::chrono::steady_clock::now();
};

int boundaryLoops(const TriangleSurface& s)
{
  return static_cast<int>(std::count(s.Virtual.begin(), s.Virtual.end(), 1));
}

ComponentSize sizeOf(const TriangleSurface& s)
{
  return {s.area(), leastQuads(s.eulerCharacteristic(), boundaryLoops(s))};
}

/// Some points of the surface as it came, so that the distance is not to the decimated one only.
std::vector<Vec3> samplesOf(const TriangleSurface& s)
{
  constexpr std::size_t most = 40000;
  const std::size_t stride = s.Points.size() / most + 1;
  std::vector<Vec3> samples;
  samples.reserve(s.Points.size() / stride + 1);
  for (std::size_t v = 0; v < s.Points.size(); v += stride)
  {
    if (!s.Virtual[v])
    {
      samples.push_back(s.Points[v]);
    }
  }
  return samples;
}

void append(PartitionedSurface& all, const PartitionedSurface& part, Index firstCell)
{
  const auto base = static_cast<Index>(all.Mesh.Points.size());
  all.Mesh.Points.insert(all.Mesh.Points.end(), part.Mesh.Points.begin(), part.Mesh.Points.end());
  all.Eigenfunction.insert(
    all.Eigenfunction.end(), part.Eigenfunction.begin(), part.Eigenfunction.end());
  all.Critical.insert(all.Critical.end(), part.Critical.begin(), part.Critical.end());
  for (const auto& t : part.Mesh.Triangles)
  {
    all.Mesh.Triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  for (Index c : part.Cell)
  {
    all.Cell.push_back(c + firstCell);
  }
}

/// The Morse-Smale layout of one component; adds what it leaves besides to `layout`.
Result<LayoutDraft> morseDraft(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, int quads, const QuadRemeshOptions& options, QuadLayout& layout,
  Monitor& monitor)
{
  MorseOptions morse;
  morse.NumberOfQuads = quads;
  morse.Eigenfunction = options.Eigenfunction;
  morse.Persistence = options.Persistence;
  auto found = morseLayout(s, reference, sizing, morse, monitor);
  if (!found)
  {
    return found.status();
  }
  layout.Surface = std::move(found->Surface);
  layout.Morse.push_back(found->Report);
  return std::move(found->Draft);
}

void append(QuadMesh& all, const QuadMesh& part)
{
  const auto base = static_cast<Index>(all.Points.size());
  all.Points.insert(all.Points.end(), part.Points.begin(), part.Points.end());
  all.Region.insert(all.Region.end(), part.Region.begin(), part.Region.end());
  for (const auto& q : part.Quads)
  {
    all.Quads.push_back({q[0] + base, q[1] + base, q[2] + base, q[3] + base});
  }
}
Result<FieldLayout> layOut(TriangleSurface& s, const ReferenceSurface& reference, int quads,
  const QuadRemeshOptions& options, const Sizing::Field& field, QuadLayout& layout,
  Monitor& monitor)
{
  SubMonitor laying(monitor, 0.0, 0.9);
  auto sizing = Sizing::measured(s, reference, quads, options.Sizing, field, monitor);
  if (!sizing)
  {
    return sizing.status();
  }
  if (options.Method == LayoutMethod::MorseSmale)
  {
    auto draft = morseDraft(s, reference, *sizing, quads, options, layout, laying);
    return draft ? Result<FieldLayout>(FieldLayout{std::move(*draft), LayoutStage::MorseSmale})
                 : Result<FieldLayout>(draft.status());
  }
  layout.Surface = {s.toMesh(), {}, {}, {}};
  FollowedFeatures& followed = layout.Followed.back();
  auto found = layoutOfFeatures(s, reference, *sizing, {quads, options.Seed, options.Sizing, field},
    sizeOf(s).Least, followed, laying);
  SubMonitor moving(monitor, 0.9, 0.97);
  SubMonitor fitting(monitor, options.FitMoves ? 0.97 : 0.9, 1.0);
  if (found && options.FitMoves)
  {
    if (Status status = moveToFit(found->Draft, s, reference, moving); !status)
    {
      return status;
    }
  }
  if (found && options.FitRelaxation)
  {
    const LayoutDraft before = found->Draft;
    if (Status status = fitLayout(found->Draft, s, fitting); !status)
    {
      return status;
    }
    const LayoutReport report = checkLayout(found->Draft.Mesh);
    if (!report.Valid || report.Flipped > checkLayout(before.Mesh).Flipped)
    {
      found->Draft = before;
    }
  }
  return found;
}

/// Is the component, for so many quads, one that gets a box around it? If it is the last, no other
/// one makes up for what is missed.
bool boxed(const TriangleSurface& s, int quads, bool last, const QuadRemeshOptions& options)
{
  const int most = last ? std::min(SpeckQuads, 6 + options.NumberOfQuads / 20) : SpeckQuads;
  return options.Method == LayoutMethod::FieldAligned && quads <= most && isSphere(s);
}

/// Or one quad?
bool flat(const TriangleSurface& s, int quads, const QuadRemeshOptions& options)
{
  return options.Method == LayoutMethod::FieldAligned && quads <= DiscQuads && isDisc(s);
}

/// The layout of a speck; no quads if it is none.
LayoutDraft speckLayout(
  const TriangleSurface& s, int quads, bool last, const QuadRemeshOptions& options)
{
  if (boxed(s, quads, last, options))
  {
    return boxLayout(s);
  }
  return flat(s, quads, options) ? singleQuad(s) : LayoutDraft{};
}

/// The layout of a component, which is decimated on the way; `layout` is of that alone.
Status layOutComponent(TriangleSurface& s, int quads, bool last, const QuadRemeshOptions& options,
  const Sizing::Field& field, QuadLayout& layout, Monitor& monitor)
{
  Clock clock;
  const std::vector<Vec3> samples = samplesOf(s);
  const int euler = s.eulerCharacteristic();
  LayoutDraft made = speckLayout(s, quads, last, options);
  const bool speck = !made.Mesh.Quads.empty();
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  TriangleMesh whole; // with the regions whose borders are not followed
  if (std::any_of(s.Region.begin(), s.Region.end(), [](Index r) { return r > 0; }))
  {
    whole = s.toMesh();
  }
  layout.Followed.push_back(dropHopelessCreases(s, quads));
  if (!speck)
  {
    SubMonitor decimating(monitor, 0.0, 0.4);
    DecimateOptions decimation;
    decimation.Target = std::max(20000, 60 * quads);
    decimation.Most = 3 * decimation.Target;
    decimation.MaximumError = 0.02 * std::sqrt(s.area() / quads);
    if (Status status = decimate(s, decimation, decimating); !status)
    {
      return status;
    }
  }
  layout.Seconds.Decimation += clock.lap();
  ReferenceSurface reference(s, monitor);
  reference.Samples = surfaceSamples(s, 400 + 12 * quads);
  SubMonitor laying(monitor, 0.4, 1.0);
  auto found = speck ? Result<FieldLayout>(FieldLayout{std::move(made), LayoutStage::Box})
                     : layOut(s, reference, quads, options, field, layout, laying);
  if (!found)
  {
    return found.status();
  }
  if (speck)
  {
    layout.Surface = {s.toMesh(), {}, {}, {}};
  }
  layout.Seconds.Layout += clock.lap();
  layout.MinimumQuads = leastQuads(euler, boundaryLoops(s));
  const LayoutReport report = checkLayout(found->Draft.Mesh);
  if (!report.Valid || report.Euler != euler)
  {
    return Status::failed("No valid layout was found: " +
                          (report.Valid ? std::string("the topology changed") : report.Problem) +
                          "; try another NumberOfQuads or Seed.");
  }
  layout.Distance = layoutDistance(found->Draft.Mesh, s, reference, samples, monitor);
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  if (layout.Followed.back() == FollowedFeatures::None && !whole.Triangles.empty())
  {
    takeRegions(found->Draft.Mesh, whole);
  }
  layout.Stages.push_back(found->Stage);
  layout.Mesh = std::move(found->Draft.Mesh);
  layout.Seconds.Measure += clock.lap();
  return Status::ok();
}

/// Adds the layout of a component; `share` is that of its area.
void append(QuadLayout& all, const QuadLayout& part, double share)
{
  Index cells = 0;
  for (const MorseReport& r : all.Morse)
  {
    cells += r.Cells;
  }
  append(all.Surface, part.Surface, cells);
  append(all.Mesh, part.Mesh);
  all.Morse.insert(all.Morse.end(), part.Morse.begin(), part.Morse.end());
  all.Followed.insert(all.Followed.end(), part.Followed.begin(), part.Followed.end());
  all.Stages.insert(all.Stages.end(), part.Stages.begin(), part.Stages.end());
  all.MinimumQuads += part.MinimumQuads;
  all.Distance.Maximum = std::max(all.Distance.Maximum, part.Distance.Maximum);
  all.Distance.Mean += share * part.Distance.Mean;
  all.Seconds.Decimation += part.Seconds.Decimation;
  all.Seconds.Layout += part.Seconds.Layout;
  all.Seconds.Measure += part.Seconds.Measure;
}

/// In which order the components are laid out: those of many handles, which may need more quads
/// than they are given, and specks, which may take less, come first, so that the others can make up
/// for it.
std::vector<std::size_t> workOrder(
  const std::vector<TriangleSurface>& surfaces, const QuadRemeshOptions& options)
{
  std::vector<ComponentSize> sizes;
  sizes.reserve(surfaces.size());
  for (const TriangleSurface& s : surfaces)
  {
    sizes.push_back(sizeOf(s));
  }
  const std::vector<int> counts = componentShares(sizes, options.NumberOfQuads);
  std::vector<std::tuple<int, bool, std::size_t>> keys;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
  {
    const TriangleSurface& s = surfaces[i];
    const bool speck = boxed(s, counts[i], false, options) || flat(s, counts[i], options);
    keys.emplace_back(std::min(0, s.eulerCharacteristic()), !speck, i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> order;
  order.reserve(keys.size());
  for (const auto& key : keys)
  {
    order.push_back(std::get<2>(key));
  }
  return order;
}

/// The layouts of all components.
Status layOutAll(std::vector<TriangleSurface>& surfaces, const QuadRemeshOptions& options,
  const Sizing::Field& field, QuadLayout& layout, Monitor& monitor)
{
  const std::vector<std::size_t> order = workOrder(surfaces, options);
  std::vector<ComponentSize> left; // to be laid out, in this order
  double total = 0.0;
  for (std::size_t i : order)
  {
    left.push_back(sizeOf(surfaces[i]));
    total += left.back().Area;
  }
  std::vector<QuadLayout> parts(surfaces.size());
  std::vector<double> share(surfaces.size());
  std::vector<int> counts = componentShares(left, options.NumberOfQuads);
  int quads = options.NumberOfQuads;
  double done = 0.0;
  for (std::size_t i : order)
  {
    share[i] = left.front().Area / total;
    SubMonitor part(monitor, done, done + share[i]);
    done += share[i];
    const int count = counts.front();
    const bool last = left.size() == 1;
    if (Status status = layOutComponent(surfaces[i], count, last, options, field, parts[i], part);
        !status)
    {
      return status;
    }
    const auto made = static_cast<int>(parts[i].Mesh.Quads.size());
    quads -= made;
    left.erase(left.begin());
    counts.erase(counts.begin());
    if (made != count && !left.empty())
    {
      counts = componentShares(left, std::max(quads, 1));
    }
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    append(layout, parts[i], share[i]);
  }
  return Status::ok();
}
} // namespace

Result<QuadLayout> quadRemesh(
  const TriangleMesh& mesh, const QuadRemeshOptions& options, Monitor& caller)
{
  GrowingMonitor monitor(caller);
  if (Status s = checkOptions(options); !s)
  {
    return s;
  }
  if (Status s = checkSizeField(mesh, options); !s)
  {
    return s;
  }
  const Sizing::Field field = sizeField(mesh, options);
  QuadLayout layout;
  Clock clock;
  const bool morse = options.Method == LayoutMethod::MorseSmale;
  BuildSurfaceOptions building;
  building.FeatureAngle = morse ? 180.0 : options.FeatureAngle;
  building.SmallestShare = options.SmallestComponent / options.NumberOfQuads;
  SubMonitor repairing(monitor, 0.0, 0.1);
  SubMonitor rest(monitor, 0.1, 1.0);
  std::vector<Index> regions = morse ? std::vector<Index>() : mesh.Region;
  const std::vector<std::array<Index, 2>> renamed = renumberRegions(regions);
  auto surfaces = morse || !renamed.empty()
                    ? buildSurfaces({mesh.Points, mesh.Triangles, std::move(regions)}, building,
                        layout.Repairs, repairing)
                    : buildSurfaces(mesh, building, layout.Repairs, repairing);
  if (!surfaces)
  {
    return surfaces.status();
  }
  layout.Seconds.Repair = clock.lap();
  if (Status status = layOutAll(*surfaces, options, field, layout, rest); !status)
  {
    return status;
  }
  clock.lap();
  for (Index& region : layout.Mesh.Region)
  {
    const auto old = std::lower_bound(renamed.begin(), renamed.end(), region,
      [](const auto& pair, Index r) { return pair[0] < r; });
    region = old != renamed.end() && (*old)[0] == region ? (*old)[1] : region;
  }
  layout.Report = checkLayout(layout.Mesh);
  monitor.progress(1.0);
  layout.Seconds.Measure += clock.lap();
  return layout;
}
} // namespace bsr
