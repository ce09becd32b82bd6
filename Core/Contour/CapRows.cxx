#include "Contour/JunctionRows.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double RimAngle = 0.25 * Pi; ///< of the rim on the elliptic profile of a cap

/// The net of a cap: rings 0 and 1 given, the rest without bending (discrete bi-Laplacian).
class CapNet
{
public:
  CapNet(std::size_t columns, std::size_t rows)
      : Net(rows, ControlRow(columns, Vec3::Zero())), Columns(columns), Rows(rows)
  {
  }

  Vec3& at(std::size_t i, std::size_t j) { return this->Net[j][i]; }

  void fill()
  {
    if (this->Columns < 5 || this->Rows < 5)
    {
      return;
    }
    const std::size_t w = this->Columns - 4;
    const std::size_t h = this->Rows - 4;
    const auto n = static_cast<Eigen::Index>(w * h);
    const auto number = [&](std::size_t i, std::size_t j)
    { return static_cast<Eigen::Index>((j - 2) * w + (i - 2)); };
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 3);
    static constexpr int Stencil[13][3] = {{0, 0, 20}, {1, 0, -8}, {-1, 0, -8}, {0, 1, -8},
      {0, -1, -8}, {1, 1, 2}, {1, -1, 2}, {-1, 1, 2}, {-1, -1, 2}, {2, 0, 1}, {-2, 0, 1}, {0, 2, 1},
      {0, -2, 1}};
    for (std::size_t j = 2; j + 2 < this->Rows; ++j)
    {
      for (std::size_t i = 2; i + 2 < this->Columns; ++i)
      {
        for (const auto& s : Stencil)
        {
          const std::size_t x = i + static_cast<std::size_t>(s[0] + 2) - 2;
          const std::size_t y = j + static_cast<std::size_t>(s[1] + 2) - 2;
          const bool inner = x >= 2 && y >= 2 && x + 2 < this->Columns && y + 2 < this->Rows;
          if (inner)
          {
            m(number(i, j), number(x, y)) += s[2];
          }
          else
          {
            right.row(number(i, j)) -= s[2] * this->at(x, y).transpose();
          }
        }
      }
    }
    const Eigen::MatrixXd solved = m.ldlt().solve(right);
    for (std::size_t j = 2; j + 2 < this->Rows; ++j)
    {
      for (std::size_t i = 2; i + 2 < this->Columns; ++i)
      {
        this->at(i, j) = solved.row(number(i, j)).transpose();
      }
    }
  }

  std::vector<ControlRow> Net;

private:
  std::size_t Columns;
  std::size_t Rows;
};

class CapMaker
{
public:
  CapMaker(
    const EndRows& end, const std::vector<int>& corners, const Vec3& tip, const RowOptions& options)
      : Tip(tip), Options(options), Sites(rowSites(options))
  {
    const auto n = static_cast<int>(end.Last->size());
    for (const Vec3& p : *end.Last)
    {
      this->Center += p / n;
    }
    for (std::size_t k = 0; k < 4; ++k)
    {
      const int spans = (corners[(k + 1) % 4] - corners[k] + n) % n;
      this->Spans.push_back(spans);
      this->Last.push_back(periodicPiece(*end.Last, options.OrderU, corners[k], spans));
    }
  }

  CapRows run()
  {
    for (std::size_t k = 0; k < 4; ++k)
    {
      this->makeArc(k);
    }
    for (std::size_t k = 0; k < 4; ++k)
    {
      this->makeCorner(k);
    }
    this->makeNet();
    return std::move(this->Out);
  }

private:
  /// t = 1 at the contour, 0 at the rim, negative beyond.
  Vec3 dome(const Vec3& p, double t) const
  {
    const double angle = RimAngle * (1.0 - t);
    return this->Center + std::cos(angle) * (p - this->Center) + std::sin(angle) * this->Tip;
  }

  void makeArc(std::size_t k)
  {
    std::vector<ControlRow> rows(static_cast<std::size_t>(this->Options.fixedRows()));
    ControlRow beyond;
    for (std::size_t i = 0; i < this->Last[k].size(); ++i)
    {
      const Vec3& p = this->Last[k][i];
      for (std::size_t j = 0; j < rows.size(); ++j)
      {
        rows[j].push_back(this->dome(p, this->Sites.share(static_cast<int>(j))));
      }
      const Vec3 v = 0.5 * (this->dome(p, -this->Sites.share(1)) - rows[1][i]);
      beyond.push_back(rows[0][i] + v);
      rows[1][i] = rows[0][i] - v;
      this->Out.Reach += (this->dome(p, 0.5) - rows[0][i]).norm() + (p - this->dome(p, 0.5)).norm();
      this->Count += 1.0;
    }
    this->Out.Arcs.push_back(std::move(rows));
    this->Beyond.push_back(std::move(beyond));
  }

