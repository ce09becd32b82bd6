#include "Image/Threshold.h"

#include "Common/MonitoredLoop.h"
#include "Image/ScalarTypes.h"

#include <cmath>
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

template <class T>
Histogram histogramOf(const ImageView<const T>& image, const ValueRange& range)
{
  Histogram h;
  const double span = range.Max - range.Min;
  const bool whole = std::is_integral<T>::value && span < 65536.0;
  const std::int64_t bins = whole ? static_cast<std::int64_t>(span) + 1 : 4096;
  h.Width = whole ? 1.0 : span / static_cast<double>(bins);
  h.First = whole ? range.Min : range.Min + 0.5 * h.Width;
  const double scale = whole ? 1.0 : static_cast<double>(bins) / span;
  using Counts = std::vector<std::int64_t>;
  const Counts counts = parallelReduce(
    0, image.size(), std::max(Chunk, image.size() / 16 + 1), Counts(),
    [&](std::int64_t begin, std::int64_t end)
    {
      Counts c(static_cast<std::size_t>(bins), 0);
      for (std::int64_t i = begin; i < end; ++i)
      {
        const double at = (static_cast<double>(image.Data[i]) - range.Min) * scale;
        ++c[std::min(bins - 1, static_cast<std::int64_t>(at))];
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
  h.Count.assign(counts.begin(), counts.end());
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

/// Sums over the voxels of both classes that have only neighbors of their own class.
struct InnerSums
{
  std::array<double, 2> Sum{{0.0, 0.0}};
  std::array<double, 2> Inner{{0.0, 0.0}};
  std::array<double, 2> All{{0.0, 0.0}};
};

template <class T>
InnerSums innerSums(const ImageView<const T>& image, const Volume<std::uint8_t>& mask)
{
  const Int3& n = image.Dims;
  const ImageView<const std::uint8_t> m = mask.view();
  const auto rowSums = [&](std::int64_t begin, std::int64_t end)
  {
    InnerSums s;
    for (std::int64_t r = begin; r < end; ++r)
    {
      const std::int64_t j = 1 + r % (n[1] - 2);
      const std::int64_t k = 1 + r / (n[1] - 2);
      const std::uint8_t* const row = m.row(j, k);
      const T* const gray = image.row(j, k);
      for (std::int64_t i = 1; i + 1 < n[0]; ++i)
      {
        const int sum = row[i - 1] + row[i] + row[i + 1] + row[i - n[0]] + row[i + n[0]] +
                        row[i - n[0] * n[1]] + row[i + n[0] * n[1]];
        s.All[row[i]] += 1.0;
        if (sum == 0 || sum == 7)
        {
          s.Sum[row[i]] += static_cast<double>(gray[i]);
          s.Inner[row[i]] += 1.0;
        }
      }
    }
    return s;
  };
  return parallelReduce(0, (n[1] - 2) * (n[2] - 2), 64, InnerSums(), rowSums,
    [](InnerSums a, const InnerSums& b)
    {
      for (int c = 0; c < 2; ++c)
      {
        a.Sum[c] += b.Sum[c];
        a.Inner[c] += b.Inner[c];
        a.All[c] += b.All[c];
      }
      return a;
    });
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
  return bestBorder(histogramOf(image, range));
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
  double threshold = start;
  if (image.Dims[0] < 3 || image.Dims[1] < 3 || image.Dims[2] < 3)
  {
    return start;
  }
  for (int iteration = 0; iteration < 3; ++iteration)
  {
    const auto mask = thresholdMask(image, threshold, monitor);
    if (!mask)
    {
      return mask.status();
    }
    const InnerSums s = innerSums(image, *mask);
    if (s.Inner[0] < 0.1 * s.All[0] || s.Inner[1] < 0.1 * s.All[1] || s.Inner[0] < 1.0 ||
        s.Inner[1] < 1.0)
    {
      return start;
    }
    threshold = 0.5 * (s.Sum[0] / s.Inner[0] + s.Sum[1] / s.Inner[1]);
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
