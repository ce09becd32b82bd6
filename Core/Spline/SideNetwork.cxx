#include "Spline/SideNetwork.h"

#include "Common/Parallel.h"
#include "Mesh/TriangleTree.h"
#include "Spline/Basis.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace bsr
{
namespace
{
constexpr int Segments = 4; ///< of a side's curve: enough for a bend, too few for jitter

using Controls = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Share of the length at each point of a polyline.
std::vector<double> chordLengths(const std::vector<Vec3>& line)
{
  std::vector<double> at(1, 0.0);
  for (std::size_t i = 1; i < line.size(); ++i)
  {
    at.push_back(at.back() + (line[i] - line[i - 1]).norm());
  }
  for (double& t : at)
  {
    t /= std::max(at.back(), 1e-300);
  }
  return at;
}

/// The point of a polyline at a share of its length.
Vec3 pointAt(const std::vector<Vec3>& line, const std::vector<double>& at, double t)
{
  const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, t);
  const auto i = static_cast<std::size_t>(next - at.begin());
  const double span = at[i] - at[i - 1];
  const double s = span > 0.0 ? std::clamp((t - at[i - 1]) / span, 0.0, 1.0) : 0.0;
  return (1.0 - s) * line[i - 1] + s * line[i];
}

/// Least squares with fixed ends, over evenly spaced points of the polyline.
Controls fitCurve(const std::vector<Vec3>& line, const std::vector<double>& knots)
{
  const int count = Segments + 3;
  const auto at = chordLengths(line);
  Controls c = Controls::Zero(count, 3);
  c.row(0) = line.front();
  c.row(count - 1) = line.back();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count - 2, count - 2);
  Controls right = Controls::Zero(count - 2, 3);
  constexpr int Points = 64;
  for (int k = 1; k < Points; ++k)
  {
    const double t = static_cast<double>(k) / Points;
    const BasisValues b = evaluateBasis(knots.data(), 3, count, t);
    Vec3 rest = pointAt(line, at, t);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(count);
    for (int i = 0; i < 4; ++i)
    {
      row[b.First + i] = b.Value[i];
    }
    rest -= row[0] * line.front() + row[count - 1] * line.back();
    const Eigen::VectorXd inner = row.segment(1, count - 2);
    normal += inner * inner.transpose();
    right += inner * rest.transpose();
  }
  c.middleRows(1, count - 2) = normal.ldlt().solve(right);
  return c;
}

std::vector<Vec3> regularized(const std::vector<Vec3>& line, int samples,
  const std::vector<double>& knots, const TriangleTree& tree)
{
  const Controls c = fitCurve(line, knots);
  constexpr int Fine = 256;
  std::vector<Vec3> fine;
  for (int k = 0; k <= Fine; ++k)
  {
    const BasisValues b =
      evaluateBasis(knots.data(), 3, Segments + 3, static_cast<double>(k) / Fine);
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 4; ++i)
    {
      p += b.Value[i] * c.row(b.First + i).transpose();
    }
    fine.push_back(p);
  }
  const auto at = chordLengths(fine);
  std::vector<Vec3> out{line.front()};
  for (int k = 1; k + 1 < samples; ++k)
  {
    out.push_back(tree.nearest(pointAt(fine, at, static_cast<double>(k) / (samples - 1))).Point);
  }
  out.push_back(line.back());
  return out;
}
} // namespace

std::vector<std::vector<Vec3>> regularizeSides(
  const std::vector<std::vector<Vec3>>& sides, int samples, const TriangleMesh& mesh)
{
  const TriangleTree tree(mesh.Points, mesh.Triangles);
  const auto knots = segmentKnots(3, Segments, 1);
  std::vector<std::vector<Vec3>> out(sides.size());
  parallelFor(0, static_cast<std::int64_t>(sides.size()), 4,
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t i = first; i < last; ++i)
      {
        if (sides[i].size() > 1)
        {
          out[i] = regularized(sides[i], std::max(2, samples), knots, tree);
        }
      }
    });
  return out;
}
} // namespace bsr
