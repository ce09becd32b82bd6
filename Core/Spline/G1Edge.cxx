#include "Spline/G1Edge.h"

#include <array>

namespace bsr
{
namespace
{
using Forms = std::vector<LinearForm>;

LinearForm difference(const LinearForm& a, const LinearForm& b, double factor)
{
  return combine({{factor, &a}, {-factor, &b}});
}

/// Bernstein coefficients of alpha on segment s of m: none (zero), two or three.
std::vector<double> alphaOn(EdgeRule rule, const EdgeAlpha& alpha, int s, int m)
{
  const double a = alpha.A;
  const double b = alpha.B;
  if (rule == EdgeRule::Quadratic)
  {
    if (s == 0 && a != 0.0)
    {
      return {a, 0.0, 0.0};
    }
    return s == m - 1 && b != 0.0 ? std::vector<double>{0.0, 0.0, -b} : std::vector<double>{};
  }
  if (a == 0.0 && b == 0.0)
  {
    return {};
  }
  if (s == 0)
  {
    return a == 0.0 ? std::vector<double>{} : std::vector<double>{a, a / 3};
  }
  if (s == 2)
  {
    return b == 0.0 ? std::vector<double>{} : std::vector<double>{-b / 3, -b};
  }
  if (a == 0.0)
  {
    return {0.0, 0.0, -b / 3};
  }
  return b == 0.0 ? std::vector<double>{a / 3, 0.0, 0.0} : std::vector<double>{a / 3, -b / 3};
}

std::array<LinearForm, 4> bezierSegment(const Forms& d, int s, int m)
{
  const int n = static_cast<int>(d.size());
  std::array<LinearForm, 4> b;
  b[0] = s == 0 ? d[0] : combine({{0.5, &d[2 * s]}, {0.5, &d[2 * s + 1]}});
  b[1] = d[2 * s + 1];
  b[2] = d[2 * s + 2];
  b[3] = s == m - 1 ? d[n - 1] : combine({{0.5, &d[2 * s + 2]}, {0.5, &d[2 * s + 3]}});
  return b;
}

/// Bernstein coefficients of alpha times the differences of the segment's control points.
std::array<LinearForm, 4> product(const std::vector<double>& a, const std::array<LinearForm, 4>& b)
{
  const LinearForm d0 = difference(b[1], b[0], 1.0);
  const LinearForm d1 = difference(b[2], b[1], 1.0);
  const LinearForm d2 = difference(b[3], b[2], 1.0);
  if (a.size() == 2)
  {
    return {combine({{a[0], &d0}}), combine({{a[1] / 3, &d0}, {2 * a[0] / 3, &d1}}),
      combine({{2 * a[1] / 3, &d1}, {a[0] / 3, &d2}}), combine({{a[1], &d2}})};
  }
  if (a.size() == 3)
  {
    return {combine({{a[0], &d0}}), combine({{2 * a[1] / 3, &d0}, {a[0] / 3, &d2}}),
      combine({{a[2] / 3, &d0}, {2 * a[1] / 3, &d2}}), combine({{a[2], &d2}})};
  }
  return {};
}
} // namespace

bool isPivot(EdgeRule rule, const EdgeAlpha& alpha, int n, int c)
{
  if (rule == EdgeRule::Quadratic)
  {
    return (c == 2 && alpha.A != 0.0) || (c == n - 3 && alpha.B != 0.0);
  }
  return (alpha.A != 0.0 || alpha.B != 0.0) && (c == 3 || c == 4);
}

void solvePivots(EdgeRule rule, const EdgeAlpha& alpha, Forms& d)
{
  const double a = alpha.A;
  const double b = alpha.B;
  if (rule == EdgeRule::Quadratic)
  {
    const std::size_t n = d.size();
    if (a != 0.0)
    {
      d[2] = combine({{0.2, &d[3]}, {1.2, &d[1]}, {-0.4, &d[0]}});
    }
    if (b != 0.0)
    {
      d[n - 3] = combine({{0.2, &d[n - 4]}, {1.2, &d[n - 2]}, {-0.4, &d[n - 1]}});
    }
    return;
  }
  if (a != 0.0 && b != 0.0)
  {
    const double g0 = (1.0 - b / a) / 4.0 - 2.0;
    const double g1 = (1.0 - a / b) / 4.0 - 2.0;
    const double det = g0 * g1 - 1.0;
    const LinearForm r0 = combine({{1.0, &d[1]}, {g0, &d[2]}});
    const LinearForm r1 = combine({{1.0, &d[6]}, {g1, &d[5]}});
    d[3] = combine({{g1 / det, &r0}, {-1.0 / det, &r1}});
    d[4] = combine({{-1.0 / det, &r0}, {g0 / det, &r1}});
  }
  else if (b != 0.0)
  {
    d[3] = combine({{0.4, &d[2]}, {1.6, &d[5]}, {-1.0, &d[6]}});
    d[4] = combine({{0.2, &d[2]}, {1.8, &d[5]}, {-1.0, &d[6]}});
  }
  else if (a != 0.0)
  {
    d[4] = combine({{0.4, &d[5]}, {1.6, &d[2]}, {-1.0, &d[1]}});
    d[3] = combine({{0.2, &d[5]}, {1.8, &d[2]}, {-1.0, &d[1]}});
  }
}

Forms edgeSum(EdgeRule rule, const EdgeAlpha& alpha, const Forms& d)
{
  const std::size_t n = d.size();
  const double a = alpha.A;
  const double b = alpha.B;
  Forms l(n);
  const auto delta = [&d](std::size_t i, double f) { return difference(d[i + 1], d[i], f); };
  l[0] = delta(0, a);
  l[n - 1] = delta(n - 2, -b);
  if (rule == EdgeRule::Quadratic)
  {
    l[1] = combine({{a / 15, &d[0]}, {-a / 5, &d[1]}, {2 * a / 15, &d[3]}});
    l[n - 2] = combine({{b / 15, &d[n - 1]}, {-b / 5, &d[n - 2]}, {2 * b / 15, &d[n - 4]}});
    return l;
  }
  if (a != 0.0)
  {
    l[1] = delta(0, a / 9).add(delta(1, 2 * a / 3));
    l[2] = delta(1, 2 * a / 9).add(delta(2, a / 6));
  }
  if (b != 0.0)
  {
    l[6] = delta(6, -b / 9).add(delta(5, -2 * b / 3));
    l[5] = delta(5, -2 * b / 9).add(delta(4, -b / 6));
  }
  if (a != 0.0 && b != 0.0)
  {
    l[3] = delta(2, -b / 18).add(delta(3, 2 * a / 9));
    l[4] = delta(4, a / 18).add(delta(3, -2 * b / 9));
  }
  else
  {
    l[4] = delta(2, -b / 18);
    l[3] = delta(4, a / 18);
  }
  return l;
}

Forms edgeSumGeneric(EdgeRule rule, const EdgeAlpha& alpha, const Forms& d)
{
  const int n = static_cast<int>(d.size());
  const int m = (n - 2) / 2;
  Forms l(n);
  for (int s = 0; s < m; ++s)
  {
    const auto r = product(alphaOn(rule, alpha, s, m), bezierSegment(d, s, m));
    if (s == 0)
    {
      l[0] = r[0];
    }
    l[2 * s + 1] = r[1];
    l[2 * s + 2] = r[2];
    if (s == m - 1)
    {
      l[n - 1] = r[3];
    }
  }
  return l;
}

Forms curveConditions(EdgeRule rule, const EdgeAlpha& alpha, const Forms& d)
{
  const int m = (static_cast<int>(d.size()) - 2) / 2;
  Forms conditions;
  std::vector<std::array<LinearForm, 4>> r(m);
  for (int s = 0; s < m; ++s)
  {
    const auto a = alphaOn(rule, alpha, s, m);
    const auto b = bezierSegment(d, s, m);
    r[s] = product(a, b);
    if (a.size() == 3)
    {
      conditions.push_back(combine({{-1.0, &b[0]}, {3.0, &b[1]}, {-3.0, &b[2]}, {1.0, &b[3]}}));
    }
  }
  for (int s = 0; s + 1 < m; ++s)
  {
    conditions.push_back(combine({{1.0, &r[s][3]}, {-0.5, &r[s][2]}, {-0.5, &r[s + 1][1]}}));
  }
  return conditions;
}
} // namespace bsr
