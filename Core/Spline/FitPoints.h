#pragma once

#include "Spline/Basis.h"
#include "Spline/PatchNet.h"
#include "Spline/RationalPatch.h"

namespace bsr
{
/// A data point with its parameters on a patch.
struct FitPoint
{
  Vec3 Position = Vec3::Zero();
  Index Patch = 0;
  double U = 0.5;
  double V = 0.5;
  Vec3 Normal = Vec3::Zero(); ///< of the surface the point comes from, either sign; 0: unknown
  double Weight = 1.0;        ///< the user's weight
  double Robust = 1.0;        ///< factor of the robust estimation, 0 for outliers
  Index Source = -1;          ///< index of the input point
  bool Fixed = false;         ///< rim samples: keep their parameters and their weight

  double weight() const { return this->Weight * this->Robust; }
};

using NetPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Evaluates the patches of a net.
class NetEvaluator
{
public:
  /// Patches of `own` that are not empty take the place of the net's.
  NetEvaluator(
    const PatchNet& net, const NetPoints& points, const std::vector<RationalPatch>* own = nullptr)
      : Net(net), Points(points), Own(own), Knots(segmentKnots(3, net.segments(), 2))
  {
  }

  BasisValues basis(double t) const
  {
    return evaluateBasis(this->Knots.data(), 3, this->Net.side(), t);
  }
  SurfacePoint at(Index patch, double u, double v) const
  {
    if (this->Own && !this->Own->empty() && !(*this->Own)[patch].empty())
    {
      return (*this->Own)[patch].at(u, v);
    }
    return this->at(patch, this->basis(u), this->basis(v));
  }
  /// Of the net's own patch.
  SurfacePoint at(Index patch, const BasisValues& u, const BasisValues& v) const;

private:
  const PatchNet& Net;
  const NetPoints& Points;
  const std::vector<RationalPatch>* Own;
  std::vector<double> Knots;
};

/// A patch of a net on its own, with weights of 1.
RationalPatch ownPatch(const PatchNet& net, const NetPoints& points, Index patch);

/// Sorts by patch, keeping the order within one; returns the first point of each patch and the end.
std::vector<std::int64_t> sortByPatch(std::vector<FitPoint>& points, Index patches);
} // namespace bsr
