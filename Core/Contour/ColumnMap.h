#pragma once

#include "Contour/BranchedNetwork.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bsr
{
/// Piecewise linear through (from, to); both increase.
inline double interpolated(const std::vector<double>& from, const std::vector<double>& to, double x)
{
  const auto next = std::upper_bound(from.begin() + 1, from.end() - 1, x);
  const auto i = static_cast<std::size_t>(next - from.begin());
  const double width = from[i] - from[i - 1];
  const double r = width > 0.0 ? std::clamp((x - from[i - 1]) / width, 0.0, 1.0) : 0.0;
  return (1.0 - r) * to[i - 1] + r * to[i];
}

inline double fraction(double x)
{
  return x - std::floor(x);
}

/// Columns at which something of a tube's end is fixed to a place on its contour.
struct Anchor
{
  int Column;
  double Share;
};

/// Monotone periodic map from columns to shares through anchors (F. Fritsch, R. Carlson, SIAM J.
/// Numer. Anal. 17, 1980; harmonic means of the slopes).
class ColumnMap
{
public:
  ColumnMap(std::vector<Anchor> anchors, int columns) : Anchors(std::move(anchors)), N(columns)
  {
    std::sort(this->Anchors.begin(), this->Anchors.end(),
      [](const Anchor& a, const Anchor& b) { return a.Column < b.Column; });
    for (std::size_t i = 1; i < this->Anchors.size(); ++i) // unwrap
    {
      const double before = this->Anchors[i - 1].Share;
      this->Anchors[i].Share += std::ceil(before - this->Anchors[i].Share);
    }
  }

  double at(double u) const
  {
    const auto r = static_cast<int>(this->Anchors.size());
    int turn = 0;
    while (u < this->Anchors[0].Column)
    {
      u += this->N;
      --turn;
    }
    while (u >= this->Anchors[0].Column + this->N)
    {
      u -= this->N;
      ++turn;
    }
    int i = r - 1;
    while (i > 0 && this->Anchors[i].Column > u)
    {
      --i;
    }
    const double length = this->width(i);
    const double x = (u - this->Anchors[i].Column) / length;
    const double rise = this->rise(i);
    const double m0 = this->slope(i) * length;
    const double m1 = this->slope(i + 1) * length;
    const double h01 = x * x * (3.0 - 2.0 * x);
    return turn + this->Anchors[i].Share + rise * h01 + m0 * x * (1.0 - x) * (1.0 - x) -
           m1 * x * x * (1.0 - x);
  }

private:
  int index(int i) const
  {
    const auto r = static_cast<int>(this->Anchors.size());
    return (i % r + r) % r;
  }
  double width(int i) const
  {
    const int a = this->index(i);
    const int b = this->index(i + 1);
    return this->Anchors[b].Column - this->Anchors[a].Column + (b <= a ? this->N : 0);
  }
  double rise(int i) const
  {
    const int a = this->index(i);
    const int b = this->index(i + 1);
    return this->Anchors[b].Share - this->Anchors[a].Share + (b <= a ? 1.0 : 0.0);
  }
  double slope(int i) const
  {
    const double before = this->rise(i - 1) / this->width(i - 1);
    const double after = this->rise(i) / this->width(i);
    return before > 0.0 && after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
  }

  std::vector<Anchor> Anchors;
  int N;
};

/// An arc of a junction as one of the tubes at it sees it.
struct ArcEnd
{
  JunctionArc* Arc;
  bool Stem;
  double share() const { return this->Stem ? this->Arc->StemShare : this->Arc->BranchShare; }
  double length() const { return this->Stem ? this->Arc->StemLength : this->Arc->BranchLength; }
  const std::vector<double>& places() const
  {
    return this->Stem ? this->Arc->Match.Second : this->Arc->Match.First;
  }
  int& column() const { return this->Stem ? this->Arc->StemColumn : this->Arc->BranchColumn; }
};

/// What is known of a tube's columns while they are assigned.
struct ColumnLayout
{
  std::vector<ArcCurve> Curves; ///< of its contours, in space
  std::vector<double> Start;    ///< aligned origins of the shares
  std::vector<ArcMatch> Next;   ///< places on each contour and on the next one, from the origins
  std::vector<double> Bottom;   ///< share of each column on the lowest contour; empty: free
};
} // namespace bsr
