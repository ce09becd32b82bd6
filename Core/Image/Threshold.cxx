#include "Image/Threshold.h"

#include "Common/MonitoredLoop.h"
#include "Image/DistanceTransform.h"
#include "Image/ScalarTypes.h"

#include <cmath>
#include <functional>
#include <numeric>
#include <type_traits>
#include <vector>

namespace bsr
{
namespace
{
constexpr std::int64_t Chunk = std::int64_t{1} << 18;

struct Histogram
{
  double First = 0.0; ///< value at the middle of bin 0
  double Width = 1.0;
  std::vector<double> Count;
};

/// Of the voxels for which counts(index) holds.
template <class T, class Predicate>
Histogram histogramOf(
  const ImageView<const T>& image, const ValueRange& range, const Predicate& counts)
{
  Histogram h;
  const double span = range.Max - range.Min;
  const bool whole = std::is_integral<T>::value && span < 65536.0;
  const std::int64_t bins = whole ? static_cast<std::int64_t>(span) + 1 : 4096;
  h.Width = whole ? 1.0 : span / static_cast<double>(bins);
  h.First = whole ? range.Min : range.Min + 0.5 * h.Width;
  const double scale = whole ? 1.0 : static_cast<double>(bins) / span;
  using Counts = std::vector<std::int64_t>;
  const Counts sums = parallelReduce(
    0, image.size(), std::max(Chunk, image.size() / 16 + 1), Counts(),
    [&](std::int64_t begin, std::int64_t end)
    {
      Counts c(static_cast<std::size_t>(bins), 0);
      for (std::int64_t i = begin; i < end; ++i)
      {
        if (counts(i))
        {
          const double at = (static_cast<double>(image.Data[i]) - range.Min) * scale;
          ++c[std::min(bins - 1, static_cast<std::int64_t>(at))];
        }
      }
      return c;
    },
    [](Counts a, const Counts& b)
    {
      a.resize(std::max(a.size(), b.size()), 0);
      for (std::size_t i = 0; i < b.size(); ++i)
      {
        a[i] += b[i];
      }
      return a;
    });
  h.Count.assign(sums.begin(), sums.end());
  return h;
}

/// Border between bins that maximizes the variance between classes: middle of the equal maxima.
double bestBorder(const Histogram& h)
{
  double total = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < h.Count.size(); ++i)
  {
    total += h.Count[i];
    sum += h.Count[i] * static_cast<double>(i);
  }
  double below = 0.0;
  double belowSum = 0.0;
  double best = -1.0;
  double first = 0.0;
  double last = 0.0;
  for (std::size_t i = 0; i + 1 < h.Count.size(); ++i)
  {
    below += h.Count[i];
    belowSum += h.Count[i] * static_cast<double>(i);
    const double above = total - below;
    if (below <= 0.0 || above <= 0.0)
    {
      continue;
    }
    const double d = belowSum / below - (sum - belowSum) / above;
    const double variance = below * above * d * d;
    if (variance > best * (1.0 + 1e-12))
    {
      best = variance;
      first = static_cast<double>(i);
    }
    if (variance >= best * (1.0 - 1e-12))
    {
      last = static_cast<double>(i);
    }
  }
  return h.First + h.Width * (0.5 * (first + last) + 0.5);
}

/// Depths in voxels that the levels of a phase are tried at, and the voxels that it takes.
constexpr std::array<double, 5> LevelDepths{{3.0, 2.5, 2.0, 1.5, 1.2}};
constexpr double LeastShare = 0.02; ///< of the phase's voxels
constexpr std::int64_t LeastVoxels = 64;
constexpr int LevelRounds = 4;
constexpr double LevelTolerance = 0.005; ///< of the contrast

/// The greatest of LevelDepths (squared) that enough voxels of a phase reach; 0: none.
double levelDepth(const std::vector<std::int64_t>& reached, std::int64_t all)
{
  const auto least =
    std::max(LeastVoxels, static_cast<std::int64_t>(LeastShare * static_cast<double>(all)));
  for (std::size_t k = 0; k < LevelDepths.size(); ++k)
  {
    if (reached[k] >= least)
    {
      return LevelDepths[k] * LevelDepths[k];
    }
  }
  return 0.0;
}

/// Middle of a histogram, between the bins' borders where it falls inside of one.
double medianOf(const Histogram& h)
{
  const double half = 0.5 * std::accumulate(h.Count.begin(), h.Count.end(), 0.0);
  double below = 0.0;
  std::size_t i = 0;
  while (i + 1 < h.Count.size() && below + h.Count[i] < half)
  {
    below += h.Count[i++];
  }
  const double within = h.Count[i] > 0.0 ? (half - below) / h.Count[i] : 0.5;
  return h.First + h.Width * (static_cast<double>(i) + within - 0.5);
}

/// The gray value of a phase away from its border: the median of its deepest voxels. NaN where the
/// phase has no voxel without a neighbor of the other.
template <class T>
Result<double> phaseLevel(const ImageView<const T>& image, const ValueRange& range,
  const Volume<std::uint8_t>& mask, std::uint8_t phase, Monitor& monitor)
{
  DistanceOptions o;
  o.ToZeros = phase != 0;
  o.Bound = LevelDepths.front() + 0.1;
  const auto depth = squaredDistance(mask.view(), o, monitor);
  if (!depth)
  {
    return depth.status();
  }
  using Counts = std::vector<std::int64_t>;
  const Counts reached = parallelReduce(
    0, image.size(), Chunk, Counts(LevelDepths.size() + 1, 0),
    [&](std::int64_t begin, std::int64_t end)
    {
      Counts c(LevelDepths.size() + 1, 0);
      for (std::int64_t i = begin; i < end; ++i)
      {
        for (std::size_t k = 0; mask.Data[i] == phase && k < LevelDepths.size(); ++k)
        {
          c[k] += depth->Data[i] > LevelDepths[k] * LevelDepths[k] * (1.0 - 1e-6);
        }
        c.back() += mask.Data[i] == phase;
      }
      return c;
    },
    [](Counts a, const Counts& b)
    {
      std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::plus<>());
      return a;
    });
  const double least = levelDepth(reached, reached.back()) * (1.0 - 1e-6);
  if (least <= 0.0)
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return medianOf(histogramOf(
    image, range, [&](std::int64_t i) { return mask.Data[i] == phase && depth->Data[i] > least; }));
}
} // namespace

