#include "Spline/WeightProblem.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace bsr
{
namespace
{
} // namespace

WeightProblem::WeightProblem(const RationalPatch& start, const FitPoint* first,
  const FitPoint* last, FreeControlPoints free, const PatchObjective& objective)
    : Start(start), Objective(objective), Position(start.ControlPoints.size(), -1)
{
  const int n = start.countU();
  const int m = start.countV();
  const int rim = free == FreeControlPoints::Interior ? 2 : 0;
  for (int l = 0; l < n * m; ++l)
  {
    const int i = l % n;
    const int j = l / n;
    if (std::min(i, j) >= rim && i < n - rim && j < m - rim)
    {
      this->Position[l] = static_cast<int>(this->Free.size());
      this->Free.push_back(l);
    }
  }
  for (const FitPoint* p = first; p != last; ++p)
  {
    if (p->weight() > 0.0)
    {
      this->Samples.push_back({evaluateBasis(start.KnotsU.data(), 3, n, p->U),
        evaluateBasis(start.KnotsV.data(), 3, m, p->V), p->Position, p->weight()});
    }
  }
}

/// Values phi = N w / W of the sixteen rational basis functions at a sample, and their numbers.
void WeightProblem::rational(
  const Sample& s, const RationalPatch& p, double (&phi)[16], int (&index)[16]) const
{
  double sum = 0.0;
  for (int k = 0; k < 16; ++k)
  {
    index[k] = (s.V.First + k / 4) * p.countU() + s.U.First + k % 4;
    phi[k] = s.U.Value[k % 4] * s.V.Value[k / 4] * p.ControlPoints[index[k]][3];
    sum += phi[k];
  }
  for (double& f : phi)
  {
    f /= sum;
  }
}

bool WeightProblem::assemble(
  const RationalPatch& p, Eigen::MatrixXd& a, Eigen::MatrixXd& right) const
{
  const auto k = static_cast<Eigen::Index>(this->Free.size());
  a = Eigen::MatrixXd::Zero(k, k);
  right = Eigen::MatrixXd::Zero(k, 3);
  double phi[16];
  int index[16];
  for (const Sample& s : this->Samples)
  {
    this->rational(s, p, phi, index);
    Vec3 rest = s.Position;
    for (int i = 0; i < 16; ++i)
    {
      if (this->Position[index[i]] < 0)
      {
        rest -= phi[i] * p.ControlPoints[index[i]].head<3>();
      }
    }
    const double w = this->Objective.Data * s.Weight;
    for (int i = 0; i < 16; ++i)
    {
      const int row = this->Position[index[i]];
      for (int j = 0; row >= 0 && j <= i; ++j)
      {
        if (this->Position[index[j]] >= 0)
        {
          a(row, this->Position[index[j]]) += w * phi[i] * phi[j];
        }
      }
      if (row >= 0)
      {
        right.row(row) += (w * phi[i] * rest).transpose();
      }
    }
  }
  if (this->Objective.Fairing.rows() > 0)
  {
    for (Eigen::Index i = 0; i < k; ++i)
    {
      for (int l = 0; l < static_cast<int>(this->Position.size()); ++l)
      {
        const double f = this->Objective.Fairing(this->Free[i], l);
        if (this->Position[l] >= 0)
        {
          a(i, this->Position[l]) += this->Position[l] <= i ? f : 0.0;
        }
        else
        {
          right.row(i) -= f * p.ControlPoints[l].head<3>().transpose();
        }
      }
      if (this->Objective.FairingRight.rows() > 0)
      {
        right.row(i) += this->Objective.FairingRight.row(this->Free[i]);
      }
    }
  }
  return a.allFinite() && right.allFinite();
}

bool WeightProblem::solve(const Eigen::VectorXd& weights, State& state) const
{
  state.Patch = this->Start;
  auto& points = state.Patch.ControlPoints;
  for (int i = 0; i < this->variables(); ++i)
  {
    points[this->Free[i]][3] = weights[i];
  }
  Eigen::MatrixXd a;
  Eigen::MatrixXd right;
  if (!this->assemble(state.Patch, a, right))
  {
    return false;
  }
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(a);
  const double largest = ldlt.vectorD().cwiseAbs().maxCoeff();
  if (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 1e-13 * largest))
  {
    return false;
  }
  const Eigen::MatrixXd b = ldlt.solve(right);
  for (int i = 0; i < this->variables(); ++i)
  {
    points[this->Free[i]].head<3>() = b.row(i).transpose();
  }
  double phi[16];
  int index[16];
  double total = 0.0;
  state.Mean = 0.0;
  state.Rms = 0.0;
  for (const Sample& s : this->Samples)
  {
    this->rational(s, state.Patch, phi, index);
    Vec3 e = s.Position;
    for (int i = 0; i < 16; ++i)
    {
      e -= phi[i] * points[index[i]].head<3>();
    }
    total += s.Weight;
    state.Mean += s.Weight * e.norm();
    state.Rms += s.Weight * e.squaredNorm();
  }
  state.Objective = this->Objective.Data * state.Rms;
  if (this->Objective.Fairing.rows() > 0)
  {
    Eigen::MatrixXd all(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t l = 0; l < points.size(); ++l)
    {
      all.row(static_cast<Eigen::Index>(l)) = points[l].head<3>().transpose();
    }
    state.Objective += (all.transpose() * this->Objective.Fairing * all).trace();
    if (this->Objective.FairingRight.rows() > 0)
    {
      state.Objective -= 2.0 * (all.transpose() * this->Objective.FairingRight).trace();
    }
  }
  state.Mean /= std::max(total, 1e-300);
  state.Rms = std::sqrt(state.Rms / std::max(total, 1e-300));
  return std::isfinite(state.Objective);
}

