#include "Contour/UniformSpline.h"

#include "Spline/Basis.h"

#include <algorithm>

namespace bsr
{
namespace
{
/// The polar form of the polynomial on the knot span [span, span + 1] at order - 1 arguments.
Vec3 polarForm(const KnotCurve& curve, int order, int span, const double* arguments)
{
  const int p = order - 1;
  std::array<Vec3, MaximumDegree + 1> c;
  for (int r = 0; r <= p; ++r)
  {
    c[r] = curve.Points[span - p + r];
  }
  for (int level = 1; level <= p; ++level)
  {
    for (int r = p; r >= level; --r)
    {
      const double low = curve.Knots[span - p + r];
      const double high = curve.Knots[span + 1 + r - level];
      const double a = (arguments[level - 1] - low) / (high - low);
      c[r] = (1.0 - a) * c[r - 1] + a * c[r];
    }
  }
  return c[p];
}

/// Last span of positive length that begins at or before t, within the domain.
int spanAt(const std::vector<double>& knots, int order, double t)
{
  const auto first = knots.begin() + (order - 1);
  const auto last = knots.end() - order;
  const auto next = std::upper_bound(first, last, t);
  auto span = static_cast<int>(next - knots.begin()) - 1;
  while (span > order - 1 && knots[span + 1] <= knots[span])
  {
    --span;
  }
  return span;
}
} // namespace

std::vector<double> siteValues(int order)
{
  // The B-spline on [0, order] at its middle and whole distances from it.
  std::vector<double> wide;
  for (int i = -order; i <= 2 * order; ++i)
  {
    wide.push_back(i);
  }
  const int count = static_cast<int>(wide.size()) - order;
  std::vector<double> values;
  const int reach = (order - 1) / 2;
  for (int d = -reach; d <= reach; ++d)
  {
    const BasisValues b = evaluateBasis(wide.data(), order - 1, count, 0.5 * order - d);
    const int own = order - b.First; // the B-spline that begins at knot 0 has index `order`
    values.push_back(own >= 0 && own < order ? b.Value[own] : 0.0);
  }
  return values;
}

PeriodicInterpolation::PeriodicInterpolation(int order, int count)
{
  const std::vector<double> values = siteValues(order);
  const auto reach = static_cast<int>(values.size() / 2);
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(count, count);
  for (int i = 0; i < count; ++i)
  {
    for (int d = -reach; d <= reach; ++d)
    {
      m(i, ((i + d) % count + count) % count) += values[d + reach];
    }
  }
  this->Matrix.compute(m);
}

ControlRow PeriodicInterpolation::solve(const ControlRow& points) const
{
  Eigen::MatrixXd right(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    right.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  const Eigen::MatrixXd solved = this->Matrix.solve(right);
  ControlRow row;
  for (Eigen::Index i = 0; i < solved.rows(); ++i)
  {
    row.emplace_back(solved.row(i).transpose());
  }
  return row;
}

ControlRow periodicPiece(const ControlRow& row, int order, int first, int spans)
{
  // The control points that act on the piece, on integer knots.
  const auto n = static_cast<int>(row.size());
  KnotCurve wide;
  for (int b = 1 - order; b < spans; ++b)
  {
    const int i = first + b + order / 2;
    wide.Points.push_back(row[(i % n + n) % n]);
  }
  for (int k = 1 - order; k < spans + order; ++k)
  {
    wide.Knots.push_back(k);
  }
  return curvePiece(wide, order, 0.0, spans).Points;
}

std::vector<double> clampedKnots(int order, int spans)
{
  std::vector<double> knots(static_cast<std::size_t>(order), 0.0);
  for (int i = 1; i < spans; ++i)
  {
    knots.push_back(i);
  }
  knots.insert(knots.end(), static_cast<std::size_t>(order), spans);
  return knots;
}

std::vector<double> grevilleSites(const std::vector<double>& knots, int order)
{
  std::vector<double> sites;
  for (std::size_t i = 0; i + order < knots.size(); ++i)
  {
    double sum = 0.0;
    for (int k = 1; k < order; ++k)
    {
      sum += knots[i + k];
    }
    sites.push_back(sum / (order - 1));
  }
  return sites;
}

KnotCurve curvePiece(const KnotCurve& curve, int order, double a, double b)
{
  KnotCurve piece;
  piece.Knots.assign(static_cast<std::size_t>(order), a);
  for (const double k : curve.Knots)
  {
    if (k > a && k < b)
    {
      piece.Knots.push_back(k);
    }
  }
  piece.Knots.insert(piece.Knots.end(), static_cast<std::size_t>(order), b);
  const auto count = static_cast<int>(piece.Knots.size()) - order;
  for (int j = 0; j < count; ++j)
  {
    // A span of the piece that this control point acts on.
    int own = std::max(j, order - 1);
    while (own + 1 < count && piece.Knots[own + 1] <= piece.Knots[own])
    {
      ++own;
    }
    const double middle = 0.5 * (piece.Knots[own] + piece.Knots[own + 1]);
    const int span = spanAt(curve.Knots, order, middle);
    piece.Points.push_back(polarForm(curve, order, span, piece.Knots.data() + j + 1));
  }
  return piece;
}
} // namespace bsr
