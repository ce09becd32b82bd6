#include "Layout/SquareMap.h"

#include <Eigen/SparseLU>

#include <cmath>

namespace bsr
{
namespace
{
class ConvexMap
{
public:
  explicit ConvexMap(const SquareDisc& disc) : Disc(disc), Unknown(disc.Mesh.Points.size(), 0)
  {
    for (const Index v : disc.Boundary)
    {
      this->Unknown[v] = -1;
    }
    for (Index& u : this->Unknown)
    {
      u = u < 0 ? -1 : this->Count++;
    }
    this->UV.assign(disc.Mesh.Points.size(), Vec2::Zero());
    for (std::size_t i = 0; i < disc.Boundary.size(); ++i)
    {
      this->UV[disc.Boundary[i]] = disc.BoundaryUV[i];
    }
    this->meanValues();
  }

  bool solve()
  {
    if (this->Count == 0)
    {
      return true;
    }
    std::vector<double> sum(this->UV.size(), 0.0);
    for (const Weight& w : this->Weights)
    {
      sum[w.From] += w.Value;
    }
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(this->Count + this->Weights.size());
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(this->Count, 2);
    for (Index i = 0; i < this->Count; ++i)
    {
      entries.emplace_back(i, i, 1.0);
    }
    for (const Weight& w : this->Weights)
    {
      const Index row = this->Unknown[w.From];
      const double value = w.Value / sum[w.From];
      if (this->Unknown[w.To] >= 0)
      {
        entries.emplace_back(row, this->Unknown[w.To], -value);
      }
      else
      {
        b.row(row) += value * this->UV[w.To].transpose();
      }
    }
    Eigen::SparseMatrix<double> a(this->Count, this->Count);
    a.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Eigen::SparseMatrix<double>> lu;
    lu.compute(a);
    if (lu.info() != Eigen::Success)
    {
      return false;
    }
    const Eigen::MatrixXd x = lu.solve(b);
    if (!x.allFinite())
    {
      return false;
    }
    for (std::size_t v = 0; v < this->UV.size(); ++v)
    {
      if (this->Unknown[v] >= 0)
      {
        this->UV[v] = x.row(this->Unknown[v]).transpose();
      }
    }
    return true;
  }

  /// The L2 stretch of the whole map, and of each vertex.
  double stretch(std::vector<double>& ofVertex) const
  {
    ofVertex.assign(this->UV.size(), 0.0);
    std::vector<double> area(this->UV.size(), 0.0);
    double total = 0.0;
    double areas = 0.0;
    for (const auto& t : this->Disc.Mesh.Triangles)
    {
      const double a = 0.5 * this->normal(t).norm();
      const double s = this->squaredStretch(t);
      total += a * s;
      areas += a;
      for (const Index v : t)
      {
        ofVertex[v] += a * s;
        area[v] += a;
      }
    }
    for (std::size_t v = 0; v < ofVertex.size(); ++v)
    {
      ofVertex[v] = area[v] > 0.0 ? std::sqrt(ofVertex[v] / area[v]) : 1.0;
    }
    return std::sqrt(total / areas);
  }

  void divide(const std::vector<double>& stretch)
  {
    for (Weight& w : this->Weights)
    {
      w.Value /= std::max(stretch[w.To], 1e-12);
    }
  }

  std::vector<Vec2> UV;

private:
  struct Weight
  {
    Index From;
    Index To;
    double Value;
  };

  Vec3 normal(const std::array<Index, 3>& t) const
  {
    const auto& p = this->Disc.Mesh.Points;
    return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]);
  }

  /// Mean of the squared singular values of the map from the square to the triangle.
  double squaredStretch(const std::array<Index, 3>& t) const
  {
    const auto& p = this->Disc.Mesh.Points;
    const Vec2 e1 = this->UV[t[1]] - this->UV[t[0]];
    const Vec2 e2 = this->UV[t[2]] - this->UV[t[0]];
    const double det = std::max(e1[0] * e2[1] - e1[1] * e2[0], 1e-16);
    const Vec3 q1 = p[t[1]] - p[t[0]];
    const Vec3 q2 = p[t[2]] - p[t[0]];
    const Vec3 du = (q1 * e2[1] - q2 * e1[1]) / det;
    const Vec3 dv = (q2 * e1[0] - q1 * e2[0]) / det;
    return 0.5 * (du.squaredNorm() + dv.squaredNorm());
  }

  void meanValues()
  {
    const auto& p = this->Disc.Mesh.Points;
    for (const auto& t : this->Disc.Mesh.Triangles)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Index i = t[k];
        if (this->Unknown[i] < 0)
        {
          continue;
        }
        const Vec3 a = p[t[(k + 1) % 3]] - p[i];
        const Vec3 b = p[t[(k + 2) % 3]] - p[i];
        const double half = 0.5 * std::atan2(a.cross(b).norm(), a.dot(b));
        const double w = std::max(std::tan(std::min(half, 1.55)), 1e-4);
        this->Weights.push_back({i, t[(k + 1) % 3], w / std::max(a.norm(), 1e-300)});
        this->Weights.push_back({i, t[(k + 2) % 3], w / std::max(b.norm(), 1e-300)});
      }
    }
  }

  const SquareDisc& Disc;
  std::vector<Index> Unknown; ///< number of each inner vertex, -1 on the boundary
  Index Count = 0;
  std::vector<Weight> Weights;
};
} // namespace

std::vector<Vec2> squareMap(const SquareDisc& disc, int stretchRounds)
{
  ConvexMap map(disc);
  if (!map.solve())
  {
    return {};
  }
  std::vector<double> stretch;
  std::vector<Vec2> best = map.UV;
  double least = map.stretch(stretch);
  int folded = foldedTriangles(disc.Mesh, best);
  for (int round = 0; round < stretchRounds; ++round)
  {
    map.divide(stretch);
    if (!map.solve())
    {
      break;
    }
    const double now = map.stretch(stretch);
    const int folds = foldedTriangles(disc.Mesh, map.UV);
    if (!(now < least) || folds > folded)
    {
      break;
    }
    least = now;
    folded = folds;
    best = map.UV;
  }
  return best;
}

int foldedTriangles(const TriangleMesh& mesh, const std::vector<Vec2>& uv)
{
  int folded = 0;
  for (const auto& t : mesh.Triangles)
  {
    const Vec2 a = uv[t[1]] - uv[t[0]];
    const Vec2 b = uv[t[2]] - uv[t[0]];
    folded += a[0] * b[1] - a[1] * b[0] > 0.0 ? 0 : 1;
  }
  return folded;
}
} // namespace bsr
