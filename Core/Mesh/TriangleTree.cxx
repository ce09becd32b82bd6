#include "Mesh/TriangleTree.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace bsr
{
namespace
{
constexpr Index LeafSize = 6;
constexpr Index Portion = 4096; ///< triangles halved between two questions, about
constexpr double Near = 1e-6;   ///< barycentric coordinate of points that may be beyond a side
constexpr double Sound = 1e-8;  ///< squared, twice the area over the square of the longest side
constexpr double Slack = 1.0 - 1e-9; ///< of lower bounds, for rounding

Vec3 nearestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b)
{
  const Vec3 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return a + t * d;
}

double squaredDistanceToBox(const Vec3& p, const Vec3& low, const Vec3& high)
{
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

/// The nearest point of a triangle where the cross product of b - a and c - a is known.
Vec3 nearestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n)
{
  const Vec3 e0 = b - a;
  const Vec3 e1 = c - a;
  const double nn = n.squaredNorm();
  const double longest = std::max(e0.squaredNorm(), e1.squaredNorm());
  std::array<bool, 3> beyond = {true, true, true}; // the sides from a, b and c
  if (nn > 1e-24 * longest * longest)
  {
    const Vec3 w = p - a;
    const double beta = w.cross(e1).dot(n) / nn;
    const double gamma = e0.cross(w).dot(n) / nn;
    if (beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0)
    {
      return a + beta * e0 + gamma * e1;
    }
    if (nn > Sound * longest * longest)
    {
      beyond[0] = gamma < Near;
      beyond[1] = beta + gamma > 1.0 - Near;
      beyond[2] = beta < Near;
    }
  }
  Vec3 best = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  const std::array<const Vec3*, 4> corners = {&a, &b, &c, &a};
  for (int k = 0; k < 3; ++k)
  {
    if (beyond[k])
    {
      const Vec3 q = nearestOnSegment(p, *corners[k], *corners[k + 1]);
      const double d = (q - p).squaredNorm();
      if (d < least)
      {
        least = d;
        best = q;
      }
    }
  }
  return best;
}
} // namespace

Vec3 nearestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  return nearestOnTriangle(p, a, b, c, (b - a).cross(c - a));
}

TriangleTree::TriangleTree(std::vector<Vec3> points, std::vector<std::array<Index, 3>> triangles)
{
  Monitor quiet;
  *this = TriangleTree(std::move(points), std::move(triangles), quiet);
}

TriangleTree::TriangleTree(
  std::vector<Vec3> points, std::vector<std::array<Index, 3>> triangles, Monitor& monitor)
    : Points(std::move(points)), Triangles(std::move(triangles))
{
  std::vector<Vec3> centers;
  centers.reserve(this->Triangles.size());
  for (const auto& t : this->Triangles)
  {
    centers.push_back((this->Points[t[0]] + this->Points[t[1]] + this->Points[t[2]]) / 3.0);
  }
  this->Cross.reserve(this->Triangles.size());
  this->Square.reserve(this->Triangles.size());
  for (const auto& t : this->Triangles)
  {
    const Vec3 e0 = this->Points[t[1]] - this->Points[t[0]];
    const Vec3 e1 = this->Points[t[2]] - this->Points[t[0]];
    const Vec3 n = e0.cross(e1);
    const double longest = std::max(e0.squaredNorm(), e1.squaredNorm());
    this->Cross.push_back(n);
    this->Square.push_back(n.squaredNorm() > Sound * longest * longest ? n.squaredNorm() : 0.0);
  }
  this->Order.resize(this->Triangles.size());
  std::iota(this->Order.begin(), this->Order.end(), 0);
  if (!this->Order.empty())
  {
    this->Nodes.reserve(this->Triangles.size());
    this->build(this->Order, centers, 0, static_cast<Index>(this->Order.size()), monitor);
  }
}

void TriangleTree::grow(Node& node, Index triangle) const
{
  for (Index v : this->Triangles[triangle])
  {
    node.Low = node.Low.cwiseMin(this->Points[v]);
    node.High = node.High.cwiseMax(this->Points[v]);
  }
}

