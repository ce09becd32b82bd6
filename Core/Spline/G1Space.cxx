#include "Spline/G1Space.h"

#include "Spline/G1Edge.h"

#include <Eigen/Dense>

#include <cmath>

namespace bsr
{
namespace
{
/// Columns: an orthonormal basis of the vectors of size n orthogonal to (1, -1, 1, ...).
Eigen::MatrixXd alternatingComplement(int n)
{
  Eigen::MatrixXd a(n, 1);
  for (int k = 0; k < n; ++k)
  {
    a(k, 0) = k % 2 ? -1.0 : 1.0;
  }
  const Eigen::MatrixXd q = a.householderQr().householderQ() * Eigen::MatrixXd::Identity(n, n);
  return q.rightCols(n - 1);
}

class Builder
{
public:
  Builder(const QuadComplex& complex, const PatchNet& net, EdgeRule rule, const Creases& creases)
      : Complex(complex),
        Net(net),
        Rule(rule),
        Marks(creases),
        Frames(complex, creases),
        N(net.side()),
        Form(net.points())
  {
  }

  SplineSpace build()
  {
    this->TauOf.resize(this->Complex.vertices());
    for (Index v = 0; v < this->Complex.vertices(); ++v)
    {
      if (this->Complex.fan(v).faces() > 0)
      {
        this->vertexUnknowns(v);
      }
    }
    for (Index v = 0; v < this->Complex.vertices(); ++v)
    {
      this->coupledUnknowns(v);
    }
    for (Index e = 0; e < this->Complex.edges(); ++e)
    {
      this->edgeCurve(e);
    }
    for (Index v = 0; v < this->Complex.vertices(); ++v)
    {
      if (this->Complex.fan(v).faces() > 0)
      {
        for (std::size_t s = 0; s < this->Frames.at(v).Sectors.size(); ++s)
        {
          this->twists(this->Frames.at(v).Sectors[s].Fan, this->TauOf[v][s]);
        }
      }
    }
    for (Index e = 0; e < this->Complex.edges(); ++e)
    {
      this->edgeRows(e);
    }
    this->patchInteriors();
    SplineSpace s;
    s.Basis = matrixFrom(this->Form, static_cast<Index>(this->Read.size()));
    s.Reader = matrixFrom(this->Read, this->Net.points());
    return s;
  }

private:
  /// A new unknown that is read from a net by the form.
  LinearForm unknown(LinearForm read)
  {
    this->Read.push_back(std::move(read));
    return LinearForm(static_cast<int>(this->Read.size()) - 1);
  }
  LinearForm freePoint(Index point) { return this->unknown(LinearForm(point)); }

  bool coupled(Index v) const
  {
    const auto& sectors = this->Frames.at(v).Sectors;
    const int n = this->Complex.fan(v).faces();
    return !sectors.empty() && sectors[0].Fan.Closed && n >= 6 && n % 2 == 0;
  }

  /// An edge across which the tangent planes agree.
  bool smooth(Index e) const { return this->Complex.edge(e).Second >= 0 && !this->Marks.at(e); }

  void vertexUnknowns(Index v)
  {
    const VertexFan& fan = this->Complex.fan(v);
    const Index p = this->Net.spoke(fan, 0, 0);
    this->Form[p] = this->freePoint(p);
    this->tangents(fan, p, this->Frames.at(v).Tangents);
    for (const VertexSector& s : this->Frames.at(v).Sectors)
    {
      const bool free = !s.Fan.Closed || s.Fan.faces() % 2 == 0;
      this->TauOf[v].push_back(free ? this->unknown(this->readTau(s.Fan, p)) : LinearForm());
    }
  }

  /// d1_k = p + sum_j t(k, j) x_j, read by least squares.
  void tangents(const VertexFan& fan, Index p, const Eigen::MatrixXd& t)
  {
    const Eigen::MatrixXd inverse = (t.transpose() * t).inverse() * t.transpose();
    std::vector<LinearForm> axis;
    for (Eigen::Index a = 0; a < t.cols(); ++a)
    {
      LinearForm read(p, -inverse.row(a).sum());
      for (int k = 0; k < fan.spokes(); ++k)
      {
        read.add(LinearForm(this->Net.spoke(fan, k, 1)), inverse(a, k));
      }
      axis.push_back(this->unknown(std::move(read)));
    }
    for (int k = 0; k < fan.spokes(); ++k)
    {
      LinearForm d = this->Form[p];
      for (Eigen::Index a = 0; a < t.cols(); ++a)
      {
        d.add(axis[a], t(k, a));
      }
      this->Form[this->Net.spoke(fan, k, 1)] = d;
    }
  }

