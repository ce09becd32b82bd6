#include "Contour/SkinGrid.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bsr
{
namespace
{
/// A rectangle of the data set: rings, and inside them a core or parts side by side.
struct Block
{
  std::vector<Index> Contours; ///< rings from the outside inwards
  std::vector<Block> Parts;
  bool Root = false;
  bool Stacked = false; ///< parts above one another instead of side by side
  int Rows = 0;         ///< least
  int Columns = 0;
  Vec2 Center = Vec2::Zero(); ///< in the frame of the grid
  Vec2 Half = Vec2::Zero();
  Vec2 EndHalf = Vec2::Zero(); ///< of the innermost ring

  int rings() const { return static_cast<int>(this->Contours.size()); }
};

class Arranger
{
public:
  Arranger(
    const ContourStack& stack, const SkinTree& tree, int coreRows, bool shaped, SkinGrid& grid)
      : Stack(stack), Tree(tree), CoreRows(coreRows), Shaped(shaped), Grid(grid)
  {
  }

  void run()
  {
    this->chooseFrame();
    Block root = this->block(0);
    root.Root = true;
    this->measure(root);
    this->Grid.Rows = root.Rows;
    this->Grid.Columns = root.Columns;
    this->place(root, 0, 0, root.Rows, root.Columns, -1);
  }

  Vec2 AxisU = Vec2::UnitX();

private:
  const Contour& contour(Index node) const
  {
    return this->Stack.Contours[this->Tree.Nodes[node].Contour];
  }

  /// Columns run along the line of the centers of the legs of the widest split; without a split
  /// across the longer direction of the end.
  void chooseFrame()
  {
    Eigen::Matrix2d widest = Eigen::Matrix2d::Zero();
    for (const SkinNode& n : this->Tree.Nodes)
    {
      Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
      for (const Index a : n.Children)
      {
        for (const Index b : n.Children)
        {
          const Vec2 d = this->contour(a).Center - this->contour(b).Center;
          spread += d * d.transpose();
        }
      }
      widest = spread.trace() > widest.trace() ? spread : widest;
    }
    int column = 1;
    if (!(widest.trace() > 0.0))
    {
      column = 0;
      const Contour& end = this->contour(static_cast<Index>(this->Tree.Nodes.size()) - 1);
      for (const Vec2& p : end.Flat)
      {
        widest += (p - end.Center) * (p - end.Center).transpose();
      }
    }
    this->AxisU = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(widest).eigenvectors().col(column);
    this->AxisU *= this->AxisU[0] + 1e-9 * this->AxisU[1] < 0.0 ? -1.0 : 1.0;
  }

  Vec2 inFrame(const Vec2& p) const
  {
    return {this->AxisU.dot(p), this->AxisU.x() * p.y() - this->AxisU.y() * p.x()};
  }

  Vec2 halfExtent(Index node) const
  {
    const Contour& c = this->contour(node);
    Vec2 half = Vec2::Zero();
    for (const Vec2& p : c.Flat)
    {
      half = half.cwiseMax((this->inFrame(p) - this->inFrame(c.Center)).cwiseAbs());
    }
    return half;
  }

  Block block(Index node) const
  {
    Block b;
    const std::vector<Index> chain = this->Tree.chain(node);
    for (const Index n : chain)
    {
      b.Contours.push_back(this->Tree.Nodes[n].Contour);
    }
    b.Center = this->inFrame(this->contour(node).Center);
    b.Half = this->halfExtent(node);
    b.EndHalf = this->halfExtent(chain.back());
    std::vector<Block> parts;
    for (const Index child : this->Tree.Nodes[chain.back()].Children)
    {
      parts.push_back(this->block(child));
    }
    if (!parts.empty())
    {
      Block inner = cut(std::move(parts));
      b.Parts = std::move(inner.Parts);
      b.Stacked = inner.Stacked;
    }
    return b;
  }

  /// Parts in the order and direction of the widest gap between them; groups become blocks without
  /// rings.
  static Block cut(std::vector<Block> parts)
  {
    Block whole;
    int direction = 0;
    std::size_t at = 1;
    double widest = -std::numeric_limits<double>::infinity();
    for (const int d : {0, 1})
    {
      sortAlong(parts, d);
      for (std::size_t k = 1; k < parts.size(); ++k)
      {
        const double gap = gapAt(parts, d, k);
        if (gap > widest + 1e-9)
        {
          widest = gap;
          direction = d;
          at = k;
        }
      }
    }
    sortAlong(parts, direction);
    whole.Stacked = direction == 1;
    const auto middle = parts.begin() + static_cast<std::ptrdiff_t>(at);
    for (auto group :
      {std::vector<Block>(parts.begin(), middle), std::vector<Block>(middle, parts.end())})
    {
      if (group.size() == 1)
      {
        whole.Parts.push_back(std::move(group[0]));
        continue;
      }
      Block inner = cut(std::move(group));
      if (inner.Stacked == whole.Stacked) // one row of parts
      {
        std::move(inner.Parts.begin(), inner.Parts.end(), std::back_inserter(whole.Parts));
      }
      else
      {
        whole.Parts.push_back(std::move(inner));
      }
    }
    return whole;
  }

  static void sortAlong(std::vector<Block>& parts, int d)
  {
    std::stable_sort(parts.begin(), parts.end(),
      [d](const Block& a, const Block& b) { return a.Center[d] < b.Center[d]; });
  }

  static double gapAt(const std::vector<Block>& parts, int d, std::size_t k)
  {
    double left = -std::numeric_limits<double>::infinity();
    double right = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
      const Block& p = parts[i];
      i < k ? left = std::max(left, p.Center[d] + p.Half[d])
            : right = std::min(right, p.Center[d] - p.Half[d]);
    }
    return right - left;
  }

  /// Least sizes, bottom up.
  void measure(Block& b) const
  {
    int rows = b.Parts.empty() ? this->CoreRows : 0;
    int columns = b.Parts.empty() ? 2 : 0;
    if (b.Parts.empty() && this->Shaped)
    {
      const int sum = rows + columns;
      const double high = b.EndHalf.y() / (b.EndHalf.x() + b.EndHalf.y());
      rows = std::clamp(static_cast<int>(std::lround(sum * high)), 3, sum - 3);
      columns = sum - rows;
    }
    for (Block& p : b.Parts)
    {
      this->measure(p);
      rows = b.Stacked ? rows + p.Rows : std::max(rows, p.Rows);
      columns = b.Stacked ? std::max(columns, p.Columns) : columns + p.Columns;
    }
    const int rings = b.Parts.empty() ? b.rings() - 1 : b.rings();
    b.Rows = rows + 2 * rings;
    b.Columns = columns + 2 * rings;
  }

  /// A leg is round, a ring around parts nearly a rectangle; the outermost ring is one, and those
  /// inside it become round by and by.
  static double roundness(const Block& b, int k)
  {
    constexpr double R0 = 0.25;
    constexpr double R1 = 1.0;
    const double inside = b.Parts.empty() ? R1 : R0;
    const double depth = b.rings() > 1 ? static_cast<double>(k) / (b.rings() - 1) : 1.0;
    return b.Root ? inside * depth : b.Parts.empty() ? inside : R0 + (1.0 - depth) * 0.3;
  }

  void place(const Block& b, int row, int column, int rows, int columns, Index outer)
  {
    for (int k = 0; k < b.rings(); ++k)
    {
      SkinRing ring;
      ring.Contour = b.Contours[k];
      ring.Row = row;
      ring.Column = column;
      ring.Rows = rows;
      ring.Columns = columns;
      ring.Core = b.Parts.empty() && k + 1 == b.rings();
      ring.Up = this->Tree.Up;
      ring.Outer = outer;
      ring.Roundness = roundness(b, k);
      outer = static_cast<Index>(this->Grid.Rings.size());
      this->Grid.Rings.push_back(ring);
      ++row;
      ++column;
      rows -= 2;
      columns -= 2;
    }
    int need = 0;
    for (const Block& p : b.Parts)
    {
      need += b.Stacked ? p.Rows : p.Columns;
    }
    int extra = (b.Stacked ? rows : columns) - need;
    auto left = static_cast<int>(b.Parts.size());
    for (const Block& p : b.Parts)
    {
      const int share = extra / left--;
      extra -= share;
      if (b.Stacked)
      {
        this->place(p, row, column, p.Rows + share, columns, outer);
        row += p.Rows + share;
      }
      else
      {
        this->place(p, row, column, rows, p.Columns + share, outer);
        column += p.Columns + share;
      }
    }
  }

  const ContourStack& Stack;
  const SkinTree& Tree;
  int CoreRows;
  bool Shaped;
  SkinGrid& Grid;
};

/// Out of the legs at the cores, and the room to the next slice.
void findCapRoom(const ContourStack& stack, SkinGrid& grid)
{
  for (const SkinRing& ring : grid.Rings)
  {
    const Index s = stack.Contours[ring.Contour].Slice;
    const Slice& slice = stack.Slices[s];
    grid.CapDirection.emplace_back(
      ring.Core ? Vec3((ring.Up ? 1.0 : -1.0) * slice.Normal) : Vec3(Vec3::Zero()));
    // the distance of slices on the leg's side of its end
    const Index other = ring.Up ? s - 1 : s + 1;
    const double room = other >= 0 && other < static_cast<Index>(stack.Slices.size())
                          ? std::abs(stack.Slices[other].Position - slice.Position)
                          : stack.spacing();
    const Index beyond = ring.Up ? s + 1 : s - 1;
    const double gap = beyond >= 0 && beyond < static_cast<Index>(stack.Slices.size())
                         ? std::abs(stack.Slices[beyond].Position - slice.Position)
                         : room;
    grid.CapRoom.push_back(ring.Core ? std::min(room, gap) : 0.0);
  }
}

} // namespace

