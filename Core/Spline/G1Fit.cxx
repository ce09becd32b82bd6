#include "Spline/G1Fit.h"

#include "Spline/CoverageEnds.h"
#include "Spline/CreaseEdges.h"
#include "Spline/FoldCheck.h"
#include "Spline/LayoutEnds.h"
#include "Spline/ModelBuilder.h"
#include "Spline/PointSelection.h"
#include "Spline/VertexSpace.h"
#include "Spline/WallThickness.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Inner points that cover less of the layout are no lumen's.
constexpr double LeastCoverage = 0.4;
/// Of the outer shell's balance of data and fairing. The roughness is the same, but the inner wall
/// is rounder, and the difference to the outer one that is faired holds the roughness of both.
constexpr double InnerBalance = 2.0;

std::unique_ptr<FitSolver> makeSolver(const QuadComplex& complex, const PatchNet& net,
  Continuity continuity, const Creases& creases, SplineSpace& space)
{
  if (continuity == Continuity::C0Multipliers)
  {
    return makeMultiplierSolver(net);
  }
  if (continuity == Continuity::C0Reduction)
  {
    space = makeC0Space(net);
  }
  else
  {
    space = makeG1Space(complex, net, defaultRule(net.segments()), creases);
    if (continuity == Continuity::VertexG1)
    {
      space = makeVertexSpace(complex, net, space);
    }
  }
  return makeReducedSolver(net, space);
}

/// `own`: the shell's rational patches, where it has them.
ShellSummary summarize(const PatchNet& net, const ShellFitResult& fit, const RationalShell& own,
  bool inner, std::vector<PatchReport>& reports)
{
  // Distances at the true feet, not at the parameters of the last equations.
  const NetEvaluator surface(net, fit.Net, &own.Patches);
  std::vector<FitPoint> points = own.Patches.empty() ? fit.Points : own.Points;
  correctParameters(surface, CorrectionMethod::Newton, points);
  const auto r = residuals(surface, points);
  const auto shapes = checkShapes(net, fit.Net);
  const std::size_t first = reports.size();
  for (std::size_t p = 0; p < shapes.size(); ++p)
  {
    PatchReport report;
    report.Side = inner ? Shell::Inner : Shell::Outer;
    report.MinJacobian = shapes[p].MinJacobian;
    report.SegmentsU = report.SegmentsV = net.segments();
    if (!own.Patches.empty())
    {
      report.MinJacobian = checkShape(own.Patches[p]).MinJacobian;
      report.SegmentsU = own.Patches[p].SegmentsU;
      report.SegmentsV = own.Patches[p].SegmentsV;
      report.Gain = own.Gains[p];
    }
    reports.push_back(report);
  }
  ShellSummary total;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (points[i].weight() <= 0.0)
    {
      ++total.Outliers;
      continue;
    }
    PatchReport& p = reports[first + points[i].Patch];
    ++p.Points;
    p.Rms += r[i].Distance * r[i].Distance;
    p.Max = std::max(p.Max, r[i].Distance);
  }
  for (std::size_t i = first; i < reports.size(); ++i)
  {
    PatchReport& p = reports[i];
    total.Points += p.Points;
    total.Rms += p.Rms;
    total.Max = std::max(total.Max, p.Max);
    p.Rms = p.Points ? std::sqrt(p.Rms / static_cast<double>(p.Points)) : 0.0;
  }
  total.Rms = total.Points ? std::sqrt(total.Rms / static_cast<double>(total.Points)) : 0.0;
  total.DataWeight = fit.DataWeight;
  total.RobustScale = fit.RobustScale;
  total.Convergence = own.History;
  total.WeightSeconds = own.Seconds;
  return total;
}

class Fitter
{
public:
  Fitter(const PartitionedPoints& points, const QuadMesh& quads, const G1FitOptions& options,
    Monitor& monitor)
      : Input(points), Full(quads), Options(options), Watch(monitor)
  {
  }