  LinearForm readTau(const VertexFan& fan, Index p) const
  {
    LinearForm read;
    if (fan.faces() == 1)
    {
      return read.add(LinearForm(this->Net.twist(fan, 0)))
        .add(LinearForm(this->Net.spoke(fan, 0, 1)), -1.0)
        .add(LinearForm(this->Net.spoke(fan, 1, 1)), -1.0)
        .add(LinearForm(p));
    }
    for (int k = 0; k < fan.faces(); ++k)
    {
      read.add(LinearForm(this->Net.twist(fan, k)), (k % 2 ? -1.0 : 1.0) / fan.faces());
    }
    return read;
  }

  int coupledIndex() const { return this->Rule == EdgeRule::Quadratic ? 3 : 2; }

  /// Closed even valence >= 6: the twists exist only if sum (-1)^k c_k = 0.
  void coupledUnknowns(Index v)
  {
    const VertexFan& fan = this->Complex.fan(v);
    if (!this->coupled(v))
    {
      return;
    }
    const int n = fan.faces();
    const Eigen::MatrixXd q = alternatingComplement(n);
    const Index p = this->Net.spoke(fan, 0, 0);
    std::vector<LinearForm> c(n, this->Form[p]);
    for (int i = 0; i < n - 1; ++i)
    {
      LinearForm read(p, -q.col(i).sum());
      for (int k = 0; k < n; ++k)
      {
        read.add(LinearForm(this->Net.spoke(fan, k, this->coupledIndex())), q(k, i));
      }
      const LinearForm y = this->unknown(std::move(read));
      for (int k = 0; k < n; ++k)
      {
        c[k].add(y, q(k, i));
      }
    }
    for (int k = 0; k < n; ++k)
    {
      this->Form[this->Net.spoke(fan, k, this->coupledIndex())] = c[k];
    }
  }

  std::vector<LinearForm> curve(Index e) const
  {
    std::vector<LinearForm> d(this->N);
    for (int c = 0; c < this->N; ++c)
    {
      d[c] = this->Form[this->Net.row(this->Complex.edge(e).First, 0, c)];
    }
    return d;
  }

  void edgeCurve(Index e)
  {
    const QuadEdge& edge = this->Complex.edge(e);
    const Index from = this->Complex.from(edge.First);
    const Index to = this->Complex.to(edge.First);
    const bool inner = this->smooth(e);
    const EdgeAlpha alpha{
      inner ? this->Frames.alpha(edge.First) : 0.0, inner ? this->Frames.alpha(edge.Second) : 0.0};
    for (int c = 2; c < this->N - 2; ++c)
    {
      const bool isCoupled = (this->coupled(from) && c == this->coupledIndex()) ||
                             (this->coupled(to) && c == this->N - 1 - this->coupledIndex());
      if (!isCoupled && !isPivot(this->Rule, alpha, this->N, c))
      {
        const Index point = this->Net.row(edge.First, 0, c);
        this->Form[point] = this->freePoint(point);
      }
    }
    auto d = this->curve(e);
    solvePivots(this->Rule, alpha, d);
    for (int c = 2; c < this->N - 2; ++c)
    {
      this->Form[this->Net.row(edge.First, 0, c)] = d[c];
    }
    this->Sum.push_back(inner ? edgeSum(this->Rule, alpha, d) : std::vector<LinearForm>());
  }

  /// 2 d1 + L1 of spoke k, seen from the vertex.
  LinearForm rho(const VertexFan& fan, int k) const
  {
    const Index h = fan.HalfEdges[k];
    const Index e = this->Complex.edgeOf(h);
    LinearForm r = this->Sum[e][this->Complex.edge(e).First == h ? 1 : this->N - 2];
    return r.add(this->Form[this->Net.spoke(fan, k, 1)], 2.0);
  }

  void twists(const VertexFan& fan, const LinearForm& tau)
  {
    const int n = fan.faces();
    std::vector<LinearForm> w(n);
    if (fan.Closed && n % 2 == 1)
    {
      std::vector<LinearForm> r(n);
      for (int k = 0; k < n; ++k)
      {
        r[k] = this->rho(fan, k);
      }
      for (int k = 0; k < n; ++k)
      {
        for (int j = 0; j < n; ++j)
        {
          w[k].add(r[(k + 1 + j) % n], j % 2 ? -0.5 : 0.5);
        }
      }
    }
    else if (n == 1)
    {
      w[0] = combine({{1.0, &this->Form[this->Net.spoke(fan, 0, 1)]},
        {1.0, &this->Form[this->Net.spoke(fan, 1, 1)]},
        {-1.0, &this->Form[this->Net.spoke(fan, 0, 0)]}, {1.0, &tau}});
    }
    else
    {
      this->alternatingTwists(fan, tau, w);
    }
    for (int k = 0; k < n; ++k)
    {
      this->Form[this->Net.twist(fan, k)] = w[k];
    }
  }

