#include "Spline/Basis.h"

#include <algorithm>

namespace bsr
{
namespace
{
int findSpan(const double* knots, int degree, int count, double t)
{
  if (t >= knots[count])
  {
    int span = count - 1;
    while (span > degree && knots[span] >= knots[count])
    {
      --span;
    }
    return span;
  }
  const double* upper = std::upper_bound(knots + degree, knots + count, t);
  return static_cast<int>(upper - knots) - 1;
}

using Row = std::array<double, MaximumDegree + 1>;

/// The d + 1 B-splines of degree d on the span (Cox, de Boor).
Row basisOfDegree(const double* knots, int span, int d, double t)
{
  Row n{};
  n[0] = 1.0;
  for (int j = 1; j <= d; ++j)
  {
    double saved = 0.0;
    for (int r = 0; r < j; ++r)
    {
      const double right = knots[span + r + 1];
      const double left = knots[span + 1 - j + r];
      const double term = n[r] / (right - left);
      n[r] = saved + (right - t) * term;
      saved = (t - left) * term;
    }
    n[j] = saved;
  }
  return n;
}

/// Derivatives of the splines of degree d from (derivatives of) those of degree d - 1.
Row differentiate(const double* knots, int span, int d, const Row& lower)
{
  Row n{};
  for (int r = 0; r <= d; ++r)
  {
    const int i = span - d + r;
    double v = 0.0;
    if (r > 0)
    {
      v += lower[r - 1] / (knots[i + d] - knots[i]);
    }
    if (r < d)
    {
      v -= lower[r] / (knots[i + d + 1] - knots[i + 1]);
    }
    n[r] = d * v;
  }
  return n;
}
} // namespace

BasisValues evaluateBasis(const double* knots, int degree, int count, double t)
{
  t = std::clamp(t, knots[degree], knots[count]);
  const int span = findSpan(knots, degree, count, t);
  BasisValues b;
  b.First = span - degree;
  b.Value = basisOfDegree(knots, span, degree, t);
  if (degree >= 1)
  {
    b.Derivative = differentiate(knots, span, degree, basisOfDegree(knots, span, degree - 1, t));
  }
  if (degree >= 2)
  {
    const Row low = basisOfDegree(knots, span, degree - 2, t);
    b.Derivative2 = differentiate(knots, span, degree, differentiate(knots, span, degree - 1, low));
  }
  return b;
}

std::vector<double> segmentKnots(int degree, int segments, int inner)
{
  std::vector<double> k(degree + 1, 0.0);
  for (int s = 1; s < segments; ++s)
  {
    k.insert(k.end(), inner, static_cast<double>(s) / segments);
  }
  k.insert(k.end(), degree + 1, 1.0);
  return k;
}
} // namespace bsr