  Result<G1FitResult> run()
  {
    if (Status s = checkOptions(this->Options); !s)
    {
      return s;
    }
    if (Status s = checkPoints(this->Input, this->Full); !s)
    {
      return s;
    }
    auto whole = QuadComplex::build(this->Full.Quads, static_cast<Index>(this->Full.Points.size()));
    if (!whole)
    {
      return whole.status();
    }
    this->Cut = cutEnds(this->Full,
      this->Options.Ends == OpenEnds::Automatic ? this->Full.Region : std::vector<Index>());
    auto complex =
      QuadComplex::build(this->Cut.Quads.Quads, static_cast<Index>(this->Full.Points.size()));
    if (!complex)
    {
      return complex.status();
    }
    this->Out.OpenEndCount = this->Cut.Ends;
    this->Out.Message = this->Cut.Message;
    return this->fitShells(*complex);
  }

private:
  Result<G1FitResult> fitShells(const QuadComplex& complex)
  {
    const PatchNet net(complex, this->Options.Segments);
    this->findCreases(complex);
    SplineSpace space;
    const auto solver = makeSolver(complex, net, this->Options.Smoothness, this->Sharp, space);
    this->Out.Unknowns = solver->unknowns();
    const ShellLayout layout{&complex, &net, &this->Full.Points};
    std::vector<ShellFitResult> shells;
    shells.reserve(2); // the second shell refers to the first
    std::vector<ShellFitOptions> options;
    const double share = this->Options.Rational ? 0.3 : 0.45; // of a shell in the progress
    for (int side = 0; side < 2; ++side)
    {
      auto points = selectPoints(this->Input, this->Full, this->Cut, side);
      if (side == 1 && tooFew(points, net))
      {
        this->say("No inner wall: there are " + std::to_string(points.size()) +
                  " points of it; only the outer shell was fitted.");
        break;
      }
      if (side == 1 && coverage(points, net) < LeastCoverage)
      {
        this->say("No inner wall: its points cover only " +
                  std::to_string(std::lround(100.0 * coverage(points, net))) +
                  " % of the layout, which is no lumen; only the outer shell was fitted.");
        break;
      }
      if (side == 0 && tooFew(points, net))
      {
        return Status::invalidInput(
          "Only " + std::to_string(points.size()) + " points for " +
          std::to_string(complex.faces()) +
          " quads; give at least four a quad on average, or a layout of fewer quads.");
      }
      SubMonitor part(this->Watch, share * side, share * (side + 1));
      ShellFitOptions shellOptions = this->shellOptions();
      if (side == 1)
      {
        // Where the lumen's wall has few points it follows the outer wall.
        shellOptions.RestShape = &shells[0].Net;
        this->gaugeWall(net, shells[0], points, shellOptions);
        if (this->Options.CorrelatedNoise && this->smooth() && this->Options.DataWeight == 0.0)
        {
          shellOptions.DataWeight = InnerBalance * shells[0].Balance;
        }
      }
      auto fit = fitShell(layout, *solver, std::move(points),
        borderSamples(this->Input, this->Cut, complex, this->Full.Points, side == 1), shellOptions,
        part);
      if (!fit)
      {
        return fit.status();
      }
      if (side == 1 && !this->isSound(net, shells[0], *fit))
      {
        break;
      }
      shells.push_back(std::move(*fit));
      options.push_back(shellOptions);
    }
    SubMonitor rest(this->Watch, 2.0 * share, 1.0);
    auto own = this->rationalShells(layout, *solver, shells, options, rest);
    if (!own)
    {
      return own.status();
    }
    if (Status s = this->finish(complex, net, shells, *own); !s)
    {
      return s;
    }
    return std::move(this->Out);
  }

