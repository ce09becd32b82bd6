#include "SplineMeshes.h"

#include "Spline/Evaluate.h"
#include "Spline/G1Edge.h"
#include "Spline/ThinPlate.h"
#include "Spline/VertexSpace.h"

#include <Eigen/Dense>

#include <gtest/gtest.h>

using namespace bsr;

namespace
{
QuadComplex complexOf(const QuadMesh& m)
{
  auto c = QuadComplex::build(m.Quads, static_cast<Index>(m.Points.size()));
  EXPECT_TRUE(c) << c.status().message();
  return *c;
}

struct Case
{
  const char* Name;
  QuadMesh Mesh;
  int Quadratic; ///< expected dimension with EdgeRule::Quadratic
  int Linear;    ///< and with EdgeRule::Linear; -1: not known from elsewhere
};

std::vector<Case> cases()
{
  using namespace meshes;
  return {{"cube", cube(), 192, 192}, {"cube subdivided", subdivide(cube()), 840, 816},
    {"torus", torus(6, 5), 1080, 1080}, {"branch", branch(), 579, 567},
    {"cross", cross(), 936, 936}, {"trapezohedron 4", trapezohedron(4), 264, 256},
    {"trapezohedron 5", trapezohedron(5), 316, 316},
    {"trapezohedron 6", trapezohedron(6), 378, 378},
    {"trapezohedron 7", trapezohedron(7), 440, 440},
    {"trapezohedron 8", trapezohedron(8), 502, 502}, {"open tube", tube(6, 3), -1, -1},
    {"open cross", without(cross(), {0, 7}), -1, -1},
    {"single quad", without(cube(), {1, 2, 3, 4, 5}), 64, 64},
    {"open trapezohedron 6", without(trapezohedron(6), {3, 4}), -1, -1}};
}

int denseRank(const Eigen::MatrixXd& m)
{
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(m);
  qr.setThreshold(1e-10);
  return static_cast<int>(qr.rank());
}

/// Largest angle in degrees between the normals at both sides of all inner edges.
double normalJump(const QuadComplex& c, const PatchNet& net, const Eigen::MatrixXd& b)
{
  SplineModel model;
  model.Knots = segmentKnots(3, net.segments(), 2);
  for (Index f = 0; f < c.faces(); ++f)
  {
    SplinePatch p;
    p.CountU = p.CountV = net.side();
    p.FirstControlPoint = static_cast<std::int64_t>(model.ControlPoints.size());
    model.Patches.push_back(p);
    for (int l = 0; l < net.perPatch(); ++l)
    {
      const Vec3 x = b.row(net.at(f, l)).transpose();
      model.ControlPoints.emplace_back(x[0], x[1], x[2], 1.0);
    }
  }
  const auto at = [&](Index h, double t)
  {
    const double uv[4][2] = {{t, 0}, {1, t}, {1 - t, 1}, {0, 1 - t}};
    return evaluatePatch(model, model.Patches[h / 4], uv[h % 4][0], uv[h % 4][1]);
  };
  double worst = 0.0;
  for (Index e = 0; e < c.edges(); ++e)
  {
    for (int s = 0; s <= 30 && c.edge(e).Second >= 0; ++s)
    {
      const SurfacePoint p = at(c.edge(e).First, s / 30.0);
      const SurfacePoint q = at(c.edge(e).Second, 1 - s / 30.0);
      EXPECT_LE((p.Point - q.Point).norm(), 1e-12);
      const Vec3 n = p.normal().normalized();
      const Vec3 m = q.normal().normalized();
      worst = std::max(worst, std::atan2(n.cross(m).norm(), std::abs(n.dot(m))) * 180 / M_PI);
    }
  }
  return worst;
}
} // namespace

TEST(QuadComplex, CountsAndLoops)
{
  const QuadComplex c = complexOf(meshes::subdivide(meshes::cube()));
  EXPECT_EQ(c.eulerCharacteristic(), 2);
  EXPECT_TRUE(c.closed());
  EXPECT_EQ(complexOf(meshes::torus(6, 5)).eulerCharacteristic(), 0);
  const QuadComplex t = complexOf(meshes::tube(6, 3));
  const auto loops = t.borderLoops();
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].size(), 6u);
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_EQ(t.to(loops[0][i]), t.from(loops[0][(i + 1) % 6]));
  }
}

