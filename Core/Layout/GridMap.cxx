#include "Layout/GridMap.h"

#include "Layout/GridReduction.h"
#include "Layout/GridTopology.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bsr
{
namespace
{
using Sparse = Eigen::SparseMatrix<double>;
using Factors = SparseFactors<Sparse>;
constexpr Index MostIntegers = 1200;
constexpr int StiffeningPasses = 2;

/// A corner coordinate as a combination of unknowns.
using Combination = std::vector<std::pair<Index, double>>;

class GridSolver
{
public:
  GridSolver(const TriangleSurface& s, const GridTopology& topology, Monitor& monitor)
      : S(s), Topology(topology), M(monitor), Stiffness(s.Region.size(), 1.0)
  {
    if (monitor.cancelled() || !topology.Usable || topology.Kernel.freeVariables() > MostIntegers)
    {
      return;
    }
    this->number();
    this->Usable =
      this->cacheCombinations() && this->factor(this->Base, this->BaseKnown) && this->reduce();
  }

  template <class Offer>
  void run(const std::vector<double>& cells, const Offer& offer)
  {
    if (!this->Usable || this->M.cancelled())
    {
      return;
    }
    const Index ny = this->Topology.Kernel.freeVariables();
    this->Cells = &cells;
    this->Stiffness.assign(this->S.Region.size(), 1.0);
    this->wish();
    this->Pull = this->By - this->Reduced.transpose() *
                              (this->BaseInverse.asDiagonal() * this->forward(this->Br));
    if (!this->round())
    {
      return;
    }
    std::vector<std::int64_t> integers(static_cast<std::size_t>(ny));
    for (Index i = 0; i < ny; ++i)
    {
      integers[i] = std::llround(this->Y[i]);
    }
    for (int pass = 0; pass < StiffeningPasses; ++pass)
    {
      const Factors& factors = pass == 0 ? this->Base : this->Stiff;
      const Sparse& mixed = pass == 0 ? this->BaseMixed : this->Hry;
      const Eigen::VectorXd right = this->Br - mixed * this->Y;
      const Eigen::VectorXd x = factors.solve(right);
      if (factors.info() != Eigen::Success || !x.allFinite())
      {
        return;
      }
      std::vector<Vec2> uv;
      this->evaluate(x, uv);
      const int folded = this->stiffen(uv);
      if (offer(std::move(uv), integers, folded) || folded == 0 || pass + 1 == StiffeningPasses ||
          !this->factor(this->Stiff, this->StiffKnown))
      {
        return;
      }
      this->wish();
    }
  }

private:
  /// Numbers the real unknowns: coordinates of vertices that are not whole.
  void number()
  {
    this->Real.assign(2 * this->S.Points.size(), -1);
    for (Index v = 0; v < this->S.vertices(); ++v)
    {
      for (int c = 0; c < 2 && this->Topology.Used[v]; ++c)
      {
        if (this->Topology.Whole[2 * v + c] < 0)
        {
          this->Real[2 * v + c] = this->Reals++;
        }
      }
    }
  }

  Combination combination(Index h, int c) const
  {
    const CornerForm& corner = this->Topology.Corners[h];
    int from = 0;
    const int sign = corner.source(c, from);
    const Index v = this->S.start(h);
    IntegerForm whole;
    Combination out;
    const Index id = this->Topology.Whole[2 * v + from];
    if (id < 0)
    {
      out.emplace_back(this->Real[2 * v + from], sign);
    }
    else
    {
      addForm(whole, this->Topology.Kernel.variable(id), sign);
    }
    for (const auto& [variable, factor] : corner.Form[c])
    {
      addForm(whole, this->Topology.Kernel.variable(variable), factor);
    }
    for (const auto& [variable, factor] : whole)
    {
      out.emplace_back(this->Reals + variable, static_cast<double>(factor));
    }
    return out;
  }

  /// False: cancelled.
  bool cacheCombinations()
  {
    this->Corner.resize(2 * this->S.Vertex.size());
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (h % 512 == 0 && this->M.cancelled())
      {
        return false;
      }
      for (int c = 0; c < 2 && this->Topology.Field.Inside[h / 3]; ++c)
      {
        this->Corner[2 * h + c] = this->combination(h, c);
      }
    }
    return true;
  }

  /// Gradients of the three hat functions of a triangle, in its own frame; twice the area.
  double gradients(Index f, std::array<Vec2, 3>& g) const
  {
    const auto c = this->S.corners(f);
    const Vec3 e0 = this->S.Points[c[1]] - this->S.Points[c[0]];
    const Vec3 e1 = this->S.Points[c[2]] - this->S.Points[c[0]];
    const Vec3 x = e0.normalized();
    const Vec3 y = e0.cross(e1).normalized().cross(x);
    const std::array<Vec2, 3> p = {Vec2(0, 0), Vec2(e0.norm(), 0), Vec2(e1.dot(x), e1.dot(y))};
    const double twice = std::max(p[1][0] * p[2][1], 1e-300);
    for (int k = 0; k < 3; ++k)
    {
      const Vec2 e = p[(k + 2) % 3] - p[(k + 1) % 3];
      g[k] = Vec2(-e[1], e[0]) / twice;
    }
    return twice;
  }

  /// Writes down and factors the quadratic part of the energy; `known`: its pattern is. False:
  /// cancelled or singular.
  bool factor(Factors& factors, bool& known)
  {
    const Index ny = this->Topology.Kernel.freeVariables();
    std::vector<Eigen::Triplet<double>> rr;
    std::vector<Eigen::Triplet<double>> ry;
    this->Stiffened = &factors == &this->Stiff;
    if (!this->Stiffened)
    {
      this->Hyy = Eigen::MatrixXd::Zero(ny, ny);
    }
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      if (f % 32 == 0 && this->M.cancelled())
      {
        return false;
      }
      if (this->Topology.Field.Inside[f])
      {
        this->addFace(f, rr, ry);
      }
    }
    for (Index i = 0; i < this->Reals; ++i)
    {
      rr.emplace_back(i, i, 1e-9);
    }
    Sparse h(this->Reals, this->Reals);
    h.setFromTriplets(rr.begin(), rr.end());
    this->Hry.resize(this->Reals, ny);
    this->Hry.setFromTriplets(ry.begin(), ry.end());
    if (this->M.cancelled())
    {
      return false;
    }
    if (!known)
    {
      factors.analyzePattern(h);
      known = true;
      if (this->M.cancelled())
      {
        return false;
      }
    }
    return factors.factorize(h, this->M);
  }

  template <class List>
  void addFace(Index f, List& rr, List& ry)
  {
    std::array<Vec2, 3> g;
    const double weight = this->Stiffness[f] * 0.5 * this->gradients(f, g);
    for (int c = 0; c < 2; ++c)
    {
      for (int i = 0; i < 3; ++i)
      {
        for (const auto& [a, fa] : this->Corner[2 * (3 * f + i) + c])
        {
          if (a >= this->Reals && this->Stiffened)
          {
            break; // whole unknowns come last
          }
          for (int j = 0; j < 3; ++j)
          {
            const double w = weight * g[i].dot(g[j]) * fa;
            for (const auto& [d, fd] : this->Corner[2 * (3 * f + j) + c])
            {
              if (a < this->Reals && d < this->Reals)
              {
                if (d <= a)
                {
                  rr.emplace_back(a, d, w * fd);
                }
              }
              else if (a < this->Reals)
              {
                ry.emplace_back(a, d - this->Reals, w * fd);
              }
              else if (d >= this->Reals && d <= a)
              {
                this->Hyy(a - this->Reals, d - this->Reals) += w * fd;
              }
            }
          }
        }
      }
    }
  }

  /// The linear part of the energy: gradients wanted, by field and size of cells.
  void wish()
  {
    this->Br = Eigen::VectorXd::Zero(this->Reals);
    this->By = Eigen::VectorXd::Zero(this->Topology.Kernel.freeVariables());
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      if (!this->Topology.Field.Inside[f])
      {
        continue;
      }
      std::array<Vec2, 3> g;
      // The area of all cells weighs alike.
      const double weight = this->Stiffness[f] * 0.5 * this->gradients(f, g);
      const double cell = (*this->Cells)[f];
      const double angle = this->Topology.Field.Angle[f];
      const std::array<Vec2, 2> wish = {Vec2(std::cos(angle), std::sin(angle)) / cell,
        Vec2(-std::sin(angle), std::cos(angle)) / cell};
      for (int c = 0; c < 2; ++c)
      {
        for (int i = 0; i < 3; ++i)
        {
          for (const auto& [a, fa] : this->Corner[2 * (3 * f + i) + c])
          {
            const double b = weight * g[i].dot(wish[c]) * fa;
            (a < this->Reals ? this->Br[a] : this->By[a - this->Reals]) += b;
          }
        }
      }
    }
  }

  Eigen::VectorXd forward(const Eigen::VectorXd& right) const
  {
    const Eigen::VectorXd permuted = this->Base.permutationP() * right;
    return this->Base.matrixL().solve(permuted);
  }

  /// The energy as a function of the whole unknowns alone.
  bool reduce()
  {
    this->BaseMixed = this->Hry;
    this->Reduced = forwardSolved(this->Base, this->Hry, this->M);
    this->BaseInverse = this->Base.vectorD().cwiseInverse();
    if (this->M.cancelled())
    {
      return false;
    }
    this->Schur = schurComplement(this->Hyy, this->Reduced, this->BaseInverse, this->M);
    return !this->M.cancelled() && this->Schur.allFinite();
  }

  /// Fixes the whole unknowns: always the one whose rounding costs least, then single steps.
  /// False: cancelled.
  bool round()
  {
    const Eigen::Index n = this->Schur.rows();
    Eigen::MatrixXd inverse = this->Schur;
    const double ridge = 1e-9 * std::max(1.0, this->Schur.trace() / std::max<double>(n, 1.0));
    inverse.diagonal().array() += ridge;
    if (!invert(inverse, 0.5 * ridge, this->M))
    {
      return false;
    }
    Eigen::VectorXd y = inverse * this->Pull;
    this->Y.resize(n);
    std::vector<Eigen::Index> unknown(n); // those not fixed yet, in the order of y and the matrix
    std::iota(unknown.begin(), unknown.end(), 0);
    for (Eigen::Index left = n; left > 0; --left)
    {
      if (left % 8 == 0 && this->M.cancelled())
      {
        return false;
      }
      const Eigen::Index best = cheapest(y, inverse, unknown, left);
      const double value = std::round(y[best]);
      this->Y[unknown[best]] = value;
      const double pivot = std::max(inverse(best, best), 1e-300);
      const double change = (value - y[best]) / pivot;
      const Eigen::Index last = left - 1;
      inverse.col(best).head(left).swap(inverse.col(last).head(left));
      inverse.row(best).head(left).swap(inverse.row(last).head(left));
      std::swap(y[best], y[last]);
      std::swap(unknown[best], unknown[last]);
      const auto column = inverse.col(last).head(last);
      y.head(last) += column * change;
      for (Eigen::Index j = 0; j < last; ++j)
      {
        inverse.col(j).head(last).array() -= column.array() * column[j] / pivot;
      }
    }
    this->improve();
    return !this->M.cancelled();
  }

  /// Place, among the first `left`, of the whole unknown whose rounding costs least.
  static Eigen::Index cheapest(const Eigen::VectorXd& y, const Eigen::MatrixXd& inverse,
    const std::vector<Eigen::Index>& unknown, Eigen::Index left)
  {
    Eigen::Index best = -1;
    double least = 0.0;
    for (Eigen::Index i = 0; i < left; ++i)
    {
      const double off = std::round(y[i]) - y[i];
      const double cost = off * off / std::max(inverse(i, i), 1e-300);
      if (best < 0 || cost < least || (cost == least && unknown[i] < unknown[best]))
      {
        best = i;
        least = cost;
      }
    }
    return best;
  }

  void improve()
  {
    Eigen::VectorXd slope = this->Schur * this->Y - this->Pull;
    for (int pass = 0; pass < 50; ++pass)
    {
      bool moved = false;
      for (Eigen::Index i = 0; i < slope.size(); ++i)
      {
        const double step = slope[i] > 0.0 ? -1.0 : 1.0;
        if (step * slope[i] + 0.5 * this->Schur(i, i) < -1e-9)
        {
          this->Y[i] += step;
          slope += step * this->Schur.col(i);
          moved = true;
        }
      }
      if (!moved)
      {
        break;
      }
    }
  }

  void evaluate(const Eigen::VectorXd& x, std::vector<Vec2>& uv) const
  {
    uv.assign(this->S.Vertex.size(), Vec2::Zero());
    for (std::size_t i = 0; i < this->Corner.size(); ++i)
    {
      for (const auto& [unknown, factor] : this->Corner[i])
      {
        uv[i / 2][static_cast<Eigen::Index>(i % 2)] +=
          factor * (unknown < this->Reals ? x[unknown] : this->Y[unknown - this->Reals]);
      }
    }
  }

  /// Stiffens triangles that fold or nearly so, and their neighbors; returns how many fold.
  int stiffen(const std::vector<Vec2>& uv)
  {
    int folded = 0;
    std::vector<double> more(this->Stiffness.size(), 1.0);
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      if (!this->Topology.Field.Inside[f])
      {
        continue;
      }
      const Vec2 a = uv[3 * f + 1] - uv[3 * f];
      const Vec2 b = uv[3 * f + 2] - uv[3 * f];
      const double area = a[0] * b[1] - a[1] * b[0];
      const double cell = (*this->Cells)[f];
      const double wished = 2.0 * this->S.areaNormal(f).norm() / (cell * cell);
      folded += area <= 0.0;
      if (area < 0.1 * wished)
      {
        more[f] = 3.0;
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          more[this->S.Opposite[h] / 3] = std::max(more[this->S.Opposite[h] / 3], 1.8);
        }
      }
    }
    for (std::size_t f = 0; f < more.size(); ++f)
    {
      this->Stiffness[f] *= more[f];
    }
    return folded;
  }

  const TriangleSurface& S;
  const GridTopology& Topology;
  Monitor& M;
  const std::vector<double>* Cells = nullptr;
  std::vector<double> Stiffness;
  std::vector<Index> Real;
  Index Reals = 0;
  std::vector<Combination> Corner;
  bool Usable = false;
  Sparse Hry;
  Sparse BaseMixed;            ///< Hry without stiffening
  Sparse Reduced;              ///< L^-1 P Hry
  Eigen::VectorXd BaseInverse; ///< of the diagonal factor
  Eigen::MatrixXd Hyy;         ///< lower half
  Eigen::MatrixXd Schur;
  Eigen::VectorXd Br;
  Eigen::VectorXd By;
  Eigen::VectorXd Pull;
  Eigen::VectorXd Y;
  Factors Base;
  Factors Stiff;
  bool BaseKnown = false;
  bool StiffKnown = false;
  bool Stiffened = false; ///< the whole unknowns are known: their own part is not needed
};
} // namespace