template <class T>
ValueRange valueRange(const ImageView<const T>& image)
{
  struct Partial
  {
    double Min = std::numeric_limits<double>::infinity();
    double Max = -std::numeric_limits<double>::infinity();
    std::int64_t NotFinite = 0;
  };
  const Partial p = parallelReduce(
    0, image.size(), Chunk, Partial(),
    [&](std::int64_t begin, std::int64_t end)
    {
      Partial r;
      for (std::int64_t i = begin; i < end; ++i)
      {
        const double v = static_cast<double>(image.Data[i]);
        if (!std::isfinite(v))
        {
          ++r.NotFinite;
          continue;
        }
        r.Min = std::min(r.Min, v);
        r.Max = std::max(r.Max, v);
      }
      return r;
    },
    [](Partial a, const Partial& b)
    {
      a.Min = std::min(a.Min, b.Min);
      a.Max = std::max(a.Max, b.Max);
      a.NotFinite += b.NotFinite;
      return a;
    });
  return {p.Min, p.Max, p.NotFinite};
}

template <class T>
Result<double> otsuThreshold(const ImageView<const T>& image, Monitor& monitor)
{
  if (image.size() <= 0)
  {
    return Status::invalidInput("The image is empty.");
  }
  const ValueRange range = valueRange(image);
  if (range.NotFinite > 0)
  {
    return Status::invalidInput(
      "The image has " + std::to_string(range.NotFinite) +
      " values that are NaN or infinite; replace them first (Calculator).");
  }
  if (!(range.Max > range.Min))
  {
    return Status::invalidInput("The image is constant (" + std::to_string(range.Min) +
                                "): there is no object in it; check the array that is chosen.");
  }
  if (monitor.cancelled())
  {
    return Status::cancelled();
  }
  return bestBorder(histogramOf(image, range, [](std::int64_t) { return true; }));
}

template <class T>
Result<Volume<std::uint8_t>> thresholdMask(
  const ImageView<const T>& image, double threshold, Monitor& monitor)
{
  Volume<std::uint8_t> mask(Box{{{0, 0, 0}}, image.Dims}, image.Spacing);
  const bool done = monitoredFor(0, image.size(), Chunk, monitor,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        mask.Data[i] = static_cast<double>(image.Data[i]) >= threshold ? 1 : 0;
      }
    });
  if (!done)
  {
    return Status::cancelled();
  }
  return mask;
}

template <class T>
Result<double> halfwayThreshold(const ImageView<const T>& image, double start, Monitor& monitor)
{
  const ValueRange range = valueRange(image);
  if (range.NotFinite > 0 || !(range.Max > range.Min))
  {
    return start;
  }
  double threshold = start;
  for (int round = 0; round < LevelRounds; ++round)
  {
    const auto mask = thresholdMask(image, threshold, monitor);
    if (!mask)
    {
      return mask.status();
    }
    std::array<double, 2> level{};
    for (const std::uint8_t phase : {0, 1})
    {
      const auto found = phaseLevel(image, range, *mask, phase, monitor);
      if (!found)
      {
        return found.status();
      }
      level[phase] = *found;
    }
    if (!(level[1] > level[0])) // also where one is not known
    {
      return start;
    }
    const double moved = std::abs(0.5 * (level[0] + level[1]) - threshold);
    threshold = 0.5 * (level[0] + level[1]);
    if (moved <= LevelTolerance * (level[1] - level[0]))
    {
      break;
    }
  }
  return threshold;
}

#define BSR_INSTANTIATE(T)                                                                         \
  template ValueRange valueRange<T>(const ImageView<const T>&);                                    \
  template Result<double> otsuThreshold<T>(const ImageView<const T>&, Monitor&);                   \
  template Result<double> halfwayThreshold<T>(const ImageView<const T>&, double, Monitor&);        \
  template Result<Volume<std::uint8_t>> thresholdMask<T>(                                          \
    const ImageView<const T>&, double, Monitor&);
BSR_FOR_EACH_SCALAR_TYPE(BSR_INSTANTIATE)
#undef BSR_INSTANTIATE
} // namespace bsr
