#include "Spline/CreaseEdges.h"

#include "Common/Parallel.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr int Places = 4;
constexpr int LeastPoints = 6; ///< for a plane

/// Sums of the points of one place beside an edge.
struct PlaneSums
{
  int Count = 0;
  Vec3 Sum = Vec3::Zero();
  Eigen::Matrix3d Squares = Eigen::Matrix3d::Zero();

  void add(const Vec3& p)
  {
    ++this->Count;
    this->Sum += p;
    this->Squares += p * p.transpose();
  }
  /// Unit normal of the plane, on the side of `outward`; zero where the points are too few.
  Vec3 normal(const Vec3& outward) const
  {
    if (this->Count < LeastPoints)
    {
      return Vec3::Zero();
    }
    const Vec3 mean = this->Sum / this->Count;
    const Eigen::Matrix3d c = this->Squares / this->Count - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(c);
    // A line of points has no plane.
    if (!(eigen.eigenvalues()[1] > 1e-4 * eigen.eigenvalues()[2]))
    {
      return Vec3::Zero();
    }
    const Vec3 n = eigen.eigenvectors().col(0);
    return n.dot(outward) < 0.0 ? Vec3(-n) : n;
  }
};

class CreaseFinder
{
public:
  CreaseFinder(const QuadComplex& complex, const std::vector<Vec3>& vertices,
    const std::vector<FitPoint>& points, double angle)
      : Complex(complex),
        Vertices(vertices),
        Points(points),
        Cosine(std::cos(angle * 0.017453292519943295))
  {
    this->First.assign(static_cast<std::size_t>(complex.faces()) + 1, 0);
    for (const FitPoint& p : points)
    {
      ++this->First[p.Patch + 1];
    }
    for (Index f = 0; f < complex.faces(); ++f)
    {
      this->First[f + 1] += this->First[f];
    }
  }

  bool isSharp(const QuadEdge& edge) const
  {
    if (edge.Second < 0)
    {
      return false;
    }
    const std::pair<double, int> looks[] = {{0.1, 4}, {0.2, 4}, {0.3, 2}, {0.5, 1}};
    for (const auto& [band, count] : looks)
    {
      const auto a = this->normals(edge.First, band, count);
      const auto b = this->normals(edge.Second, band, count);
      int places = 0;
      int sharp = 0;
      for (int k = 0; k < count; ++k)
      {
        const Vec3& n = a[k];
        const Vec3& m = b[count - 1 - k];
        if (n.squaredNorm() > 0.0 && m.squaredNorm() > 0.0)
        {
          ++places;
          sharp += n.dot(m) < this->Cosine;
        }
      }
      if (2 * places > count)
      {
        return 2 * sharp > places;
      }
    }
    return false;
  }

private:
  /// Distance from the side of a half-edge and place along it, in the patch's parameters.
  static Vec2 beside(Index halfEdge, const FitPoint& p)
  {
    switch (halfEdge % 4)
    {
    case 0:
      return {p.V, p.U};
    case 1:
      return {1.0 - p.U, p.V};
    case 2:
      return {1.0 - p.V, 1.0 - p.U};
    default:
      return {p.U, 1.0 - p.V};
    }
  }

  std::array<Vec3, Places> normals(Index halfEdge, double band, int count) const
  {
    std::array<PlaneSums, Places> sums;
    const Index f = halfEdge / 4;
    const auto& q = this->Complex.quad(f);
    const Vec3& origin = this->Vertices[q[0]];
    for (std::int64_t i = this->First[f]; i < this->First[f + 1]; ++i)
    {
      const Vec2 at = beside(halfEdge, this->Points[i]);
      // Points on the very edge belong to neither side.
      if (at[0] > 0.0 && at[0] <= band && this->Points[i].weight() > 0.0)
      {
        const int place = std::min(count - 1, static_cast<int>(count * at[1]));
        sums[place].add(this->Points[i].Position - origin);
      }
    }
    const Vec3 outward =
      (this->Vertices[q[2]] - origin).cross(this->Vertices[q[3]] - this->Vertices[q[1]]);
    std::array<Vec3, Places> normal;
    for (int k = 0; k < Places; ++k)
    {
      normal[k] = sums[k].normal(outward);
    }
    return normal;
  }

  const QuadComplex& Complex;
  const std::vector<Vec3>& Vertices;
  const std::vector<FitPoint>& Points;
  double Cosine;
  std::vector<std::int64_t> First;
};
} // namespace

Creases findCreases(const QuadComplex& complex, const std::vector<Vec3>& vertices,
  const std::vector<FitPoint>& points, double angle)
{
  Creases creases;
  if (!(angle < 180.0))
  {
    return creases;
  }
  creases.Vertices = vertices;
  creases.Edge.assign(complex.edges(), 0);
  const CreaseFinder finder(complex, vertices, points, angle);
  parallelFor(0, complex.edges(), 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (auto e = static_cast<Index>(begin); e < end; ++e)
      {
        creases.Edge[e] = finder.isSharp(complex.edge(e));
      }
    });
  return creases;
}
} // namespace bsr
