#ifndef PublishedSurfaces_h
#define PublishedSurfaces_h

#include "Contour/DisjointSurface.h"

/// The control polyhedra of paper 002's figures, from their description (order 3; the paper gives
/// no coordinates: branches are squares of side 2, the stem a rectangle, slices 1 apart).
namespace bsrtest
{
using bsr::ControlRow;
using bsr::DisjointSurface;
using bsr::Vec3;

enum class PublishedModel
{
  First,          ///< section 3.2: stem polygon traversed twice
  SecondWrapped,  ///< 3.3, figure 4 (a): stem of two open polygons that join
  SecondRepeated, ///< 3.3, figure 4 (d): clamped by repeated points
  Superimposed,   ///< 5.1, figure 6: last sections of the branches superimposed, edges shared
  SharedEdge,     ///< 5.2, figures 7 and 8: two inserted slices share an edge
  Asymmetric      ///< 6, figure 9: they share a repeated point
};

inline void append(ControlRow& row, const ControlRow& more)
{
  row.insert(row.end(), more.begin(), more.end());
}

/// A branch's square about (x, 0), from its inner edge on counterclockwise, first leg wrapped.
/// side: -1 left, 1 right; inner: where the inner edge lies.
inline ControlRow branchSquare(double side, double inner, double z, double half = 1.0)
{
  const double outer = inner + 2.0 * side;
  const double up = -side; // the left branch's inner edge runs up, the right one's down
  return {Vec3(inner, -up * half, z), Vec3(inner, up * half, z), Vec3(outer, up * half, z),
    Vec3(outer, -up * half, z), Vec3(inner, -up * half, z), Vec3(inner, up * half, z)};
}

/// One of the two open polygons of the stem; its first and last legs are shared with the other.
inline ControlRow stemHalf(double side, double z, double front, double back)
{
  const double p = 0.6;
  const double w = 3.0 * side;
  const double start = side < 0.0 ? back : -front; // the left half starts at the back
  const double end = side < 0.0 ? -front : back;
  return {Vec3(-side * p, start, z), Vec3(side * p, start, z), Vec3(w, start, z), Vec3(w, end, z),
    Vec3(side * p, end, z), Vec3(-side * p, end, z)};
}

inline DisjointSurface publishedSurface(PublishedModel model)
{
  DisjointSurface s;
  const bool point = model == PublishedModel::Asymmetric;
  const bool clamped = model == PublishedModel::SecondRepeated;
  const int count = point || clamped ? 8 : 6;
  s.Counts = {count, count};
  // Asymmetric: both polygons start and end twice in one point A of the common line.
  const auto pointed = [](double side, double inner, double z)
  {
    const Vec3 a(inner, 0.3, z);
    ControlRow q = branchSquare(side, inner, z);
    return ControlRow{a, a, q[1], q[2], q[3], q[4], a, a};
  };
  const auto repeated = [](ControlRow q)
  {
    const Vec3 a = 0.5 * (q[0] + q[1]);
    const Vec3 b = 0.5 * (q[4] + q[5]);
    return ControlRow{a, a, q[1], q[2], q[3], q[4], b, b};
  };
  const auto branches = [&](double inner, double z)
  {
    ControlRow row;
    for (const double side : {-1.0, 1.0})
    {
      const ControlRow q = branchSquare(side, side * inner, z);
      append(row, point ? pointed(side, side * inner, z) : clamped ? repeated(q) : q);
    }
    s.Rows.push_back(row);
  };
  for (int k = 0; k < 4; ++k)
  {
    branches(1.0 - 0.2 * k, 0.5 * k);
  }
  const bool inserted = model == PublishedModel::SharedEdge || point;
  for (int k = 0; k < 2 && inserted; ++k)
  {
    branches(0.0, 2.0 + 0.5 * k);
  }
  for (int k = 0; k < 2 && model == PublishedModel::Superimposed; ++k)
  {
    branches(0.0, 2.0);
  }
  for (int k = 0; k < 4; ++k)
  {
    const double z = 3.5 + k;
    ControlRow row;
    for (const double side : {-1.0, 1.0})
    {
      const ControlRow half = stemHalf(side, z, 1.4, point ? 2.2 : 1.4);
      if (model == PublishedModel::First)
      {
        append(row, {Vec3(-3, -1.4, z), Vec3(3, -1.4, z), Vec3(3, 1.4, z), Vec3(-3, 1.4, z),
                      Vec3(-3, -1.4, z), Vec3(3, -1.4, z)});
      }
      else if (point)
      {
        // Clamped where the halves meet; the points beside stand in line (section 3.3).
        const Vec3 a = 0.5 * (half[0] + half[1]);
        const Vec3 b = 0.5 * (half[4] + half[5]);
        append(row, {a, a, half[1], half[2], half[3], half[4], b, b});
      }
      else
      {
        append(row, clamped ? repeated(half) : half);
      }
    }
    s.Rows.push_back(row);
  }
  return s;
}

} // namespace bsrtest

#endif