  /// Sharp edges of the outer wall, where they are wanted.
  void findCreases(const QuadComplex& complex)
  {
    if (this->Options.Smoothness != Continuity::FullG1 || !(this->Options.CreaseAngle < 180.0))
    {
      return;
    }
    auto points = selectPoints(this->Input, this->Full, this->Cut, 0);
    sortByPatch(points, complex.faces());
    this->Sharp = bsr::findCreases(complex, this->Full.Points, points, this->Options.CreaseAngle);
    this->Out.CreaseEdges =
      static_cast<int>(std::count(this->Sharp.Edge.begin(), this->Sharp.Edge.end(), 1));
  }

  /// One a shell; empty ones where patches are not to be rational.
  Result<std::vector<RationalShell>> rationalShells(const ShellLayout& layout, FitSolver& solver,
    const std::vector<ShellFitResult>& shells, const std::vector<ShellFitOptions>& options,
    Monitor& monitor)
  {
    std::vector<RationalShell> own(shells.size());
    if (!this->Options.Rational)
    {
      return own;
    }
    RationalOptions o = this->Options.Weights;
    o.Lambda = this->Options.Fairing.back();
    std::vector<const ShellFitResult*> fits;
    for (std::size_t s = 0; s < shells.size(); ++s)
    {
      SubMonitor part(monitor, 0.4 * s, 0.4 * (s + 1));
      auto shell = optimizeWeights(layout, solver, shells[s], options[s], o, part);
      if (!shell)
      {
        return shell.status();
      }
      own[s] = std::move(*shell);
      fits.push_back(&shells[s]);
    }
    if (o.Tolerance > 0.0)
    {
      SubMonitor part(monitor, 0.8, 1.0);
      if (Status status = refineShells(layout, own, fits, options, o, part); !status)
      {
        return status;
      }
      this->sayMissed(own, o.Tolerance);
    }
    return own;
  }

  void sayMissed(const std::vector<RationalShell>& own, double tolerance)
  {
    double worst = 0.0;
    for (const RationalShell& shell : own)
    {
      for (const PatchGain& g : shell.Gains)
      {
        this->Out.PatchesAboveTolerance += g.MeanAfter > tolerance;
        worst = std::max(worst, g.MeanAfter);
      }
    }
    if (this->Out.PatchesAboveTolerance > 0)
    {
      this->say(std::to_string(this->Out.PatchesAboveTolerance) +
                " patches miss the tolerance (largest mean distance " + std::to_string(worst) +
                "); use more segments or quads.");
    }
  }

  /// Share of the patches' quarters along u and v (4 x 4 a patch) that have points, over what as
  /// many points would hit at random.
  static double coverage(const std::vector<FitPoint>& points, const PatchNet& net)
  {
    std::vector<char> hit(16 * static_cast<std::size_t>(net.patches()), 0);
    for (const FitPoint& p : points)
    {
      const int u = std::min(3, static_cast<int>(4.0 * p.U));
      const int v = std::min(3, static_cast<int>(4.0 * p.V));
      hit[16 * static_cast<std::size_t>(p.Patch) + 4 * v + u] = 1;
    }
    const auto cells = static_cast<double>(hit.size());
    const double random = cells * (1.0 - std::exp(-static_cast<double>(points.size()) / cells));
    return std::min(1.0, static_cast<double>(std::count(hit.begin(), hit.end(), 1)) / random);
  }

  /// The thickness that the wall must have, and has where nothing is known of it.
  void gaugeWall(const PatchNet& net, const ShellFitResult& outer,
    const std::vector<FitPoint>& points, ShellFitOptions& o) const
  {
    o.TypicalWall = medianWall(WallGauge(net, outer.Net), points);
    o.LeastWall = 0.2 * o.TypicalWall;
  }

