#include "Mesh/LaplaceSpectrum.h"
#include "MorseShapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace bsr;

/// A sphere whose triangles are needles: points of a fine grid of longitudes and latitudes.
bsrtest::AnalyticSurface needleSphere()
{
  bsrtest::AnalyticSurface s = bsrtest::ellipsoid({1, 1, 1}, 5);
  for (Vec3& p : s.Mesh.Points)
  {
    p = Vec3(p.x(), p.y(), 6.0 * p.z()).normalized(); // crowds the points towards the poles
  }
  return s;
}
} // namespace

TEST(Laplacian, RowsSumToZeroAndMassIsTheArea)
{
  const TriangleSurface s = bsrtest::torus(60, 30).surface();
  const Laplacian l = cotangentLaplacian(s);
  EXPECT_NEAR(l.Mass.sum(), s.area(), 0.02 * s.area()); // flips bend edges of the surface
  EXPECT_LT((l.Stiffness * Eigen::VectorXd::Ones(l.Mass.size())).cwiseAbs().maxCoeff(), 1e-10);
  const Eigen::SparseMatrix<double> transposed = l.Stiffness.transpose();
  EXPECT_LT((l.Stiffness - transposed).norm(), 1e-12);
}

TEST(Laplacian, WeightsAreNotNegativeWhateverTheTriangles)
{
  bsrtest::AnalyticSurface flat = needleSphere();
  for (const auto& shape : {flat, bsrtest::tube(400, 8), bsrtest::torus(7, 150)})
  {
    const Laplacian l = cotangentLaplacian(shape.surface());
    for (int c = 0; c < l.Stiffness.outerSize(); ++c)
    {
      for (Eigen::SparseMatrix<double>::InnerIterator i(l.Stiffness, c); i; ++i)
      {
        EXPECT_TRUE(i.row() == i.col() ? i.value() > 0.0 : i.value() < 1e-6) << i.value();
      }
    }
  }
}

TEST(Laplacian, DegenerateTrianglesAreEndured)
{
  bsrtest::AnalyticSurface s = bsrtest::ellipsoid({1, 1, 1}, 2);
  s.Mesh.Points[20] = s.Mesh.Points[s.Mesh.Triangles[0][0]]; // makes triangles of no area
  const Laplacian l = cotangentLaplacian(s.surface());
  EXPECT_TRUE(l.Mass.allFinite());
  EXPECT_GT(l.Mass.minCoeff(), 0.0);
  for (int k = 0; k < l.Stiffness.outerSize(); ++k)
  {
    for (Eigen::SparseMatrix<double>::InnerIterator i(l.Stiffness, k); i; ++i)
    {
      EXPECT_TRUE(std::isfinite(i.value()));
    }
  }
}

TEST(LaplaceSpectrum, SphereHasItsHarmonics)
{
  // Degree l: eigenvalue l (l + 1), 2 l + 1 times.
  LaplaceSpectrum spectrum(cotangentLaplacian(bsrtest::ellipsoid({1, 1, 1}, 5).surface()));
  Monitor monitor;
  for (int degree : {0, 1, 2, 5, 9})
  {
    EXPECT_EQ(spectrum.countBelow(degree * (degree + 1.0) + 0.5 * (degree + 1)),
      (degree + 1) * (degree + 1));
    for (int k : {degree * degree, degree * degree + 2 * degree})
    {
      const auto e = spectrum.at(k, monitor);
      ASSERT_TRUE(e) << e.status().message();
      EXPECT_EQ(e->Number, k);
      EXPECT_NEAR(e->Eigenvalue, degree * (degree + 1.0), 0.03 * degree * (degree + 1.0) + 1e-6);
    }
  }
}

TEST(LaplaceSpectrum, FunctionsSolveTheirEquation)
{
  for (const auto& shape : {bsrtest::torus(60, 30), bsrtest::tube(40, 30)})
  {
    const Laplacian l = cotangentLaplacian(shape.surface());
    LaplaceSpectrum spectrum(l);
    Monitor monitor;
    const auto found = spectrum.near(spectrum.weyl(40.0), 10, monitor);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), 10U);
    double last = 0.0;
    for (std::size_t i = 0; i < found->size(); ++i)
    {
      const Eigenfunction& e = (*found)[i];
      EXPECT_EQ(e.Number, found->front().Number + static_cast<int>(i));
      EXPECT_GE(e.Eigenvalue, last);
      last = e.Eigenvalue;
      Eigen::VectorXd u(l.Mass.size());
      for (std::size_t v = 0; v < e.Values.size(); ++v)
      {
        if (l.Row[v] >= 0)
        {
          u[l.Row[v]] = e.Values[v];
        }
      }
      EXPECT_NEAR(u.cwiseAbs().maxCoeff(), 1.0, 1e-12);
      EXPECT_LT((l.Stiffness * u - e.Eigenvalue * l.Mass.cwiseProduct(u)).norm(),
        1e-5 * (e.Eigenvalue * l.Mass.cwiseProduct(u)).norm());
    }
  }
}

TEST(LaplaceSpectrum, OpenTubeHasNaturalBoundaries)
{
  // Along the axis cos (pi k z / 4), around cos (m a): the longest wave is a half one.
  LaplaceSpectrum spectrum(cotangentLaplacian(bsrtest::tube(60, 60).surface()));
  Monitor monitor;
  const auto e = spectrum.at(1, monitor);
  ASSERT_TRUE(e);
  EXPECT_NEAR(e->Eigenvalue, M_PI * M_PI / 16.0, 0.01);
}

TEST(LaplaceSpectrum, SameSurfaceSameBits)
{
  const TriangleSurface s = bsrtest::torus(50, 24).surface();
  LaplaceSpectrum a(cotangentLaplacian(s));
  LaplaceSpectrum b(cotangentLaplacian(s));
  Monitor monitor;
  const auto ea = a.near(a.weyl(20.0), 6, monitor);
  const auto eb = b.near(b.weyl(20.0), 6, monitor);
  ASSERT_TRUE(ea && eb);
  for (std::size_t i = 0; i < ea->size(); ++i)
  {
    EXPECT_EQ((*ea)[i].Values, (*eb)[i].Values);
  }
}

TEST(LaplaceSpectrum, NoSuchPlaceIsAnError)
{
  LaplaceSpectrum spectrum(cotangentLaplacian(bsrtest::ellipsoid({1, 1, 1}, 1).surface()));
  Monitor monitor;
  EXPECT_EQ(spectrum.at(-1, monitor).status().code(), StatusCode::InvalidParameter);
  EXPECT_EQ(spectrum.at(1000, monitor).status().code(), StatusCode::InvalidParameter);
}
