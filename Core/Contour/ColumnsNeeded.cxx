#include "Contour/BranchedNetwork.h"
#include "Contour/UniformSpline.h"
#include "Spline/Basis.h"

#include <cmath>

namespace bsr
{
namespace
{
/// Largest distance from a closed contour of the curve through n of its points.
double sectionError(const ArcCurve& curve, int order, int n)
{
  const double offset = siteOffset(order);
  ControlRow points;
  for (int i = 0; i < n; ++i)
  {
    points.push_back(curve.at((i + offset) / n));
  }
  const ControlRow row = PeriodicInterpolation(order, n).solve(points);
  const ControlRow piece = periodicPiece(row, order, 0, n);
  const std::vector<double> knots = clampedKnots(order, n);
  double sum = 0.0;
  const int samples = 2 * n;
  for (int i = 0; i < samples; ++i)
  {
    const double u = 0.5 * i + 0.5 * (0.5 - offset); // between the sites, and a quarter beside them
    const BasisValues b = evaluateBasis(knots.data(), order - 1, static_cast<int>(piece.size()), u);
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < order; ++k)
    {
      p += b.Value[k] * piece[b.First + k];
    }
    sum += (curve.at(curve.nearest(p)) - p).squaredNorm() / samples;
  }
  return std::sqrt(sum);
}
} // namespace

int columnsNeeded(const Contour& contour, int order, double tolerance)
{
  const ArcCurve curve(contour.Points, true);
  for (const int n : {16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 160, 192})
  {
    if (sectionError(curve, order, n) <= tolerance)
    {
      return n;
    }
  }
  return 224;
}
} // namespace bsr
