#include "Layout/CrossField.h"

#include "Common/Parallel.h"
#include "Common/SparseFactors.h"
#include "Mesh/Curvature.h"

#include <Eigen/Geometry>

#include <cmath>
#include <complex>

namespace bsr
{
namespace
{
using Complex = std::complex<double>;
using ComplexVector = Eigen::Matrix<Complex, Eigen::Dynamic, 1>;
using ComplexMatrix = Eigen::SparseMatrix<Complex>;

class FieldSolver
{
public:
  FieldSolver(const TriangleSurface& s, std::vector<std::uint8_t> inside,
    const CrossFieldOptions& options, Monitor& monitor)
      : S(s),
        Inside(std::move(inside)),
        Options(options),
        M(monitor),
        Row(s.Region.size(), -1),
        EdgeAngle(s.Vertex.size(), 0.0)
  {
    for (Index f = 0; f < s.faces(); ++f)
    {
      if (this->Inside[f])
      {
        this->Row[f] = this->Rows++;
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          this->EdgeAngle[h] = edgeAngle(s, h);
        }
      }
    }
  }

  CrossField run()
  {
    this->bendings();
    if (!this->M.cancelled())
    {
      this->targets();
    }
    CrossField field{this->Inside, {}};
    ComplexVector z;
    if (!this->solve(z))
    {
      return field;
    }
    field.Angle.assign(this->S.Region.size(), 0.0);
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      if (this->Row[f] >= 0)
      {
        field.Angle[f] = std::arg(z[this->Row[f]]) / 4.0;
      }
    }
    return field;
  }

private:
  bool inner(Index h) const { return this->Inside[h / 3] && this->Inside[this->S.Opposite[h] / 3]; }

  /// Turns the n-th power of a direction in the face of h into that of the neighbor.
  Complex transport(Index h, int n) const
  {
    const Index o = this->S.Opposite[h];
    return std::polar(1.0, n * (this->EdgeAngle[o] + M_PI - this->EdgeAngle[h]));
  }

  /// Deviatoric part of the second fundamental form of each face as a complex number
  /// (difference of principal curvatures, doubled angle of the larger), smoothed.
  void bendings()
  {
    const TriangleSurface& s = this->S;
    const std::vector<Vec3> form = faceCurvature(s, this->Inside, this->M);
    this->Bending.assign(static_cast<std::size_t>(this->Rows), Complex(0.0));
    for (Index f = 0; f < s.faces(); ++f)
    {
      if (this->Row[f] >= 0)
      {
        this->Bending[this->Row[f]] = Complex(form[f][0] - form[f][2], 2.0 * form[f][1]);
      }
    }
    for (int round = 0; round < 6; ++round)
    {
      std::vector<Complex> next = this->Bending;
      parallelForUntilCancelled(0, s.faces(), 2048, this->M,
        [&](std::int64_t first, std::int64_t last)
        {
          for (auto f = static_cast<Index>(first); f < last; ++f)
          {
            if (this->Row[f] >= 0)
            {
              next[this->Row[f]] = this->averaged(f);
            }
          }
        });
      this->Bending.swap(next);
    }
  }