  /// An inner shell that crosses the outer one whatever was tried is not delivered.
  bool isSound(const PatchNet& net, const ShellFitResult& outer, const ShellFitResult& inner)
  {
    this->Out.MinimumWall = minimumWall(net, WallGauge(net, outer.Net), inner.Net);
    if (this->Out.MinimumWall > 0.0)
    {
      return true;
    }
    this->say(
      "No inner wall: it would cross the outer one by " + std::to_string(-this->Out.MinimumWall) +
      "; only the outer shell was fitted. Its points may be no lumen's; else use more quads.");
    this->Out.MinimumWall = 0.0;
    return false;
  }

  static bool tooFew(const std::vector<FitPoint>& points, const PatchNet& net)
  {
    return static_cast<std::int64_t>(points.size()) < 4 * static_cast<std::int64_t>(net.patches());
  }

  void say(const std::string& text)
  {
    this->Out.Message += (this->Out.Message.empty() ? "" : " ") + text;
  }

  /// Whether tangent planes are continuous between the patches.
  bool smooth() const
  {
    return this->Options.Smoothness == Continuity::FullG1 ||
           this->Options.Smoothness == Continuity::VertexG1;
  }

  ShellFitOptions shellOptions() const
  {
    ShellFitOptions o;
    o.Fairing = this->Options.Fairing;
    o.Correction = this->Options.Correction;
    o.DataWeight = this->Options.DataWeight;
    o.CorrelatedNoise = this->Options.CorrelatedNoise;
    o.Creases = !this->smooth();
    o.MostPasses = this->Options.CorrelatedNoise ? 0 : 40; // exact points: their parameters count
    o.Robust = this->Options.Robust;
    o.Reassign = this->Options.Reassign;
    return o;
  }

  Status finish(const QuadComplex& complex, const PatchNet& net,
    const std::vector<ShellFitResult>& shells, const std::vector<RationalShell>& own)
  {
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t s = 0; s < shells.size(); ++s)
    {
      if (this->Watch.cancelled())
      {
        return Status::cancelled();
      }
      this->Out.Shells.push_back(summarize(net, shells[s], own[s], s == 1, this->Out.Patches));
      const ShellSummary& t = this->Out.Shells.back();
      squares += t.Rms * t.Rms * static_cast<double>(t.Points);
      count += static_cast<double>(t.Points);
      this->Out.Max = std::max(this->Out.Max, t.Max);
      this->Out.FoldedPatches += shells[s].Folded + shells[s].FoldedWalls;
      this->Out.MaxNormalJump = std::max(this->Out.MaxNormalJump,
        largestNormalJump(complex, NetEvaluator(net, shells[s].Net, &own[s].Patches), this->Sharp));
    }
    this->Out.Rms = count > 0 ? std::sqrt(squares / count) : 0.0;
    std::vector<std::vector<RationalPatch>> patches;
    for (std::size_t s = 0; s < shells.size(); ++s)
    {
      patches.push_back(own[s].Patches.empty() ? ownPatches(net, shells[s].Net) : own[s].Patches);
    }
    this->Out.Model = buildModel(complex, patches[0], patches.size() > 1 ? &patches[1] : nullptr);
    if (this->Out.FoldedPatches > 0)
    {
      this->say(std::to_string(this->Out.FoldedPatches) +
                " patches are still folded; use another number of quads.");
    }
    PatchReport wall;
    wall.Side = Shell::Wall;
    this->Out.Patches.resize(this->Out.Model.Patches.size(), wall);
    return this->Watch.cancelled() ? Status::cancelled() : Status::ok();
  }

  const PartitionedPoints& Input;
  const QuadMesh& Full;
  const G1FitOptions& Options;
  Monitor& Watch;
  CutLayout Cut;
  Creases Sharp;
  G1FitResult Out;
};

/// Volume enclosed by the layout, negative if its quads are oriented inward.
double enclosedVolume(const QuadMesh& quads)
{
  double volume = 0.0;
  const Vec3 origin = quads.Points.empty() ? Vec3::Zero() : quads.Points.front();
  for (const auto& q : quads.Quads)
  {
    const Vec3 a = quads.Points[q[0]] - origin;
    const Vec3 c = quads.Points[q[2]] - origin;
    volume += a.dot((quads.Points[q[1]] - origin).cross(c)) / 6.0;
    volume += a.dot(c.cross(quads.Points[q[3]] - origin)) / 6.0;
  }
  return volume;
}