TEST(QuadComplex, RefusesWhatIsNoManifold)
{
  const auto message = [](std::vector<std::array<Index, 4>> quads, Index n)
  {
    auto c = QuadComplex::build(std::move(quads), n);
    EXPECT_FALSE(c);
    return c.status().message();
  };
  EXPECT_NE(message({}, 4).find("no quads"), std::string::npos);
  EXPECT_NE(message({{0, 1, 2, 7}}, 4).find("does not exist"), std::string::npos);
  EXPECT_NE(message({{0, 1, 2, 2}}, 4).find("same point"), std::string::npos);
  EXPECT_NE(
    message({{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}}, 8).find("3 quads"), std::string::npos);
  EXPECT_NE(message({{0, 1, 2, 3}, {0, 1, 4, 5}}, 6).find("oriented"), std::string::npos);
  EXPECT_NE(message({{0, 1, 2, 3}, {0, 4, 5, 6}}, 7).find("fans"), std::string::npos);
  EXPECT_NE(message({{0, 1, 2, 3}, {0, 3, 2, 4}}, 5).find("doublet"), std::string::npos);
}

TEST(G1Space, DimensionIsThatOfTheWholeSpace)
{
  for (const Case& k : cases())
  {
    const QuadComplex c = complexOf(k.Mesh);
    const PatchNet net(c, 3);
    for (const EdgeRule rule : {EdgeRule::Quadratic, EdgeRule::Linear})
    {
      const SplineSpace s = makeG1Space(c, net, rule);
      const SparseRows g = g1Constraints(c, net, rule);
      const int expected = rule == EdgeRule::Quadratic ? k.Quadratic : k.Linear;
      if (expected >= 0)
      {
        EXPECT_EQ(s.Basis.cols(), expected) << k.Name;
      }
      const SparseRows gb = g * s.Basis;
      EXPECT_LE(gb.coeffs().size() ? gb.coeffs().abs().maxCoeff() : 0.0, 1e-13) << k.Name;
      const SparseRows rb = s.Reader * s.Basis;
      EXPECT_LE((Eigen::MatrixXd(rb) - Eigen::MatrixXd::Identity(rb.rows(), rb.cols()))
                  .cwiseAbs()
                  .maxCoeff(),
        1e-13)
        << k.Name;
      if (net.points() < 1000)
      {
        const int nullity =
          static_cast<int>(net.points()) - (g.rows() ? denseRank(Eigen::MatrixXd(g)) : 0);
        EXPECT_EQ(s.Basis.cols(), nullity) << k.Name;
      }
    }
  }
}

/// Creases of every kind: through vertices, corners, ends inside and at a border, at random.
TEST(G1Space, CreasesCutTheTangentPlanesOnly)
{
  std::mt19937 random(4);
  for (const QuadMesh& mesh : {meshes::cube(), meshes::torus(5, 5), meshes::branch(),
         meshes::cross(), meshes::tube(5, 3), meshes::trapezohedron(6)})
  {
    const QuadComplex c = complexOf(mesh);
    const PatchNet net(c, 3);
    for (int kind = 0; kind < 6; ++kind)
    {
      Creases creases;
      creases.Vertices = mesh.Points;
      creases.Edge.assign(c.edges(), kind == 0);
      for (Index e = 0; e < c.edges() && kind > 0; ++e)
      {
        creases.Edge[e] = random() % 6 < static_cast<unsigned>(kind);
      }
      for (const EdgeRule rule : {EdgeRule::Quadratic, EdgeRule::Linear})
      {
        const SplineSpace s = makeG1Space(c, net, rule, creases);
        const SparseRows g = g1Constraints(c, net, rule, creases);
        const int rank = g.rows() ? denseRank(Eigen::MatrixXd(g)) : 0;
        EXPECT_EQ(s.Basis.cols(), net.points() - rank) << kind;
        const SparseRows gb = g * s.Basis;
        EXPECT_LE(gb.coeffs().size() ? gb.coeffs().abs().maxCoeff() : 0.0, 1e-12);
        const SparseRows rb = s.Reader * s.Basis;
        EXPECT_LE((Eigen::MatrixXd(rb) - Eigen::MatrixXd::Identity(rb.rows(), rb.cols()))
                    .cwiseAbs()
                    .maxCoeff(),
          1e-12);
      }
    }
  }
}

TEST(G1Space, AnyNumberOfSegments)
{
  for (const int m : {3, 4, 5})
  {
    for (const QuadMesh& mesh : {meshes::cube(), meshes::trapezohedron(6), meshes::tube(5, 2)})
    {
      const QuadComplex c = complexOf(mesh);
      const PatchNet net(c, m);
      const SplineSpace s = makeG1Space(c, net, EdgeRule::Quadratic);
      const SparseRows g = g1Constraints(c, net, EdgeRule::Quadratic);
      EXPECT_LE(Eigen::MatrixXd(g * s.Basis).cwiseAbs().maxCoeff(), 1e-13);
      EXPECT_EQ(s.Basis.cols(), net.points() - denseRank(Eigen::MatrixXd(g)));
      const Eigen::MatrixXd b = s.Basis * Eigen::MatrixXd::Random(s.Basis.cols(), 3);
      EXPECT_LE(normalJump(c, net, b), 1e-8);
    }
  }
}

