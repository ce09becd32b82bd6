#include "Spline/FoldCheck.h"

#include "Common/Parallel.h"

#include <cmath>

namespace bsr
{
namespace
{
constexpr int Samples = 25;

/// `at(i, j)` gives the surface at sample i along u and j along v.
template <class At>
PatchShape shapeOf(const At& at)
{
  std::vector<Vec3> normal(Samples * Samples);
  double mean = 0.0;
  double least = std::numeric_limits<double>::max();
  for (int j = 0; j < Samples; ++j)
  {
    for (int i = 0; i < Samples; ++i)
    {
      Vec3& n = normal[j * Samples + i];
      n = at(i, j).normal();
      mean += n.norm() / (Samples * Samples);
      least = std::min(least, n.norm());
    }
  }
  PatchShape s;
  s.Folded = normalsFold(normal, Samples);
  s.MinJacobian = mean > 0.0 ? least / mean : 0.0;
  s.MinJacobian *= s.Folded ? -1.0 : 1.0;
  return s;
}
} // namespace

bool normalsFold(const std::vector<Vec3>& normals, int grid)
{
  double mean = 0.0;
  double least = std::numeric_limits<double>::max();
  for (const Vec3& n : normals)
  {
    mean += n.norm() / static_cast<double>(normals.size());
    least = std::min(least, n.norm());
  }
  bool folded = !(least >= 1e-5 * mean) || mean == 0.0;
  for (int i = 0; i < grid * grid; ++i)
  {
    folded = folded || (i % grid > 0 && normals[i].dot(normals[i - 1]) <= 0.0) ||
             (i >= grid && normals[i].dot(normals[i - grid]) <= 0.0);
  }
  return folded;
}

std::vector<PatchShape> checkShapes(const PatchNet& net, const NetPoints& surface)
{
  const NetEvaluator evaluator(net, surface);
  std::vector<BasisValues> basis;
  basis.reserve(Samples);
  for (int i = 0; i < Samples; ++i)
  {
    basis.push_back(evaluator.basis(i / (Samples - 1.0)));
  }
  std::vector<PatchShape> shapes(net.patches());
  parallelFor(0, net.patches(), 8,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t p = begin; p < end; ++p)
      {
        const auto patch = static_cast<Index>(p);
        shapes[p] = shapeOf([&](int i, int j) { return evaluator.at(patch, basis[i], basis[j]); });
      }
    });
  return shapes;
}

PatchShape checkShape(const RationalPatch& patch)
{
  return shapeOf([&](int i, int j) { return patch.at(i / (Samples - 1.0), j / (Samples - 1.0)); });
}

double largestNormalJump(
  const QuadComplex& complex, const NetEvaluator& evaluator, const Creases& creases)
{
  const auto normalAt = [&](Index h, double t)
  {
    const double uv[4][2] = {{t, 0.0}, {1.0, t}, {1.0 - t, 1.0}, {0.0, 1.0 - t}};
    return evaluator.at(h / 4, uv[h % 4][0], uv[h % 4][1]).normal();
  };
  return parallelReduce<double>(
    0, complex.edges(), 64, 0.0,
    [&](std::int64_t begin, std::int64_t end)
    {
      double worst = 0.0;
      for (std::int64_t e = begin; e < end; ++e)
      {
        const QuadEdge& edge = complex.edge(static_cast<Index>(e));
        const bool smooth = edge.Second >= 0 && !creases.at(static_cast<Index>(e));
        for (int s = 0; s <= 24 && smooth; ++s)
        {
          const Vec3 a = normalAt(edge.First, s / 24.0);
          const Vec3 b = normalAt(edge.Second, 1.0 - s / 24.0);
          worst = std::max(worst, std::atan2(a.cross(b).norm(), a.dot(b)));
        }
      }
      return worst * 57.29577951308232;
    },
    [](double a, double b) { return std::max(a, b); });
}
} // namespace bsr
