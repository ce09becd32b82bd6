#include "Layout/QuadRemesh.h"

#include "Layout/PairTriangles.h"
#include "Layout/ParametrizedLayout.h"
#include "Layout/RelaxLayout.h"
#include "Mesh/Decimate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

namespace bsr
{
namespace
{
constexpr int MostQuads = 200000;
constexpr double PoorCost = 25.0; ///< of a map's layout: the other road may do better

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

/// Bending of the surface, measured on triangles of a fifth of a quad.
Result<Sizing> sizingOf(TriangleSurface s, const ReferenceSurface& reference, int quads,
  QuadSizing kind, const Sizing::Field& field, Monitor& monitor)
{
  const double cell = std::sqrt(s.area() / quads);
  QuietMonitor quiet(monitor);
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  if (Status status = remesh(
        s, reference, [&](const Vec3&) { return 0.2 * cell; }, 3, quiet);
      !status)
  {
    return status;
  }
  return Sizing(s, cell, kind, field);
}

/// The layout of one component, by the fallback: pairs of triangles give four quads each, so half
/// as many triangles as quads are wanted; the edge length is corrected until the count fits.
Result<LayoutDraft> pairedLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, int quads, Monitor& monitor)
{
  constexpr int tries = 5;
  double cell = sizing.cellFor(quads);
  LayoutDraft best;
  double bestMiss = std::numeric_limits<double>::infinity();
  for (int i = 0; i < tries && bestMiss > 0.06; ++i)
  {
    SubMonitor part(monitor, 0.5 * i / tries, 0.5 * (i + 1) / tries);
    TriangleSurface coarse = s;
    const double edge = std::sqrt(8.0 / std::sqrt(3.0));
    const auto length = [&](const Vec3& p) { return edge * sizing.side(p, cell); };
    if (Status status = remesh(coarse, reference, length, 8, part); !status)
    {
      return status;
    }
    LayoutDraft draft = pairTriangles(coarse);
    const double ratio = static_cast<double>(draft.Mesh.Quads.size()) / quads;
    const double miss = std::abs(std::log(ratio));
    if (miss < bestMiss)
    {
      bestMiss = miss;
      best = std::move(draft);
    }
    if (ratio > 3.0 && i > 0)
    {
      break; // the topology needs so many
    }
    cell *= std::clamp(std::sqrt(ratio), 0.6, 1.6);
  }
  SubMonitor second(monitor, 0.5, 1.0);
  if (Status status = relaxLayout(best, reference, 40, second); !status)
  {
    return status;
  }
  return best;
}

/// The better of the two roads; the second is taken where the first gave nothing good.
Result<LayoutDraft> bestLayout(const TriangleSurface& s, const ReferenceSurface& reference,
  const Sizing& sizing, int quads, int seed, LayoutStage& stage, Monitor& monitor)
{
  LayoutDraft best;
  double cost = std::numeric_limits<double>::infinity();
  // Many handles on few quads leave no room for a map.
  if (-6 * s.eulerCharacteristic() < quads)
  {
    SubMonitor first(monitor, 0.0, 0.7);
    auto draft = parametrizedLayout(s, reference, sizing, quads, seed, first);
    if (!draft)
    {
      return draft;
    }
    best = std::move(*draft);
    if (!best.Mesh.Quads.empty())
    {
      cost = layoutCost(best, checkLayout(best.Mesh), s, reference, quads);
    }
  }
  stage = LayoutStage::Parametrized;
  if (cost < PoorCost)
  {
    return best;
  }
  SubMonitor second(monitor, 0.7, 1.0);
  auto draft = pairedLayout(s, reference, sizing, quads, second);
  if (!draft)
  {
    return draft;
  }
  const LayoutReport report = checkLayout(draft->Mesh);
  const bool valid = report.Valid && report.Euler == s.eulerCharacteristic();
  if (best.Mesh.Quads.empty() || (valid && layoutCost(*draft, report, s, reference, quads) < cost))
  {
    stage = LayoutStage::Paired;
    return draft;
  }
  return best;
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
  Index cells = 0;
  for (const MorseReport& r : layout.Morse)
  {
    cells += r.Cells;
  }
  append(layout.Surface, found->Surface, cells);
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
} // namespace

int leastQuads(int euler, int boundaryLoops)
{
  if (boundaryLoops > 0)
  {
    const double border = std::max(3.0 * boundaryLoops, -0.8 * euler);
    return std::max(1, static_cast<int>(std::ceil(0.5 * border - euler)));
  }
  if (euler > 0)
  {
    return 6;
  }
  const double points =
    std::max<double>(-euler, std::ceil(0.5 * (5.0 + std::sqrt(25.0 - 16.0 * euler))));
  return static_cast<int>(points) - euler;
}

Result<QuadLayout> quadRemesh(
  const TriangleMesh& mesh, const QuadRemeshOptions& options, Monitor& monitor)
{
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
  auto surfaces =
    morse ? buildSurfaces({mesh.Points, mesh.Triangles, {}}, building, layout.Repairs, repairing)
          : buildSurfaces(mesh, building, layout.Repairs, repairing);
  if (!surfaces)
  {
    return surfaces.status();
  }
  double total = 0.0;
  for (const TriangleSurface& s : *surfaces)
  {
    total += s.area();
  }
  layout.Seconds.Repair = clock.lap();
  double done = 0.0;
  for (TriangleSurface& s : *surfaces)
  {
    const double share = s.area() / total;
    SubMonitor part(rest, done, done + share);
    done += share;
    const int quads = std::max(24, static_cast<int>(std::lround(share * options.NumberOfQuads)));
    const int euler = s.eulerCharacteristic();
    layout.MinimumQuads += leastQuads(euler, boundaryLoops(s));
    const std::vector<Vec3> samples = samplesOf(s);
    SubMonitor decimating(part, 0.0, 0.5);
    DecimateOptions decimation;
    decimation.Target = std::max(20000, 60 * quads);
    decimation.Most = 3 * decimation.Target;
    decimation.MaximumError = 0.02 * std::sqrt(s.area() / quads);
    if (Status status = decimate(s, decimation, decimating); !status)
    {
      return status;
    }
    layout.Seconds.Decimation += clock.lap();
    const ReferenceSurface reference(s);
    SubMonitor laying(part, 0.5, 0.95);
    auto sizing = sizingOf(s, reference, quads, options.Sizing, field, monitor);
    if (!sizing)
    {
      return sizing.status();
    }
    if (!morse)
    {
      append(layout.Surface, {s.toMesh(), {}, {}, {}}, 0);
    }
    LayoutStage stage = morse ? LayoutStage::MorseSmale : LayoutStage::Parametrized;
    auto draft = morse ? morseDraft(s, reference, *sizing, quads, options, layout, laying)
                       : bestLayout(s, reference, *sizing, quads, options.Seed, stage, laying);
    if (!draft)
    {
      return draft.status();
    }
    layout.Seconds.Layout += clock.lap();
    const LayoutReport report = checkLayout(draft->Mesh);
    if (!report.Valid || report.Euler != euler)
    {
      return Status::failed("No valid layout was found: " +
                            (report.Valid ? std::string("the topology changed") : report.Problem) +
                            "; try another NumberOfQuads or Seed.");
    }
    const LayoutDistance d = layoutDistance(draft->Mesh, s, reference, samples);
    layout.Distance.Maximum = std::max(layout.Distance.Maximum, d.Maximum);
    layout.Distance.Mean += share * d.Mean;
    layout.Stages.push_back(stage);
    append(layout.Mesh, draft->Mesh);
    layout.Seconds.Measure += clock.lap();
  }
  layout.Report = checkLayout(layout.Mesh);
  monitor.progress(1.0);
  layout.Seconds.Measure += clock.lap();
  return layout;
}
} // namespace bsr
