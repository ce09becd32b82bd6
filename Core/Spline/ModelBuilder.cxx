#include "Spline/ModelBuilder.h"

namespace bsr
{
namespace
{
/// Side of the transposed patch that side s becomes.
int transposedSide(int s)
{
  return 3 - s;
}

class Builder
{
public:
  Builder(const QuadComplex& complex, const PatchNet& net) : Complex(complex), Net(net)
  {
    this->Model.Knots = segmentKnots(3, net.segments(), 2);
    this->LinearKnots = static_cast<std::int64_t>(this->Model.Knots.size());
  }

  void addShell(const NetPoints& points, Shell side)
  {
    const auto first = static_cast<std::int64_t>(this->Model.Patches.size());
    const bool turn = side == Shell::Inner;
    const int n = this->Net.side();
    for (Index f = 0; f < this->Complex.faces(); ++f)
    {
      this->addPatch(side, n, 0);
      for (int l = 0; l < n * n; ++l)
      {
        const int i = l % n;
        const int j = l / n;
        this->addPoint(points.row(turn ? this->Net.at(f, j, i) : this->Net.at(f, i, j)));
      }
      std::array<std::int64_t, 4> neighbor{};
      for (int k = 0; k < 4; ++k)
      {
        const Index t = this->Complex.twin(4 * f + k);
        const int own = turn ? transposedSide(k) : k;
        neighbor[own] = t < 0 ? -1 : 4 * (first + t / 4) + (turn ? transposedSide(t % 4) : t % 4);
      }
      this->Model.Neighbors.push_back(neighbor);
    }
  }

  void addWalls(const NetPoints& outer, const NetPoints& inner)
  {
    this->Model.Knots.insert(this->Model.Knots.end(), {0.0, 0.0, 1.0, 1.0});
    for (const auto& loop : this->Complex.borderLoops())
    {
      const auto first = static_cast<std::int64_t>(this->Model.Patches.size());
      const auto count = static_cast<std::int64_t>(loop.size());
      for (std::int64_t i = 0; i < count; ++i)
      {
        this->addWall(loop[i], outer, inner);
        auto& neighbor = this->Model.Neighbors.back();
        // u runs against the border, so that the normal points out of the solid.
        neighbor[3] = 4 * (first + (i + 1) % count) + 1;
        neighbor[1] = 4 * (first + (i + count - 1) % count) + 3;
      }
    }
  }

  SplineModel Model;

private:
  void addPatch(Shell side, int countV, std::int64_t firstKnotV)
  {
    SplinePatch p;
    p.Side = side;
    p.CountU = this->Net.side();
    p.CountV = countV;
    p.DegreeV = countV == 2 ? 1 : 3;
    p.FirstKnotV = firstKnotV;
    p.FirstControlPoint = static_cast<std::int64_t>(this->Model.ControlPoints.size());
    this->Model.Patches.push_back(p);
  }

  template <class Row>
  void addPoint(const Row& p)
  {
    this->Model.ControlPoints.emplace_back(p[0], p[1], p[2], 1.0);
  }

  void addWall(Index h, const NetPoints& outer, const NetPoints& inner)
  {
    const auto wall = static_cast<std::int64_t>(this->Model.Patches.size());
    const int n = this->Net.side();
    this->addPatch(Shell::Wall, 2, this->LinearKnots);
    for (const NetPoints* shell : {&outer, &inner})
    {
      for (int c = 0; c < n; ++c)
      {
        this->addPoint(shell->row(this->Net.row(h, 0, n - 1 - c)));
      }
    }
    const std::int64_t innerPatch = this->Complex.faces() + h / 4;
    const int innerSide = transposedSide(h % 4);
    this->Model.Neighbors.push_back({h, -1, 4 * innerPatch + innerSide, -1});
    this->Model.Neighbors[h / 4][h % 4] = 4 * wall;
    this->Model.Neighbors[innerPatch][innerSide] = 4 * wall + 2;
  }

  const QuadComplex& Complex;
  const PatchNet& Net;
  std::int64_t LinearKnots;
};
} // namespace

SplineModel buildModel(
  const QuadComplex& complex, const PatchNet& net, const NetPoints& outer, const NetPoints* inner)
{
  Builder b(complex, net);
  b.addShell(outer, Shell::Outer);
  if (inner)
  {
    b.addShell(*inner, Shell::Inner);
    if (!complex.closed())
    {
      b.addWalls(outer, *inner);
    }
  }
  return std::move(b.Model);
}
} // namespace bsr
