#include "Contour/SkinTree.h"

#include <algorithm>
#include <map>

namespace bsr
{
namespace
{
/// The part of a tree from `node` on.
SkinTree subtree(const SkinTree& tree, Index node)
{
  SkinTree sub;
  sub.Up = tree.Up;
  std::vector<Index> source{node};
  sub.Nodes.push_back({tree.Nodes[node].Contour, {}});
  for (std::size_t n = 0; n < source.size(); ++n)
  {
    for (const Index child : tree.Nodes[source[n]].Children)
    {
      sub.Nodes[n].Children.push_back(static_cast<Index>(sub.Nodes.size()));
      sub.Nodes.push_back({tree.Nodes[child].Contour, {}});
      source.push_back(child);
    }
  }
  return sub;
}

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
    const SkinTree& legs = up.Nodes.size() == 1 ? down : up;
    if (isRoot && !this->endsClosed(legs.Nodes[0].Contour, legs.Nodes[1].Contour))
    {
      piece.Legs = legs;
      return piece;
    }
    piece.Closed = true;
    if (isRoot)
    {
      this->closeBase(legs, piece);
    }
    else
    {
      this->closeBoth(down, up, piece);
    }
    return piece;
  }

  static SkinTree lineOf(const std::vector<Index>& contours, bool up)
  {
    SkinTree tree;
    tree.Up = up;
    for (std::size_t i = 0; i < contours.size(); ++i)
    {
      tree.Nodes.push_back({contours[i], {}});
      if (i + 1 < contours.size())
      {
        tree.Nodes.back().Children.push_back(static_cast<Index>(i) + 1);
      }
    }
    return tree;
  }

  /// How many contours of a line from its end on the cap takes: those closer to the end than half
  /// a diameter, but not all.
  std::size_t capLength(const std::vector<Index>& line) const
  {
    const Contour& end = this->contour(line.back());
    std::size_t n = 1;
    while (n + 2 < line.size() &&
           std::abs(this->Stack.Slices[this->contour(line[line.size() - 1 - n]).Slice].Position -
                    this->Stack.Slices[end.Slice].Position) <
             0.4 * this->contour(line[line.size() - 1 - n]).diameter())
    {
      ++n;
    }
    return n;
  }

  /// A tree whose root end is to be closed: its first chain becomes cap and trunk.
  void closeBase(const SkinTree& legs, SkinPiece& piece) const
  {
    const std::vector<Index> nodes = legs.chain(0);
    std::vector<Index> line; // contours from the split (or the far end) to the root
    for (const Index n : nodes)
    {
      line.push_back(legs.Nodes[n].Contour);
    }
    std::reverse(line.begin(), line.end());
    const bool tube = !legs.splits();
    std::vector<Index> reversed(line.rbegin(), line.rend());
    const std::size_t near = tube ? std::min(this->capLength(reversed), line.size() / 3) : 0;
    const std::size_t far = std::min(this->capLength(line), (line.size() - near - 1) / 2);
    // trunk: line[near .. size - 1 - far]
    const std::size_t last = line.size() - 1 - far;
    piece.Trunk.assign(line.begin() + static_cast<std::ptrdiff_t>(near),
      line.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    const SkinTree inner =
      tube ? lineOf(std::vector<Index>(
                      reversed.end() - 1 - static_cast<std::ptrdiff_t>(near), reversed.end()),
               legs.Up)
           : subtree(legs, nodes.back());
    const SkinTree outer = lineOf(
      std::vector<Index>(line.begin() + static_cast<std::ptrdiff_t>(last), line.end()), !legs.Up);
    piece.Lower = legs.Up ? outer : inner;
    piece.Upper = legs.Up ? inner : outer;
    if (legs.Up)
    {
      std::reverse(piece.Trunk.begin(), piece.Trunk.end());
    }
  }

  void closeBoth(const SkinTree& down, const SkinTree& up, SkinPiece& piece) const
  {
    const std::vector<Index> low = down.chain(0);
    const std::vector<Index> high = up.chain(0);
    for (auto n = low.rbegin(); n != low.rend(); ++n)
    {
      piece.Trunk.push_back(down.Nodes[*n].Contour);
    }
    for (std::size_t n = 1; n < high.size(); ++n)
    {
      piece.Trunk.push_back(up.Nodes[high[n]].Contour);
    }
    piece.Lower = subtree(down, low.back());
    piece.Upper = subtree(up, high.back());
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

bool SkinTree::splits() const
{
  return std::any_of(this->Nodes.begin(), this->Nodes.end(),
    [](const SkinNode& n) { return n.Children.size() > 1; });
}

SkinPiece asTrunk(const SkinPiece& open)
{
  SkinPiece piece;
  std::vector<Index> nodes = open.Legs.chain(0);
  // without a split the last third of the line closes the end
  const std::size_t keep =
    open.Legs.splits() ? nodes.size() : std::max<std::size_t>(2, 2 * nodes.size() / 3);
  nodes.resize(std::min(keep, nodes.size()));
  for (const Index n : nodes)
  {
    piece.Trunk.push_back(open.Legs.Nodes[n].Contour);
  }
  (open.Legs.Up ? piece.Upper : piece.Lower) = subtree(open.Legs, nodes.back());
  if (!open.Legs.Up)
  {
    std::reverse(piece.Trunk.begin(), piece.Trunk.end());
  }
  return piece;
}

std::vector<SkinPiece> cutPieces(
  const ContourStack& stack, SkinBase base, std::vector<ContourNote>& notes)
{
  return Cutter(stack, base, notes).run();
}
} // namespace bsr