Index TriangleTree::build(std::vector<Index>& order, const std::vector<Vec3>& centers, Index first,
  Index last, Monitor& monitor)
{
  const auto id = static_cast<Index>(this->Nodes.size());
  Node node;
  node.Low = Vec3::Constant(std::numeric_limits<double>::infinity());
  node.High = -node.Low;
  Vec3 low = node.Low;
  Vec3 high = node.High;
  for (Index i = first; i < last; ++i)
  {
    this->grow(node, order[i]);
    low = low.cwiseMin(centers[order[i]]);
    high = high.cwiseMax(centers[order[i]]);
  }
  this->Nodes.push_back(node);
  if (last - first <= LeafSize || (last - first >= Portion && monitor.cancelled()))
  {
    this->Nodes[id].First = first;
    this->Nodes[id].Count = last - first;
    this->boundCrosses(this->Nodes[id]);
    return id;
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const Index middle = first + (last - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last,
    [&](Index a, Index b)
    { return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis] : a < b; });
  const Index left = this->build(order, centers, first, middle, monitor);
  const Index second = this->build(order, centers, middle, last, monitor);
  Node& made = this->Nodes[id];
  made.First = second;
  made.LowCross = this->Nodes[left].LowCross.cwiseMin(this->Nodes[second].LowCross);
  made.HighCross = this->Nodes[left].HighCross.cwiseMax(this->Nodes[second].HighCross);
  return id;
}

void TriangleTree::visit(const Vec3& p, Index triangle, NearestOnTriangle& best) const
{
  const auto& t = this->Triangles[triangle];
  const Vec3& a = this->Points[t[0]];
  const Vec3& n = this->Cross[triangle];
  const double height = n.dot(p - a);
  const double square = this->Square[triangle];
  if (square > 0.0 && height * height * Slack >= best.SquaredDistance * square)
  {
    return; // its plane is too far
  }
  const Vec3 q = nearestOnTriangle(p, a, this->Points[t[1]], this->Points[t[2]], n);
  const double d = (q - p).squaredNorm();
  if (d < best.SquaredDistance)
  {
    best = {triangle, q, d};
  }
}

void TriangleTree::boundCrosses(Node& node) const
{
  node.LowCross = node.HighCross = this->Cross[this->Order[node.First]];
  for (Index i = node.First + 1; i < node.First + node.Count; ++i)
  {
    const Vec3& n = this->Cross[this->Order[i]];
    node.LowCross = node.LowCross.cwiseMin(n);
    node.HighCross = node.HighCross.cwiseMax(n);
  }
}

template <class MayHold, class Allowed>
void TriangleTree::search(
  const Vec3& p, NearestOnTriangle& best, const MayHold& mayHold, const Allowed& allowed) const
{
  if (this->Nodes.empty())
  {
    return;
  }
  std::array<std::pair<Index, double>, 96> stack;
  int top = 0;
  stack[top++] = {0, 0.0};
  while (top > 0)
  {
    const auto [id, bound] = stack[--top];
    if (bound >= best.SquaredDistance)
    {
      continue;
    }
    const Node& node = this->Nodes[id];
    if (!mayHold(node))
    {
      continue;
    }
    for (Index i = node.First; i < node.First + node.Count; ++i)
    {
      if (allowed(this->Order[i]))
      {
        this->visit(p, this->Order[i], best);
      }
    }
    if (node.Count == 0)
    {
      std::pair<Index, double> a{id + 1, 0.0};
      std::pair<Index, double> b{node.First, 0.0};
      a.second = squaredDistanceToBox(p, this->Nodes[a.first].Low, this->Nodes[a.first].High);
      b.second = squaredDistanceToBox(p, this->Nodes[b.first].Low, this->Nodes[b.first].High);
      if (a.second < b.second)
      {
        std::swap(a, b);
      }
      stack[top++] = a;
      stack[top++] = b;
    }
  }
}

NearestOnTriangle TriangleTree::nearest(const Vec3& p) const
{
  NearestOnTriangle best;
  this->search(
    p, best, [](const Node&) { return true; }, [](Index) { return true; });
  return best;
}

NearestOnTriangle TriangleTree::nearestFacing(
  const Vec3& p, const Vec3& direction, double most, Index hint) const
{
  NearestOnTriangle best;
  best.SquaredDistance = most * most;
  const auto allowed = [&](Index triangle) { return this->Cross[triangle].dot(direction) > 0.0; };
  if (hint >= 0 && allowed(hint))
  {
    this->visit(p, hint, best);
  }
  this->search(
    p, best,
    [&](const Node& node)
    {
      const Vec3 low = node.LowCross.cwiseProduct(direction);
      return low.cwiseMax(node.HighCross.cwiseProduct(direction)).sum() > 0.0;
    },
    allowed);
  return best.Triangle >= 0 ? best : this->nearest(p);
}

Vec3 TriangleTree::normal(Index triangle) const
{
  const Vec3& n = this->Cross[triangle];
  const double length = n.norm();
  return length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero());
}
} // namespace bsr
