#include "Image/ClosingRadius.h"

#include "Common/MonitoredLoop.h"
#include "Image/CrossingDistance.h"
#include "Image/DistanceTransform.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
constexpr double FirstRadius = 1.5;
constexpr double Ratio = 1.2;      // of neighboring radii of the curve
constexpr double FineRatio = 1.05; // to which the end of the rise is refined
constexpr double Margin = 1.08;    // on the radius where the rise ends
constexpr double CoarseSamples = 4.0e5;
constexpr double SteepAtLeast = 0.3;  // d ln(volume) / d ln(radius) of a lumen being filled
constexpr double StillSteep = 0.35;   // share of the steepest slope that still belongs to the rise
constexpr double PlateauAtMost = 0.2; // share of the steepest slope that a plateau may have
constexpr std::size_t PlateauWithin = 3; // intervals after the rise

/// At every Step-th voxel the curve is sampled.
std::int64_t samplingStep(const Volume<std::uint8_t>& object)
{
  const double n = static_cast<double>(object.Extent.volume());
  return std::max<std::int64_t>(1, std::llround(std::cbrt(n / CoarseSamples)));
}

/// Balls too small for the samples are closed voxel by voxel.
bool needsVoxels(double radius, std::int64_t step)
{
  return radius < 2.0 * static_cast<double>(step);
}

/// Geometric progression, with every other radius left out where a value is dear.
std::vector<double> radii(const Volume<std::uint8_t>& object)
{
  const std::int64_t step = samplingStep(object);
  const double unit = voxelLength(object.Spacing);
  double width = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a)
  {
    width = std::min(width, static_cast<double>(object.Extent.Size[a]) * object.Spacing[a] / unit);
  }
  std::vector<double> r{FirstRadius};
  double next = FirstRadius;
  while ((next *= needsVoxels(r.back() * Ratio, step) ? Ratio * Ratio : Ratio) <= 0.5 * width)
  {
    r.push_back(next);
  }
  return r;
}

std::int64_t count(const Volume<std::uint8_t>& mask)
{
  return parallelReduce(
    0, mask.Extent.volume(), std::int64_t{1} << 18, std::int64_t{0},
    [&](std::int64_t begin, std::int64_t end)
    {
      std::int64_t n = 0;
      for (std::int64_t i = begin; i < end; ++i)
      {
        n += mask.Data[i];
      }
      return n;
    },
    [](std::int64_t a, std::int64_t b) { return a + b; });
}

/// Every `every`-th sample of a box of a squared distance, less the radius, in units of the
/// samples.
Volume<float> dilationField(
  const Volume<float>& distance, const Box& box, std::int64_t every, double scale, double radius)
{
  Volume<float> field(Box{{{0, 0, 0}}, box.Size}, distance.Spacing);
  const ImageView<const float> from = distance.view();
  const ImageView<float> to = field.view();
  parallelFor(0, box.Size[1] * box.Size[2], 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t r = begin; r < end; ++r)
      {
        const std::int64_t j = r % box.Size[1];
        const std::int64_t k = r / box.Size[1];
        const float* src = from.row(box.Lo[1] + j * every, box.Lo[2] + k * every) + box.Lo[0];
        float* dst = to.row(j, k);
        for (std::int64_t i = 0; i < box.Size[0]; ++i)
        {
          const double d = std::min(src[i * every], 1e12f);
          dst[i] = static_cast<float>((std::sqrt(d) - radius) * scale);
        }
      }
    });
  return field;
}

/// The closing's volume relative to the object's for any radius up to a largest one.
class VolumeSampler
{
public:
  VolumeSampler(const Volume<std::uint8_t>& object, double largest)
      : Object(object), Largest(largest), Raw(static_cast<double>(count(object)))
  {
    this->Step = samplingStep(object);
  }

  /// One distance transform for all radii, at every Step-th voxel.
  Status prepare(Monitor& monitor)
  {
    this->Pad = reach(this->Largest, this->Object.Spacing);
    for (auto& p : this->Pad)
    {
      p = (p / this->Step + 1 + 2 * MaxEvery) * this->Step;
    }
    DistanceOptions o;
    o.Bound = this->Largest + 2.0 * static_cast<double>(this->Step * MaxEvery);
    o.Step = this->Step;
    o.Extent = Box{{{0, 0, 0}}, this->Object.Extent.Size}.padded(this->Pad);
    auto d = squaredDistance(this->Object.view(), o, monitor);
    if (!d)
    {
      return d.status();
    }
    this->Distance = std::move(*d);
    return Status::ok();
  }

