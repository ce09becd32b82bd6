#include "Contour/SkinCap.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Refined grid over one core.
class Cap
{
public:
  Cap(const SkinGrid& grid, Index r) : Ring(grid.Rings[r])
  {
    this->SubU = (6 + this->Ring.Columns - 2) / (this->Ring.Columns - 1);
    this->SubV = (6 + this->Ring.Rows - 2) / (this->Ring.Rows - 1);
    this->Wide = this->SubU * (this->Ring.Columns - 1) + 1;
    this->High = this->SubV * (this->Ring.Rows - 1) + 1;
    this->Points.assign(static_cast<std::size_t>(this->Wide) * this->High, Vec3::Zero());
    this->fillOutline(grid, r);
    this->fillInside();
  }

  /// Heights of all nodes, 1 at the highest, 0 on the outline.
  std::vector<double> membrane(const ContourStack& stack) const
  {
    std::vector<Vec2> flat;
    for (const Vec3& p : this->Points)
    {
      flat.push_back(stack.flat(p));
    }
    Triplets entries;
    Eigen::VectorXd load = Eigen::VectorXd::Zero(this->unknowns());
    for (int j = 0; j + 1 < this->High; ++j)
    {
      for (int i = 0; i + 1 < this->Wide; ++i)
      {
        const std::array<int, 4> q{
          this->id(i, j), this->id(i + 1, j), this->id(i + 1, j + 1), this->id(i, j + 1)};
        for (const std::array<int, 3>& t :
          {std::array<int, 3>{q[0], q[1], q[2]}, std::array<int, 3>{q[0], q[2], q[3]},
            std::array<int, 3>{q[0], q[1], q[3]}, std::array<int, 3>{q[1], q[2], q[3]}})
        {
          this->addTriangle(flat, t, entries, load);
        }
      }
    }
    const Eigen::VectorXd h = this->solve(entries, load);
    std::vector<double> height(this->Points.size(), 0.0);
    const double top = h.size() > 0 ? h.maxCoeff() : 0.0;
    for (int k = 0; k < static_cast<int>(height.size()); ++k)
    {
      const int u = this->unknown(k);
      height[k] = u >= 0 && top > 0.0 ? std::max(0.0, h[u] / top) : 0.0;
    }
    return height;
  }

  bool inside(int i, int j) const
  {
    return i > 0 && j > 0 && i + 1 < this->Wide && j + 1 < this->High;
  }
  int id(int i, int j) const { return j * this->Wide + i; }
  Vec2 place(int i, int j) const
  {
    return {this->Ring.Column + static_cast<double>(i) / this->SubU,
      this->Ring.Row + static_cast<double>(j) / this->SubV};
  }

  const SkinRing& Ring;
  int SubU, SubV, Wide, High;
  std::vector<Vec3> Points;

private:
  int unknowns() const { return std::max(0, this->Wide - 2) * std::max(0, this->High - 2); }
  int unknown(int k) const
  {
    const int i = k % this->Wide;
    const int j = k / this->Wide;
    return this->inside(i, j) ? (j - 1) * (this->Wide - 2) + i - 1 : -1;
  }

  void fillOutline(const SkinGrid& grid, Index r)
  {
    const double w = this->Ring.Columns - 1;
    const double h = this->Ring.Rows - 1;
    for (int j = 0; j < this->High; ++j)
    {
      for (int i = 0; i < this->Wide; ++i)
      {
        const double x = static_cast<double>(i) / this->SubU;
        const double y = static_cast<double>(j) / this->SubV;
        if (!this->inside(i, j))
        {
          const double k = j == 0                ? x
                           : i + 1 == this->Wide ? w + y
                           : j + 1 == this->High ? 2.0 * w + h - x
                                                 : 2.0 * w + 2.0 * h - y;
          this->Points[this->id(i, j)] = grid.at(r, k);
        }
      }
    }
  }

  void fillInside()
  {
    Triplets entries;
    Eigen::MatrixXd load = Eigen::MatrixXd::Zero(this->unknowns(), 3);
    for (int j = 1; j + 1 < this->High; ++j)
    {
      for (int i = 1; i + 1 < this->Wide; ++i)
      {
        const int u = this->unknown(this->id(i, j));
        entries.emplace_back(u, u, 4.0);
        for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        {
          const int k = this->id(i + di, j + dj);
          if (const int n = this->unknown(k); n >= 0)
          {
            entries.emplace_back(u, n, -1.0);
          }
          else
          {
            load.row(u) += this->Points[k].transpose();
          }
        }
      }
    }
    const Eigen::MatrixXd x = this->solve(entries, load);
    for (int k = 0; k < static_cast<int>(this->Points.size()); ++k)
    {
      if (const int u = this->unknown(k); u >= 0)
      {
        this->Points[k] = x.row(u).transpose();
      }
    }
  }