/// Gauss-Newton matrix and gradient (halved) of the projected objective in the logarithms of the
/// weights. Column j of the Jacobian is -P phi_j (b_j - S), P the projector off the free points.
bool WeightProblem::linearize(
  const State& state, Eigen::MatrixXd& normal, Eigen::VectorXd& gradient) const
{
  const int k = this->variables();
  Eigen::MatrixXd a;
  Eigen::MatrixXd right;
  if (!this->assemble(state.Patch, a, right))
  {
    return false;
  }
  normal = Eigen::MatrixXd::Zero(k, k);
  gradient = Eigen::VectorXd::Zero(k);
  std::array<Eigen::MatrixXd, 3> mixed; // Phi^T V of each coordinate
  mixed.fill(Eigen::MatrixXd::Zero(k, k));
  double phi[16];
  int index[16];
  const auto& points = state.Patch.ControlPoints;
  for (const Sample& s : this->Samples)
  {
    this->rational(s, state.Patch, phi, index);
    Vec3 at = Vec3::Zero();
    for (int i = 0; i < 16; ++i)
    {
      at += phi[i] * points[index[i]].head<3>();
    }
    const Vec3 e = s.Position - at;
    const double w = this->Objective.Data * s.Weight;
    Vec3 v[16];
    for (int i = 0; i < 16; ++i)
    {
      v[i] = phi[i] * (points[index[i]].head<3>() - at);
    }
    for (int i = 0; i < 16; ++i)
    {
      const int row = this->Position[index[i]];
      if (row < 0)
      {
        continue;
      }
      gradient[row] -= w * v[i].dot(e);
      for (int j = 0; j < 16; ++j)
      {
        const int column = this->Position[index[j]];
        if (column < 0)
        {
          continue;
        }
        normal(row, column) += w * v[i].dot(v[j]);
        for (int c = 0; c < 3; ++c)
        {
          mixed[c](row, column) += w * phi[i] * v[j][c];
        }
      }
    }
  }
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(a);
  for (const Eigen::MatrixXd& m : mixed)
  {
    normal -= m.transpose() * ldlt.solve(m);
  }
  return normal.allFinite() && gradient.allFinite();
}

Eigen::VectorXd WeightProblem::weightsOf(const RationalPatch& patch) const
{
  Eigen::VectorXd w(this->variables());
  for (int i = 0; i < this->variables(); ++i)
  {
    w[i] = patch.ControlPoints[this->Free[i]][3];
  }
  return w;
}

int WeightProblem::optimize(State& state, int iterations) const
{
  double damping = 1e-3;
  for (int it = 0; it < iterations; ++it)
  {
    Eigen::MatrixXd normal;
    Eigen::VectorXd gradient;
    if (!this->linearize(state, normal, gradient))
    {
      return it;
    }
    const double floor = 1e-12 * std::max(normal.diagonal().maxCoeff(), 1e-300);
    const Eigen::VectorXd logs = this->weightsOf(state.Patch).array().log();
    bool better = false;
    for (int attempt = 0; attempt < 6 && !better; ++attempt)
    {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() += (damping * normal.diagonal().array().max(0.0) + floor).matrix();
      const Eigen::VectorXd step = damped.ldlt().solve(-gradient).cwiseMax(-1.0).cwiseMin(1.0);
      const Eigen::VectorXd weights = (logs + step)
                                        .array()
                                        .max(std::log(LeastPatchWeight))
                                        .min(std::log(LargestPatchWeight))
                                        .exp();
      State next;
      better = step.allFinite() && this->solve(weights, next) && next.Objective < state.Objective;
      if (better)
      {
        const bool finished = next.Objective > (1.0 - 1e-7) * state.Objective;
        state = std::move(next);
        damping = std::max(0.2 * damping, 1e-12);
        if (finished)
        {
          return it + 1;
        }
      }
      else
      {
        damping *= 8.0;
      }
    }
    if (!better)
    {
      return it;
    }
  }
  return iterations;
}
} // namespace bsr