  /// The corner where arc k starts: a star of three arms, along the arc, back along the one before,
  /// and down the tube.
  void makeCorner(std::size_t k)
  {
    const std::size_t before = (k + 3) % 4;
    auto& next = this->Out.Arcs[k];
    auto& last = this->Out.Arcs[before];
    const std::size_t e = last[0].size() - 1;
    const Vec3 c = next[0][0];
    const Vec3 along = 0.5 * ((next[0][1] - c) - (last[0][e - 1] - c));
    const double size = this->Options.StarSize;
    Vec3 down = next[1][0] - c;
    down *= std::min(1.0, 0.8 * along.norm() / std::max(down.norm(), 1e-300)) * size;
    const Vec3 w = size * 0.9 * along;
    const std::vector<Vec3> arms{-0.5 * down + w, -0.5 * down - w, down};
    const std::vector<Vec3> sectors = starSectors(c, arms);
    // Straight first spans, faded into the rim.
    this->straighten(k, false, arms[0]);
    this->straighten(before, true, arms[1]);
    for (std::size_t j = 1; j < next.size(); ++j)
    {
      Vec3 seam = 0.5 * (next[j][1] + last[j][e - 1]);
      if (static_cast<int>(j) < this->Options.OrderV)
      {
        seam = c + this->Sites.Rows[j] / this->Sites.Rows[1] * down;
      }
      const Vec3 shift = seam - 0.5 * (next[j][1] + last[j][e - 1]);
      next[j][1] += shift;
      last[j][e - 1] += shift;
      next[j][0] = seam;
      last[j][e] = seam;
    }
    next[1][1] = sectors[2];     // between the tube's arm and the arc
    last[1][e - 1] = sectors[1]; // between the arc before and the tube's arm
    this->Inner.push_back(sectors[0]);
  }

  void straighten(std::size_t k, bool end, const Vec3& leg)
  {
    auto& rows = this->Out.Arcs[k];
    const std::vector<double> g =
      grevilleSites(clampedKnots(this->Options.OrderU, this->Spans[k]), this->Options.OrderU);
    const std::size_t count = g.size();
    const double straight = g[this->Options.OrderU - 1];
    const double reach = std::max(0.5 * this->Spans[k] - straight, 0.5);
    const Vec3 c = end ? rows[0][count - 1] : rows[0][0];
    for (std::size_t s = 1; s < count && g[s] < 0.5 * this->Spans[k]; ++s)
    {
      const std::size_t i = end ? count - 1 - s : s;
      double x = std::clamp((g[s] - straight) / reach, 0.0, 1.0);
      x = (1.0 - x) * (1.0 - x) * (1.0 + 2.0 * x);
      const Vec3 shift = x * (c + g[s] / g[1] * leg - rows[0][i]);
      for (std::size_t j = 0; j < rows.size(); ++j)
      {
        rows[j][i] += (1.0 - this->Sites.share(static_cast<int>(j))) * shift;
      }
      this->Beyond[k][i] = 2.0 * rows[0][i] - rows[1][i];
    }
  }

  void makeNet()
  {
    this->Out.Reach /= this->Count;
    const std::size_t w = this->Last[0].size();
    const std::size_t h = this->Last[1].size();
    CapNet net(w, h);
    for (const std::size_t ring : {std::size_t{1}, std::size_t{0}})
    {
      for (std::size_t i = ring; i + ring < w; ++i)
      {
        net.at(i, ring) = ring ? this->Beyond[0][i] : this->Out.Arcs[0][0][i];
        net.at(i, h - 1 - ring) =
          ring ? this->Beyond[2][w - 1 - i] : this->Out.Arcs[2][0][w - 1 - i];
      }
      for (std::size_t j = ring; j + ring < h; ++j)
      {
        net.at(w - 1 - ring, j) = ring ? this->Beyond[1][j] : this->Out.Arcs[1][0][j];
        net.at(ring, j) = ring ? this->Beyond[3][h - 1 - j] : this->Out.Arcs[3][0][h - 1 - j];
      }
    }
    net.at(1, 1) = this->Inner[0];
    net.at(w - 2, 1) = this->Inner[1];
    net.at(w - 2, h - 2) = this->Inner[2];
    net.at(1, h - 2) = this->Inner[3];
    net.fill();
    this->Out.Net = std::move(net.Net);
  }

  const Vec3 Tip;
  const RowOptions& Options;
  const RowSites Sites;
  Vec3 Center = Vec3::Zero();
  std::vector<int> Spans;
  std::vector<ControlRow> Last;
  std::vector<ControlRow> Beyond; ///< the cap's row beside the rim
  std::vector<Vec3> Inner;        ///< the cap's control points at its corners
  double Count = 0.0;
  CapRows Out;
};
} // namespace

CapRows makeCapRows(
  const EndRows& end, const std::vector<int>& corners, const Vec3& tip, const RowOptions& options)
{
  return CapMaker(end, corners, tip, options).run();
}
} // namespace bsr
