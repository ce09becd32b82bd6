#include "Spline/SplitPatch.h"

#include "Spline/Evaluate.h"
#include "Spline/FoldCheck.h"

#include <algorithm>

namespace bsr
{
namespace
{
/// One direction of a net: knots, and control points as rows of a matrix.
struct Direction
{
  int Degree;
  std::vector<double> Knots;
  Eigen::MatrixXd Control;

  /// Inserts a knot once (Boehm).
  void insert(double t)
  {
    const auto span = static_cast<int>(
      std::upper_bound(this->Knots.begin(), this->Knots.end(), t) - this->Knots.begin() - 1);
    const Eigen::Index n = this->Control.rows();
    Eigen::MatrixXd finer(n + 1, this->Control.cols());
    for (Eigen::Index i = 0; i <= n; ++i)
    {
      if (i <= span - this->Degree)
      {
        finer.row(i) = this->Control.row(i);
      }
      else if (i > span)
      {
        finer.row(i) = this->Control.row(i - 1);
      }
      else
      {
        const double low = this->Knots[i];
        const double high = this->Knots[i + this->Degree];
        const double a = high > low ? (t - low) / (high - low) : 0.0;
        finer.row(i) = (1.0 - a) * this->Control.row(i - 1) + a * this->Control.row(i);
      }
    }
    this->Control.swap(finer);
    this->Knots.insert(this->Knots.begin() + span + 1, t);
  }