  /// The mean bending of a face and its neighbors.
  Complex averaged(Index f) const
  {
    Complex sum = this->Bending[this->Row[f]];
    double weight = 1.0;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if (this->inner(h))
      {
        const Index o = this->S.Opposite[h];
        sum += this->transport(o, 2) * this->Bending[this->Row[o / 3]];
        weight += 1.0;
      }
    }
    return sum / weight;
  }

  /// Direction of a crease at half-edge h, over some edges on either side so that jagged borders
  /// do not turn the field.
  double creaseAngle(Index h) const
  {
    const Vec3 ahead = this->S.Points[this->along(h, this->S.end(h), 3)];
    const Vec3 behind = this->S.Points[this->along(h, this->S.start(h), 3)];
    const FaceFrame frame = faceFrame(this->S, h / 3);
    const Vec3 d = ahead - behind;
    const double angle = std::atan2(d.dot(frame.Y), d.dot(frame.X));
    const double off = std::remainder(angle - this->EdgeAngle[h], 2.0 * M_PI);
    return std::abs(off) < 0.9 ? angle : this->EdgeAngle[h];
  }

  /// The vertex some steps along the crease of h, from its end or start away from h.
  Index along(Index h, Index v, int steps) const
  {
    Index from = v == this->S.end(h) ? this->S.start(h) : this->S.end(h);
    for (int i = 0; i < steps && this->S.creaseDegree(v) == 2; ++i)
    {
      Index next = -1;
      this->S.around(v, [&](Index x)
        { next = this->S.Crease[x] && this->S.end(x) != from ? this->S.end(x) : next; });
      if (next < 0)
      {
        break;
      }
      from = v;
      v = next;
    }
    return v;
  }

  /// What each face would like to be, and how much.
  void targets()
  {
    this->Target = ComplexVector::Zero(this->Rows);
    this->Weight = Eigen::VectorXd::Zero(this->Rows);
    for (Index f = 0; f < this->S.faces(); ++f)
    {
      if (this->Row[f] < 0)
      {
        continue;
      }
      const Index r = this->Row[f];
      const double bent = std::abs(this->Bending[r]) * this->Options.Size;
      if (bent > 0.0)
      {
        this->Target[r] = std::polar(1.0, 2.0 * std::arg(this->Bending[r]));
        this->Weight[r] = 0.05 * this->Options.Curvature * std::min(1.0, bent * bent);
      }
      Complex along(0.0);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (this->S.Crease[h])
        {
          along += std::polar(1.0, 4.0 * this->creaseAngle(h));
        }
      }
      if (std::abs(along) > 0.1)
      {
        this->Target[r] = along / std::abs(along);
        this->Weight[r] = 1e4;
      }
    }
  }

  ComplexMatrix laplacian() const
  {
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(6 * static_cast<std::size_t>(this->Rows));
    for (Index h = 0; h < static_cast<Index>(this->S.Vertex.size()); ++h)
    {
      if (this->inner(h))
      {
        const Index r = this->Row[h / 3];
        const Index o = this->S.Opposite[h];
        entries.emplace_back(r, r, 1.0);
        entries.emplace_back(r, this->Row[o / 3], -this->transport(o, 4));
      }
    }
    ComplexMatrix m(this->Rows, this->Rows);
    m.setFromTriplets(entries.begin(), entries.end());
    return m;
  }

  /// False: cancelled, or no solution.
  bool solve(ComplexVector& z) const
  {
    if (this->M.cancelled())
    {
      return false;
    }
    const ComplexMatrix smooth = this->laplacian();
    ComplexMatrix attach(this->Rows, this->Rows);
    attach.setIdentity();
    for (Index r = 0; r < this->Rows; ++r)
    {
      attach.coeffRef(r, r) = this->Weight[r];
    }
    ComplexMatrix identity(this->Rows, this->Rows);
    identity.setIdentity();
    const ComplexVector pull = this->Weight.cast<Complex>().cwiseProduct(this->Target);
    // Inverse power steps towards the smoothest field, pulled by the targets.
    const ComplexMatrix held = smooth + attach;
    SparseFactors<ComplexMatrix> solver;
    const ComplexMatrix pattern = held + identity;
    if (this->M.cancelled())
    {
      return false;
    }
    solver.analyzePattern(pattern);
    if (this->M.cancelled() || !solver.factorize(held + 1e-4 * identity, this->M))
    {
      return false;
    }
    z = this->Target;
    if (this->Weight.maxCoeff() <= 0.0)
    {
      z.setOnes();
    }
    for (int i = 0; i < 5; ++i)
    {
      const ComplexVector right = pull + 1e-4 * z;
      z = solver.solve(right);
      z /= std::max(z.cwiseAbs().maxCoeff(), 1e-300);
      if (this->M.cancelled())
      {
        return false;
      }
    }
    normalize(z);
    // Diffusion over about a quad, with normalization.
    double tau = 30.0;
    for (int stage = 0; stage < 3; ++stage, tau *= 0.4)
    {
      if (this->M.cancelled() || !solver.factorize(tau * held + identity, this->M))
      {
        return false;
      }
      for (int i = 0; i < this->Options.Rounds / 3; ++i)
      {
        const ComplexVector right = tau * pull + z;
        z = solver.solve(right);
        normalize(z);
        if (this->M.cancelled())
        {
          return false;
        }
      }
    }
    return z.allFinite();
  }

  static void normalize(ComplexVector& z)
  {
    for (Eigen::Index i = 0; i < z.size(); ++i)
    {
      const double length = std::abs(z[i]);
      z[i] = length > 1e-12 ? z[i] / length : Complex(1.0);
    }
  }

  const TriangleSurface& S;
  std::vector<std::uint8_t> Inside;
  CrossFieldOptions Options;
  Monitor& M;
  std::vector<Index> Row;
  std::vector<double> EdgeAngle;
  Index Rows = 0;
  std::vector<Complex> Bending;
  ComplexVector Target;
  Eigen::VectorXd Weight;
};
} // namespace

double edgeAngle(const TriangleSurface& s, Index h)
{
  const FaceFrame frame = faceFrame(s, h / 3);
  const Vec3 e = s.Points[s.end(h)] - s.Points[s.start(h)];
  return std::atan2(e.dot(frame.Y), e.dot(frame.X));
}

CrossField crossField(const TriangleSurface& s, std::vector<std::uint8_t> inside,
  const CrossFieldOptions& options, Monitor& monitor)
{
  return FieldSolver(s, std::move(inside), options, monitor).run();
}
} // namespace bsr