/// Two shells are to be fitted to ends that nobody has marked.
bool mustFindEnds(const PartitionedPoints& points, const QuadMesh& quads, const G1FitOptions& o)
{
  const auto inner = std::count(points.Side.begin(), points.Side.end(), std::uint8_t{1});
  return o.Ends == OpenEnds::Automatic && quads.Region.empty() &&
         inner >= 4 * static_cast<std::ptrdiff_t>(quads.Quads.size());
}

/// Fits; a body of one shell only is fitted again with closed ends, for it would have no walls
/// there.
Result<G1FitResult> fitBody(
  const PartitionedPoints& points, const QuadMesh& quads, G1FitOptions options, Monitor& monitor)
{
  SubMonitor first(monitor, 0.0, 0.6);
  const bool find = mustFindEnds(points, quads, options) && checkPoints(points, quads);
  const QuadMesh layout = find ? markOpenEnds(points, quads) : quads;
  auto fit = Fitter(points, layout, options, first).run();
  if (!fit || fit->OpenEndCount == 0 || fit->Shells.size() > 1)
  {
    return fit;
  }
  options.Ends = OpenEnds::KeepClosed;
  const std::string why = fit->Message;
  SubMonitor second(monitor, 0.6, 1.0);
  fit = Fitter(points, quads, options, second).run();
  if (fit)
  {
    fit->Message =
      fit->Shells.size() > 1
        ? "The ends were kept closed: with open ends there is no sound inner wall (" + why + ")."
        : why + " Its ends were kept closed.";
  }
  return fit;
}
} // namespace

Status checkOptions(const G1FitOptions& o)
{
  if (o.Segments < 3 || o.Segments > 16)
  {
    return Status::invalidParameter(
      "SegmentsPerSide is " + std::to_string(o.Segments) + "; choose 3 to 16.");
  }
  if (o.Fairing.empty())
  {
    return Status::invalidParameter("Fairing is empty; give at least one value, e.g. 0.9 0.5 0.1.");
  }
  for (const double l : o.Fairing)
  {
    if (!(l > 0.0 && l < 1.0))
    {
      return Status::invalidParameter(
        "A Fairing value is " + std::to_string(l) + "; all must lie between 0 and 1, exclusive.");
    }
  }
  if (!(o.CreaseAngle > 0.0))
  {
    return Status::invalidParameter("CreaseAngle must be above 0 degrees (180: no creases).");
  }
  if (!(o.DataWeight >= 0.0) || !std::isfinite(o.DataWeight))
  {
    return Status::invalidParameter("DataWeight must be 0 (automatic) or a positive number.");
  }
  return Status::ok();
}

Result<G1FitResult> fitG1(const PartitionedPoints& points, const QuadMesh& quads,
  const G1FitOptions& options, Monitor& monitor)
{
  const auto last = static_cast<Index>(quads.Points.size());
  const bool inRange = std::all_of(quads.Quads.begin(), quads.Quads.end(),
    [last](const auto& q)
    { return std::all_of(q.begin(), q.end(), [last](Index i) { return i >= 0 && i < last; }); });
  if (!inRange || enclosedVolume(quads) >= 0.0)
  {
    return fitBody(points, quads, options, monitor);
  }
  // Isosurfaces may be oriented inward: turn the quads over, u and v change places.
  QuadMesh outward = quads;
  for (auto& q : outward.Quads)
  {
    std::swap(q[1], q[3]);
  }
  PartitionedPoints turned = points;
  for (Vec2& uv : turned.UV)
  {
    std::swap(uv[0], uv[1]);
  }
  return fitBody(turned, outward, options, monitor);
}
} // namespace bsr
