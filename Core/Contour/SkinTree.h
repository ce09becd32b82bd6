#pragma once

#include "Contour/ContourStack.h"

namespace bsr
{
/// Something to tell about a contour of the stack.
struct ContourNote
{
  Index Contour = -1;
  std::string Text;
};

/// A contour in a tree that runs from a root contour down (or up) to the ends of its legs.
struct SkinNode
{
  Index Contour = -1;
  std::vector<Index> Children; ///< nodes
};

/// Node 0 is the root; all children lie on one side of their parents.
struct SkinTree
{
  bool Up = false; ///< the legs lie above the root
  std::vector<SkinNode> Nodes;

  /// Nodes from `node` on that have one child each, up to and with a leaf or a split.
  std::vector<Index> chain(Index node) const;
};

/**
 * A part of the stack without loops and turns. An open one has its root contour as border and its
 * tree in Legs; a closed one has a tree to both sides of its root, one of which may be the root
 * alone.
 */
struct SkinPiece
{
  bool Closed = false;
  SkinTree Legs;  ///< of an open piece
  SkinTree Other; ///< of a closed piece: beyond the root of Legs

  std::vector<Index> contours() const;
};

enum class SkinBase
{
  Automatic, ///< closed where the root contour shrinks towards its end or ends inside the stack
  Open,
  Closed
};

/**
 * Cuts the graph of closed contours into pieces with legs on one side (paper 004's trousers, any
 * number of legs and levels) or, closed, on both. Links that close a loop (a handle) or turn back
 * (down and up again) are cut: their legs end there, and a note says so. Contours without any
 * partner get a note and are in no piece.
 */
std::vector<SkinPiece> cutPieces(
  const ContourStack& stack, SkinBase base, std::vector<ContourNote>& notes);
} // namespace bsr
