#include "Contour/RelaxFolds.h"

#include "Common/Parallel.h"
#include "Contour/NormalMatrix.h"
#include "Contour/RelaxSpace.h"
#include "Contour/SurfaceReport.h"
#include "Spline/Basis.h"
#include "Spline/ClosestPoint.h"
#include "Spline/Evaluate.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace bsr
{
namespace
{
constexpr int Samples = 25;     ///< a side, as in patchJacobians
constexpr int Window = 4;       ///< samples on each side that a reference normal is the mean of
constexpr double Turned = 0.12; ///< least wanted area of a sample, of the patch's mean
constexpr double Acceptable = 0.06;
constexpr double DataWeight = 300.0;    ///< of the contours' points against the bending energy
constexpr int Rounds = 24;              ///< of turning samples over, at most
constexpr int Patience = 8;             ///< rounds without one folded patch less
constexpr double LongestStep = 0.25;    ///< in sizes of a span
constexpr double SharpTurn = 0.1;       ///< cosine between neighboring samples' normals
constexpr std::size_t LargeModel = 600; ///< patches, small enough for regions of many rings
constexpr double Misfit = 0.1;          ///< RMS distance that data may be left behind, in spans

/// Values (or derivatives) of the control points at a place: a linear form in them.
struct PointForm
{
  std::vector<std::pair<std::int64_t, double>> Terms;
};

/// The part of a model that moves.
class Relaxer
{
public:
  Relaxer(const SplineModel& model, std::vector<std::int64_t> region)
      : Model(model), Region(std::move(region)), Space(makeRelaxSpace(model, this->Region))
  {
    this->N = this->Space.Variables;
    this->Energy.resize(this->N, this->N);
    this->Gradient = Eigen::MatrixXd::Zero(this->N, 3);
  }

  bool empty() const { return this->N == 0; }
  const SplineModel& result() const { return this->Model; }
  const std::vector<std::int64_t>& region() const { return this->Region; }

  /// Thin plate and data, about the model as it is.
  void assemble(
    const std::vector<ModelHit>& hits, const std::vector<Vec3>& points, double dataWeight)
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (const std::int64_t p : this->Region)
    {
      this->addBending(p, entries);
    }
    double& apart = this->SpanSize;
    for (const std::int64_t p : this->Region)
    {
      const auto [lu, lv] = this->lengths(p);
      const SplinePatch& s = this->Model.Patches[p];
      apart += std::sqrt(lu * lv / ((s.CountU - s.DegreeU) * (s.CountV - s.DegreeV))) /
               static_cast<double>(this->Region.size());
    }
    for (std::size_t i = 0; i < hits.size(); ++i)
    {
      if (std::binary_search(this->Region.begin(), this->Region.end(), hits[i].Patch))
      {
        const SplinePatch& s = this->Model.Patches[hits[i].Patch];
        const LinearForm f = this->moved(this->basisAt(s, hits[i].U, hits[i].V, 0, 0));
        this->addSquare(f, points[i] - hits[i].Point, dataWeight / (apart * apart), entries);
      }
    }
    this->Energy.setFromTriplets(entries.begin(), entries.end());
  }

  double spanSize() const { return this->SpanSize; }

  /// RMS distance of the data from where they were nearest.
  double misfit(const std::vector<ModelHit>& hits, const std::vector<Vec3>& points) const
  {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < hits.size(); ++i)
    {
      if (std::binary_search(this->Region.begin(), this->Region.end(), hits[i].Patch))
      {
        const SplinePatch& s = this->Model.Patches[hits[i].Patch];
        sum +=
          (points[i] - evaluatePatch(this->Model, s, hits[i].U, hits[i].V).Point).squaredNorm();
        count += 1.0;
      }
    }
    return std::sqrt(sum / std::max(count, 1.0));
  }

  /// The least energy.
  void solve()
  {
    Eigen::SparseMatrix<double> a = this->Energy;
    for (int i = 0; i < this->N; ++i)
    {
      a.coeffRef(i, i) += 1e-9 * a.coeff(i, i) + 1e-12;
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(a);
    if (solver.info() == Eigen::Success)
    {
      this->move(solver.solve(-this->Gradient));
    }
  }

  /// One step that turns samples over whose normal points backward. False: there is none.
  bool turn(double weight)
  {
    NormalMatrix a(3 * this->N);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * this->N);
    bool any = false;
    for (const std::int64_t p : this->Region)
    {
      any = this->addTurned(p, weight, a, right) || any;
    }
    if (!any)
    {
      return false;
    }
    for (int k = 0; k < this->Energy.outerSize(); ++k)
    {
      for (Eigen::SparseMatrix<double>::InnerIterator e(this->Energy, k); e; ++e)
      {
        for (int c = 0; c < 3; ++c)
        {
          a.add(3 * static_cast<int>(e.row()) + c, 3 * k + c, e.value());
        }
      }
    }
    for (int i = 0; i < this->N; ++i)
    {
      right.segment<3>(3 * i) -= this->Gradient.row(i).transpose();
    }
    Eigen::VectorXd x;
    if (!a.solve(right, x))
    {
      return false;
    }
    Eigen::MatrixXd step(this->N, 3);
    for (int i = 0; i < this->N; ++i)
    {
      step.row(i) = x.segment<3>(3 * i).transpose();
    }
    double longest = 0.0;
    for (const std::int64_t p : this->Region)
    {
      const SplinePatch& patch = this->Model.Patches[p];
      for (std::int64_t k = 0; k < static_cast<std::int64_t>(patch.CountU) * patch.CountV; ++k)
      {
        longest = std::max(longest, this->displacement(patch.FirstControlPoint + k, step).norm());
      }
    }
    this->move(step * std::min(1.0, LongestStep * this->SpanSize / std::max(longest, 1e-300)));
    return true;
  }

private:
  static BasisValues basis(const SplineModel& m, const SplinePatch& s, bool v, double t)
  {
    return v ? evaluateBasis(m.Knots.data() + s.FirstKnotV, s.DegreeV, s.CountV, t)
             : evaluateBasis(m.Knots.data() + s.FirstKnotU, s.DegreeU, s.CountU, t);
  }

  static const std::array<double, MaximumDegree + 1>& derivative(const BasisValues& b, int order)
  {
    return order == 0 ? b.Value : order == 1 ? b.Derivative : b.Derivative2;
  }

  /// A derivative of a patch, of orders du and dv, as a form in its control points.
  static PointForm product(
    const SplinePatch& s, const BasisValues& bu, const BasisValues& bv, int du, int dv)
  {
    PointForm f;
    f.Terms.reserve(
      (static_cast<std::size_t>(s.DegreeU) + 1) * (static_cast<std::size_t>(s.DegreeV) + 1));
    for (int j = 0; j <= s.DegreeV; ++j)
    {
      for (int i = 0; i <= s.DegreeU; ++i)
      {
        f.Terms.emplace_back(
          s.FirstControlPoint + static_cast<std::int64_t>(bv.First + j) * s.CountU + bu.First + i,
          derivative(bu, du)[i] * derivative(bv, dv)[j]);
      }
    }
    return f;
  }

  PointForm basisAt(const SplinePatch& s, double u, double v, int du, int dv) const
  {
    return product(s, basis(this->Model, s, false, u), basis(this->Model, s, true, v), du, dv);
  }

  /// The displacement of a form, in the variables.
  LinearForm moved(const PointForm& f)
  {
    std::map<int, double> sum;
    for (const auto& [point, factor] : f.Terms)
    {
      for (const LinearForm::Term& t : this->Space.Points[point].terms())
      {
        sum[t.first] += factor * t.second;
      }
    }
    LinearForm out;
    for (const auto& [variable, factor] : sum)
    {
      out.add(LinearForm(variable), factor);
    }
    return out;
  }

  Vec3 value(const PointForm& f) const
  {
    Vec3 sum = Vec3::Zero();
    for (const auto& [point, factor] : f.Terms)
    {
      sum += factor * this->Model.ControlPoints[point].head<3>();
    }
    return sum;
  }

  /// weight |f(x) - target|^2
  void addSquare(const LinearForm& f, const Vec3& target, double weight,
    std::vector<Eigen::Triplet<double>>& entries)
  {
    for (const LinearForm::Term& a : f.terms())
    {
      this->Gradient.row(a.first) -= weight * a.second * target.transpose();
      for (const LinearForm::Term& b : f.terms())
      {
        entries.emplace_back(a.first, b.first, weight * a.second * b.second);
      }
    }
  }

  /// Mean lengths of a patch along u and v.
  std::pair<double, double> lengths(std::int64_t p) const
  {
    const SplinePatch& s = this->Model.Patches[p];
    const auto d = patchDomain(this->Model, s);
    double lu = 0.0;
    double lv = 0.0;
    constexpr int n = 6;
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        const SurfacePoint q = evaluatePatch(this->Model, s, d[0] + (d[1] - d[0]) * (i + 0.5) / n,
          d[2] + (d[3] - d[2]) * (j + 0.5) / n);
        lu += q.Du.norm() * (d[1] - d[0]) / (n * n);
        lv += q.Dv.norm() * (d[3] - d[2]) / (n * n);
      }
    }
    return {std::max(lu, 1e-12), std::max(lv, 1e-12)};
  }

  void addBending(std::int64_t p, std::vector<Eigen::Triplet<double>>& entries)
  {
    const SplinePatch& s = this->Model.Patches[p];
    const auto d = patchDomain(this->Model, s);
    const auto [lengthU, lengthV] = this->lengths(p);
    const double lu = lengthU / (d[1] - d[0]);
    const double lv = lengthV / (d[3] - d[2]);
    const auto spansOf = [&](std::int64_t first, int degree, int count)
    {
      std::vector<double> k(
        this->Model.Knots.begin() + first + degree, this->Model.Knots.begin() + first + count + 1);
      k.erase(std::unique(k.begin(), k.end()), k.end());
      return k;
    };
    const std::vector<double> ku = spansOf(s.FirstKnotU, s.DegreeU, s.CountU);
    const std::vector<double> kv = spansOf(s.FirstKnotV, s.DegreeV, s.CountV);
    const double gauss[2] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
    for (std::size_t j = 0; j + 1 < kv.size(); ++j)
    {
      for (std::size_t i = 0; i + 1 < ku.size(); ++i)
      {
        const double hu = ku[i + 1] - ku[i];
        const double hv = kv[j + 1] - kv[j];
        const double weight = 0.25 * hu * hv * lu * lv;
        for (int g = 0; g < 4; ++g)
        {
          const double u = ku[i] + gauss[g % 2] * hu;
          const double v = kv[j] + gauss[g / 2] * hv;
          const BasisValues bu = basis(this->Model, s, false, u);
          const BasisValues bv = basis(this->Model, s, true, v);
          const PointForm parts[3] = {
            product(s, bu, bv, 2, 0), product(s, bu, bv, 1, 1), product(s, bu, bv, 0, 2)};
          const double scale[3] = {1.0 / (lu * lu), 1.0 / (lu * lv), 1.0 / (lv * lv)};
          for (int k = 0; k < 3; ++k)
          {
            this->addSquare(this->moved(parts[k]), -this->value(parts[k]),
              (k == 1 ? 2.0 : 1.0) * weight * scale[k] * scale[k], entries);
          }
        }
      }
    }
  }

  /// Samples of a patch with too small an area seen along the mean normal about them.
  bool addTurned(std::int64_t p, double weight, NormalMatrix& entries, Eigen::VectorXd& right)
  {
    const SplinePatch& s = this->Model.Patches[p];
    const auto d = patchDomain(this->Model, s);
    std::vector<BasisValues> bu;
    std::vector<BasisValues> bv;
    for (int i = 0; i < Samples; ++i)
    {
      const double x = i / (Samples - 1.0);
      bu.push_back(basis(this->Model, s, false, d[0] + (d[1] - d[0]) * x));
      bv.push_back(basis(this->Model, s, true, d[2] + (d[3] - d[2]) * x));
    }
    std::vector<SurfacePoint> at;
    double mean = 0.0;
    for (int k = 0; k < Samples * Samples; ++k)
    {
      at.push_back(evaluatePatch(this->Model, s, bu[k % Samples], bv[k / Samples]));
      mean += at.back().normal().norm() / (Samples * Samples);
    }
    bool any = false;
    const auto add = [&](int k, const Vec3& reference, double missing)
    {
      // d area = (Dv x n) . dDu + (n x Du) . dDv
      const LinearForm du = this->moved(product(s, bu[k % Samples], bv[k / Samples], 1, 0));
      const LinearForm dv = this->moved(product(s, bu[k % Samples], bv[k / Samples], 0, 1));
      this->addArea(du, dv, at[k].Dv.cross(reference) / mean, reference.cross(at[k].Du) / mean,
        missing, weight, entries, right);
    };
    for (int k = 0; k < Samples * Samples; ++k)
    {
      const Vec3 reference = meanNormal(at, k);
      const double area = reference.dot(at[k].normal()) / mean;
      any = any || area < Acceptable;
      if (area < Turned)
      {
        add(k, reference, 1.5 * Turned - area);
      }
      for (const int next : {k % Samples + 1 < Samples ? k + 1 : -1, k + Samples})
      {
        if (next < 0 || next >= Samples * Samples)
        {
          continue;
        }
        const Vec3 a = at[k].normal();
        const Vec3 b = at[next].normal();
        if (a.dot(b) > SharpTurn * a.norm() * b.norm())
        {
          continue;
        }
        any = true;
        const Vec3 middle = (a.normalized() + b.normalized()).normalized();
        add(k, middle, std::max(0.8 * a.norm() - a.dot(middle), 0.05 * mean) / mean);
        add(next, middle, std::max(0.8 * b.norm() - b.dot(middle), 0.05 * mean) / mean);
      }
    }
    return any;
  }

  void addArea(const LinearForm& du, const LinearForm& dv, const Vec3& a, const Vec3& b,
    double missing, double weight, NormalMatrix& entries, Eigen::VectorXd& right) const
  {
    std::map<int, Vec3> row;
    for (const LinearForm::Term& t : du.terms())
    {
      row.try_emplace(t.first, Vec3::Zero()).first->second += t.second * a;
    }
    for (const LinearForm::Term& t : dv.terms())
    {
      row.try_emplace(t.first, Vec3::Zero()).first->second += t.second * b;
    }
    for (const auto& [i, x] : row)
    {
      right.segment<3>(3 * i) += weight * missing * x;
      for (const auto& [j, y] : row)
      {
        for (int c = 0; c < 9; ++c)
        {
          entries.add(3 * i + c / 3, 3 * j + c % 3, weight * x[c / 3] * y[c % 3]);
        }
      }
    }
  }

  static Vec3 meanNormal(const std::vector<SurfacePoint>& at, int k)
  {
    Vec3 sum = Vec3::Zero();
    for (int j = std::max(k / Samples - Window, 0);
         j <= std::min(k / Samples + Window, Samples - 1); ++j)
    {
      for (int i = std::max(k % Samples - Window, 0);
           i <= std::min(k % Samples + Window, Samples - 1); ++i)
      {
        sum += at[static_cast<std::size_t>(j) * Samples + i].normal();
      }
    }
    return sum.norm() > 0.0 ? sum.normalized() : sum;
  }

  Vec3 displacement(std::int64_t point, const Eigen::MatrixXd& x) const
  {
    Vec3 sum = Vec3::Zero();
    for (const LinearForm::Term& t : this->Space.Points[point].terms())
    {
      sum += t.second * x.row(t.first).transpose();
    }
    return sum;
  }

  /// Moves the model by values of the variables.
  void move(const Eigen::MatrixXd& x)
  {
    for (const std::int64_t p : this->Region)
    {
      const SplinePatch& s = this->Model.Patches[p];
      for (std::int64_t k = 0; k < static_cast<std::int64_t>(s.CountU) * s.CountV; ++k)
      {
        this->Model.ControlPoints[s.FirstControlPoint + k].head<3>() +=
          this->displacement(s.FirstControlPoint + k, x);
      }
    }
    this->Gradient += this->Energy * x;
  }

  SplineModel Model;
  std::vector<std::int64_t> Region;
  const RelaxSpace Space;
  int N = 0;
  double SpanSize = 0.0; ///< typical size of a patch's span
  Eigen::SparseMatrix<double> Energy;
  Eigen::MatrixXd Gradient; ///< of the energy where the model is now
};

