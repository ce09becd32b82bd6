#pragma once

#include "Contour/SampleContour.h"

namespace bsr
{
/// Corresponding places along two curve pieces, at equal steps: shares of their lengths, each
/// starting at 0 and ending at 1.
struct ArcMatch
{
  std::vector<double> First;
  std::vector<double> Second;
};

/**
 * Monotone correspondence of two pieces, from share a.From over a.Length (of closed curves), that
 * makes the sum of squared distances small (dynamic time warping: H. Sakoe, S. Chiba, IEEE Trans.
 * ASSP 26, 1978), evened out so that neither stands still. Steps + 1 places.
 */
struct ArcPiece
{
  const ArcCurve* Curve = nullptr;
  double From = 0.0;
  double Length = 1.0;
};
struct MatchOptions
{
  int Steps = 128;
  double Evenness = 0.3; ///< share of the uniform correspondence
  bool Center = false;   ///< compare the pieces with equal means
};
ArcMatch matchArcs(const ArcPiece& first, const ArcPiece& second, const MatchOptions& options = {});
} // namespace bsr