TEST(G1Space, RandomNetsHaveContinuousNormals)
{
  for (const Case& k : cases())
  {
    const QuadComplex c = complexOf(k.Mesh);
    const PatchNet net(c, 3);
    for (const EdgeRule rule : {EdgeRule::Quadratic, EdgeRule::Linear})
    {
      const SplineSpace full = makeG1Space(c, net, rule);
      const SplineSpace coarse = makeVertexSpace(c, net, full);
      Eigen::MatrixXd q(coarse.Basis.cols(), 3);
      Index row = 0;
      std::mt19937 random(7);
      for (Index v = 0; v < c.vertices(); ++v)
      {
        if (c.fan(v).faces() > 0)
        {
          q.row(row++) = k.Mesh.Points[v].transpose() + 0.1 * Eigen::RowVector3d(random() / 4.3e9,
                                                                random() / 4.3e9, random() / 4.3e9);
        }
      }
      const Eigen::MatrixXd b = coarse.Basis * q;
      EXPECT_LE(normalJump(c, net, b), 1e-10) << k.Name;
      // A perturbation in the whole space that keeps the surface regular.
      const Eigen::MatrixXd x = full.Reader * b;
      EXPECT_LE((full.Basis * x - b).cwiseAbs().maxCoeff(), 1e-12) << k.Name;
      const Eigen::MatrixXd y = x + 0.01 * Eigen::MatrixXd::Random(x.rows(), 3);
      EXPECT_LE(normalJump(c, net, full.Basis * y), 1e-10) << k.Name;
    }
  }
}

TEST(VertexSpace, RowsSumToOneAndRegularIsUniformBSpline)
{
  for (const Case& k : cases())
  {
    const QuadComplex c = complexOf(k.Mesh);
    const PatchNet net(c, 3);
    const SplineSpace full = makeG1Space(c, net, EdgeRule::Linear);
    const SplineSpace v = makeVertexSpace(c, net, full);
    const Eigen::VectorXd ones = v.Basis * Eigen::VectorXd::Ones(v.Basis.cols());
    EXPECT_LE((ones.array() - 1.0).abs().maxCoeff(), 1e-13) << k.Name;
  }
  const QuadComplex c = complexOf(meshes::torus(8, 8));
  const PatchNet net(c, 3);
  const SplineSpace v = makeVertexSpace(c, net, makeG1Space(c, net, EdgeRule::Linear));
  // Patch 9 has corners 9, 10, 18, 17: its corner is (1 4 1)/6 x (1 4 1)/6 around vertex 9.
  const Eigen::VectorXd row = Eigen::MatrixXd(v.Basis).row(net.at(9, 0, 0));
  EXPECT_NEAR(row[9], 16.0 / 36, 1e-14);
  EXPECT_NEAR(row[10], 4.0 / 36, 1e-14);
  EXPECT_NEAR(row[18], 1.0 / 36, 1e-14);
}

TEST(ThinPlate, IsExactOnPolynomials)
{
  for (const int m : {3, 5})
  {
    const PatchEnergies e = patchEnergies(m);
    const int n = 2 * m + 2;
    // Greville abscissae reproduce x; the blossom of x^2 at (a, b, c) is (ab + bc + ca) / 3.
    const auto knots = segmentKnots(3, m, 2);
    Eigen::VectorXd square(n);
    Eigen::VectorXd linear(n);
    for (int i = 0; i < n; ++i)
    {
      const double a = knots[i + 1];
      const double b = knots[i + 2];
      const double c = knots[i + 3];
      square[i] = (a * b + b * c + c * a) / 3;
      linear[i] = (a + b + c) / 3;
    }
    Eigen::VectorXd uu(n * n);
    Eigen::VectorXd uv(n * n);
    for (int l = 0; l < n * n; ++l)
    {
      uu[l] = square[l % n];
      uv[l] = linear[l % n] * linear[l / n];
    }
    EXPECT_NEAR(uu.dot(e.thinPlate() * uu), 4.0, 1e-11);
    EXPECT_NEAR(uv.dot(e.thinPlate() * uv), 2.0, 1e-11);
    EXPECT_NEAR(uv.dot(e.Mass * uv), 1.0 / 9, 1e-13);
    EXPECT_NEAR(uu.dot(e.thinPlate(2.0, 3.0) * uu), 4.0 * 3 / 8, 1e-11);
  }
}