/// How a region is relaxed.
struct Pass
{
  int Rings;   ///< of patches about the folded one that move with it
  double Data; ///< factor on the weight of the contours' points
  bool Smooth; ///< to least energy first
};

/// Folded patches of a region; their values are brought up to date.
int foldedIn(
  const SplineModel& model, const std::vector<std::int64_t>& region, std::vector<double>& jacobians)
{
  int folded = 0;
  for (const std::int64_t p : region)
  {
    jacobians[p] = patchJacobian(model, p);
    folded += jacobians[p] < 0.0 ? 1 : 0;
  }
  return folded;
}

/// Moves a region until no patch of it is folded; the model is changed where fewer are, and its
/// data are not left behind.
void unfold(SplineModel& model, std::vector<double>& jacobians,
  const std::vector<std::int64_t>& region, const std::vector<ModelHit>& hits,
  const std::vector<Vec3>& points, const Pass& pass, Monitor& monitor)
{
  Relaxer relaxer(model, region);
  if (relaxer.empty())
  {
    return;
  }
  int least = foldedIn(model, region, jacobians);
  relaxer.assemble(hits, points, DataWeight * pass.Data);
  const double allowed = relaxer.misfit(hits, points) + Misfit * relaxer.spanSize();
  if (pass.Smooth)
  {
    relaxer.solve();
  }
  double weight = 0.05;
  int stuck = 0;
  int fewest = std::numeric_limits<int>::max();
  std::vector<double> now = jacobians;
  for (int round = 0; round <= Rounds; ++round)
  {
    const int left = foldedIn(relaxer.result(), region, now);
    if (left < least && relaxer.misfit(hits, points) <= allowed)
    {
      least = left;
      model = relaxer.result();
      jacobians = now;
    }
    stuck = left < fewest ? 0 : stuck + 1;
    fewest = std::min(fewest, left);
    if (left == 0 || stuck > Patience || monitor.cancelled() || !relaxer.turn(weight))
    {
      break;
    }
    weight *= 2.0;
  }
}
} // namespace

