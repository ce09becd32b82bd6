#include "Layout/NearestQuad.h"

#include <cmath>

namespace bsr
{
namespace
{
/// Lower bounds are compared with computed distances: leave room for rounding.
constexpr double Slack = 1.0 - 1e-12;

/// A nearest point in the parameters of [-1, 1]^2.
struct Candidate
{
  double S = 0.0;
  double T = 0.0;
  double Squared = std::numeric_limits<double>::infinity();
};

/// Parameter in [-1, 1] of the point of segment M + x H nearest to p.
double onSegment(const Vec3& middle, const Vec3& half, const Vec3& p)
{
  const double length = half.squaredNorm();
  return length > 0.0 ? std::clamp((p - middle).dot(half) / length, -1.0, 1.0) : 0.0;
}

/// Newton's method for a stationary point inside the square, from (s, t).
template <class Patch>
Candidate newton(const Patch& b, const Vec3& p, double s, double t)
{
  for (int iteration = 0; iteration < 20; ++iteration)
  {
    const Vec3 ps = b.A + t * b.D;
    const Vec3 pt = b.B + s * b.D;
    const Vec3 r = b.C + s * ps + t * b.B - p;
    const double gs = r.dot(ps);
    const double gt = r.dot(pt);
    const double ss = ps.squaredNorm();
    const double tt = pt.squaredNorm();
    double st = ps.dot(pt) + r.dot(b.D);
    if (ss * tt <= st * st)
    {
      st = ps.dot(pt); // not convex here: Gauss-Newton goes downhill
    }
    const double det = ss * tt - st * st;
    if (!(det > 1e-14 * ss * tt))
    {
      return {};
    }
    const double ds = (st * gt - tt * gs) / det;
    const double dt = (st * gs - ss * gt) / det;
    s = std::clamp(s + ds, -1.5, 1.5);
    t = std::clamp(t + dt, -1.5, 1.5);
    if (std::abs(ds) + std::abs(dt) < 1e-7)
    {
      break; // quadratic convergence: this step leaves some 1e-14
    }
    if (iteration > 1 && (std::abs(s) >= 1.5 || std::abs(t) >= 1.5))
    {
      return {};
    }
  }
  if (std::abs(s) > 1.0 || std::abs(t) > 1.0)
  {
    return {};
  }
  return {s, t, (b.C + s * (b.A + t * b.D) + t * b.B - p).squaredNorm()};
}

/// Improves `best` by the nearest point on one side, exactly; sides t = -1, t = 1, s = -1, s = 1.
template <class Patch>
void onSide(const Patch& b, const Vec3& p, int side, Candidate& best)
{
  const double fixed = side % 2 ? 1.0 : -1.0;
  const bool alongS = side < 2;
  const Vec3 middle = b.C + fixed * (alongS ? b.B : b.A);
  const Vec3 half = (alongS ? b.A : b.B) + fixed * b.D;
  const double x = onSegment(middle, half, p);
  const double d = (middle + x * half - p).squaredNorm();
  if (d < best.Squared)
  {
    best = {alongS ? x : fixed, alongS ? fixed : x, d};
  }
}

/// The general case: several stationary points are possible.
template <class Patch>
Candidate searchAll(const Patch& b, const Vec3& p)
{
  Candidate best = newton(b, p, 0.0, 0.0);
  for (int k = 0; k < 4; ++k)
  {
    onSide(b, p, k, best);
    const Candidate c = newton(b, p, k % 2 ? 0.9 : -0.9, k / 2 ? 0.9 : -0.9);
    best = c.Squared < best.Squared ? c : best;
  }
  return best;
}
} // namespace

NearestQuad::NearestQuad(const QuadMesh& mesh)
{
  std::vector<Box> boxes;
  this->Patches.reserve(mesh.Quads.size());
  boxes.reserve(mesh.Quads.size());
  for (const auto& q : mesh.Quads)
  {
    const Vec3& p0 = mesh.Points[q[0]];
    const Vec3& p1 = mesh.Points[q[1]];
    const Vec3& p2 = mesh.Points[q[2]];
    const Vec3& p3 = mesh.Points[q[3]];
    Patch b;
    b.C = 0.25 * (p0 + p1 + p2 + p3);
    b.A = 0.25 * (p1 - p0 + p2 - p3);
    b.B = 0.25 * (p3 - p0 + p2 - p1);
    b.D = 0.25 * (p0 - p1 + p2 - p3);
    Vec3 n = b.A.cross(b.B);
    n = n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3(Vec3::UnitZ());
    Vec3 a = b.A - n * n.dot(b.A);
    a = a.norm() > 0.0 ? Vec3(a.normalized()) : Vec3(n.unitOrthogonal());
    b.AA = b.A.squaredNorm();
    b.BB = b.B.squaredNorm();
    b.AB = b.A.dot(b.B);
    const double det = b.AA * b.BB - b.AB * b.AB;
    b.Inverse = det > 1e-14 * b.AA * b.BB ? 1.0 / det : 0.0;
    // The twist moves the tangents by D; small against the patch's width, or no shortcut.
    const double width = std::sqrt(std::max(det, 0.0));
    const double skew = b.D.norm() * std::sqrt(std::max(b.AA, b.BB));
    b.Convex = b.Inverse > 0.0 && skew < 0.2 * width ? 0.2 * width : -1.0;
    b.Axes << a.transpose(), n.cross(a).transpose(), n.transpose();
    Box local;
    Box box;
    for (const Index corner : q)
    {
      local.add(b.Axes * (mesh.Points[corner] - b.C));
      box.add(mesh.Points[corner]);
    }
    b.Low = local.Min;
    b.High = local.Max;
    this->Patches.push_back(b);
    boxes.push_back(box);
  }
  this->Tree = BoxTree(boxes);
}

double NearestQuad::boxDistance(const Patch& b, const Vec3& p)
{
  const Vec3 x = b.Axes * (p - b.C);
  return (b.Low - x).cwiseMax(x - b.High).cwiseMax(0.0).squaredNorm();
}

QuadHit NearestQuad::project(const Patch& b, const Vec3& p)
{
  const Vec3 r = p - b.C;
  const double offset = std::abs(r.dot(b.D));
  Candidate best;
  if (offset > b.Convex)
  {
    best = searchAll(b, p);
  }
  else
  {
    // Convex: one stationary point, near that of the plane in the patch's middle. If it lies
    // outside the square, the nearest point is on a side that it lies beyond.
    const double ra = r.dot(b.A);
    const double rb = r.dot(b.B);
    const double s = (b.BB * ra - b.AB * rb) * b.Inverse;
    const double t = (b.AA * rb - b.AB * ra) * b.Inverse;
    if (std::abs(s) < 1.5 && std::abs(t) < 1.5)
    {
      best = newton(b, p, s, t);
    }
    if (!(best.Squared < std::numeric_limits<double>::infinity()))
    {
      // The true stationary point is a little off: take every side that it may lie beyond.
      const double margin = 0.75;
      for (int k = 0; k < 4; ++k)
      {
        const double out = (k < 2 ? t : s) * (k % 2 ? 1.0 : -1.0);
        if (out > margin)
        {
          onSide(b, p, k, best);
        }
      }
    }
    if (!(best.Squared < std::numeric_limits<double>::infinity()))
    {
      best = searchAll(b, p);
    }
  }
  QuadHit hit;
  hit.UV = Vec2(0.5 * (best.S + 1.0), 0.5 * (best.T + 1.0));
  hit.SquaredDistance = best.Squared;
  return hit;
}

template <class Allowed>
QuadHit NearestQuad::search(const Vec3& p, Index hint, const Allowed& allowed) const
{
  QuadHit best;
  double bound = best.SquaredDistance;
  const auto visit = [&](Index q)
  {
    const Patch& patch = this->Patches[q];
    if (q == best.Quad || boxDistance(patch, p) * Slack > bound || !allowed(patch))
    {
      return;
    }
    const QuadHit hit = project(patch, p);
    if (hit.SquaredDistance < best.SquaredDistance ||
        (hit.SquaredDistance == best.SquaredDistance && q < best.Quad))
    {
      best = hit;
      best.Quad = q;
      bound = hit.SquaredDistance / Slack;
    }
  };
  if (hint >= 0)
  {
    visit(hint);
  }
  this->Tree.nearest(p, bound, visit);
  return best;
}

QuadHit NearestQuad::find(const Vec3& p, Index hint) const
{
  return this->search(p, hint, [](const Patch&) { return true; });
}

QuadHit NearestQuad::findFacing(const Vec3& p, const Vec3& direction, Index hint) const
{
  return this->search(p, hint, [&](const Patch& b) { return b.Axes.row(2).dot(direction) > 0.0; });
}
} // namespace bsr