  Result<double> operator()(double radius, Monitor& monitor) const
  {
    if (needsVoxels(radius, this->Step))
    {
      const auto closed = closeByBall(this->Object.view(), radius, monitor);
      return closed ? Result<double>(static_cast<double>(count(*closed)) / this->Raw)
                    : Result<double>(closed.status());
    }
    std::int64_t every = 1;
    while (2 * every <= MaxEvery && radius >= 6.0 * static_cast<double>(2 * every * this->Step))
    {
      every *= 2;
    }
    return this->coarse(radius, every, monitor);
  }

private:
  static constexpr std::int64_t MaxEvery = 4;

  Result<double> coarse(double radius, std::int64_t every, Monitor& monitor) const
  {
    const std::int64_t step = this->Step * every;
    const double scale = 1.0 / static_cast<double>(step);
    const Int3 halo = reach(radius, this->Object.Spacing);
    Box domain;
    DistanceOptions o;
    for (int a = 0; a < 3; ++a)
    {
      const std::int64_t pad = this->Pad[a] / this->Step;
      const std::int64_t h = std::min(pad / every, halo[a] / step + 2);
      const std::int64_t size = (this->Object.Extent.Size[a] + step - 1) / step;
      domain.Lo[a] = pad - h * every;
      domain.Size[a] =
        std::min((this->Distance.Extent.Size[a] - domain.Lo[a] + every - 1) / every, size + 2 * h);
      o.Extent.Lo[a] = h;
      o.Extent.Size[a] = size;
    }
    const Volume<float> field = dilationField(this->Distance, domain, every, scale, radius);
    o.Bound = radius * scale + 1.0;
    const auto depth = crossingDistance(field.view(), o, monitor);
    if (!depth)
    {
      return depth.status();
    }
    const std::int64_t n = closedSamples(field, o.Extent.Lo, *depth, (radius - 0.2) * scale);
    return static_cast<double>(n) * std::pow(static_cast<double>(step), 3) / this->Raw;
  }

  static std::int64_t closedSamples(
    const Volume<float>& field, const Int3& at, const Volume<float>& depth, double limit)
  {
    const ImageView<const float> view = depth.view();
    std::int64_t n = 0;
    for (std::int64_t r = 0; r < view.Dims[1] * view.Dims[2]; ++r)
    {
      const std::int64_t j = r % view.Dims[1];
      const std::int64_t k = r / view.Dims[1];
      const float* f = field.view().row(j + at[1], k + at[2]) + at[0];
      const float* d = view.row(j, k);
      for (std::int64_t i = 0; i < view.Dims[0]; ++i)
      {
        n += f[i] < 0.0f && static_cast<double>(d[i]) > limit ? 1 : 0;
      }
    }
    return n;
  }

  const Volume<std::uint8_t>& Object;
  double Largest;
  double Raw;
  std::int64_t Step = 1;
  Int3 Pad{};
  Volume<float> Distance;
};

Status sampleCurve(
  const VolumeSampler& volume, const std::vector<double>& at, ClosingCurve& curve, Monitor& monitor)
{
  const double n = static_cast<double>(at.size());
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    SubMonitor part(monitor, static_cast<double>(i) / n, static_cast<double>(i + 1) / n);
    const auto v = volume(at[i], part);
    if (!v)
    {
      return v.status();
    }
    curve.Radius.push_back(at[i]);
    curve.Volume.push_back(*v);
  }
  return Status::ok();
}

double slope(double r0, double v0, double r1, double v1)
{
  return std::log(v1 / v0) / std::log(r1 / r0);
}

double slope(const ClosingCurve& c, std::size_t from, std::size_t to)
{
  return slope(c.Radius[from], c.Volume[from], c.Radius[to], c.Volume[to]);
}

