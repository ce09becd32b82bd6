#include "Spline/PatchNet.h"

namespace bsr
{
namespace
{
/// Local number of the point (r, c) seen from side k.
int localOf(int k, int r, int c, int n)
{
  switch (k)
  {
  case 0:
    return r * n + c;
  case 1:
    return c * n + (n - 1 - r);
  case 2:
    return (n - 1 - r) * n + (n - 1 - c);
  default:
    return (n - 1 - c) * n + r;
  }
}
} // namespace

PatchNet::PatchNet(const QuadComplex& complex, int segments)
    : Segments(segments), Side(2 * segments + 2), Patches(complex.faces())
{
  const int n = this->Side;
  this->Map.assign(static_cast<std::size_t>(this->Patches) * n * n, -1);
  std::vector<Index> vertexPoint(complex.vertices(), -1);
  for (Index v = 0; v < complex.vertices(); ++v)
  {
    if (complex.fan(v).faces() > 0)
    {
      vertexPoint[v] = this->Count++;
    }
  }
  const auto set = [&](Index halfEdge, int r, int c, Index point)
  {
    this->Map[static_cast<std::size_t>(halfEdge / 4) * n * n + localOf(halfEdge % 4, r, c, n)] =
      point;
  };
  for (Index h = 0; h < 4 * this->Patches; ++h)
  {
    set(h, 0, 0, vertexPoint[complex.from(h)]);
  }
  for (Index e = 0; e < complex.edges(); ++e)
  {
    const QuadEdge& edge = complex.edge(e);
    for (int c = 1; c < n - 1; ++c)
    {
      set(edge.First, 0, c, this->Count);
      if (edge.Second >= 0)
      {
        set(edge.Second, 0, n - 1 - c, this->Count);
      }
      ++this->Count;
    }
  }
  for (Index f = 0; f < this->Patches; ++f)
  {
    for (int j = 1; j < n - 1; ++j)
    {
      for (int i = 1; i < n - 1; ++i)
      {
        set(4 * f, j, i, this->Count++);
      }
    }
  }
}

Index PatchNet::row(Index halfEdge, int r, int c) const
{
  return this->at(halfEdge / 4, localOf(halfEdge % 4, r, c, this->Side));
}

Index PatchNet::spoke(const VertexFan& fan, int k, int c) const
{
  if (k < fan.faces())
  {
    return this->row(fan.HalfEdges[k], 0, c);
  }
  const Index last = fan.HalfEdges.back();
  return this->row(last / 4 * 4 + (last + 3) % 4, 0, this->Side - 1 - c);
}

SparseRows matrixFrom(const std::vector<LinearForm>& rows, Index columns)
{
  SparseRows m(static_cast<Eigen::Index>(rows.size()), columns);
  std::vector<int> sizes;
  sizes.reserve(rows.size());
  for (const LinearForm& r : rows)
  {
    sizes.push_back(static_cast<int>(r.terms().size()));
  }
  m.reserve(sizes);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    for (const auto& [column, value] : rows[i].terms())
    {
      m.insert(static_cast<Eigen::Index>(i), column) = value;
    }
  }
  m.makeCompressed();
  return m;
}

SplineSpace makeC0Space(const PatchNet& net)
{
  SplineSpace s;
  s.Basis.resize(net.points(), net.points());
  s.Basis.setIdentity();
  s.Reader = s.Basis;
  return s;
}
} // namespace bsr
