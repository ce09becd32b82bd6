#include "Spline/FitEquations.h"

#include "Common/Parallel.h"

namespace bsr
{
namespace
{
Eigen::MatrixXd patchNet(const PatchNet& net, const NetPoints& points, Index patch)
{
  Eigen::MatrixXd own(net.perPatch(), 3);
  for (int l = 0; l < net.perPatch(); ++l)
  {
    own.row(l) = points.row(net.at(patch, l));
  }
  return own;
}
} // namespace

PatchBlocks FitEquations::blocks(const PatchNet& net, double lambda, double dataWeight) const
{
  const double data =
    (1.0 - lambda) * dataWeight * net.patches() / std::max(this->TotalWeight, 1e-300);
  PatchBlocks b;
  b.resize(net.patches(), net.perPatch());
  const auto one = [&](Index p)
  {
    b.Matrix[p] = data * this->Data.Matrix[p];
    b.Right[p] = data * this->Data.Right[p];
    const double fairing = lambda * this->Stiffness[p];
    const auto [a, c] = this->Aspect[p];
    const Eigen::MatrixXd stiffness = fairing * this->Energies.thinPlate(a, c);
    b.Matrix[p] += stiffness;
    if (this->RestShape.rows() > 0)
    {
      b.Right[p] += stiffness * patchNet(net, this->RestShape, p);
    }
    if (this->Pull[p] > 0.0)
    {
      b.Matrix[p] += this->Pull[p] * this->Energies.Mass;
      b.Right[p] += this->Pull[p] * (this->Energies.Mass * patchNet(net, this->Reference, p));
    }
  };
  parallelFor(0, net.patches(), 8,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t p = begin; p < end; ++p)
      {
        one(static_cast<Index>(p));
      }
    });
  return b;
}
} // namespace bsr
