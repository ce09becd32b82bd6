#pragma once

#include "Common/Types.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace bsr
{
/// An axis-aligned box; empty until a point is added.
struct Box
{
  Vec3 Min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 Max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& p)
  {
    this->Min = this->Min.cwiseMin(p);
    this->Max = this->Max.cwiseMax(p);
  }
  void add(const Box& b)
  {
    this->Min = this->Min.cwiseMin(b.Min);
    this->Max = this->Max.cwiseMax(b.Max);
  }
  Vec3 center() const { return 0.5 * (this->Min + this->Max); }
  /// Squared distance from a point; 0 inside.
  double squaredDistance(const Vec3& p) const
  {
    const Vec3 d = (this->Min - p).cwiseMax(p - this->Max).cwiseMax(0.0);
    return d.squaredNorm();
  }
};

/**
 * Bounding-volume tree over boxes, for nearest-item queries. Built in O(n log n) by halving along
 * the longest axis of the boxes' centers; the same boxes always give the same tree.
 */
class BoxTree
{
public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box>& boxes)
  {
    std::vector<Index> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    this->Nodes.reserve(2 * boxes.size());
    if (!boxes.empty())
    {
      this->build(boxes, order.data(), order.data() + order.size());
    }
  }

  /**
   * Calls visit(item) for every item whose box may lie within sqrt(bound) of p, the nearer subtree
   * first. `visit` lowers `bound` (a squared distance) as it finds better items. Items whose box
   * is exactly as far as the bound are visited too, so that ties can be broken by the visitor.
   */
  template <class Visit>
  void nearest(const Vec3& p, const double& bound, Visit&& visit) const
  {
    if (this->Nodes.empty())
    {
      return;
    }
    struct Entry
    {
      Index Node;
      double Distance;
    };
    std::array<Entry, 64> stack; // depth is at most log2(2^31) + 1
    int top = 0;
    stack[top++] = {0, this->Nodes[0].Bounds.squaredDistance(p)};
    while (top > 0)
    {
      const Entry e = stack[--top];
      if (e.Distance > bound)
      {
        continue;
      }
      const Node& node = this->Nodes[e.Node];
      if (node.Item >= 0)
      {
        visit(node.Item);
        continue;
      }
      const Index left = e.Node + 1;
      const double dl = this->Nodes[left].Bounds.squaredDistance(p);
      const double dr = this->Nodes[node.Right].Bounds.squaredDistance(p);
      const bool leftFirst = dl <= dr;
      stack[top++] = leftFirst ? Entry{node.Right, dr} : Entry{left, dl};
      stack[top++] = leftFirst ? Entry{left, dl} : Entry{node.Right, dr};
    }
  }

private:
  struct Node
  {
    Box Bounds;
    Index Right = -1; ///< the left child follows its parent
    Index Item = -1;  ///< of a leaf
  };

  Index build(const std::vector<Box>& boxes, Index* begin, Index* end)
  {
    const auto id = static_cast<Index>(this->Nodes.size());
    this->Nodes.emplace_back();
    if (end - begin == 1)
    {
      this->Nodes[id].Bounds = boxes[*begin];
      this->Nodes[id].Item = *begin;
      return id;
    }
    Box bounds;
    Box centers;
    for (const Index* i = begin; i != end; ++i)
    {
      bounds.add(boxes[*i]);
      centers.add(boxes[*i].center());
    }
    int axis = 0;
    (centers.Max - centers.Min).maxCoeff(&axis);
    Index* middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end,
      [&](Index a, Index b)
      {
        const double ca = boxes[a].Min[axis] + boxes[a].Max[axis];
        const double cb = boxes[b].Min[axis] + boxes[b].Max[axis];
        return ca != cb ? ca < cb : a < b;
      });
    this->Nodes[id].Bounds = bounds;
    this->build(boxes, begin, middle);
    const Index right = this->build(boxes, middle, end);
    this->Nodes[id].Right = right;
    return id;
  }

  std::vector<Node> Nodes;
};
} // namespace bsr
