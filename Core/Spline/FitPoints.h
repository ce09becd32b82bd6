#pragma once

#include "Spline/Basis.h"
#include "Spline/PatchNet.h"

namespace bsr
{
/// A data point with its parameters on a patch.
struct FitPoint
{
  Vec3 Position = Vec3::Zero();
  Index Patch = 0;
  double U = 0.5;
  double V = 0.5;
  double Weight = 1.0; ///< the user's weight
  double Robust = 1.0; ///< factor of the robust estimation, 0 for outliers
  Index Source = -1;   ///< index of the input point
  bool Fixed = false;  ///< rim samples: keep their parameters and their weight

  double weight() const { return this->Weight * this->Robust; }
};

using NetPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A point of a polynomial patch with its derivatives.
struct PatchPoint
{
  Vec3 Point;
  Vec3 Du;
  Vec3 Dv;
  Vec3 Duu;
  Vec3 Duv;
  Vec3 Dvv;

  Vec3 normal() const { return this->Du.cross(this->Dv); }
};

/// Evaluates the patches of a net.
class NetEvaluator
{
public:
  NetEvaluator(const PatchNet& net, const NetPoints& points)
      : Net(net), Points(points), Knots(segmentKnots(3, net.segments(), 2))
  {
  }

  BasisValues basis(double t) const
  {
    return evaluateBasis(this->Knots.data(), 3, this->Net.side(), t);
  }
  PatchPoint at(Index patch, double u, double v) const
  {
    return this->at(patch, this->basis(u), this->basis(v));
  }
  PatchPoint at(Index patch, const BasisValues& u, const BasisValues& v) const;

private:
  const PatchNet& Net;
  const NetPoints& Points;
  std::vector<double> Knots;
};

/// Sorts by patch, keeping the order within one; returns the first point of each patch and the end.
std::vector<std::int64_t> sortByPatch(std::vector<FitPoint>& points, Index patches);
} // namespace bsr
