#pragma once

#include "Layout/LayoutDraft.h"

namespace bsr
{
/**
 * A chord (polychord): the strip of quads reached by always leaving a quad over the side opposite
 * to the one it was entered by; closed, or from boundary to boundary. May cross itself.
 */
struct Chord
{
  std::vector<std::array<Index, 2>> Rungs; ///< edges across the strip, each once, as point pairs
  std::vector<Index> Quads;                ///< each once
  double Width = 0.0; ///< mean length of the rungs, relative to the side wanted there
  bool Twice = false; ///< crosses itself
  double Gain = 0.0;  ///< change of the irregularity if the strip is taken out
};

/// All chords of a layout; `sides` is the side wanted at each point.
std::vector<Chord> chordsOf(const LayoutDraft& draft, const std::vector<double>& sides);

/**
 * The layout without the strip: each rung shrinks to a point (Daniels et al. 2008). Empty where
 * that would touch a corner twice or merge creases; the caller has to check the topology.
 * `merged` receives the points that rungs became.
 */
LayoutDraft withoutChord(
  const LayoutDraft& draft, const Chord& chord, std::vector<Index>* merged = nullptr);

/// The layout with the strip split in two along its middle.
LayoutDraft withSplitChord(const LayoutDraft& draft, const Chord& chord);
} // namespace bsr