Vec2 SkinRing::place(double k) const
{
  const double n = this->size();
  k -= n * std::floor(k / n);
  const int w = this->Columns - 1;
  const int h = this->Rows - 1;
  Vec2 p(this->Column, this->Row);
  if (k <= w)
  {
    return p + Vec2(k, 0.0);
  }
  if (k <= w + h)
  {
    return p + Vec2(w, k - w);
  }
  if (k <= 2 * w + h)
  {
    return p + Vec2(2 * w + h - k, h);
  }
  return p + Vec2(0.0, n - k);
}

Vec2 SkinRing::rounded(const Vec2& place) const
{
  const Vec2 half(0.5 * (this->Columns - 1), 0.5 * (this->Rows - 1));
  const Vec2 middle = Vec2(this->Column, this->Row) + half;
  const Vec2 p = (place - middle).cwiseQuotient(half);
  const double t = 0.5 * this->Roundness;
  return middle + half.cwiseProduct(Vec2(p.x() * std::sqrt(1.0 - t * p.y() * p.y()),
                    p.y() * std::sqrt(1.0 - t * p.x() * p.x())));
}

Vec2 SkinGrid::rounded(const Vec2& place) const
{
  const auto column = static_cast<int>(std::floor(place.x()));
  const auto row = static_cast<int>(std::floor(place.y()));
  const Vec2 t = place - Vec2(column, row);
  Vec2 sum = Vec2::Zero();
  for (const int i : {0, 1})
  {
    for (const int j : {0, 1})
    {
      const double w = (i ? t.x() : 1.0 - t.x()) * (j ? t.y() : 1.0 - t.y());
      if (w > 0.0)
      {
        const Index r = this->OwnerOf[this->node(row + j, column + i)];
        sum += w * this->Rings[r].rounded(Vec2(column + i, row + j));
      }
    }
  }
  return sum;
}

double SkinRing::shareAt(double k) const
{
  const auto n = static_cast<std::int64_t>(this->Shares.size());
  const double whole = std::floor(k);
  const auto i = static_cast<std::int64_t>(whole);
  const auto value = [&](std::int64_t j)
  {
    const std::int64_t turns = j >= 0 ? j / n : -((n - 1 - j) / n);
    return this->Shares[j - turns * n] + static_cast<double>(turns);
  };
  return value(i) + (k - whole) * (value(i + 1) - value(i));
}

SkinGrid arrangeGrid(const ContourStack& stack, const SkinTree& tree, int coreRows, bool shaped)
{
  SkinGrid grid;
  Arranger arranger(stack, tree, std::max(coreRows, 3), shaped, grid);
  arranger.run();
  grid.AxisU = arranger.AxisU;
  for (const SkinRing& ring : grid.Rings)
  {
    grid.Curves.emplace_back(stack.Contours[ring.Contour].Points, true);
  }
  findCapRoom(stack, grid);
  return grid;
}

} // namespace bsr
