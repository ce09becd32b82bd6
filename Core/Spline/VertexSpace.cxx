#include "Spline/VertexSpace.h"

#include "Spline/ThinPlate.h"

#include <Eigen/Dense>

#include <cmath>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// Bezier data of the quads around one vertex.
struct VertexLimit
{
  LinearForm Point;
  std::vector<LinearForm> Tangent;  ///< of each spoke, of the cubic Bezier over a whole side
  std::vector<LinearForm> Interior; ///< of each face, the Bezier point diagonal to the vertex
};

class Limits
{
public:
  explicit Limits(const QuadComplex& complex) : Complex(complex), Column(complex.vertices(), -1)
  {
    for (Index v = 0; v < complex.vertices(); ++v)
    {
      if (complex.fan(v).faces() > 0)
      {
        this->Column[v] = this->Columns++;
      }
    }
  }

  Index columns() const { return this->Columns; }

  VertexLimit at(Index v) const
  {
    const VertexFan& fan = this->Complex.fan(v);
    VertexLimit l = fan.Closed ? this->inner(v, fan) : this->border(v, fan);
    const double n = fan.Closed ? fan.faces() : 2 * fan.faces();
    const int spokes = fan.spokes();
    for (int k = 0; k < fan.faces(); ++k)
    {
      LinearForm i(this->Column[v], n / (n + 5));
      i.add(this->spokeEnd(fan, k), 2 / (n + 5));
      i.add(this->spokeEnd(fan, (k + 1) % spokes), 2 / (n + 5));
      l.Interior.push_back(i.add(this->opposite(fan, k), 1 / (n + 5)));
    }
    return l;
  }

private:
  LinearForm spokeEnd(const VertexFan& fan, int k) const
  {
    if (k < fan.faces())
    {
      return LinearForm(this->Column[this->Complex.to(fan.HalfEdges[k])]);
    }
    const Index h = fan.HalfEdges.back();
    return LinearForm(this->Column[this->Complex.from(h / 4 * 4 + (h + 3) % 4)]);
  }
  LinearForm opposite(const VertexFan& fan, int k) const
  {
    const Index h = fan.HalfEdges[k];
    return LinearForm(this->Column[this->Complex.quad(h / 4)[(h + 2) % 4]]);
  }

  /// The Catmull-Clark limit point and tangents.
  VertexLimit inner(Index v, const VertexFan& fan) const
  {
    const int n = fan.faces();
    const double c = std::cos(Pi / n);
    const double s = std::sqrt(4 + c * c);
    VertexLimit l;
    l.Point = LinearForm(this->Column[v], n / (n + 5.0));
    for (int k = 0; k < n; ++k)
    {
      l.Point.add(this->spokeEnd(fan, k), 4.0 / (n * (n + 5.0)));
      l.Point.add(this->opposite(fan, k), 1.0 / (n * (n + 5.0)));
      LinearForm t;
      for (int j = 0; j < n; ++j)
      {
        const double angle = 2 * Pi * (j - k) / n;
        t.add(this->spokeEnd(fan, j), (1 + c / s) * std::cos(angle) / n);
        t.add(this->opposite(fan, j), std::cos(angle + Pi / n) / (n * s));
      }
      l.Tangent.push_back(std::move(t));
    }
    return l;
  }

  /// A cubic B-spline along the border; the other tangents by least squares in its tangent plane.
  VertexLimit border(Index v, const VertexFan& fan) const
  {
    const int m = fan.faces();
    const LinearForm q(this->Column[v]);
    VertexLimit l;
    l.Point = q;
    std::vector<LinearForm> t;
    for (int k = 0; k <= m; ++k)
    {
      t.push_back(this->spokeEnd(fan, k).add(q, -1.0));
    }
    l.Tangent = t;
    if (m == 1)
    {
      return l;
    }
    l.Point.add(t[0], 1.0 / 6).add(t[m], 1.0 / 6);
    const LinearForm along = combine({{0.5, &t[0]}, {-0.5, &t[m]}});
    LinearForm across;
    double norm = 0.0;
    for (int k = 1; k < m; ++k)
    {
      across.add(t[k], std::sin(Pi * k / m));
      across.add(along, -std::sin(Pi * k / m) * std::cos(Pi * k / m));
      norm += std::sin(Pi * k / m) * std::sin(Pi * k / m);
    }
    for (int k = 0; k <= m; ++k)
    {
      const double sine = k == 0 || k == m ? 0.0 : std::sin(Pi * k / m) / norm;
      l.Tangent[k] = combine({{std::cos(Pi * k / m), &along}, {sine, &across}});
    }
    return l;
  }

  const QuadComplex& Complex;
  std::vector<Index> Column;
  Index Columns = 0;
};

