#include "Contour/StackPlanes.h"

#include "Common/UnionFind.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace bsr
{
namespace
{
/// The plane of one contour.
struct Fit
{
  Vec3 Center;
  Vec3 Normal;
  double Weight; ///< second largest variance: how well the points span a plane
  double Extent; ///< root of the largest variance
  double Off;    ///< largest distance of a point from the plane
};

double offPlane(const std::vector<Vec3>& points, const Vec3& center, const Vec3& normal)
{
  double off = 0.0;
  for (const Vec3& p : points)
  {
    off = std::max(off, std::abs(normal.dot(p - center)));
  }
  return off;
}

Fit fitPlane(const std::vector<Vec3>& points)
{
  Fit f;
  f.Center = Vec3::Zero();
  for (const Vec3& p : points)
  {
    f.Center += p / static_cast<double>(points.size());
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points)
  {
    covariance += (p - f.Center) * (p - f.Center).transpose();
  }
  covariance /= static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  f.Normal = solver.eigenvectors().col(0);
  f.Weight = std::max(0.0, solver.eigenvalues()[1] - solver.eigenvalues()[0]);
  f.Extent = std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
  f.Off = offPlane(points, f.Center, f.Normal);
  return f;
}

std::string nameOf(const Contour& c)
{
  return "Polyline " + std::to_string(c.Source);
}

double median(std::vector<double> values)
{
  if (values.empty())
  {
    return 0.0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Distinct consecutive points; closed contours without their repeated first point.
Contour cleaned(const Polyline& line, Index source)
{
  Contour c;
  c.Source = source;
  c.Closed = line.Closed;
  double size = 0.0;
  for (const Vec3& p : line.Points)
  {
    size = std::max(size, (p - line.Points.front()).norm());
  }
  const double tiny = 1e-9 * size;
  for (const Vec3& p : line.Points)
  {
    if (c.Points.empty() || (p - c.Points.back()).norm() > tiny)
    {
      c.Points.push_back(p);
    }
  }
  while (c.Points.size() > 2 && (c.Points.front() - c.Points.back()).norm() <= tiny)
  {
    c.Points.pop_back();
    c.Closed = true;
  }
  for (std::size_t i = 1; i < c.Points.size(); ++i)
  {
    c.Length += (c.Points[i] - c.Points[i - 1]).norm();
  }
  c.Length += c.Closed && !c.Points.empty() ? (c.Points.back() - c.Points.front()).norm() : 0.0;
  return c;
}

Status cleanAll(
  const std::vector<Polyline>& polylines, const StackOptions& options, ContourStack& stack)
{
  std::vector<double> lengths;
  for (std::size_t i = 0; i < polylines.size(); ++i)
  {
    for (const Vec3& p : polylines[i].Points)
    {
      if (!p.allFinite())
      {
        return Status::invalidInput("Polyline " + std::to_string(i) +
                                    " has a coordinate that is not a finite number; remove it.");
      }
    }
    stack.Contours.push_back(cleaned(polylines[i], static_cast<Index>(i)));
    lengths.push_back(stack.Contours.back().Length);
  }
  const double speck = options.SpeckShare * median(lengths);
  const auto dropped = [&](const Contour& c)
  {
    const std::size_t least = c.Closed ? std::max(options.MinimumPoints, 3) : 2;
    const bool out = !options.ComponentOf.empty() && options.ComponentOf[c.Source] == -2; // by hand
    const bool few = c.Points.size() < least;
    if (out || few || c.Length < speck)
    {
      stack.Dropped.push_back(
        {c.Source, out   ? "left out by hand"
                   : few ? "a speck of " + std::to_string(c.Points.size()) + " point(s)"
                         : "a speck: shorter than SpeckShare of the median length"});
      return true;
    }
    return false;
  };
  auto& all = stack.Contours;
  all.erase(std::remove_if(all.begin(), all.end(), dropped), all.end());
  if (all.empty())
  {
    return Status::invalidInput(
      polylines.empty()
        ? "There is no polyline in the input; give the contours of at least two slices."
        : "No contour is left: all " + std::to_string(polylines.size()) +
            " polyline(s) are specks or single points; give contours of at least two slices.");
  }
  return Status::ok();
}

/// Mean normal of the contours, by how well each spans its plane; its largest entry is positive.
Vec3 meanNormal(const std::vector<Fit>& fits)
{
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vec3 mean = Vec3::Zero();
  for (const Fit& f : fits)
  {
    sum += f.Weight * f.Normal * f.Normal.transpose();
    mean += f.Center / static_cast<double>(fits.size());
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  Vec3 axis = solver.eigenvectors().col(2);
  if (!(solver.eigenvalues()[2] > 0.0)) // straight open lines only: across them all
  {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Fit& f : fits)
    {
      spread += (f.Center - mean) * (f.Center - mean).transpose();
    }
    axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  }
  int largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Vec3(-axis) : axis;
}

void chooseAxes(ContourStack& stack, const std::vector<Fit>& fits)
{
  stack.Axis = meanNormal(fits);
  int smallest = 0;
  stack.Axis.cwiseAbs().minCoeff(&smallest);
  stack.AxisX = (Vec3::Unit(smallest) - stack.Axis[smallest] * stack.Axis).normalized();
  stack.AxisY = stack.Axis.cross(stack.AxisX);
  stack.Origin = Vec3::Zero();
  for (const Fit& f : fits)
  {
    stack.Origin += f.Center / static_cast<double>(fits.size());
  }
}

/// Typical distance of slices: the median over the contours of the distance, across its plane, to
/// the nearest contour of another plane that lies over or under it; of any other plane where there
/// is none.
double typicalGap(const std::vector<Fit>& fits, const Vec3& axis)
{
  const auto distances = [&](bool facing)
  {
    std::vector<std::vector<double>> all(fits.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < fits.size(); ++i)
    {
      for (std::size_t j = 0; j < fits.size(); ++j)
      {
        const Vec3 d = fits[j].Center - fits[i].Center;
        const double across = (d - axis.dot(d) * axis).norm();
        if (j != i && (!facing || across <= 1.5 * std::max(fits[i].Extent, fits[j].Extent)))
        {
          all[i].push_back(std::abs(fits[i].Normal.dot(d)));
          largest = std::max(largest, all[i].back());
        }
      }
    }
    std::vector<double> nearest;
    for (const auto& list : all)
    {
      double best = std::numeric_limits<double>::infinity();
      for (const double d : list)
      {
        best = d > 1e-3 * largest ? std::min(best, d) : best;
      }
      if (std::isfinite(best))
      {
        nearest.push_back(best);
      }
    }
    return median(nearest);
  };
  const double gap = distances(true);
  return gap > 0.0 ? gap : distances(false);
}

/// Group number of each contour.
std::vector<std::int64_t> groupPlanes(const ContourStack& stack, const std::vector<Fit>& fits,
  const StackOptions& options, double tolerance, bool parallel)
{
  const auto n = static_cast<std::int64_t>(fits.size());
  UnionFind sets(n);
  std::map<int, std::int64_t> byHand;
  for (std::int64_t i = 0; i < n; ++i)
  {
    if (!options.SliceOf.empty())
    {
      const auto [it, fresh] = byHand.emplace(options.SliceOf[stack.Contours[i].Source], i);
      sets.join(it->second, i);
      continue;
    }
    for (std::int64_t j = 0; j < i; ++j)
    {
      const Vec3 d = fits[j].Center - fits[i].Center;
      if (parallel && std::abs(stack.Axis.dot(d)) <= tolerance)
      {
        sets.join(i, j);
      }
      const auto large = fits[i].Weight >= fits[j].Weight ? i : j;
      const auto small = large == i ? j : i;
      if (std::abs(fits[large].Normal.dot(d)) <= tolerance &&
          offPlane(stack.Contours[small].Points, fits[large].Center, fits[large].Normal) <=
            2.0 * tolerance)
      {
        sets.join(i, j);
      }
    }
  }
  std::vector<std::int64_t> group;
  for (std::int64_t i = 0; i < n; ++i)
  {
    group.push_back(sets.find(i));
  }
  return group;
}

void makeSlices(ContourStack& stack, const std::vector<Fit>& fits,
  const std::vector<std::int64_t>& group, bool parallel)
{
  std::map<std::int64_t, Slice> slices;
  std::map<std::int64_t, double> best;
  for (std::size_t i = 0; i < fits.size(); ++i)
  {
    Slice& s = slices[group[i]];
    s.Contours.push_back(static_cast<Index>(i));
    if (s.Contours.size() == 1 || fits[i].Weight > best[group[i]])
    {
      best[group[i]] = fits[i].Weight;
      s.Origin = fits[i].Center;
      s.Normal = parallel ? stack.Axis : fits[i].Normal;
    }
  }
  for (auto& [id, s] : slices)
  {
    // where the plane meets the axis of the stack
    s.Position = stack.Axis.dot(stack.Origin) +
                 s.Normal.dot(s.Origin - stack.Origin) / s.Normal.dot(stack.Axis);
    stack.Slices.push_back(std::move(s));
  }
  std::stable_sort(stack.Slices.begin(), stack.Slices.end(),
    [](const Slice& a, const Slice& b) { return a.Position < b.Position; });
  std::vector<Contour> ordered;
  for (Slice& s : stack.Slices)
  {
    for (Index& c : s.Contours)
    {
      ordered.push_back(std::move(stack.Contours[c]));
      ordered.back().Slice = static_cast<Index>(&s - stack.Slices.data());
      c = static_cast<Index>(ordered.size()) - 1;
    }
  }
  stack.Contours.swap(ordered);
}

void flatten(ContourStack& stack)
{
  for (Contour& c : stack.Contours)
  {
    for (const Vec3& p : c.Points)
    {
      c.Flat.push_back(stack.flat(p));
    }
    c.Area = c.Closed ? signedArea(c.Flat) : 0.0;
    if (c.Area < 0.0)
    {
      std::reverse(c.Points.begin(), c.Points.end());
      std::reverse(c.Flat.begin(), c.Flat.end());
      c.Area = -c.Area;
    }
    c.Center = c.Closed ? areaCentroid(c.Flat) : Vec2(Vec2::Zero());
    for (const Vec2& p : c.Flat)
    {
      c.Center += c.Closed ? Vec2(Vec2::Zero()) : Vec2(p / static_cast<double>(c.Flat.size()));
    }
  }
}

/// Slices whose contours lie on both sides of each other's planes.
Status checkCuts(const ContourStack& stack, double tolerance)
{
  const auto straddles = [&](const Slice& plane, const Slice& other)
  {
    double low = 0.0;
    double high = 0.0;
    for (const Index c : other.Contours)
    {
      for (const Vec3& p : stack.Contours[c].Points)
      {
        const double d = plane.Normal.dot(p - plane.Origin);
        low = std::min(low, d);
        high = std::max(high, d);
      }
    }
    return low < -tolerance && high > tolerance;
  };
  for (std::size_t s = 1; s < stack.Slices.size(); ++s)
  {
    const Slice& a = stack.Slices[s - 1];
    const Slice& b = stack.Slices[s];
    if (straddles(a, b) && straddles(b, a))
    {
      return Status::invalidInput("The slices at polylines " +
                                  std::to_string(stack.Contours[a.Contours[0]].Source) + " and " +
                                  std::to_string(stack.Contours[b.Contours[0]].Source) +
                                  " cut each other; remove one, or tilt the planes less.");
    }
  }
  return Status::ok();
}
} // namespace

Result<ContourStack> sliceContours(
  const std::vector<Polyline>& polylines, const StackOptions& options, Monitor& monitor)
{
  ContourStack stack;
  if (Status s = cleanAll(polylines, options, stack); !s)
  {
    return s;
  }
  std::vector<Fit> fits;
  for (const Contour& c : stack.Contours)
  {
    fits.push_back(fitPlane(c.Points));
  }
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  chooseAxes(stack, fits);
  for (Fit& f : fits)
  {
    const double along = f.Normal.dot(stack.Axis);
    if (std::sqrt(f.Weight) < 1e-3 * f.Extent || along * along < 0.25)
    {
      f.Normal = stack.Axis; // a straight line or a speck has no plane of its own
    }
    else if (along < 0.0)
    {
      f.Normal = -f.Normal;
    }
  }
  const double gap = typicalGap(fits, stack.Axis);
  if (!(gap > 0.0) || (stack.Contours.size() < 2))
  {
    return Status::invalidInput("All contours lie in one plane; give at least two slices.");
  }
  const double planar = 0.25 * gap;
  bool parallel = true;
  for (std::size_t i = 0; i < fits.size(); ++i)
  {
    parallel = parallel && offPlane(stack.Contours[i].Points, fits[i].Center, stack.Axis) <= planar;
  }
  for (std::size_t i = 0; i < fits.size(); ++i)
  {
    const double off = parallel ? 0.0 : fits[i].Off;
    if (off > planar || off > 0.2 * fits[i].Extent)
    {
      return Status::invalidInput(
        nameOf(stack.Contours[i]) + " is not planar: it leaves its plane by " +
        std::to_string(off) + " where slices are " + std::to_string(gap) +
        " apart; cut the surface with planes (Slice), or leave this polyline out.");
    }
  }
  const double tolerance = options.PlaneTolerance > 0.0 ? options.PlaneTolerance : 0.05 * gap;
  makeSlices(stack, fits, groupPlanes(stack, fits, options, tolerance, parallel), parallel);
  if (stack.Slices.size() < 2)
  {
    return Status::invalidInput(
      "All contours lie in one plane within the PlaneTolerance; give at least two slices.");
  }
  flatten(stack);
  if (!parallel)
  {
    if (Status s = checkCuts(stack, tolerance); !s)
    {
      return s;
    }
  }
  return stack;
}
} // namespace bsr
