#include "Spline/ShellFit.h"

#include "Spline/DataBalance.h"
#include "Spline/FoldCheck.h"
#include "Spline/NetMixer.h"
#include "Spline/RobustWeights.h"
#include "Spline/ShellRepair.h"

#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
constexpr double FirstDataWeight = 100.0; ///< K until it is known
constexpr std::size_t MixedSteps = 6;     ///< of which accelerated passes are made

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
    this->Vertices = layout.Vertices;
    this->Judge =
      std::make_unique<ShellFaults>(this->Complex, this->Net, options.RestShape, options.LeastWall);
    if (options.RestShape)
    {
      const auto aligned = alignedRim(this->Complex, this->Net, *options.RestShape);
      this->Rim.insert(this->Rim.end(), aligned.begin(), aligned.end());
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
    this->Result_.Balance = this->K;
    for (int i = 0; i < this->Options.ExtraPasses; ++i)
    {
      if (Status s = this->pass(schedule.back(), 4.685); !s)
      {
        return s;
      }
    }
    if (Status s = this->converge(schedule.back()); !s)
    {
      return s;
    }
    this->Watch.progress(0.9);
    if (Status s = this->unfold(schedule.back()); !s)
    {
      return s;
    }
    if (Status s = this->repair(schedule.back()); !s)
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
      p.Weight = share * r.Weight;
      p.Fixed = true;
      if (directed)
      {
        const Vec3 s = surface.at(p.Patch, p.U, p.V).Point;
        p.Position = s + r.Direction * r.Direction.dot(r.Target - s);
      }
      all.push_back(p);
    }
    all.insert(all.end(), this->Pushes.begin(), this->Pushes.end());
    return all;
  }

  void assemble()
  {
    double sum = 0.0;
    for (const FitPoint& p : this->Points)
    {
      sum += p.weight();
    }
    // In the repair the other points keep their say whatever is dropped.
    this->TotalWeight = this->Repairing ? this->TotalWeight : sum;
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
    if (this->Watch.cancelled())
    {
      return Status::cancelled();
    }
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
    if (this->Watch.cancelled())
    {
      return Status::cancelled();
    }
    this->weigh(c);
    return Status::ok();
  }

  /// Passes go on, accelerated, until they gain next to nothing: alone, parameters drift along the
  /// surface for hundreds of passes. Where patches fold in the end, the last net without folds is
  /// taken.
  Status converge(double lambda)
  {
    constexpr double Growth = 1.02;  ///< of the distances, for the steps to be forgotten
    NetPoints sound = this->Surface; // the last one without folds
    std::vector<FitPoint> points = this->Points;
    NetMixer mixer(MixedSteps);
    double before = std::numeric_limits<double>::infinity();
    int idle = 0;
    for (int i = 0; i < this->Options.MostPasses && idle < 2; ++i)
    {
      const NetPoints from = this->Surface;
      if (Status s = this->solve(lambda); !s)
      {
        return s;
      }
      const double now = weightedRms(this->Net, this->Surface, this->Points);
      idle = now > (1.0 - this->Options.LeastGain) * before ? idle + 1 : 0;
      if (now > Growth * before)
      {
        mixer.clear();
      }
      before = now;
      const NetPoints to = this->Surface;
      this->Judge->look(to);
      if (this->Judge->score() < ShellFaults::Severe)
      {
        sound = to;
        points = this->Points;
      }
      this->Surface = mixer.next(from, to);
      if (i + 1 == this->Options.MostPasses || idle == 2)
      {
        this->Surface = to;
      }
      this->correct();
      if (this->Watch.cancelled())
      {
        return Status::cancelled();
      }
      this->weigh(4.685);
    }
    this->Judge->look(this->Surface);
    if (this->Judge->score() >= ShellFaults::Severe)
    {
      this->Surface = std::move(sound);
      this->Points = std::move(points);
      this->correct();
    }
    return Status::ok();
  }

  Status balance(double lambda)
  {
    if (this->Options.DataWeight > 0.0)
    {
      return Status::ok();
    }
    this->assemble();
    auto scores = scanDataWeight(this->Net, this->Solver, this->Equations, this->Points, lambda,
      this->Options.CorrelatedNoise, this->Options.Creases, this->Watch, this->K);
    if (!scores)
    {
      return scores.status();
    }
    return Status::ok();
  }

  /// A first shell with folds gets local fairing, then loses the data of the patches that stay
  /// folded; where that does not do, all data count less. What is left is for the repair.
  Status unfold(double lambda)
  {
    constexpr int Rounds = 9;
    constexpr int Drop = 6;
    constexpr double LeastDataWeight = 30.0;
    this->Judge->look(this->Surface);
    if (this->Options.RestShape || this->Judge->score() < ShellFaults::Severe)
    {
      return Status::ok();
    }
    const std::vector<FitPoint> points = this->Points;
    const auto stiffness = this->Equations.Stiffness;
    this->Repairing = true;
    for (int round = 0; this->Judge->score() >= ShellFaults::Severe; ++round)
    {
      if (round % Rounds == Rounds - 1)
      {
        this->Repairing = false;
        this->Points = points;
        this->Equations.Stiffness = stiffness;
        if (this->K <= LeastDataWeight)
        {
          return this->pass(lambda, 4.685);
        }
        this->K /= 3.0;
        if (Status s = this->pass(lambda, 4.685); !s)
        {
          return s;
        }
        this->Repairing = true;
      }
      else
      {
        for (const Index f : this->Judge->BadPatches)
        {
          this->stiffen(f);
        }
        if (round % Rounds >= Drop)
        {
          this->dropData();
        }
        if (Status s = this->solve(lambda); !s)
        {
          return s;
        }
      }
      this->Judge->look(this->Surface);
    }
    return Status::ok();
  }

  /// The points of bad patches lose their weight.
  void dropData()
  {
    std::vector<char> bad(this->Net.patches(), 0);
    for (const Index f : this->Judge->BadPatches)
    {
      bad[f] = 1;
    }
    for (FitPoint& p : this->Points)
    {
      p.Robust = bad[p.Patch] ? 0.0 : p.Robust;
    }
  }

  /// Parameters stay; what helped least comes first, so that healthy data are touched least.
  Status repair(double lambda)
  {
    constexpr int FairingRounds = 4;
    constexpr int PullRounds = 12;
    constexpr int Rounds = 22;
    this->Repairing = true;
    this->Judge->look(this->Surface);
    this->Result_.Repaired = static_cast<int>(this->Judge->BadPatches.size());
    NetPoints best = this->Surface;
    double bestScore = this->Judge->score();
    for (int round = 0; round<Rounds&& this->Judge->score()> 0.0; ++round)
    {
      if (round == FairingRounds || round == PullRounds)
      {
        if (Status s = round == PullRounds ? this->findSafeShape() : this->findReference(); !s)
        {
          return s;
        }
      }
      for (const Index f : this->Judge->BadPatches)
      {
        round < FairingRounds ? this->stiffen(f) : this->pull(f, 1 + (round - 4) / 6);
      }
      this->hold(round >= PullRounds);
      if (Status s = this->solve(lambda); !s)
      {
        return s;
      }
      this->Judge->look(this->Surface);
      if (this->Judge->score() < bestScore)
      {
        bestScore = this->Judge->score();
        best = this->Surface;
      }
    }
    this->Surface = std::move(best);
    return this->blend(bestScore);
  }

  /// Thin places are pushed inward, data that say otherwise or keep patches folded are dropped.
  void hold(bool drop)
  {
    const double share = this->TotalWeight / this->Net.patches() / 80.0;
    for (FitPoint p : this->Judge->Thin)
    {
      p.Weight = share;
      this->Pushes.push_back(p);
    }
    std::vector<char> thin(this->Net.patches(), 0);
    for (const FitPoint& p : this->Judge->Thin)
    {
      thin[p.Patch] = 1;
    }
    std::vector<char> bad(this->Net.patches(), 0);
    for (const Index f : this->Judge->BadPatches)
    {
      bad[f] = drop;
    }
    for (FitPoint& p : this->Points)
    {
      if (bad[p.Patch] || (thin[p.Patch] && this->Judge->tooClose(p.Position)))
      {
        p.Robust = 0.0;
      }
    }
    for (const Index h : this->Judge->Walls)
    {
      for (RimSample& r : this->Rim)
      {
        r.Weight *= r.HalfEdge == h && r.Weight < 1e4 ? 2.0 : 1.0;
      }
    }
  }

  /// The way out that always leads to the safe shape: nets of a space may be mixed.
  Status blend(double bestScore)
  {
    const NetPoints fitted = this->Surface;
    if (bestScore >= ShellFaults::Severe)
    {
      if (Status s = this->findSafeShape(); !s)
      {
        return s;
      }
      for (int i = 1; i <= 10 && bestScore >= ShellFaults::Severe; ++i)
      {
        const NetPoints mixed = (1.0 - 0.1 * i) * fitted + 0.1 * i * this->Equations.Reference;
        this->Judge->look(mixed);
        if (this->Judge->score() < bestScore)
        {
          bestScore = this->Judge->score();
          this->Surface = mixed;
        }
      }
    }
    this->Judge->look(this->Surface);
    this->Result_.Folded = this->Judge->Folded;
    this->Result_.FoldedWalls = static_cast<int>(this->Judge->Walls.size());
    return Status::ok();
  }

  /// The layout itself, or the outer shell moved inward, smoothed until nothing is wrong with it.
  Status findSafeShape()
  {
    if (this->HasSafeShape)
    {
      return Status::ok();
    }
    this->HasSafeShape = true;
    double depth = std::max(this->Options.TypicalWall, 1.5 * this->Options.LeastWall);
    ShellFaults judge = *this->Judge;
    FitEquations e = this->Equations;
    e.Pull.assign(this->Net.patches(), 0.0);
    e.Stiffness.assign(this->Net.patches(), 1.0);
    double least = std::numeric_limits<double>::max();
    for (int round = 0; round < 6 && least > 0.0; ++round)
    {
      std::vector<FitPoint> targets = this->Options.RestShape
                                        ? judge.pointsBelow(depth)
                                        : layoutPoints(this->Complex, *this->Vertices);
      const auto first = sortByPatch(targets, this->Net.patches());
      e.Data = dataBlocks(this->Net, targets, first);
      e.TotalWeight = static_cast<double>(targets.size());
      auto net = this->Solver.solve(e.blocks(this->Net, 0.5, 100.0));
      if (!net)
      {
        return net.status();
      }
      judge.look(*net);
      if (judge.score() < least)
      {
        least = judge.score();
        this->Equations.Reference = *net;
      }
      for (const Index f : judge.BadPatches)
      {
        for (const Index g : this->ring(f))
        {
          e.Stiffness[g] = std::min(e.Stiffness[g] * 4.0, 1e4);
        }
      }
      depth = std::max(0.7 * depth, 1.5 * this->Options.LeastWall);
    }
    return this->Watch.cancelled() ? Status::cancelled() : Status::ok();
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

  void pull(Index f, int rings)
  {
    std::vector<Index> faces{f};
    for (int i = 0; i < rings; ++i)
    {
      std::vector<Index> wider;
      for (const Index g : faces)
      {
        const auto around = this->ring(g);
        wider.insert(wider.end(), around.begin(), around.end());
      }
      std::sort(wider.begin(), wider.end());
      wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
      faces = std::move(wider);
    }
    for (const Index g : faces)
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
  std::vector<RimSample> Rim;
  std::vector<FitPoint> Pushes; ///< hold the wall's least thickness
  std::unique_ptr<ShellFaults> Judge;
  const ShellFitOptions& Options;
  Monitor& Watch;
  std::vector<FitPoint> Points;
  FitEquations Equations;
  const std::vector<Vec3>* Vertices = nullptr;
  NetPoints Surface;
  ShellFitResult Result_;
  double K = FirstDataWeight;
  double TotalWeight = 0.0;
  bool Repairing = false;
  bool HasSafeShape = false; ///< the reference is it
  double PatchSize = 1.0;
};
} // namespace

Result<ShellFitResult> fitShell(const ShellLayout& layout, FitSolver& solver,
  std::vector<FitPoint> points, const std::vector<RimSample>& rim, const ShellFitOptions& options,
  Monitor& monitor)
{
  return ShellFitter(layout, solver, std::move(points), rim, options, monitor).run();
}
} // namespace bsr