/// Coefficients of a cubic on [0, 1] on the double knots of m segments, by blossoming: n x 4.
Eigen::MatrixXd refineCubic(int segments)
{
  const int n = 2 * segments + 2;
  Eigen::MatrixXd r(n, 4);
  const auto knot = [&](int i) { return std::clamp(i / 2, 0, segments) / double(segments); };
  for (int i = 0; i < n; ++i)
  {
    // Coefficient i is the blossom at three consecutive inner arguments of the knot vector.
    const double t[3] = {knot(i - 1), knot(i), knot(i + 1)};
    Eigen::Matrix4d b = Eigen::Matrix4d::Identity();
    for (int level = 0; level < 3; ++level)
    {
      for (int k = 0; k < 3 - level; ++k)
      {
        b.row(k) = (1 - t[level]) * b.row(k) + t[level] * b.row(k + 1);
      }
    }
    r.row(i) = b.row(0);
  }
  return r;
}

/// The 16 Bezier points of a patch, number 4 j + i.
std::array<LinearForm, 16> bezierPatch(
  const QuadComplex& complex, const std::vector<VertexLimit>& limits, Index f)
{
  static constexpr int Corner[4] = {0, 3, 15, 12};
  static constexpr int Next[4] = {1, 7, 14, 8};
  static constexpr int Previous[4] = {4, 2, 11, 13};
  static constexpr int Inside[4] = {5, 6, 10, 9};
  std::array<LinearForm, 16> b;
  for (int k = 0; k < 4; ++k)
  {
    const Index v = complex.quad(f)[k];
    const VertexFan& fan = complex.fan(v);
    const auto it = std::find(fan.HalfEdges.begin(), fan.HalfEdges.end(), 4 * f + k);
    const int i = static_cast<int>(it - fan.HalfEdges.begin());
    const VertexLimit& l = limits[v];
    b[Corner[k]] = l.Point;
    b[Next[k]] = combine({{1.0, &l.Point}, {1.0 / 3, &l.Tangent[i]}});
    b[Previous[k]] = combine({{1.0, &l.Point}, {1.0 / 3, &l.Tangent[(i + 1) % fan.spokes()]}});
    b[Inside[k]] = l.Interior[i];
  }
  return b;
}

/// K of the specification: all patches as bicubics, refined; not yet G1 at irregular vertices.
std::vector<LinearForm> catmullClarkNet(
  const QuadComplex& complex, const PatchNet& net, const Limits& limits)
{
  std::vector<VertexLimit> limit(complex.vertices());
  for (Index v = 0; v < complex.vertices(); ++v)
  {
    if (complex.fan(v).faces() > 0)
    {
      limit[v] = limits.at(v);
    }
  }
  const int n = net.side();
  const Eigen::MatrixXd refine = refineCubic(net.segments());
  std::vector<LinearForm> form(net.points());
  for (Index f = 0; f < complex.faces(); ++f)
  {
    const auto b = bezierPatch(complex, limit, f);
    for (int j = 0; j < n; ++j)
    {
      for (int i = 0; i < n; ++i)
      {
        LinearForm& target = form[net.at(f, i, j)];
        target = LinearForm();
        for (int l = 0; l < 16; ++l)
        {
          target.add(b[l], refine(i, l % 4) * refine(j, l / 4));
        }
      }
    }
  }
  return form;
}

/// Moves the interior of every patch by the least thin-plate extension of the change of its rim.
SparseRows extendChange(const PatchNet& net, const SparseRows& before, const SparseRows& after)
{
  const int n = net.side();
  std::vector<int> inside;
  std::vector<int> outside;
  for (int l = 0; l < n * n; ++l)
  {
    const int i = l % n;
    const int j = l / n;
    (i >= 2 && i < n - 2 && j >= 2 && j < n - 2 ? inside : outside).push_back(l);
  }
  const Eigen::MatrixXd energy = patchEnergies(net.segments()).thinPlate();
  const Eigen::MatrixXd extension =
    -energy(inside, inside).ldlt().solve(Eigen::MatrixXd(energy(inside, outside)));
  std::vector<char> isInside(net.points(), 0);
  std::vector<Eigen::Triplet<double>> triplets;
  for (Index f = 0; f < net.patches(); ++f)
  {
    for (std::size_t r = 0; r < inside.size(); ++r)
    {
      isInside[net.at(f, inside[r])] = 1;
      for (std::size_t c = 0; c < outside.size(); ++c)
      {
        triplets.emplace_back(net.at(f, inside[r]), net.at(f, outside[c]),
          extension(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)));
      }
    }
  }
  for (Index p = 0; p < net.points(); ++p)
  {
    if (!isInside[p])
    {
      triplets.emplace_back(p, p, 1.0);
    }
  }
  SparseRows spread(net.points(), net.points());
  spread.setFromTriplets(triplets.begin(), triplets.end());
  const SparseRows change = after - before;
  SparseRows result = before + SparseRows(spread * change);
  result.prune(1e-15, 1.0);
  return result;
}
} // namespace

SplineSpace makeVertexSpace(
  const QuadComplex& complex, const PatchNet& net, const SplineSpace& full)
{
  const Limits limits(complex);
  const SparseRows k = matrixFrom(catmullClarkNet(complex, net, limits), limits.columns());
  const SparseRows x = full.Reader * k;
  const SparseRows projected = full.Basis * x;
  SplineSpace space;
  space.Basis = extendChange(net, k, projected);
  return space;
}
} // namespace bsr