/// The last interval [end - 1, end] of the curve that is steep; 0 where there is no rise with a
/// plateau.
std::size_t endOfRise(const ClosingCurve& c, double& steepest)
{
  steepest = 0.0;
  for (std::size_t i = 1; i < c.Radius.size(); ++i)
  {
    steepest = std::max(steepest, slope(c, i - 1, i));
  }
  if (steepest < SteepAtLeast)
  {
    return 0;
  }
  std::size_t end = c.Radius.size() - 1;
  while (slope(c, end - 1, end) < std::max(StillSteep * steepest, 0.5 * SteepAtLeast))
  {
    --end;
  }
  const std::size_t last = std::min(end + PlateauWithin, c.Radius.size() - 1);
  double flattest = steepest;
  for (std::size_t i = end + 1; i <= last; ++i)
  {
    flattest = std::min(flattest, slope(c, i - 1, i));
  }
  return flattest <= PlateauAtMost * steepest ? end : 0;
}

/// Where in the last steep interval the steep part ends.
Result<double> refine(const VolumeSampler& volume, const ClosingCurve& c, std::size_t end,
  double steepest, Monitor& monitor)
{
  double low = c.Radius[end - 1];
  double high = c.Radius[end];
  const double top = c.Volume[end];
  while (high / low > FineRatio)
  {
    const double middle = std::sqrt(low * high);
    const auto v = volume(middle, monitor);
    if (!v)
    {
      return v.status();
    }
    const bool flat = slope(middle, *v, c.Radius[end], top) < StillSteep * steepest;
    (flat ? high : low) = middle;
  }
  return high;
}

/// Of some radii, in their order: the first that gives a ball, else the one with the fewest holes.
Status chooseByTopology(const Volume<std::uint8_t>& object, const std::vector<double>& candidates,
  RadiusChoice& choice, Monitor& monitor)
{
  const auto holes = [](const BettiNumbers& b) { return b.Components + b.Tunnels + b.Cavities; };
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    const double n = static_cast<double>(candidates.size());
    SubMonitor part(monitor, static_cast<double>(i) / n, static_cast<double>(i + 1) / n);
    auto closed = closeByBall(object.view(), candidates[i], part);
    if (!closed)
    {
      return closed.status();
    }
    const auto betti = bettiNumbers(closed->view(), Connectivity::TwentySix, part);
    if (!betti)
    {
      return betti.status();
    }
    if (!choice.Closed.Data || holes(*betti) < holes(choice.Betti))
    {
      choice.Radius = candidates[i];
      choice.Betti = *betti;
      choice.Closed = std::move(*closed);
    }
    if (betti->isBall())
    {
      break;
    }
  }
  return Status::ok();
}
} // namespace

Result<ClosingCurve> closingCurve(const Volume<std::uint8_t>& object, Monitor& monitor)
{
  const std::vector<double> at = radii(object);
  VolumeSampler volume(object, at.back());
  SubMonitor first(monitor, 0.0, 0.3);
  SubMonitor second(monitor, 0.3, 1.0);
  ClosingCurve curve;
  Status s = volume.prepare(first);
  s = s ? sampleCurve(volume, at, curve, second) : s;
  return s ? Result<ClosingCurve>(std::move(curve)) : Result<ClosingCurve>(s);
}

Result<RadiusChoice> closingRadius(const Volume<std::uint8_t>& object, Monitor& monitor)
{
  const std::vector<double> at = radii(object);
  VolumeSampler volume(object, at.back());
  SubMonitor first(monitor, 0.0, 0.2);
  SubMonitor second(monitor, 0.2, 0.7);
  SubMonitor third(monitor, 0.7, 1.0);
  RadiusChoice choice;
  Status s = volume.prepare(first);
  s = s ? sampleCurve(volume, at, choice.Curve, second) : s;
  if (!s)
  {
    return s;
  }
  const std::size_t end = endOfRise(choice.Curve, choice.Rise);
  std::vector<double> candidates;
  if (end > 0)
  {
    const auto filled = refine(volume, choice.Curve, end, choice.Rise, monitor);
    if (!filled)
    {
      return filled.status();
    }
    choice.Plateau = true;
    for (double r = *filled * Margin; r < *filled * Margin * 4.0 / 3.0; r *= Margin)
    {
      candidates.push_back(r);
    }
  }
  else
  {
    for (std::size_t i = 0; i < at.size() && (i == 0 || choice.Curve.Volume[i] <= 2.0); ++i)
    {
      candidates.push_back(at[i]);
    }
  }
  s = chooseByTopology(object, candidates, choice, third);
  return s ? Result<RadiusChoice>(std::move(choice)) : Result<RadiusChoice>(s);
}
} // namespace bsr
