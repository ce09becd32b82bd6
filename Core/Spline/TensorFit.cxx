#include "Spline/TensorFit.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cmath>

namespace bsr
{
namespace
{
/// Least squares of curves: one data row a parameter, ends interpolated.
Eigen::MatrixXd fitCurves(const std::vector<double>& knots, int degree,
  const std::vector<double>& parameters, const Eigen::MatrixXd& data)
{
  const int count = static_cast<int>(knots.size()) - degree - 1;
  const Eigen::Index m = data.rows();
  Eigen::MatrixXd n = Eigen::MatrixXd::Zero(m, count);
  for (Eigen::Index k = 0; k < m; ++k)
  {
    const BasisValues b = evaluateBasis(knots.data(), degree, count, parameters[k]);
    for (int i = 0; i <= degree; ++i)
    {
      n(k, b.First + i) = b.Value[i];
    }
  }
  Eigen::MatrixXd control(count, data.cols());
  control.row(0) = data.row(0);
  control.row(count - 1) = data.row(m - 1);
  if (count > 2)
  {
    const Eigen::MatrixXd inner = n.block(1, 1, m - 2, count - 2);
    const Eigen::MatrixXd rest = data.middleRows(1, m - 2) - n.block(1, 0, m - 2, 1) * data.row(0) -
                                 n.block(1, count - 1, m - 2, 1) * data.row(m - 1);
    const Eigen::MatrixXd normal = inner.transpose() * inner;
    control.middleRows(1, count - 2) = normal.ldlt().solve(inner.transpose() * rest);
  }
  return control;
}

/// Banded Gram matrices of derivatives 0, 1, 2: row i, entry p + j - i.
std::array<Eigen::MatrixXd, 3> gramBands(const std::vector<double>& knots, int degree)
{
  const int count = static_cast<int>(knots.size()) - degree - 1;
  std::array<Eigen::MatrixXd, 3> g;
  g.fill(Eigen::MatrixXd::Zero(count, 2 * degree + 1));
  // five Gauss points: exact to degree 9
  static const double x[5] = {
    -0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
  static const double w[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
    0.4786286704993665, 0.2369268850561891};
  for (int s = degree; s < count; ++s)
  {
    const double half = 0.5 * (knots[s + 1] - knots[s]);
    for (int q = 0; half > 0.0 && q < 5; ++q)
    {
      const BasisValues b =
        evaluateBasis(knots.data(), degree, count, knots[s] + half * (1.0 + x[q]));
      for (int i = 0; i <= degree; ++i)
      {
        for (int j = 0; j <= degree; ++j)
        {
          const int at = degree + j - i;
          g[0](b.First + i, at) += half * w[q] * b.Value[i] * b.Value[j];
          g[1](b.First + i, at) += half * w[q] * b.Derivative[i] * b.Derivative[j];
          g[2](b.First + i, at) += half * w[q] * b.Derivative2[i] * b.Derivative2[j];
        }
      }
    }
  }
  return g;
}
} // namespace

struct TensorSolver::Factor
{
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> Ldlt;
  bool Analyzed = false;
};

std::vector<double> dataKnots(const std::vector<double>& parameters, int degree, int count)
{
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  const double t = static_cast<double>(parameters.size()) / static_cast<double>(count - degree);
  for (int j = 1; j < count - degree; ++j)
  {
    const int i = static_cast<int>(j * t);
    const double a = j * t - i;
    knots.push_back((1.0 - a) * parameters[i - 1] + a * parameters[i]);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, 1.0);
  return knots;
}

std::vector<Vec3> fitGrid(const TensorShape& shape, const std::vector<double>& u,
  const std::vector<double>& v, const std::vector<Vec3>& points)
{
  const auto columns = static_cast<Eigen::Index>(u.size());
  const auto rows = static_cast<Eigen::Index>(v.size());
  Eigen::MatrixXd data(columns, 3 * rows);
  for (Eigen::Index r = 0; r < rows; ++r)
  {
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      data.block(c, 3 * r, 1, 3) = points[r * columns + c].transpose();
    }
  }
  const Eigen::MatrixXd across = fitCurves(shape.KnotsU, shape.DegreeU, u, data);
  const Eigen::Index nu = across.rows();
  Eigen::MatrixXd turned(rows, 3 * nu);
  for (Eigen::Index r = 0; r < rows; ++r)
  {
    for (Eigen::Index i = 0; i < nu; ++i)
    {
      turned.block(r, 3 * i, 1, 3) = across.block(i, 3 * r, 1, 3);
    }
  }
  const Eigen::MatrixXd control = fitCurves(shape.KnotsV, shape.DegreeV, v, turned);
  std::vector<Vec3> out;
  for (Eigen::Index j = 0; j < control.rows(); ++j)
  {
    for (Eigen::Index i = 0; i < nu; ++i)
    {
      out.emplace_back(control.block(j, 3 * i, 1, 3).transpose());
    }
  }
  return out;
}

TensorSolver::TensorSolver(TensorShape shape, double lengthU, double lengthV)
    : Shape(std::move(shape)),
      LengthU(lengthU),
      LengthV(lengthV),
      Solver(std::make_unique<Factor>())
{
}

TensorSolver::~TensorSolver() = default;

void TensorSolver::addPlate(double fairing)
{
  const int p = this->Shape.DegreeU;
  const int q = this->Shape.DegreeV;
  const auto gu = gramBands(this->Shape.KnotsU, p);
  const auto gv = gramBands(this->Shape.KnotsV, q);
  const double lu = this->LengthU;
  const double lv = this->LengthV;
  const double spans = static_cast<double>(this->Shape.countU() - p) * (this->Shape.countV() - q);
  const double h2 = lu * lv / spans;
  const double scale = fairing * h2 * h2 / (lu * lv);
  const double a = scale * lv / (lu * lu * lu);
  const double b = scale * 2.0 / (lu * lv);
  const double c = scale * lu / (lv * lv * lv);
  const int nu = this->Shape.countU();
  const int nv = this->Shape.countV();
  const int window = (2 * p + 1) * (2 * q + 1);
  for (int j = 0; j < nv; ++j)
  {
    for (int i = 0; i < nu; ++i)
    {
      double* row = this->Band.data() + static_cast<std::size_t>(j * nu + i) * window;
      for (int l = 0; l <= 2 * q; ++l)
      {
        for (int k = 0; k <= 2 * p; ++k)
        {
          row[l * (2 * p + 1) + k] += a * gu[2](i, k) * gv[0](j, l) +
                                      b * gu[1](i, k) * gv[1](j, l) + c * gu[0](i, k) * gv[2](j, l);
        }
      }
    }
  }
}

std::vector<Vec3> TensorSolver::solve(const std::vector<TensorSample>& samples, double fairing)
{
  const int p = this->Shape.DegreeU;
  const int q = this->Shape.DegreeV;
  const int nu = this->Shape.countU();
  const int nv = this->Shape.countV();
  const int window = (2 * p + 1) * (2 * q + 1);
  this->Band.assign(static_cast<std::size_t>(nu) * nv * window, 0.0);
  this->addPlate(fairing);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(nu) * nv, 3);
  double total = 0.0;
  for (const TensorSample& s : samples)
  {
    total += s.Weight;
  }
  for (const TensorSample& s : samples)
  {
    const BasisValues bu = evaluateBasis(this->Shape.KnotsU.data(), p, nu, s.UV.x());
    const BasisValues bv = evaluateBasis(this->Shape.KnotsV.data(), q, nv, s.UV.y());
    const double weight = s.Weight / total;
    for (int j = 0; j <= q; ++j)
    {
      for (int i = 0; i <= p; ++i)
      {
        const int row = (bv.First + j) * nu + bu.First + i;
        const double w = weight * bu.Value[i] * bv.Value[j];
        right.row(row) += w * s.Point.transpose();
        double* band = this->Band.data() + static_cast<std::size_t>(row) * window;
        for (int l = 0; l <= q; ++l)
        {
          for (int k = 0; k <= p; ++k)
          {
            band[(q + l - j) * (2 * p + 1) + p + k - i] += w * bu.Value[k] * bv.Value[l];
          }
        }
      }
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < nu * nv; ++row)
  {
    const double* band = this->Band.data() + static_cast<std::size_t>(row) * window;
    for (int l = 0; l <= 2 * q; ++l)
    {
      for (int k = 0; k <= 2 * p; ++k)
      {
        const int i = row % nu + k - p;
        const int j = row / nu + l - q;
        if (i >= 0 && j >= 0 && i < nu && j < nv && j * nu + i <= row)
        {
          entries.emplace_back(row, j * nu + i, band[l * (2 * p + 1) + k]);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> a(nu * nv, nu * nv);
  a.setFromTriplets(entries.begin(), entries.end());
  if (!this->Solver->Analyzed)
  {
    this->Solver->Ldlt.analyzePattern(a);
    this->Solver->Analyzed = true;
  }
  this->Solver->Ldlt.factorize(a);
  if (this->Solver->Ldlt.info() != Eigen::Success)
  {
    return {};
  }
  const Eigen::MatrixXd x = this->Solver->Ldlt.solve(right);
  std::vector<Vec3> control;
  for (Eigen::Index k = 0; k < x.rows(); ++k)
  {
    control.emplace_back(x.row(k).transpose());
  }
  return x.allFinite() ? control : std::vector<Vec3>();
}

SplineModel modelOf(const TensorShape& shape, const std::vector<Vec3>& control)
{
  SplineModel model;
  SplinePatch patch;
  patch.DegreeU = shape.DegreeU;
  patch.DegreeV = shape.DegreeV;
  patch.CountU = shape.countU();
  patch.CountV = shape.countV();
  patch.FirstKnotV = static_cast<std::int64_t>(shape.KnotsU.size());
  model.Patches.push_back(patch);
  model.Knots = shape.KnotsU;
  model.Knots.insert(model.Knots.end(), shape.KnotsV.begin(), shape.KnotsV.end());
  for (const Vec3& c : control)
  {
    model.ControlPoints.emplace_back(c.x(), c.y(), c.z(), 1.0);
  }
  model.Neighbors.push_back({-1, -1, -1, -1});
  return model;
}
} // namespace bsr
