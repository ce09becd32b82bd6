#include "Layout/CrossField.h"

#include "Common/Parallel.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>

#include <cmath>
#include <complex>

namespace bsr
{
namespace
{
using Complex = std::complex<double>;
using ComplexVector = Eigen::Matrix<Complex, Eigen::Dynamic, 1>;
using ComplexMatrix = Eigen::SparseMatrix<Complex>;

struct Frame
{
  Vec3 X;
  Vec3 Y;
};

Frame frameOf(const TriangleSurface& s, Index face)
{
  const auto c = s.corners(face);
  const Vec3 x = (s.Points[c[1]] - s.Points[c[0]]).normalized();
  const Vec3 n = s.areaNormal(face).normalized();
  return {x, n.cross(x)};
}

class FieldSolver
{
public:
  FieldSolver(
    const TriangleSurface& s, std::vector<std::uint8_t> inside, const CrossFieldOptions& options)
      : S(s),
        Inside(std::move(inside)),
        Options(options),
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
    this->targets();
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
    std::vector<Vec3> normal(s.Points.size(), Vec3::Zero());
    for (Index f = 0; f < s.faces(); ++f)
    {
      for (Index v : s.corners(f))
      {
        normal[v] += this->Inside[f] ? s.areaNormal(f) : Vec3(Vec3::Zero());
      }
    }
    for (Vec3& n : normal)
    {
      n.normalize();
    }
    this->Bending.assign(static_cast<std::size_t>(this->Rows), Complex(0.0));
    for (Index f = 0; f < s.faces(); ++f)
    {
      if (this->Row[f] >= 0)
      {
        this->Bending[this->Row[f]] = this->bending(f, normal);
      }
    }
    for (int round = 0; round < 6; ++round)
    {
      std::vector<Complex> next = this->Bending;
      for (Index f = 0; f < s.faces(); ++f)
      {
        if (this->Row[f] < 0)
        {
          continue;
        }
        Complex sum = this->Bending[this->Row[f]];
        double weight = 1.0;
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          if (this->inner(h))
          {
            const Index o = s.Opposite[h];
            sum += this->transport(o, 2) * this->Bending[this->Row[o / 3]];
            weight += 1.0;
          }
        }
        next[this->Row[f]] = sum / weight;
      }
      this->Bending.swap(next);
    }
  }

  Complex bending(Index f, const std::vector<Vec3>& normal) const
  {
    const TriangleSurface& s = this->S;
    const Frame frame = frameOf(s, f);
    Eigen::Matrix<double, 6, 3> a;
    Eigen::Matrix<double, 6, 1> b;
    for (int k = 0; k < 3; ++k)
    {
      const Index h = 3 * f + k;
      const Vec3 e = s.Points[s.end(h)] - s.Points[s.start(h)];
      const Vec3 d = normal[s.end(h)] - normal[s.start(h)];
      const double x = e.dot(frame.X);
      const double y = e.dot(frame.Y);
      a.row(2 * k) << x, y, 0.0;
      a.row(2 * k + 1) << 0.0, x, y;
      b[2 * k] = d.dot(frame.X);
      b[2 * k + 1] = d.dot(frame.Y);
    }
    const Vec3 q = a.colPivHouseholderQr().solve(b);
    const Complex result(q[0] - q[2], 2.0 * q[1]);
    return std::isfinite(std::norm(result)) ? result : Complex(0.0);
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
          along += std::polar(1.0, 4.0 * this->EdgeAngle[h]);
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

  bool solve(ComplexVector& z) const
  {
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
    Eigen::SimplicialLDLT<ComplexMatrix> solver;
    // Inverse power steps towards the smoothest field, pulled by the targets.
    solver.compute(smooth + attach + 1e-4 * identity);
    if (solver.info() != Eigen::Success)
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
    }
    normalize(z);
    // Diffusion over about a quad, with normalization.
    double tau = 30.0;
    for (int stage = 0; stage < 3; ++stage, tau *= 0.4)
    {
      solver.compute(tau * (smooth + attach) + identity);
      if (solver.info() != Eigen::Success)
      {
        return false;
      }
      for (int i = 0; i < this->Options.Rounds / 3; ++i)
      {
        const ComplexVector right = tau * pull + z;
        z = solver.solve(right);
        normalize(z);
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
  const Frame frame = frameOf(s, h / 3);
  const Vec3 e = s.Points[s.end(h)] - s.Points[s.start(h)];
  return std::atan2(e.dot(frame.Y), e.dot(frame.X));
}

CrossField crossField(
  const TriangleSurface& s, std::vector<std::uint8_t> inside, const CrossFieldOptions& options)
{
  return FieldSolver(s, std::move(inside), options).run();
}
} // namespace bsr
