#ifndef PublishedSurfaces_h
#define PublishedSurfaces_h

#include "Contour/DisjointSurface.h"

#include <array>
#include <cmath>

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

/// The model of section 6 with open uniform knots (section 7, figure 10): in both directions (a),
/// or along v only (b).
inline DisjointSurface uniformSurface(bool alongU)
{
  DisjointSurface s = publishedSurface(PublishedModel::Asymmetric);
  s.UniformU = alongU;
  s.UniformV = true;
  return s;
}

/// A polygon of four corners that starts and ends on an edge (section 5.2: with that edge's two
/// points) or in a point of it (section 6: twice).
inline ControlRow openPolygon(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
  const Vec3& e, const Vec3& f, bool point)
{
  const Vec3 start = 0.5 * (a + b);
  const Vec3 end = 0.5 * (e + f);
  return point ? ControlRow{start, start, b, c, d, e, end, end} : ControlRow{a, b, c, d, e, f};
}

/// Two stages by one equation (section 8, figure 11): branches 1 and 2, front and back, join to the
/// left one, which joins branch 3. `point`: arranged as in section 6 (figure 11 (a)), else as
/// in 5.2 (b). Sections of the branches are turned across their axes.
inline DisjointSurface twoStageSurface(bool point)
{
  DisjointSurface s;
  s.Counts.assign(3, point ? 8 : 6);
  const auto add = [&](const std::array<ControlRow, 3>& curves)
  {
    ControlRow row;
    for (const ControlRow& c : curves)
    {
      append(row, c);
    }
    s.Rows.push_back(std::move(row));
  };
  // a square that opens in the middle of its edge towards `in`, its edge at distance `at` from
  // there
  const auto square = [&](const Vec3& middle, const Vec3& in, double turn)
  {
    const Vec3 along = in.cross(Vec3::UnitZ()) * -1.0; // counterclockwise: in, then left of it
    const Vec3 out = -std::cos(turn) * in - std::sin(turn) * Vec3::UnitZ();
    const auto p = [&](double l, double o) { return Vec3(middle + l * along + o * out); };
    return openPolygon(p(-1, 0), p(1, 0), p(1, 2), p(-1, 2), p(-1, 0), p(1, 0), point);
  };
  const Vec3 front(0, 1, 0); // the way to the other branch
  const Vec3 left(1, 0, 0);
  // the left one of two halves; its right side lies at x
  const auto lower = [&](double x, double z)
  {
    return openPolygon(Vec3(-4.2, 0.6, z), Vec3(-4.2, -0.6, z), Vec3(-4.2, -2.2, z),
      Vec3(x, -2.2, z), Vec3(x, -0.6, z), Vec3(x, 0.6, z), point);
  };
  const auto upper = [&](double x, double z)
  {
    return openPolygon(Vec3(x, -0.6, z), Vec3(x, 0.6, z), Vec3(x, 2.2, z), Vec3(-4.2, 2.2, z),
      Vec3(-4.2, 0.6, z), Vec3(-4.2, -0.6, z), point);
  };
  const auto right = [&](double x, double z)
  {
    return openPolygon(Vec3(x, 0.6, z), Vec3(x, -0.6, z), Vec3(3.4, -1.2, z), Vec3(3.4, 1.2, z),
      Vec3(x, 0.6, z), Vec3(x, -0.6, z), point);
  };
  for (int k = 0; k < 4; ++k) // apart, and turned
  {
    const double apart = 1.0 - 0.2 * k;
    const double turn = 0.15 * (3 - k);
    add({square(Vec3(-2.6, -apart, 0.7 * k), front, turn),
      square(Vec3(-2.6, apart, 0.7 * k), -front, turn), right(1.0, 0.7 * k)});
  }
  for (const double z : {2.8, 3.4}) // the first two share an edge
  {
    add(
      {square(Vec3(-2.6, 0, z), front, 0.0), square(Vec3(-2.6, 0, z), -front, 0.0), right(1.0, z)});
  }
  for (int k = 0; k < 4; ++k)
  {
    const double z = 4.2 + 0.7 * k;
    add({lower(-1.0 + 0.15 * k, z), upper(-1.0 + 0.15 * k, z), right(1.0 - 0.15 * k, z)});
  }
  for (const double z : {7.0, 7.6}) // the left one and the third share one
  {
    add({lower(0.0, z), upper(0.0, z), right(0.0, z)});
  }
  for (int k = 0; k < 4; ++k)
  {
    const double z = 8.4 + 0.7 * k;
    add({openPolygon(Vec3(-4.2, 0.6, z), Vec3(-4.2, -0.6, z), Vec3(-4.2, -2.2, z),
           Vec3(-1.6, -2.2, z), Vec3(-0.6, -2.2, z), Vec3(0.6, -2.2, z), point),
      openPolygon(Vec3(0.6, 2.2, z), Vec3(-0.6, 2.2, z), Vec3(-1.6, 2.2, z), Vec3(-4.2, 2.2, z),
        Vec3(-4.2, 0.6, z), Vec3(-4.2, -0.6, z), point),
      openPolygon(Vec3(-0.6, -2.2, z), Vec3(0.6, -2.2, z), Vec3(3.4, -2.2, z), Vec3(3.4, 2.2, z),
        Vec3(0.6, 2.2, z), Vec3(-0.6, 2.2, z), point)});
  }
  return s;
}

} // namespace bsrtest

#endif