  void alternatingTwists(
    const VertexFan& fan, const LinearForm& tau, std::vector<LinearForm>& w) const
  {
    const int n = fan.faces();
    LinearForm mean;
    for (int k = 1; k < n; ++k)
    {
      w[k] = this->rho(fan, k);
      w[k].add(w[k - 1], -1.0);
      mean.add(w[k], (k % 2 ? -1.0 : 1.0) / n);
    }
    LinearForm shift = tau;
    shift.add(mean, -1.0);
    for (int k = 0; k < n; ++k)
    {
      w[k].add(shift, k % 2 ? -1.0 : 1.0);
    }
  }

  void edgeRows(Index e)
  {
    const QuadEdge& edge = this->Complex.edge(e);
    for (int c = 2; c < this->N - 2; ++c)
    {
      const Index p = this->Net.row(edge.First, 1, c);
      const Index q = edge.Second < 0 ? -1 : this->Net.row(edge.Second, 1, this->N - 1 - c);
      if (!this->smooth(e))
      {
        this->Form[p] = this->freePoint(p);
        if (q >= 0)
        {
          this->Form[q] = this->freePoint(q);
        }
        continue;
      }
      LinearForm read(p, 0.5);
      const LinearForm delta = this->unknown(read.add(LinearForm(q), -0.5));
      LinearForm middle = this->Form[this->Net.row(edge.First, 0, c)];
      middle.add(this->Sum[e][c], 0.5);
      this->Form[p] = combine({{1.0, &middle}, {1.0, &delta}});
      this->Form[q] = combine({{1.0, &middle}, {-1.0, &delta}});
    }
  }

  void patchInteriors()
  {
    for (Index f = 0; f < this->Complex.faces(); ++f)
    {
      for (int j = 2; j < this->N - 2; ++j)
      {
        for (int i = 2; i < this->N - 2; ++i)
        {
          const Index p = this->Net.at(f, i, j);
          this->Form[p] = this->freePoint(p);
        }
      }
    }
  }

  const QuadComplex& Complex;
  const PatchNet& Net;
  EdgeRule Rule;
  const Creases& Marks;
  VertexFrames Frames;
  int N;
  std::vector<LinearForm> Form;               ///< of each net point, over unknowns
  std::vector<LinearForm> Read;               ///< of each unknown, over net points
  std::vector<std::vector<LinearForm>> TauOf; ///< of each sector of each vertex
  std::vector<std::vector<LinearForm>> Sum;   ///< P + Q - 2 d of each inner edge
};
} // namespace

EdgeRule defaultRule(int segments)
{
  return segments == 3 ? EdgeRule::Linear : EdgeRule::Quadratic;
}

SplineSpace makeG1Space(
  const QuadComplex& complex, const PatchNet& net, EdgeRule rule, const Creases& creases)
{
  return Builder(complex, net, rule, creases).build();
}

SparseRows g1Constraints(
  const QuadComplex& complex, const PatchNet& net, EdgeRule rule, const Creases& creases)
{
  const VertexFrames frames(complex, creases);
  const int n = net.side();
  std::vector<LinearForm> rows;
  for (Index e = 0; e < complex.edges(); ++e)
  {
    const QuadEdge& edge = complex.edge(e);
    if (edge.Second < 0 || creases.at(e))
    {
      continue;
    }
    const EdgeAlpha alpha{frames.alpha(edge.First), frames.alpha(edge.Second)};
    std::vector<LinearForm> d(n);
    for (int c = 0; c < n; ++c)
    {
      d[c] = LinearForm(net.row(edge.First, 0, c));
    }
    const auto curveRows = curveConditions(rule, alpha, d);
    rows.insert(rows.end(), curveRows.begin(), curveRows.end());
    const auto sum = edgeSumGeneric(rule, alpha, d);
    for (int c = 0; c < n; ++c)
    {
      LinearForm row(net.row(edge.First, 1, c));
      row.add(LinearForm(net.row(edge.Second, 1, n - 1 - c)));
      row.add(d[c], -2.0).add(sum[c], -1.0);
      rows.push_back(std::move(row));
    }
  }
  return matrixFrom(rows, net.points());
}
} // namespace bsr
