#include "Spline/ShellFit.h"

#include "Spline/DataBalance.h"
#include "Spline/FoldCheck.h"
#include "Spline/RobustWeights.h"

#include <cmath>

namespace bsr
{
namespace
{
constexpr double FirstDataWeight = 100.0; ///< K until it is known

class ShellFitter
{
public:
  ShellFitter(const ShellLayout& layout, FitSolver& solver, std::vector<FitPoint> points,
    const std::vector<RimSample>& rim, const ShellFitOptions& options, Monitor& monitor)
      : Complex(*layout.Complex),
        Net(*layout.Net),
        Solver(solver),
        Rim(rim),
        Options(options),
        Watch(monitor),
        Points(std::move(points))
  {
    this->Equations.Energies = patchEnergies(this->Net.segments());
    this->Equations.Aspect = patchAspects(this->Complex, *layout.Vertices);
    this->Equations.Stiffness.assign(this->Net.patches(), 1.0);
    this->Equations.Pull.assign(this->Net.patches(), 0.0);
    if (options.RestShape)
    {
      this->Equations.RestShape = *options.RestShape;
    }
    this->PatchSize = meanSize(*layout.Vertices);
  }

  Result<ShellFitResult> run()
  {
    this->K = this->Options.DataWeight > 0.0 ? this->Options.DataWeight : FirstDataWeight;
    const auto& schedule = this->Options.Fairing;
    const int passes = static_cast<int>(schedule.size());
    for (int i = 0; i < passes; ++i)
    {
      if (Status s = this->pass(schedule[i], 4.685 * std::pow(2.0, std::max(0, passes - 1 - i)));
          !s)
      {
        return s;
      }
      this->Watch.progress(0.6 * (i + 1) / (passes + 1));
    }
    if (Status s = this->balance(schedule.back()); !s)
    {
      return s;
    }
    for (int i = 0; i < this->Options.ExtraPasses; ++i)
    {
      if (Status s = this->pass(schedule.back(), 4.685); !s)
      {
        return s;
      }
    }
    this->Watch.progress(0.9);
    if (Status s = this->unfold(schedule.back()); !s)
    {
      return s;
    }
    this->Watch.progress(1.0);
    this->Result_.Net = this->Surface;
    this->Result_.Points = std::move(this->Points);
    this->Result_.DataWeight = this->K;
    return std::move(this->Result_);
  }

private:
  double meanSize(const std::vector<Vec3>& v) const
  {
    double sum = 0.0;
    for (Index f = 0; f < this->Complex.faces(); ++f)
    {
      const auto& q = this->Complex.quad(f);
      sum += std::sqrt(0.5 * (v[q[2]] - v[q[0]]).cross(v[q[3]] - v[q[1]]).norm());
    }
    return sum / this->Complex.faces();
  }

  /// Rim samples as data points; a direction turns into a target that moves with the surface.
  std::vector<FitPoint> withRim() const
  {
    std::vector<FitPoint> all = this->Points;
    const NetEvaluator surface(this->Net, this->Surface);
    // A side's samples weigh a sixth of a patch's data: enough against drift along the fiber, too
    // little to hold the border back across it.
    const double share = this->TotalWeight / this->Net.patches() / 48.0;
    for (const RimSample& r : this->Rim)
    {
      const bool directed = r.Direction.squaredNorm() > 0.0;
      if (directed && this->Surface.rows() == 0)
      {
        continue;
      }
      const double t = r.T;
      const double uv[4][2] = {{t, 0.0}, {1.0, t}, {1.0 - t, 1.0}, {0.0, 1.0 - t}};
      FitPoint p;
      p.Patch = r.HalfEdge / 4;
      p.U = uv[r.HalfEdge % 4][0];
      p.V = uv[r.HalfEdge % 4][1];
      p.Position = r.Target;
      p.Weight = share;
      p.Fixed = true;
      if (directed)
      {
        const Vec3 s = surface.at(p.Patch, p.U, p.V).Point;
        p.Position = s + r.Direction * r.Direction.dot(r.Target - s);
      }
      all.push_back(p);
    }
    return all;
  }

  void assemble()
  {
    this->TotalWeight = 0.0;
    for (const FitPoint& p : this->Points)
    {
      this->TotalWeight += p.weight();
    }
    std::vector<FitPoint> all = this->withRim();
    const auto first = sortByPatch(all, this->Net.patches());
    this->Equations.Data = dataBlocks(this->Net, all, first);
    this->Equations.TotalWeight = this->TotalWeight;
  }

  Status solve(double lambda)
  {
    if (this->Watch.cancelled())
    {
      return Status::cancelled();
    }
    this->assemble();
    auto net = this->Solver.solve(this->Equations.blocks(this->Net, lambda, this->K));
    if (!net)
    {
      return net.status();
    }
    if (!net->allFinite())
    {
      return Status::failed(
        "The fit gave infinite control points; give more points or more fairing.");
    }
    this->Surface = std::move(*net);
    return Status::ok();
  }

  void correct()
  {
    correctParameters(this->Net, this->Surface, this->Options.Correction, this->Points,
      this->Options.Reassign ? &this->Complex : nullptr);
    sortByPatch(this->Points, this->Net.patches());
  }

