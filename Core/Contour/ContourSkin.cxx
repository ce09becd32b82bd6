#include "Contour/ContourSkin.h"

#include "Contour/SkinComplex.h"
#include "Spline/SampleModel.h"
#include "Spline/SplitPatch.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
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
    const std::vector<SkinPiece> pieces =
      cutPieces(this->Out.Stack, this->Options.Base, this->Out.Notes);
    const std::vector<std::vector<Index>> sheets = this->openSheets();
    const std::size_t count = pieces.size() + sheets.size();
    for (std::size_t k = 0; k < count; ++k)
    {
      const auto share = [&](std::size_t i)
      { return static_cast<double>(i) / static_cast<double>(count); };
      SubMonitor part(this->Mon, share(k), share(k + 1));
      const Status s = k < pieces.size() ? this->skinPiece(pieces[k], part)
                                         : this->skinSheet(sheets[k - pieces.size()], part);
      if (!s)
      {
        return s;
      }
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

  Status skinPiece(const SkinPiece& piece, Monitor& monitor)
  {
    if (piece.Closed)
    {
      return this->skinClosed(piece, monitor);
    }
    const ContourStack& stack = this->Out.Stack;
    std::vector<Index> contours;
    for (const SkinNode& n : piece.Legs.Nodes)
    {
      contours.push_back(n.Contour);
    }
    const SkinFitOptions fit = this->fitOptions(contours);
    const bool relaxed = fit.Parameters == SkinParameters::Relaxed;
    SkinGrid grid = arrangeGrid(stack, piece.Legs, this->Options.CorePoints, relaxed);
    alignGrid(stack, grid);
    std::vector<CapPoint> caps = closeCores(stack, grid, this->Options.ConvexEnds ? 0.75 : 0.0);
    for (const CapPoint& b : bridgeParts(stack, grid))
    {
      caps.push_back(b);
    }
    SubMonitor first(monitor, 0.0, 0.4);
    Result<SkinSurface> surface = fitSkin(grid, caps, fit, first);
    if (!surface)
    {
      return this->passOn(surface.status(), contours);
    }
    int folded = 0;
    this->blocks(*surface, folded);
    // a limit below the default is meant: a tolerance missed under it is told, not cured
    const bool free = fit.ControlPointLimit >= SkinFitOptions().ControlPointLimit;
    const bool bad = folded > 0 || (!surface->Reached && free);
    if (relaxed && bad && fit.CountU == 0 && this->Options.Layout == SkinLayout::Automatic)
    {
      SubMonitor rest(monitor, 0.4, 1.0);
      Result<SkinComplexFit> complex = this->complexOf(asTrunk(piece), fit, rest);
      if (complex && complex->Fit.FoldedPatches == 0 &&
          (complex->Fit.Rms <= fit.Tolerance || complex->Fit.Rms < surface->Rms || folded > 0))
      {
        this->addComplex(*complex, contours, fit, false);
        return Status::ok();
      }
      if (!complex && complex.status().code() == StatusCode::Cancelled)
      {
        return complex.status();
      }
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

  Status skinClosed(const SkinPiece& piece, Monitor& monitor)
  {
    std::vector<Index> contours = piece.Trunk;
    for (const SkinTree* t : {&piece.Lower, &piece.Upper})
    {
      for (std::size_t n = 1; n < t->Nodes.size(); ++n)
      {
        contours.push_back(t->Nodes[n].Contour);
      }
    }
    const SkinFitOptions fit = this->fitOptions(contours);
    Result<SkinComplexFit> complex = this->complexOf(piece, fit, monitor);
    if (!complex)
    {
      return this->passOn(complex.status(), contours);
    }
    this->addComplex(*complex, contours, fit, true);
    return Status::ok();
  }

  Result<SkinComplexFit> complexOf(
    const SkinPiece& piece, const SkinFitOptions& fit, Monitor& monitor) const
  {
    SkinComplexOptions options;
    options.Tolerance = fit.Tolerance;
    options.PointSpacing = fit.PointSpacing;
    options.CapShare = this->Options.ConvexEnds ? 0.75 : 0.0;
    options.CorePoints = this->Options.CorePoints;
    return fitComplex(this->Out.Stack, piece, options, monitor);
  }

  void addComplex(SkinComplexFit& made, const std::vector<Index>& contours,
    const SkinFitOptions& fit, bool closed)
  {
    G1FitResult& complex = made.Fit;
    const Contour& root = this->Out.Stack.Contours[contours[0]];
    SkinReport r;
    r.Component = root.Component;
    r.Side = root.hole() ? Shell::Inner : Shell::Outer;
    r.Contours = static_cast<Index>(contours.size());
    r.Closed = closed;
    r.SinglePatch = false;
    r.Tolerance = fit.Tolerance;
    r.Rms = complex.Rms;
    r.Max = complex.Max;
    r.Reached = complex.Rms <= fit.Tolerance;
    r.AverageError = complex.Rms * complex.Rms; // eq. 13 over all points of the data sets
    for (const PatchReport& p : complex.Patches)
    {
      r.TotalError += p.Rms * p.Rms * static_cast<double>(p.Points);
    }
    r.AverageErrorPerControlPoint =
      r.TotalError / static_cast<double>(complex.Model.ControlPoints.size());
    r.PointSpacing = fit.PointSpacing;
    r.NormalJump = complex.MaxNormalJump;
    r.FoldedPatches = complex.FoldedPatches;
    if (root.hole())
    {
      transposePatches(complex.Model);
    }
    // the border lies in its plane: no cut
    const std::vector<Index> cut(contours.begin() + (closed ? 0 : 1), contours.end());
    this->measureModel(complex.Model, cut, made.Ends, r.Measures);
    for (SplinePatch& p : complex.Model.Patches)
    {
      p.Side = r.Side;
    }
    this->append(complex.Model, contours[0], r);
  }

  void measureModel(const SplineModel& model, const std::vector<Index>& contours,
    const std::vector<LegEnd>& ends, SkinMeasures& out)
  {
    Monitor quiet;
    if (const auto r = resliceError(model, this->Out.Stack, contours, quiet))
    {
      out.Reslice = *r;
    }
    if (const auto s = sampleModel(model, {}, quiet))
    {
      measureEnds(this->Out.Stack, ends, s->Points, s->Normals, out);
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
    this->append(part, contours[0], r);
  }

  void append(const SplineModel& part, Index contour, SkinReport& r)
  {
    r.FirstPatch = static_cast<Index>(this->Out.Model.Patches.size());
    r.Patches = static_cast<Index>(part.Patches.size());
    appendModel(part, this->Out.Model);
    if (r.FoldedPatches > 0)
    {
      this->Out.Notes.push_back(
        {contour, "and its part: the surface folds in " + std::to_string(r.FoldedPatches) +
                    " patch(es); raise Tolerance or Fairing"});
    }
    if (!r.Reached && this->Options.Fit.CountU == 0)
    {
      this->Out.Notes.push_back({contour,
        std::string("and its part: the tolerance was not reached; ") +
          (r.SinglePatch ? "raise ControlPointLimit or Tolerance"
                         : "the contours change too much from slice to slice: give slices between, "
                           "raise Tolerance, or use BranchedContourSurface")});
    }
    this->Out.Skins.push_back(r);
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
  return result;
}
} // namespace bsr