  /// Stiffness (cotangents) and load (a third of the area a corner) of a triangle.
  void addTriangle(const std::vector<Vec2>& flat, const std::array<int, 3>& t, Triplets& entries,
    Eigen::VectorXd& load) const
  {
    const Vec2 e[3] = {flat[t[2]] - flat[t[1]], flat[t[0]] - flat[t[2]], flat[t[1]] - flat[t[0]]};
    const double twice = std::abs(e[0].x() * e[1].y() - e[0].y() * e[1].x());
    if (!(twice > 0.0))
    {
      return;
    }
    const double floor = 1e-3 * (e[0].squaredNorm() + e[1].squaredNorm() + e[2].squaredNorm());
    for (int a = 0; a < 3; ++a)
    {
      const int u = this->unknown(t[a]);
      if (u < 0)
      {
        continue;
      }
      load[u] += twice;
      for (int b = 0; b < 3; ++b)
      {
        const int v = this->unknown(t[b]);
        if (v >= 0)
        {
          entries.emplace_back(u, v, e[a].dot(e[b]) / std::max(twice, floor));
        }
      }
    }
  }

  template <class Load>
  Load solve(const Triplets& entries, const Load& load) const
  {
    if (this->unknowns() == 0)
    {
      return load;
    }
    Eigen::SparseMatrix<double> a(this->unknowns(), this->unknowns());
    a.setFromTriplets(entries.begin(), entries.end());
    for (int k = 0; k < a.rows(); ++k)
    {
      a.coeffRef(k, k) += 1e-9;
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(a);
    return solver.solve(load);
  }
};

double capHeight(const ContourStack& stack, const SkinGrid& grid, Index r, double share)
{
  const SkinRing& ring = grid.Rings[r];
  const Contour& end = stack.Contours[ring.Contour];
  double height = std::min(share * grid.CapRoom[r], 0.35 * end.diameter());
  if (ring.Outer >= 0)
  {
    const Contour& next = stack.Contours[grid.Rings[ring.Outer].Contour];
    const double away =
      std::abs(stack.Slices[next.Slice].Position - stack.Slices[end.Slice].Position);
    const bool whole = stack.Contours[grid.Rings[ring.Outer].Contour].Area > end.Area;
    if (whole)
    {
      height = std::min(height, away * end.Area / (next.Area - end.Area));
    }
  }
  return share > 0.0 ? std::max(height, 0.1 * share * grid.CapRoom[r]) : 0.0;
}
/// From a point to the plane of the contour around ring r, along its normal.
Vec3 liftToOuter(const ContourStack& stack, const SkinGrid& grid, Index r, const Vec3& p)
{
  Index outer = grid.Rings[r].Outer;
  if (outer < 0)
  {
    return Vec3::Zero();
  }
  const Slice& slice = stack.Slices[stack.Contours[grid.Rings[outer].Contour].Slice];
  return slice.Normal.dot(slice.Origin - p) * slice.Normal;
}
} // namespace

std::vector<CapPoint> closeCores(const ContourStack& stack, SkinGrid& grid, double share)
{
  std::vector<CapPoint> points;
  for (Index r = 0; r < static_cast<Index>(grid.Rings.size()); ++r)
  {
    if (!grid.Rings[r].Core)
    {
      continue;
    }
    const Cap cap(grid, r);
    const std::vector<double> height = cap.membrane(stack);
    const double top = capHeight(stack, grid, r, share);
    for (int j = 1; j + 1 < cap.High; ++j)
    {
      for (int i = 1; i + 1 < cap.Wide; ++i)
      {
        const int k = cap.id(i, j);
        const Vec3 p = cap.Points[k] + top * height[k] * grid.CapDirection[r];
        points.push_back({p, cap.place(i, j), r});
        if (i % cap.SubU == 0 && j % cap.SubV == 0)
        {
          grid.Points[grid.node(cap.Ring.Row + j / cap.SubV, cap.Ring.Column + i / cap.SubU)] = p;
        }
      }
    }
  }
  return points;
}
std::vector<CapPoint> bridgeParts(const ContourStack& stack, const SkinGrid& grid)
{
  std::vector<CapPoint> points;
  for (int r = 0; r < grid.Rows; ++r)
  {
    for (int c = 0; c < grid.Columns; ++c)
    {
      for (const bool across : {true, false})
      {
        const int r2 = across ? r : r + 1;
        const int c2 = across ? c + 1 : c;
        if (r2 >= grid.Rows || c2 >= grid.Columns)
        {
          continue;
        }
        const Index a = grid.RingOf[grid.node(r, c)];
        const Index b = grid.RingOf[grid.node(r2, c2)];
        if (a < 0 || b < 0 || a == b || grid.Rings[a].Outer == b || grid.Rings[b].Outer == a)
        {
          continue;
        }
        const Vec3 p = grid.Points[grid.node(r, c)];
        const Vec3 q = grid.Points[grid.node(r2, c2)];
        const SkinRing& ring = grid.Rings[a];
        const Vec3 lift = liftToOuter(stack, grid, a, 0.5 * (p + q));
        const double along = across ? static_cast<double>(r - ring.Row) / (ring.Rows - 1)
                                    : static_cast<double>(c - ring.Column) / (ring.Columns - 1);
        const double side = (2.0 * along - 1.0) * (2.0 * along - 1.0);
        for (const double t : {0.25, 0.5, 0.75})
        {
          const double share = 4.0 * t * (1.0 - t) * (0.5 + 0.45 * std::min(1.0, side));
          points.push_back({(1.0 - t) * p + t * q + share * lift,
            Vec2(c + (c2 - c) * t, r + (r2 - r) * t), a, true});
        }
      }
    }
  }
  return points;
}
} // namespace bsr
