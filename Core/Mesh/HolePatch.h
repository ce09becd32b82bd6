#pragma once

#include "Mesh/ImplicitSurface.h"
#include "Mesh/TriangleSurface.h"

#include <functional>

namespace bsr
{
/**
 * The triangles that fill one hole. Made from a triangulation of the loop; refined to the sampling
 * density of the loop's surroundings; moved onto an implicit surface that continues them. The
 * loop's own points stay where they are.
 */
class HolePatch
{
public:
  /// \param loop points of the loop, the first vertices of the patch
  /// \param triangles of the loop (see triangulateLoop)
  /// \param spacing edge length wanted at each point of the loop
  /// \param taken says of two points of the loop that they are joined outside the patch
  HolePatch(const std::vector<Vec3>& loop, const std::vector<std::array<Index, 3>>& triangles,
    const std::vector<double>& spacing, std::function<bool(Index, Index)> taken);

  /// Gives the patch the shape of a smooth membrane at the sampling density.
  void refine();

  /**
   * Moves the inner vertices onto the zero set, refining as the patch grows. False where that does
   * not work out: a vertex is farther than a tenth of its spacing from it, or the patch folds
   * (neighbors more than 100 degrees against each other). The patch is as refine() left it then.
   */
  bool project(const ImplicitSurface& implicit);

  std::vector<Vec3> innerPoints() const; ///< those after the loop's
  std::vector<std::array<Index, 3>> triangles() const;

private:
  void split();
  void collapse();
  bool joinable(Index a, Index b) const;
  bool keepsChords(Index h) const;
  void flip();
  void relax(bool tangential);
  void pull(const ImplicitSurface& implicit);
  std::vector<Index> folds() const;
  void unfold();
  bool sound(const ImplicitSurface& implicit) const;
  bool inner(Index v) const { return v >= this->LoopSize && !this->Surface.Virtual[v]; }
  bool real(Index h) const
  {
    return this->Surface.Vertex[h] >= 0 && !this->Surface.Virtual[this->Surface.start(h)] &&
           !this->Surface.Virtual[this->Surface.end(h)];
  }
  double relative(Index h) const;
  void setSpacing(Index v);

  TriangleSurface Surface;
  Index LoopSize = 0;
  std::vector<double> Spacing;
  std::function<bool(Index, Index)> Taken;
};
} // namespace bsr