struct GridMapper::Solver
{
  GridTopology Topology;
  GridSolver Grid;
  GridMap Map;

  Solver(const TriangleSurface& s, const CrossField& field, int mostSingular, Monitor& monitor)
      : Topology(gridTopology(s, field, mostSingular, monitor)), Grid(s, this->Topology, monitor)
  {
    this->Map.Surface = s;
    this->Map.Inside = field.Inside;
    this->Map.Singular = this->Topology.Singular;
  }
};

GridMapper::GridMapper(
  const TriangleSurface& s, const CrossField& field, int mostSingular, Monitor& monitor)
{
  if (!field.Angle.empty())
  {
    this->Impl = std::make_unique<Solver>(s, field, mostSingular, monitor);
  }
}

GridMapper::~GridMapper() = default;

int GridMapper::singular() const
{
  return this->Impl ? this->Impl->Topology.Singular : 0;
}

void GridMapper::run(
  const std::vector<double>& cells, const std::function<bool(const GridMap&)>& accept)
{
  if (!this->Impl)
  {
    return;
  }
  GridMap& map = this->Impl->Map;
  this->Impl->Grid.run(cells,
    [&](std::vector<Vec2> uv, const std::vector<std::int64_t>& integers, int folded)
    {
      map.UV = std::move(uv);
      map.Folded = folded;
      this->Impl->Topology.transitions(map.Surface, integers, map.Turn, map.Shift);
      return accept(map);
    });
}
} // namespace bsr
