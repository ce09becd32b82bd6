#include "Contour/ContourSkin.h"

#include "Contour/SkinNetwork.h"
#include "Spline/SampleModel.h"
#include "Spline/SplitPatch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace bsr
{
namespace
{
constexpr double Hopeless = 4.0; ///< tolerances, at which a network is made instead of one patch

Status checkOptions(const ContourSkinOptions& o)
{
  const SkinFitOptions& f = o.Fit;
  if (!(f.Tolerance >= 0.0) || !std::isfinite(f.Tolerance))
  {
    return Status::invalidParameter("Tolerance must be 0 (automatic) or a positive number.");
  }
  if (f.Degree < 2 || f.Degree > MaximumDegree)
  {
    return Status::invalidParameter(
      "Degree must lie in 2 to " + std::to_string(MaximumDegree) + "; 3 is the paper's.");
  }
  if (f.ControlPointLimit < 16)
  {
    return Status::invalidParameter("ControlPointLimit must be at least 16.");
  }
  const bool none = f.CountU == 0 && f.CountV == 0;
  if (!none && (f.CountU <= f.Degree || f.CountV <= f.Degree))
  {
    return Status::invalidParameter(
      "ControlPoints must be 0 0 (by refinement) or both above the Degree.");
  }
  if (o.CorePoints < 3 || o.CorePoints > 1000)
  {
    return Status::invalidParameter("CorePoints must lie in 3 to 1000.");
  }
  if (!(f.Fairing > 0.0) || !(f.Fairing <= 1e3))
  {
    return Status::invalidParameter("Fairing must be above 0 and at most 1000.");
  }
  return Status::ok();
}

double medianSpacing(const ContourStack& stack, const std::vector<Index>& contours)
{
  std::vector<double> spacing;
  for (const Index c : contours)
  {
    const Contour& contour = stack.Contours[c];
    spacing.push_back(contour.Length / static_cast<double>(contour.Points.size()));
  }
  std::sort(spacing.begin(), spacing.end());
  return spacing.empty() ? 0.0 : spacing[spacing.size() / 2];
}

double meanDiameter(const ContourStack& stack, const std::vector<Index>& contours)
{
  double sum = 0.0;
  for (const Index c : contours)
  {
    sum += stack.Contours[c].diameter() / static_cast<double>(contours.size());
  }
  return sum;
}

class Skinner
{
public:
  Skinner(const ContourSkinOptions& options, Monitor& monitor, ContourSkinResult& out)
      : Options(options), Mon(monitor), Out(out)
  {
  }

  Status run()
  {
    std::vector<std::vector<SkinPiece>> parts(static_cast<std::size_t>(this->Out.Stack.Components));
    for (SkinPiece& p : cutPieces(this->Out.Stack, this->Options.Base, this->Out.Notes))
    {
      const Index root = p.Legs.Nodes[0].Contour;
      parts[this->Out.Stack.Contours[root].Component].push_back(std::move(p));
    }
    parts.erase(std::remove_if(parts.begin(), parts.end(), [](const auto& p) { return p.empty(); }),
      parts.end());
    const std::vector<std::vector<Index>> sheets = this->openSheets();
    const std::size_t count = parts.size() + sheets.size();
    for (std::size_t k = 0; k < count; ++k)
    {
      const auto share = [&](std::size_t i)
      { return static_cast<double>(i) / static_cast<double>(count); };
      SubMonitor part(this->Mon, share(k), share(k + 1));
      Status s = k < parts.size() ? this->skinPart(parts[k], part)
                                  : this->skinSheet(sheets[k - parts.size()], part);
      if (!s)
      {
        return s;
      }
    }
    if (this->Mon.cancelled()) // while measuring
    {
      return Status::cancelled();
    }
    return this->Out.Skins.empty() ? this->nothing() : Status::ok();
  }

private:
  Status nothing() const
  {
    std::string why = "No surface can be laid over these contours";
    for (std::size_t k = 0; k < std::min<std::size_t>(3, this->Out.Notes.size()); ++k)
    {
      const ContourNote& n = this->Out.Notes[k];
      why += (k == 0 ? ": polyline " : "; polyline ") +
             std::to_string(this->Out.Stack.Contours[n.Contour].Source) + " " + n.Text;
    }
    return Status::invalidInput(why + ". Link them by hand (component array) or give more slices.");
  }

  /// Adds a note for all contours of a part that could not be skinned.
  void giveUp(const std::vector<Index>& contours, const std::string& why)
  {
    for (const Index c : contours)
    {
      this->Out.Notes.push_back({c, "is not skinned: " + why});
    }
  }

  SkinFitOptions fitOptions(const std::vector<Index>& contours) const
  {
    SkinFitOptions fit = this->Options.Fit;
    fit.PointSpacing = medianSpacing(this->Out.Stack, contours);
    if (!(fit.Tolerance > 0.0))
    {
      fit.Tolerance =
        std::max(1e-3 * meanDiameter(this->Out.Stack, contours), 0.1 * fit.PointSpacing);
    }
    return fit;
  }

  /// Chains of open contours; those that branch get notes.
  std::vector<std::vector<Index>> openSheets()
  {
    const auto& contours = this->Out.Stack.Contours;
    std::vector<std::vector<Index>> sheets;
    std::vector<char> split(static_cast<std::size_t>(this->Out.Stack.Components), 0);
    for (const Contour& c : contours)
    {
      split[c.Component] |= c.Above.size() > 1 || c.Below.size() > 1 ? 1 : 0;
    }
    for (Index c = 0; c < static_cast<Index>(contours.size()); ++c)
    {
      if (contours[c].Closed || !contours[c].Below.empty())
      {
        continue;
      }
      std::vector<Index> chain{c};
      while (!contours[chain.back()].Above.empty())
      {
        chain.push_back(contours[chain.back()].Above[0]);
      }
      if (split[contours[c].Component] != 0)
      {
        this->giveUp(chain, "open contours that branch cannot be skinned; close them");
      }
      else if (chain.size() < 2)
      {
        this->giveUp(chain, "it is linked to no contour of a neighboring slice");
      }
      else
      {
        sheets.push_back(std::move(chain));
      }
    }
    return sheets;
  }

  /// One patch where the part is an open tree that it can follow, else a network.
  Status skinPart(const std::vector<SkinPiece>& pieces, Monitor& monitor)
  {
    const bool open =
      std::none_of(pieces.begin(), pieces.end(), [](const SkinPiece& p) { return p.Closed; });
    const bool single = this->Options.Layout == SkinLayout::SinglePatch && open;
    if (!single && (!open || pieces.size() > 1))
    {
      return this->skinNetwork(pieces, monitor);
    }
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const auto count = static_cast<double>(pieces.size());
      SubMonitor part(monitor, static_cast<double>(k) / count, static_cast<double>(k + 1) / count);
      if (Status s = this->skinPiece(pieces[k], !single, part); !s)
      {
        return s;
      }
    }
    return Status::ok();
  }

  Status skinPiece(const SkinPiece& piece, bool otherwise, Monitor& monitor)
  {
    const ContourStack& stack = this->Out.Stack;
    std::vector<Index> contours;
    for (const SkinNode& n : piece.Legs.Nodes)
    {
      contours.push_back(n.Contour);
    }
    SkinFitOptions fit = this->fitOptions(contours);
    const bool relaxed = fit.Parameters == SkinParameters::Relaxed;
    // a limit below the default is meant: a tolerance missed under it is told, not cured
    const bool free = fit.ControlPointLimit >= SkinFitOptions().ControlPointLimit;
    const bool other = otherwise && relaxed && free && fit.CountU == 0;
    fit.Hopeless = other ? Hopeless : 0.0;
    SkinGrid grid = arrangeGrid(stack, piece.Legs, this->Options.CorePoints, relaxed);
    alignGrid(stack, grid);
    std::vector<CapPoint> caps = closeCores(stack, grid, this->Options.ConvexEnds ? 0.75 : 0.0);
    for (const CapPoint& b : bridgeParts(stack, grid))
    {
      caps.push_back(b);
    }
    SubMonitor first(monitor, 0.0, 0.6);
    Result<SkinSurface> surface = fitSkin(grid, caps, fit, first);
    if (!surface)
    {
      return this->passOn(surface.status(), contours);
    }
    int folded = 0;
    this->blocks(*surface, folded);
    if (folded > 0 ? relaxed && otherwise && fit.CountU == 0 : other && !surface->Reached)
    {
      SubMonitor rest(monitor, 0.6, 1.0);
      return this->skinNetwork({piece}, rest);
    }
    const Contour& root = stack.Contours[contours[0]];
    this->add(grid, *surface, contours, fit, piece.Legs.Up == root.hole());
    return Status::ok();
  }

  /// A failed fit is a note; a cancelled one ends all.
  Status passOn(const Status& status, const std::vector<Index>& contours)
  {
    if (status.code() == StatusCode::Cancelled)
    {
      return status;
    }
    this->giveUp(contours, status.message());
    return Status::ok();
  }

  /// The component of some contours, and those of holes in it that are alone: cavities, or bays
  /// that close for one slice. Sorted.
  std::vector<Index> withLonelyHoles(const std::vector<Index>& contours) const
  {
    const auto& all = this->Out.Stack.Contours;
    std::vector<Index> components{all[contours[0]].Component};
    for (const Contour& c : all)
    {
      if (c.Closed && c.hole() && c.Parent >= 0 && c.Below.empty() && c.Above.empty() &&
          all[c.Parent].Component == components[0])
      {
        components.push_back(c.Component);
      }
    }
    std::sort(components.begin(), components.end());
    return components;
  }

  Status skinNetwork(const std::vector<SkinPiece>& pieces, Monitor& monitor)
  {
    std::vector<Index> contours;
    for (const SkinPiece& p : pieces)
    {
      const std::vector<Index> own = p.contours();
      contours.insert(contours.end(), own.begin(), own.end());
    }
    const SkinFitOptions fit = this->fitOptions(contours);
    SkinNetworkOptions options;
    options.Tolerance = fit.Tolerance;
    options.PointSpacing = fit.PointSpacing;
    options.ConvexEnds = this->Options.ConvexEnds;
    const std::vector<Index> components = this->withLonelyHoles(contours);
    Result<SkinNetwork> network = fitNetwork(this->Out.Stack, pieces, components, options, monitor);
    if (!network)
    {
      return this->passOn(network.status(), contours);
    }
    // what was cut to make pieces of trees is whole here
    auto& notes = this->Out.Notes;
    notes.erase(std::remove_if(notes.begin(), notes.end(),
                  [&](const ContourNote& n)
                  {
                    return std::binary_search(components.begin(), components.end(),
                      this->Out.Stack.Contours[n.Contour].Component);
                  }),
      notes.end());
    for (const NetworkNote& n : network->Surface.Network.Notes)
    {
      const auto& all = this->Out.Stack.Contours;
      const auto at = std::find_if(
        all.begin(), all.end(), [&](const Contour& c) { return c.Source == n.Source; });
      notes.push_back({static_cast<Index>(at - all.begin()), n.Text});
    }
    this->addNetwork(*network, fit);
    return Status::ok();
  }

  void addNetwork(SkinNetwork& made, const SkinFitOptions& fit)
  {
    const SplineModel& model = made.Surface.Model;
    const Contour& root = this->Out.Stack.Contours[made.Contours[0]];
    SkinReport r;
    r.Component = root.Component;
    r.Side = root.hole() ? Shell::Inner : Shell::Outer;
    r.Contours = static_cast<Index>(made.Contours.size());
    r.Closed = made.Closed;
    r.SinglePatch = false;
    r.Tolerance = fit.Tolerance;
    r.Rms = made.Input.TotalRMS;
    r.Max = made.Input.TotalMax;
    r.Reached = r.Rms <= fit.Tolerance;
    r.AverageError = r.Rms * r.Rms; // eq. 13 over the contours' points
    for (const Index c : made.Contours)
    {
      r.TotalError +=
        r.AverageError * static_cast<double>(this->Out.Stack.Contours[c].Points.size());
    }
    r.AverageErrorPerControlPoint = r.TotalError / static_cast<double>(model.ControlPoints.size());
    r.PointSpacing = fit.PointSpacing;
    r.NormalJump = made.MaxNormalJump;
    r.FoldedPatches = made.Surface.FoldedPatches;
    this->measureModel(model, made.Contours, made.Ends, r.Measures);
    this->append(model, made.Contours, r);
  }

  void measureModel(const SplineModel& model, const std::vector<Index>& contours,
    const std::vector<LegEnd>& ends, SkinMeasures& out)
  {
    QuietMonitor quiet(this->Mon);
    if (const auto r = resliceError(model, this->Out.Stack, contours, quiet))
    {
      out.Reslice = *r;
    }
    if (const auto s = sampleModel(model, {}, quiet))
    {
      measureEnds(this->Out.Stack, ends, *s, out);
    }
  }

  Status skinSheet(const std::vector<Index>& contours, Monitor& monitor)
  {
    SkinGrid grid;
    SkinFitOptions fit = this->fitOptions(contours);
    double longest = 0.0;
    for (const Index c : contours)
    {
      longest = std::max(longest, this->Out.Stack.Contours[c].Length);
    }
    grid.Rows = static_cast<int>(contours.size());
    grid.Columns = std::clamp(static_cast<int>(std::ceil(longest / fit.PointSpacing)), 3, 500) + 1;
    for (const Index c : contours)
    {
      const std::vector<Vec3> row =
        sampleCurve(ArcCurve(this->Out.Stack.Contours[c].Points, false), grid.Columns);
      grid.Points.insert(grid.Points.end(), row.begin(), row.end());
    }
    if (fit.Parameters == SkinParameters::Relaxed)
    {
      fit.Parameters = SkinParameters::Chord;
    }
    Result<SkinSurface> surface = fitSkin(grid, {}, fit, monitor);
    if (!surface)
    {
      return this->passOn(surface.status(), contours);
    }
    this->add(grid, *surface, contours, fit, false);
    return Status::ok();
  }

  /// \param flip the data set's normals point inwards
  void add(const SkinGrid& grid, SkinSurface& surface, const std::vector<Index>& contours,
    const SkinFitOptions& fit, bool flip)
  {
    const Contour& root = this->Out.Stack.Contours[contours[0]];
    SkinReport r;
    r.Component = root.Component;
    r.Side = root.Closed && root.hole() ? Shell::Inner : Shell::Outer;
    r.Contours = static_cast<Index>(contours.size());
    r.Rows = grid.Rows;
    r.Columns = grid.Columns;
    r.CountU = surface.Shape.countU();
    r.CountV = surface.Shape.countV();
    r.Tolerance = fit.Tolerance;
    r.Reached = surface.Reached;
    r.TotalError = surface.TotalError;
    r.AverageError = surface.AverageError;
    r.AverageErrorPerControlPoint =
      surface.TotalError / static_cast<double>(surface.Shape.controlPoints());
    r.Rms = surface.Rms;
    r.Max = surface.Max;
    r.PointSpacing = fit.PointSpacing;
    r.Measures = measureSkin(this->Out.Stack, grid, surface);
    if (flip)
    {
      flipPatch(surface.Shape, surface.Control);
    }
    SplineModel part = this->blocks(surface, r.FoldedPatches);
    for (SplinePatch& p : part.Patches)
    {
      p.Side = r.Side;
    }
    this->append(part, contours, r);
  }

  void append(const SplineModel& part, const std::vector<Index>& contours, SkinReport& r)
  {
    r.FirstPatch = static_cast<Index>(this->Out.Model.Patches.size());
    r.Patches = static_cast<Index>(part.Patches.size());
    appendModel(part, this->Out.Model);
    if (r.FoldedPatches > 0)
    {
      this->Out.Notes.push_back(
        {contours[0], "and its part: the surface folds in " + std::to_string(r.FoldedPatches) +
                        " patch(es); raise Tolerance or Fairing"});
    }
    if (!r.Reached && this->Options.Fit.CountU == 0)
    {
      this->noteMiss(part, contours, r);
    }
    this->Out.Skins.push_back(r);
  }

  /// A missed tolerance, said of every contour that is further away than it.
  void noteMiss(const SplineModel& part, const std::vector<Index>& contours, const SkinReport& r)
  {
    this->Out.Notes.push_back({contours[0],
      std::string("and its part: the tolerance was not reached; ") +
        (r.SinglePatch ? "raise ControlPointLimit or Tolerance"
                       : "the contours change too much from slice to slice: give slices between, "
                         "or raise Tolerance")});
    QuietMonitor quiet(this->Mon);
    const auto input = inputError(part, this->Out.Stack, contours, quiet);
    for (std::size_t k = 0; input && k < contours.size(); ++k)
    {
      if (input->ContourRMS[k] > r.Tolerance)
      {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%.3g", input->ContourRMS[k]);
        this->Out.Notes.push_back({contours[k],
          std::string("lies ") + text.data() + " (RMS) from the surface, above the tolerance"});
      }
    }
  }

  SplineModel blocks(const SkinSurface& surface, int& folded) const
  {
    SplineModel best;
    for (const int spans : {0, 24, 16, 8, 4, 2})
    {
      const bool given = this->Options.PatchSpans > 0;
      SplineModel part =
        splitPatch(surface.Shape, surface.Control, given ? this->Options.PatchSpans : spans);
      int count = 0;
      for (const SplinePatch& p : part.Patches)
      {
        count += patchFolded(part, p) ? 1 : 0;
      }
      if (best.Patches.empty() || count == 0)
      {
        best = std::move(part);
        folded = count;
      }
      if (given || count == 0)
      {
        break;
      }
    }
    return best;
  }

  const ContourSkinOptions& Options;
  Monitor& Mon;
  ContourSkinResult& Out;
};
} // namespace

Result<ContourSkinResult> skinContours(
  const std::vector<Polyline>& polylines, const ContourSkinOptions& options, Monitor& monitor)
{
  if (Status s = checkOptions(options); !s)
  {
    return s;
  }
  SubMonitor first(monitor, 0.0, 0.05);
  Result<ContourStack> stack = buildStack(polylines, options.Stack, first);
  if (!stack)
  {
    return stack.status();
  }
  ContourSkinResult result;
  result.Stack = std::move(*stack);
  SubMonitor rest(monitor, 0.05, 1.0);
  if (Status s = Skinner(options, rest, result).run(); !s)
  {
    return s;
  }
  monitor.progress(1.0);
  if (monitor.cancelled())
  {
    return Status::cancelled(); // said at the last step
  }
  return result;
}
} // namespace bsr
