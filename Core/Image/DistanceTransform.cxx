#include "Image/DistanceTransform.h"

#include "Image/LinePass.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bsr
{
namespace
{
using Mask = ImageView<const std::uint8_t>;

/// First index in [i, n) whose byte is (is not) zero.
std::int64_t findByte(const std::uint8_t* row, std::int64_t i, std::int64_t n, bool zero)
{
  if (zero)
  {
    const void* p = i < n ? std::memchr(row + i, 0, static_cast<std::size_t>(n - i)) : nullptr;
    return p ? static_cast<const std::uint8_t*>(p) - row : n;
  }
  std::uint64_t word = 0;
  for (; i + 8 <= n; i += 8)
  {
    std::memcpy(&word, row + i, 8);
    if (word != 0)
    {
      break;
    }
  }
  while (i < n && row[i] == 0)
  {
    ++i;
  }
  return i;
}

/// Squared distances along one row of the mask, sampled; sites are [lo, lo + n) of the row.
class RowDistance
{
public:
  RowDistance(std::int64_t n, const LineSamples& samples, double weight, bool toZeros)
      : N(n), Samples(samples), Weight(static_cast<float>(weight)), ToZeros(toZeros)
  {
  }

  void operator()(const std::uint8_t* row, float* out) const
  {
    std::int64_t last = -1; // the last site before the gap being filled
    std::int64_t k = 0;     // next sample
    std::int64_t site = findByte(row, 0, this->N, this->ToZeros);
    while (site < this->N)
    {
      k = this->gap(last, site, k, out);
      const std::int64_t runEnd = findByte(row, site, this->N, !this->ToZeros);
      for (; k < this->Samples.Count && this->position(k) < runEnd; ++k)
      {
        out[k] = 0.0f;
      }
      last = runEnd - 1;
      site = findByte(row, runEnd, this->N, this->ToZeros);
    }
    if (last < 0)
    {
      std::fill(out, out + this->Samples.Count, FarAway);
      return;
    }
    this->ramp(k, this->Samples.Count, last, out);
  }

private:
  std::int64_t position(std::int64_t k) const
  {
    return this->Samples.First + k * this->Samples.Step;
  }
  /// First sample at or after a position.
  std::int64_t sampleAt(std::int64_t p) const
  {
    const std::int64_t d = p - this->Samples.First;
    return d <= 0
             ? 0
             : std::min((d + this->Samples.Step - 1) / this->Samples.Step, this->Samples.Count);
  }
  void ramp(std::int64_t k, std::int64_t end, std::int64_t site, float* out) const
  {
    const float step = static_cast<float>(this->Samples.Step);
    const float start = static_cast<float>(this->position(k) - site);
    const std::int64_t n = end - k;
    for (std::int64_t i = 0; i < n; ++i)
    {
      const float d = start + static_cast<float>(static_cast<std::int32_t>(i)) * step;
      out[k + i] = this->Weight * d * d;
    }
  }
  /// Fills the samples between two sites; returns the first sample at or after `right`.
  std::int64_t gap(std::int64_t left, std::int64_t right, std::int64_t k, float* out) const
  {
    const std::int64_t end = std::max(k, this->sampleAt(right));
    const std::int64_t middle =
      left < 0 ? k : std::min(end, std::max(k, this->sampleAt((left + right) / 2 + 1)));
    this->ramp(k, middle, left, out);
    this->ramp(middle, end, right, out);
    return end;
  }

  std::int64_t N;
  LineSamples Samples;
  float Weight;
  bool ToZeros;
};

Double3 weights(const Double3& spacing)
{
  const double unit = voxelLength(spacing);
  Double3 w{};
  for (int a = 0; a < 3; ++a)
  {
    w[a] = (spacing[a] / unit) * (spacing[a] / unit);
  }
  return w;
}

Status check(const Mask& mask, const DistanceOptions& o)
{
  for (int a = 0; a < 3; ++a)
  {
    if (!(mask.Spacing[a] > 0.0) || !std::isfinite(mask.Spacing[a]))
    {
      return Status::invalidInput("The image spacing must be positive along every axis.");
    }
  }
  if (mask.size() <= 0 || !mask.Data)
  {
    return Status::invalidInput("The image is empty.");
  }
  if (!(o.Bound >= 0.0) || o.Step < 1)
  {
    return Status::invalidParameter("A distance transform needs a bound >= 0 and a step >= 1.");
  }
  return Status::ok();
}

/// The three passes on a buffer that is wide enough for their inputs and outputs.
class Passes
{
public:
  Passes(const Mask& mask, const Box& sites, const Box& samples, const DistanceOptions& options)
      : Image(mask), Sites(sites), Options(options), Weights(weights(mask.Spacing))
  {
    for (int a = 0; a < 3; ++a)
    {
      this->Lines[a] = {samples.Lo[a] - sites.Lo[a], options.Step, samples.Size[a]};
    }
    this->Bound = static_cast<float>(options.Bound * options.Bound * (1.0 + 1e-6));
    if (!std::isfinite(this->Bound))
    {
      this->Bound = std::numeric_limits<float>::max();
    }
  }

  bool run(const LineBuffer& buffer, Monitor& monitor) const
  {
    SubMonitor rows(monitor, 0.0, 0.1);
    SubMonitor columns(monitor, 0.1, 0.55);
    SubMonitor depths(monitor, 0.55, 1.0);
    return this->alongX(buffer, rows) &&
           linePass(buffer, buffer, 1, this->Sites.Size[2], this->Sites.Size[1],
             this->Lines[1].Count, columns, [this]() { return this->envelope(1); }) &&
           linePass(buffer, buffer, 2, this->Lines[1].Count, this->Sites.Size[2],
             this->Lines[2].Count, depths, [this]() { return this->envelope(2); });
  }

private:
  LineEnvelope envelope(int axis) const
  {
    return {this->Sites.Size[axis], this->Lines[axis], this->Weights[axis], this->Bound};
  }
  bool alongX(const LineBuffer& buffer, Monitor& monitor) const
  {
    const std::int64_t rows = this->Sites.Size[1];
    const RowDistance distance(
      this->Sites.Size[0], this->Lines[0], this->Weights[0], this->Options.ToZeros);
    return monitoredFor(0, rows * this->Sites.Size[2], 16, monitor,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t r = begin; r < end; ++r)
        {
          const std::int64_t j = r % rows;
          const std::int64_t k = r / rows;
          const std::uint8_t* row =
            this->Image.row(j + this->Sites.Lo[1], k + this->Sites.Lo[2]) + this->Sites.Lo[0];
          distance(row, buffer.Data + j * buffer.StrideY + k * buffer.StrideZ);
        }
      });
  }

  Mask Image;
  Box Sites;
  DistanceOptions Options;
  Double3 Weights;
  std::array<LineSamples, 3> Lines;
  float Bound = 0.0f;
};

