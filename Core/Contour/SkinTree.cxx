#include "Contour/SkinTree.h"

#include <algorithm>
#include <map>

namespace bsr
{
namespace
{
/// Cuts the graph piece by piece; contours of finished pieces are taken.
class Cutter
{
public:
  Cutter(const ContourStack& stack, SkinBase base, std::vector<ContourNote>& notes)
      : Stack(stack), Base(base), Notes(notes), Taken(stack.Contours.size(), 0)
  {
  }

  std::vector<SkinPiece> run()
  {
    std::vector<SkinPiece> pieces;
    for (Index component = 0; component < this->Stack.Components; ++component)
    {
      for (Index root = this->bestRoot(component); root >= 0; root = this->bestRoot(component))
      {
        const SkinTree down = this->grow(root, false);
        const SkinTree up = this->grow(root, true);
        if (down.Nodes.size() + up.Nodes.size() == 2)
        {
          this->Taken[root] = 1;
          this->Notes.push_back(
            {root, "is linked to no contour of a neighboring slice, so there is nothing to skin"});
          continue;
        }
        this->take(down);
        this->take(up);
        pieces.push_back(this->assemble(down, up));
      }
    }
    this->noteCuts();
    return pieces;
  }

private:
  const Contour& contour(Index c) const { return this->Stack.Contours[c]; }
  const std::vector<Index>& next(Index c, bool up) const
  {
    return up ? this->contour(c).Above : this->contour(c).Below;
  }

  /// All contours reached from the root in one direction, slice by slice; one reached from several
  /// contours stays with the largest of them.
  SkinTree grow(Index root, bool up) const
  {
    SkinTree tree;
    tree.Up = up;
    tree.Nodes.push_back({root, {}});
    for (std::size_t first = 0; first < tree.Nodes.size();)
    {
      const std::size_t end = tree.Nodes.size();
      std::map<Index, Index> parent; // node by child contour
      for (std::size_t n = first; n < end; ++n)
      {
        for (const Index child : this->next(tree.Nodes[n].Contour, up))
        {
          const auto [it, fresh] = parent.emplace(child, static_cast<Index>(n));
          if (!fresh && this->contour(tree.Nodes[n].Contour).Area >
                          this->contour(tree.Nodes[it->second].Contour).Area)
          {
            it->second = static_cast<Index>(n);
          }
        }
      }
      for (const auto& [child, node] : parent)
      {
        if (!this->Taken[child])
        {
          tree.Nodes[node].Children.push_back(static_cast<Index>(tree.Nodes.size()));
          tree.Nodes.push_back({child, {}});
        }
      }
      first = end;
    }
    return tree;
  }

  void take(const SkinTree& tree)
  {
    for (const SkinNode& n : tree.Nodes)
    {
      this->Taken[n.Contour] = 1;
      for (const Index child : n.Children)
      {
        const Index c = tree.Nodes[child].Contour;
        this->Kept.emplace_back(std::min(n.Contour, c), std::max(n.Contour, c));
      }
    }
  }

  /// The contour that reaches most others going straight down and straight up; among equals one
  /// with nothing on one side, then the largest.
  Index bestRoot(Index component) const
  {
    Index best = -1;
    std::array<double, 3> bestScore{};
    for (std::size_t i = 0; i < this->Taken.size(); ++i)
    {
      const auto c = static_cast<Index>(i);
      if (this->Taken[i] || this->contour(c).Component != component || !this->contour(c).Closed)
      {
        continue;
      }
      const std::size_t down = this->grow(c, false).Nodes.size();
      const std::size_t up = this->grow(c, true).Nodes.size();
      const std::array<double, 3> score{
        static_cast<double>(down + up), down == 1 || up == 1 ? 1.0 : 0.0, this->contour(c).Area};
      if (best < 0 || score > bestScore)
      {
        best = c;
        bestScore = score;
      }
    }
    return best;
  }

  bool endsClosed(Index root, Index neighbor) const
  {
    if (this->Base != SkinBase::Automatic)
    {
      return this->Base == SkinBase::Closed;
    }
    const Index slice = this->contour(root).Slice;
    const bool atEnd = slice == 0 || slice == static_cast<Index>(this->Stack.Slices.size()) - 1;
    return !atEnd || this->contour(root).Area < 0.5 * this->contour(neighbor).Area;
  }

  SkinPiece assemble(const SkinTree& down, const SkinTree& up) const
  {
    SkinPiece piece;
    const bool isRoot = down.Nodes.size() == 1 || up.Nodes.size() == 1;
    piece.Legs = up.Nodes.size() == 1 ? down : up;
    piece.Other = up.Nodes.size() == 1 ? up : down;
    piece.Closed =
      !isRoot || this->endsClosed(piece.Legs.Nodes[0].Contour, piece.Legs.Nodes[1].Contour);
    return piece;
  }

  void noteCuts()
  {
    std::sort(this->Kept.begin(), this->Kept.end());
    for (const ContourLink& l : this->Stack.Links)
    {
      const std::pair<Index, Index> key(std::min(l.Lower, l.Upper), std::max(l.Lower, l.Upper));
      if (this->contour(l.Lower).Closed &&
          !std::binary_search(this->Kept.begin(), this->Kept.end(), key))
      {
        this->Notes.push_back({l.Lower, "its link to contour " + std::to_string(l.Upper) +
                                          " is cut, as it closes a loop or turns back; the leg "
                                          "ends there"});
      }
    }
  }

  const ContourStack& Stack;
  SkinBase Base;
  std::vector<ContourNote>& Notes;
  std::vector<char> Taken;
  std::vector<std::pair<Index, Index>> Kept;
};
} // namespace

std::vector<Index> SkinTree::chain(Index node) const
{
  std::vector<Index> nodes{node};
  while (this->Nodes[nodes.back()].Children.size() == 1)
  {
    nodes.push_back(this->Nodes[nodes.back()].Children[0]);
  }
  return nodes;
}

std::vector<Index> SkinPiece::contours() const
{
  std::vector<Index> all;
  for (const SkinNode& n : this->Legs.Nodes)
  {
    all.push_back(n.Contour);
  }
  for (std::size_t n = 1; n < this->Other.Nodes.size(); ++n)
  {
    all.push_back(this->Other.Nodes[n].Contour);
  }
  return all;
}

std::vector<SkinPiece> cutPieces(
  const ContourStack& stack, SkinBase base, std::vector<ContourNote>& notes)
{
  return Cutter(stack, base, notes).run();
}
} // namespace bsr