  /// Raises inner knots to the multiplicity of the degree where blocks of `spans` pieces end;
  /// returns these ends with 0 and 1.
  std::vector<double> cut(int spans)
  {
    std::vector<double> inner;
    for (const double k : this->Knots)
    {
      if (k > this->Knots.front() && k < this->Knots.back() && (inner.empty() || inner.back() < k))
      {
        inner.push_back(k);
      }
    }
    std::vector<double> ends{this->Knots.front()};
    const auto pieces = static_cast<int>(inner.size()) + 1;
    const int blocks = spans > 0 ? (pieces + spans - 1) / spans : 1;
    for (int b = 1; b < blocks; ++b)
    {
      const double t = inner[static_cast<std::size_t>(b) * pieces / blocks - 1];
      ends.push_back(t);
      while (std::count(this->Knots.begin(), this->Knots.end(), t) < this->Degree)
      {
        this->insert(t);
      }
    }
    ends.push_back(this->Knots.back());
    return ends;
  }
};

/// Knots of the block between two ends, full multiplicity, and its first control point.
std::vector<double> blockKnots(const Direction& d, double from, double to, int& first)
{
  std::vector<double> knots(static_cast<std::size_t>(d.Degree) + 1, from);
  for (const double k : d.Knots)
  {
    if (k > from && k < to)
    {
      knots.push_back(k);
    }
  }
  knots.insert(knots.end(), static_cast<std::size_t>(d.Degree) + 1, to);
  const auto after = std::upper_bound(d.Knots.begin(), d.Knots.end(), from);
  first = static_cast<int>(after - d.Knots.begin()) - 1 - d.Degree;
  return knots;
}
} // namespace

SplineModel splitPatch(const TensorShape& shape, const std::vector<Vec3>& control, int spans)
{
  const int nu = shape.countU();
  const int nv = shape.countV();
  Direction u{shape.DegreeU, shape.KnotsU, Eigen::MatrixXd(nu, 3 * nv)};
  for (int j = 0; j < nv; ++j)
  {
    for (int i = 0; i < nu; ++i)
    {
      u.Control.block(i, 3 * j, 1, 3) = control[j * nu + i].transpose();
    }
  }
  const std::vector<double> endsU = u.cut(spans);
  const Eigen::Index wide = u.Control.rows();
  Direction v{shape.DegreeV, shape.KnotsV, Eigen::MatrixXd(nv, 3 * wide)};
  for (int j = 0; j < nv; ++j)
  {
    for (Eigen::Index i = 0; i < wide; ++i)
    {
      v.Control.block(j, 3 * i, 1, 3) = u.Control.block(i, 3 * j, 1, 3);
    }
  }
  const std::vector<double> endsV = v.cut(spans);
  SplineModel model;
  const auto blocksU = static_cast<std::int64_t>(endsU.size()) - 1;
  const auto blocksV = static_cast<std::int64_t>(endsV.size()) - 1;
  for (std::int64_t b = 0; b < blocksV; ++b)
  {
    for (std::int64_t a = 0; a < blocksU; ++a)
    {
      int firstU = 0;
      int firstV = 0;
      TensorShape block;
      block.DegreeU = shape.DegreeU;
      block.DegreeV = shape.DegreeV;
      block.KnotsU = blockKnots(u, endsU[a], endsU[a + 1], firstU);
      block.KnotsV = blockKnots(v, endsV[b], endsV[b + 1], firstV);
      std::vector<Vec3> points;
      for (int j = 0; j < block.countV(); ++j)
      {
        for (int i = 0; i < block.countU(); ++i)
        {
          points.emplace_back(v.Control.block(firstV + j, 3 * (firstU + i), 1, 3).transpose());
        }
      }
      appendModel(modelOf(block, points), model);
      const std::int64_t p = b * blocksU + a;
      model.Neighbors.back() = {b > 0 ? 4 * (p - blocksU) + 2 : -1,
        a + 1 < blocksU ? 4 * (p + 1) + 3 : -1, b + 1 < blocksV ? 4 * (p + blocksU) : -1,
        a > 0 ? 4 * (p - 1) + 1 : -1};
    }
  }
  return model;
}

void flipPatch(TensorShape& shape, std::vector<Vec3>& control)
{
  const double ends = shape.KnotsU.front() + shape.KnotsU.back();
  std::reverse(shape.KnotsU.begin(), shape.KnotsU.end());
  for (double& k : shape.KnotsU)
  {
    k = ends - k;
  }
  const auto nu = static_cast<std::ptrdiff_t>(shape.countU());
  for (auto row = control.begin(); row != control.end(); row += nu)
  {
    std::reverse(row, row + nu);
  }
}

void transposePatches(SplineModel& model)
{
  for (std::size_t k = 0; k < model.Patches.size(); ++k)
  {
    SplinePatch& p = model.Patches[k];
    const std::vector<Vec4> old(model.ControlPoints.begin() + p.FirstControlPoint,
      model.ControlPoints.begin() + p.FirstControlPoint +
        static_cast<std::int64_t>(p.CountU) * p.CountV);
    for (int j = 0; j < p.CountV; ++j)
    {
      for (int i = 0; i < p.CountU; ++i)
      {
        model.ControlPoints[p.FirstControlPoint + static_cast<std::int64_t>(i) * p.CountV + j] =
          old[static_cast<std::size_t>(j) * p.CountU + i];
      }
    }
    std::swap(p.CountU, p.CountV);
    std::swap(p.DegreeU, p.DegreeV);
    std::swap(p.FirstKnotU, p.FirstKnotV);
    auto& n = model.Neighbors[k];
    std::swap(n[0], n[3]);
    std::swap(n[1], n[2]);
    for (std::int64_t& code : n)
    {
      code = code >= 0 ? 4 * (code / 4) + 3 - code % 4 : -1;
    }
  }
}

void appendModel(const SplineModel& part, SplineModel& whole)
{
  const auto points = static_cast<std::int64_t>(whole.ControlPoints.size());
  const auto knots = static_cast<std::int64_t>(whole.Knots.size());
  const auto patches = static_cast<std::int64_t>(whole.Patches.size());
  for (SplinePatch p : part.Patches)
  {
    p.FirstControlPoint += points;
    p.FirstKnotU += knots;
    p.FirstKnotV += knots;
    whole.Patches.push_back(p);
  }
  whole.ControlPoints.insert(
    whole.ControlPoints.end(), part.ControlPoints.begin(), part.ControlPoints.end());
  whole.Knots.insert(whole.Knots.end(), part.Knots.begin(), part.Knots.end());
  for (auto n : part.Neighbors)
  {
    for (std::int64_t& code : n)
    {
      code += code >= 0 ? 4 * patches : 0;
    }
    whole.Neighbors.push_back(n);
  }
}

bool patchFolded(const SplineModel& model, const SplinePatch& patch)
{
  constexpr int Grid = 25;
  const auto domain = patchDomain(model, patch);
  std::vector<Vec3> normals;
  for (int j = 0; j < Grid; ++j)
  {
    for (int i = 0; i < Grid; ++i)
    {
      const double u = domain[0] + (domain[1] - domain[0]) * i / (Grid - 1);
      const double v = domain[2] + (domain[3] - domain[2]) * j / (Grid - 1);
      normals.push_back(evaluatePatch(model, patch, u, v).normal());
    }
  }
  return normalsFold(normals, Grid);
}
} // namespace bsr
