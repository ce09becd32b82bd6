#include "Spline/ModelBuilder.h"

#include <map>

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
  explicit Builder(const QuadComplex& complex) : Complex(complex) {}

  void addShell(const std::vector<RationalPatch>& patches, Shell side)
  {
    const auto first = static_cast<std::int64_t>(this->Model.Patches.size());
    const bool turn = side == Shell::Inner;
    for (Index f = 0; f < this->Complex.faces(); ++f)
    {
      const RationalPatch& own = patches[f];
      const int n = own.countU();
      const int m = own.countV();
      this->addPatch(
        side, turn ? own.SegmentsV : own.SegmentsU, 3, turn ? own.SegmentsU : own.SegmentsV);
      for (int l = 0; l < n * m; ++l)
      {
        this->Model.ControlPoints.push_back(own.ControlPoints[turn ? (l % m) * n + l / m : l]);
      }
      std::array<std::int64_t, 4> neighbor{};
      for (int k = 0; k < 4; ++k)
      {
        const Index t = this->Complex.twin(4 * f + k);
        const int mine = turn ? transposedSide(k) : k;
        neighbor[mine] = t < 0 ? -1 : 4 * (first + t / 4) + (turn ? transposedSide(t % 4) : t % 4);
      }
      this->Model.Neighbors.push_back(neighbor);
    }
  }

  void addWalls(const std::vector<RationalPatch>& outer, const std::vector<RationalPatch>& inner)
  {
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
  /// First knot of a direction; patches share the vectors.
  std::int64_t knots(int degree, int segments)
  {
    const auto [it, isNew] = this->FirstKnot.try_emplace(
      {degree, segments}, static_cast<std::int64_t>(this->Model.Knots.size()));
    if (isNew)
    {
      const auto k = segmentKnots(degree, segments, 2);
      this->Model.Knots.insert(this->Model.Knots.end(), k.begin(), k.end());
    }
    return it->second;
  }

  void addPatch(Shell side, int segmentsU, int degreeV, int segmentsV)
  {
    SplinePatch p;
    p.Side = side;
    p.CountU = 2 * segmentsU + 2;
    p.DegreeV = degreeV;
    p.CountV = degreeV == 1 ? 2 : 2 * segmentsV + 2;
    p.FirstKnotU = this->knots(3, segmentsU);
    p.FirstKnotV = this->knots(degreeV, segmentsV);
    p.FirstControlPoint = static_cast<std::int64_t>(this->Model.ControlPoints.size());
    this->Model.Patches.push_back(p);
  }

  void addWall(
    Index h, const std::vector<RationalPatch>& outer, const std::vector<RationalPatch>& inner)
  {
    const auto wall = static_cast<std::int64_t>(this->Model.Patches.size());
    const RationalPatch& own = outer[h / 4];
    this->addPatch(Shell::Wall, h % 2 == 0 ? own.SegmentsU : own.SegmentsV, 1, 1);
    for (const auto* shell : {&outer, &inner})
    {
      const RationalPatch& patch = (*shell)[h / 4];
      const int n = sideCount(patch, h % 4);
      for (int c = 0; c < n; ++c)
      {
        this->Model.ControlPoints.push_back(
          patch.ControlPoints[sideIndex(patch, h % 4, n - 1 - c)]);
      }
    }
    const std::int64_t innerPatch = this->Complex.faces() + h / 4;
    const int innerSide = transposedSide(h % 4);
    this->Model.Neighbors.push_back({h, -1, 4 * innerPatch + innerSide, -1});
    this->Model.Neighbors[h / 4][h % 4] = 4 * wall;
    this->Model.Neighbors[innerPatch][innerSide] = 4 * wall + 2;
  }

  const QuadComplex& Complex;
  std::map<std::pair<int, int>, std::int64_t> FirstKnot;
};
} // namespace

SplineModel buildModel(const QuadComplex& complex, const std::vector<RationalPatch>& outer,
  const std::vector<RationalPatch>* inner)
{
  Builder b(complex);
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

std::vector<RationalPatch> ownPatches(const PatchNet& net, const NetPoints& points)
{
  std::vector<RationalPatch> own;
  own.reserve(net.patches());
  for (Index f = 0; f < net.patches(); ++f)
  {
    own.push_back(ownPatch(net, points, f));
  }
  return own;
}
} // namespace bsr
