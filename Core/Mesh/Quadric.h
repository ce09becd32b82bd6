#pragma once

#include "Common/Types.h"

namespace bsr
{
/// x' A x - 2 b' x + c: weighted sum of squared distances to planes.
struct Quadric
{
  std::array<double, 6> A{}; ///< xx xy xz yy yz zz
  Vec3 B = Vec3::Zero();
  double C = 0.0;

  void addPlane(const Vec3& n, const Vec3& p, double weight)
  {
    const double d = n.dot(p);
    this->A[0] += weight * n[0] * n[0];
    this->A[1] += weight * n[0] * n[1];
    this->A[2] += weight * n[0] * n[2];
    this->A[3] += weight * n[1] * n[1];
    this->A[4] += weight * n[1] * n[2];
    this->A[5] += weight * n[2] * n[2];
    this->B += weight * d * n;
    this->C += weight * d * d;
  }

  /// Three planes through p: pulls towards it.
  void addPoint(const Vec3& p, double weight)
  {
    this->A[0] += weight;
    this->A[3] += weight;
    this->A[5] += weight;
    this->B += weight * p;
    this->C += weight * p.squaredNorm();
  }

  void add(const Quadric& q)
  {
    for (int i = 0; i < 6; ++i)
    {
      this->A[i] += q.A[i];
    }
    this->B += q.B;
    this->C += q.C;
  }

  /// Sum of the planes' weights.
  double weight() const { return this->A[0] + this->A[3] + this->A[5]; }

  double at(const Vec3& x) const
  {
    const auto& a = this->A;
    const Vec3 ax(a[0] * x[0] + a[1] * x[1] + a[2] * x[2], a[1] * x[0] + a[3] * x[1] + a[4] * x[2],
      a[2] * x[0] + a[4] * x[1] + a[5] * x[2]);
    return x.dot(ax) - 2.0 * this->B.dot(x) + this->C;
  }

  /// The place of the least value, by Cholesky; not finite where A is singular.
  Vec3 minimum() const
  {
    const auto& a = this->A;
    const double l10 = a[1] / a[0];
    const double l20 = a[2] / a[0];
    const double d1 = a[3] - l10 * a[1];
    const double e = a[4] - l20 * a[1];
    const double l21 = e / d1;
    const double d2 = a[5] - l20 * a[2] - l21 * e;
    const double y1 = this->B[1] - l10 * this->B[0];
    const double y2 = this->B[2] - l20 * this->B[0] - l21 * y1;
    const double z = y2 / d2;
    const double y = y1 / d1 - l21 * z;
    return {this->B[0] / a[0] - l10 * y - l20 * z, y, z};
  }
};
} // namespace bsr