  void weigh(double c)
  {
    const auto r = residuals(this->Net, this->Surface, this->Points);
    this->Result_.RobustScale = robustScale(this->Points, r);
    if (this->Options.Robust)
    {
      // A floor, so that the errors of approximating clean points are not taken for outliers.
      setRobustWeights(
        this->Points, r, std::max(this->Result_.RobustScale, 2e-3 * this->PatchSize), c);
    }
  }

  Status pass(double lambda, double c)
  {
    if (Status s = this->solve(lambda); !s)
    {
      return s;
    }
    this->correct();
    this->weigh(c);
    return Status::ok();
  }

  Status balance(double lambda)
  {
    if (this->Options.DataWeight > 0.0)
    {
      return Status::ok();
    }
    this->assemble();
    auto scores = scanDataWeight(
      this->Net, this->Solver, this->Equations, this->Points, lambda, this->Watch, this->K);
    if (!scores)
    {
      return scores.status();
    }
    return Status::ok();
  }

  /// The patches that are folded; keeps their number.
  std::vector<Index> foldedPatches()
  {
    const auto shapes = checkShapes(this->Net, this->Surface);
    std::vector<Index> folded;
    for (Index f = 0; f < this->Net.patches(); ++f)
    {
      if (shapes[f].Folded)
      {
        folded.push_back(f);
      }
    }
    this->Result_.Folded = static_cast<int>(folded.size());
    return folded;
  }

  /// First fairs folded patches and their neighbors more, then pulls them to a smooth reference,
  /// both stronger from round to round, until none is folded. Parameters and weights stay.
  Status unfold(double lambda)
  {
    constexpr int FairingRounds = 4;
    constexpr int Rounds = 14;
    std::vector<Index> folded = this->foldedPatches();
    this->Result_.Unfolded = this->Result_.Folded;
    for (int round = 0; round < Rounds && !folded.empty(); ++round)
    {
      if (round == FairingRounds)
      {
        if (Status s = this->findReference(); !s)
        {
          return s;
        }
      }
      for (const Index f : folded)
      {
        round < FairingRounds ? this->stiffen(f) : this->pull(f);
      }
      if (Status s = this->solve(lambda); !s)
      {
        return s;
      }
      folded = this->foldedPatches();
    }
    return Status::ok();
  }

  /// Faces of a patch's neighborhood by corners, each once.
  std::vector<Index> ring(Index f) const
  {
    std::vector<Index> faces;
    for (const Index v : this->Complex.quad(f))
    {
      for (const Index h : this->Complex.fan(v).HalfEdges)
      {
        faces.push_back(h / 4);
      }
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  void stiffen(Index f)
  {
    for (const Index g : this->ring(f))
    {
      double& s = this->Equations.Stiffness[g];
      s = std::min(s * (g == f ? 6.0 : 2.0), 1e3);
    }
  }

  void pull(Index f)
  {
    for (const Index g : this->ring(f))
    {
      double& s = this->Equations.Pull[g];
      s = std::min(std::max(s * (g == f ? 4.0 : 2.0), 0.3 * this->K), 1e4 * this->K);
    }
  }

  /// A surface that follows the data only roughly: it is the smoothest that lies where they lie.
  Status findReference()
  {
    this->assemble();
    auto net = this->Solver.solve(this->Equations.blocks(this->Net, 0.9, std::min(this->K, 10.0)));
    if (!net)
    {
      return net.status();
    }
    this->Equations.Reference = std::move(*net);
    return Status::ok();
  }

  const QuadComplex& Complex;
  const PatchNet& Net;
  FitSolver& Solver;
  const std::vector<RimSample>& Rim;
  const ShellFitOptions& Options;
  Monitor& Watch;
  std::vector<FitPoint> Points;
  FitEquations Equations;
  NetPoints Surface;
  ShellFitResult Result_;
  double K = FirstDataWeight;
  double TotalWeight = 0.0;
  double PatchSize = 1.0;
};
} // namespace

std::vector<std::array<double, 2>> patchAspects(
  const QuadComplex& complex, const std::vector<Vec3>& v)
{
  std::vector<std::array<double, 2>> aspect(complex.faces());
  double mean = 0.0;
  for (Index f = 0; f < complex.faces(); ++f)
  {
    const auto& q = complex.quad(f);
    const double a = 0.5 * ((v[q[1]] - v[q[0]]).norm() + (v[q[2]] - v[q[3]]).norm());
    const double b = 0.5 * ((v[q[3]] - v[q[0]]).norm() + (v[q[2]] - v[q[1]]).norm());
    aspect[f] = {a, b};
    mean += std::sqrt(a * b) / complex.faces();
  }
  for (auto& [a, b] : aspect)
  {
    a = std::clamp(mean > 0.0 ? a / mean : 1.0, 1.0 / 3, 3.0);
    b = std::clamp(mean > 0.0 ? b / mean : 1.0, 1.0 / 3, 3.0);
  }
  return aspect;
}

Result<ShellFitResult> fitShell(const ShellLayout& layout, FitSolver& solver,
  std::vector<FitPoint> points, const std::vector<RimSample>& rim, const ShellFitOptions& options,
  Monitor& monitor)
{
  return ShellFitter(layout, solver, std::move(points), rim, options, monitor).run();
}
} // namespace bsr
