#include "Spline/VertexFrames.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// 2 cos(angle), exactly 0 at a right angle.
double alphaOf(double angle)
{
  return std::abs(angle - 0.5 * Pi) < 1e-9 ? 0.0 : 2.0 * std::cos(angle);
}

/// Corner angle of a face at the origin of its half-edge.
double cornerAngle(const QuadComplex& complex, const std::vector<Vec3>& v, Index halfEdge)
{
  const Index before = halfEdge / 4 * 4 + (halfEdge + 3) % 4;
  const Vec3& p = v[complex.from(halfEdge)];
  const Vec3 a = v[complex.to(halfEdge)] - p;
  const Vec3 b = v[complex.from(before)] - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Where creases meet: no half turn, for the ends of a sector must stay independent of each other.
double roundedAngle(double angle)
{
  constexpr double step = Pi / 6.0;
  const double steps = std::clamp(std::round(angle / step), 1.0, 11.0);
  return step * (steps != 6.0 ? steps : angle < Pi ? 5.0 : 7.0);
}

class FrameBuilder
{
public:
  FrameBuilder(const QuadComplex& complex, const Creases& creases, Index vertex)
      : Complex(complex), Marks(creases), Fan(complex.fan(vertex))
  {
  }

  VertexFrame build()
  {
    this->findCuts();
    const int spokes = this->Fan.spokes();
    const auto sectors = static_cast<int>(this->Cuts.size()) - (this->Fan.Closed ? 0 : 1);
    if (this->Fan.Closed && this->Cuts.size() <= 1)
    {
      // A crease that ends here only leaves the patches beside it free of each other.
      const double angle = 2.0 * Pi / this->Fan.faces();
      this->Frame.Sectors.push_back(
        {this->Cuts.empty() ? this->Fan : this->sectorFan(0), alphaOf(angle)});
      this->Frame.Tangents.resize(spokes, 2);
      for (int k = 0; k < spokes; ++k)
      {
        this->Frame.Tangents.row(k) << std::cos(k * angle), std::sin(k * angle);
      }
      return std::move(this->Frame);
    }
    for (int s = 0; s < sectors; ++s)
    {
      this->Frame.Sectors.push_back({this->sectorFan(s), 0.0});
    }
    this->runsThrough() ? this->smoothTangents() : this->cornerTangents();
    return std::move(this->Frame);
  }

private:
  /// Spokes at which sectors begin (of an open fan also its last).
  void findCuts()
  {
    const int n = this->Fan.faces();
    for (int k = 0; k < n; ++k)
    {
      const bool border = !this->Fan.Closed && k == 0;
      if (border || this->Marks.at(this->Complex.edgeOf(this->Fan.HalfEdges[k])))
      {
        this->Cuts.push_back(k);
      }
    }
    if (!this->Fan.Closed)
    {
      this->Cuts.push_back(n);
    }
  }

  VertexFan sectorFan(int s) const
  {
    const int n = this->Fan.faces();
    const int first = this->Cuts[s];
    int last = this->Cuts[(s + 1) % this->Cuts.size()];
    last += last <= first ? n : 0;
    VertexFan sector;
    sector.Closed = false;
    for (int k = first; k < last; ++k)
    {
      sector.HalfEdges.push_back(this->Fan.HalfEdges[k % n]);
    }
    return sector;
  }

  /// Whether the cut is one smooth curve through the vertex.
  bool runsThrough() const
  {
    return this->Cuts.size() == 2 &&
           std::all_of(this->Frame.Sectors.begin(), this->Frame.Sectors.end(),
             [](const VertexSector& s) { return s.Fan.faces() >= 2; });
  }

  /// Unknowns: along the curve, then one across in each sector.
  void smoothTangents()
  {
    const int spokes = this->Fan.spokes();
    auto& t = this->Frame.Tangents;
    t = Eigen::MatrixXd::Zero(spokes, 1 + static_cast<Eigen::Index>(this->Frame.Sectors.size()));
    for (std::size_t s = 0; s < this->Frame.Sectors.size(); ++s)
    {
      VertexSector& sector = this->Frame.Sectors[s];
      const int m = sector.Fan.faces();
      sector.Alpha = alphaOf(Pi / m);
      for (int k = 0; k <= m; ++k)
      {
        const int row = (this->Cuts[s] + k) % spokes;
        t(row, 0) = (s == 0 ? 1.0 : -1.0) * std::cos(k * Pi / m);
        t(row, static_cast<Eigen::Index>(s) + 1) = k % m == 0 ? 0.0 : std::sin(k * Pi / m);
      }
    }
  }

  /// Unknowns: one for each cut spoke; those between follow.
  void cornerTangents()
  {
    const int spokes = this->Fan.spokes();
    const auto cuts = static_cast<Eigen::Index>(this->Cuts.size());
    auto& t = this->Frame.Tangents;
    t = Eigen::MatrixXd::Zero(spokes, cuts);
    for (std::size_t s = 0; s < this->Frame.Sectors.size(); ++s)
    {
      VertexSector& sector = this->Frame.Sectors[s];
      const int m = sector.Fan.faces();
      double angle = 0.0;
      for (const Index h : sector.Fan.HalfEdges)
      {
        angle += m > 1 ? cornerAngle(this->Complex, this->Marks.Vertices, h) : 0.0;
      }
      angle = roundedAngle(angle);
      sector.Alpha = alphaOf(angle / m);
      const auto from = static_cast<Eigen::Index>(s);
      const Eigen::Index to = (from + 1) % cuts;
      for (int k = 0; k <= m; ++k)
      {
        const int row = (this->Cuts[s] + k) % spokes;
        t.row(row).setZero();
        t(row, from) += k == 0   ? 1.0
                        : k == m ? 0.0
                                 : std::sin((m - k) * angle / m) / std::sin(angle);
        t(row, to) += k == 0 ? 0.0 : k == m ? 1.0 : std::sin(k * angle / m) / std::sin(angle);
      }
    }
  }

  const QuadComplex& Complex;
  const Creases& Marks;
  const VertexFan& Fan;
  std::vector<int> Cuts;
  VertexFrame Frame;
};
} // namespace

bool Creases::any() const
{
  return std::find(this->Edge.begin(), this->Edge.end(), 1) != this->Edge.end();
}

VertexFrames::VertexFrames(const QuadComplex& complex, const Creases& creases)
    : Frames(complex.vertices()), Alphas(4 * static_cast<std::size_t>(complex.faces()), 0.0)
{
  for (Index v = 0; v < complex.vertices(); ++v)
  {
    if (complex.fan(v).faces() == 0)
    {
      continue;
    }
    this->Frames[v] = FrameBuilder(complex, creases, v).build();
    for (const VertexSector& s : this->Frames[v].Sectors)
    {
      for (int k = s.Fan.Closed ? 0 : 1; k < s.Fan.faces(); ++k)
      {
        this->Alphas[s.Fan.HalfEdges[k]] = s.Alpha;
      }
    }
  }
}
} // namespace bsr