/// Copies the samples out of the working buffer where that had to be larger.
void compact(const LineBuffer& from, Volume<float>& to)
{
  const ImageView<float> view = to.view();
  parallelFor(0, view.Dims[1] * view.Dims[2], 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t r = begin; r < end; ++r)
      {
        const std::int64_t j = r % view.Dims[1];
        const std::int64_t k = r / view.Dims[1];
        const float* src = from.Data + j * from.StrideY + k * from.StrideZ;
        std::copy(src, src + view.Dims[0], view.row(j, k));
      }
    });
}
} // namespace

Box boundingBox(const Mask& mask, bool nonzero)
{
  struct Range
  {
    Int3 Lo{{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max(),
      std::numeric_limits<std::int64_t>::max()}};
    Int3 Hi{{-1, -1, -1}};
  };
  const std::int64_t nx = mask.Dims[0];
  const std::int64_t ny = mask.Dims[1];
  const Range range = parallelReduce(
    0, ny * mask.Dims[2], 64, Range(),
    [&](std::int64_t begin, std::int64_t end)
    {
      Range r;
      for (std::int64_t row = begin; row < end; ++row)
      {
        const std::uint8_t* p = mask.Data + row * nx;
        const std::int64_t first = findByte(p, 0, nx, !nonzero);
        if (first == nx)
        {
          continue;
        }
        std::int64_t last = nx - 1;
        while ((p[last] != 0) != nonzero)
        {
          --last;
        }
        const Int3 lo{{first, row % ny, row / ny}};
        const Int3 hi{{last, row % ny, row / ny}};
        for (int a = 0; a < 3; ++a)
        {
          r.Lo[a] = std::min(r.Lo[a], lo[a]);
          r.Hi[a] = std::max(r.Hi[a], hi[a]);
        }
      }
      return r;
    },
    [](Range a, const Range& b)
    {
      for (int i = 0; i < 3; ++i)
      {
        a.Lo[i] = std::min(a.Lo[i], b.Lo[i]);
        a.Hi[i] = std::max(a.Hi[i], b.Hi[i]);
      }
      return a;
    });
  Box box;
  if (range.Hi[0] >= 0)
  {
    box.Lo = range.Lo;
    for (int a = 0; a < 3; ++a)
    {
      box.Size[a] = range.Hi[a] - range.Lo[a] + 1;
    }
  }
  return box;
}

Result<Volume<float>> squaredDistance(
  const Mask& mask, const DistanceOptions& options, Monitor& monitor)
{
  const Status valid = check(mask, options);
  if (!valid)
  {
    return valid;
  }
  Box samples = options.Extent.empty() ? Box{{{0, 0, 0}}, mask.Dims} : options.Extent;
  Double3 spacing = mask.Spacing;
  for (int a = 0; a < 3; ++a)
  {
    samples.Size[a] = (samples.Size[a] + options.Step - 1) / options.Step;
    spacing[a] *= static_cast<double>(options.Step);
  }
  const Box sites = boundingBox(mask, !options.ToZeros);
  Int3 work = samples.Size;
  if (!sites.empty())
  {
    work[1] = std::max(work[1], sites.Size[1]);
    work[2] = std::max(work[2], sites.Size[2]);
  }
  Volume<float> result(Box{samples.Lo, work}, spacing);
  if (sites.empty())
  {
    std::fill(result.Data.get(), result.Data.get() + samples.volume(), FarAway);
    return result;
  }
  const LineBuffer buffer{result.Data.get(), work[0], work[0], work[0] * work[1]};
  if (!Passes(mask, sites, samples, options).run(buffer, monitor))
  {
    return Status::cancelled();
  }
  if (work != samples.Size)
  {
    Volume<float> small(samples, spacing);
    compact(buffer, small);
    return small;
  }
  return result;
}
} // namespace bsr