Result<int> relaxFolds(
  SplineModel& model, std::vector<double>& jacobians, const ContourStack& stack, Monitor& monitor)
{
  std::vector<std::int64_t> folded;
  for (std::size_t p = 0; p < jacobians.size(); ++p)
  {
    if (jacobians[p] < 0.0)
    {
      folded.push_back(static_cast<std::int64_t>(p));
    }
  }
  if (folded.empty())
  {
    return 0;
  }
  std::vector<Vec3> points;
  for (const Contour& c : stack.Contours)
  {
    points.insert(points.end(), c.Points.begin(), c.Points.end());
  }
  std::vector<ModelHit> hits(points.size());
  {
    const ClosestPoint closest(model);
    const bool found =
      parallelForUntilCancelled(0, static_cast<std::int64_t>(points.size()), 256, monitor,
        [&](std::int64_t begin, std::int64_t end)
        {
          for (std::int64_t i = begin; i < end; ++i)
          {
            hits[i] = closest.find(points[i]);
          }
        });
    if (!found)
    {
      return Status::cancelled();
    }
  }
  const Pass passes[] = {{1, 1.0, true}, {1, 0.1, true}, {1, 1.0, false}, {2, 1.0, true},
    {2, 0.1, true}, {2, 0.1, false}, {3, 0.1, true}, {5, 0.1, true}, {8, 0.1, true}};
  double done = 0.0;
  for (const Pass& pass : passes)
  {
    if (pass.Rings > 3 && model.Patches.size() < LargeModel)
    {
      break;
    }
    for (const std::int64_t p : folded)
    {
      if (monitor.cancelled())
      {
        return Status::cancelled();
      }
      if (jacobians[p] < 0.0) // not yet cured with another one
      {
        unfold(model, jacobians, growRegion(model, {p}, pass.Rings), hits, points, pass, monitor);
      }
    }
    monitor.progress(done += 1.0 / static_cast<double>(std::size(passes)));
  }
  return static_cast<int>(
    std::count_if(jacobians.begin(), jacobians.end(), [](double j) { return j < 0.0; }));
}
} // namespace bsr
