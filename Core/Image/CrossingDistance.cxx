#include "Image/CrossingDistance.h"

#include "Image/LinePass.h"

#include <algorithm>
#include <cmath>

namespace bsr
{
namespace
{
/// Squared distance along a line to the nearest sign change of the field on that line.
class CrossingLine
{
public:
  CrossingLine(std::int64_t n, const LineSamples& samples, double weight)
      : N(n), Samples(samples), Weight(static_cast<float>(weight))
  {
    this->Crossings.reserve(static_cast<std::size_t>(n));
  }

  void operator()(const float* field, float* out)
  {
    this->find(field);
    if (this->Crossings.empty())
    {
      std::fill(out, out + this->Samples.Count, FarAway);
      return;
    }
    std::size_t c = 0;
    for (std::int64_t k = 0; k < this->Samples.Count; ++k)
    {
      const float p = static_cast<float>(this->Samples.First + k * this->Samples.Step);
      while (c + 1 < this->Crossings.size() && this->Crossings[c + 1] - p < p - this->Crossings[c])
      {
        ++c;
      }
      const float d = p - this->Crossings[c];
      out[k] = this->Weight * d * d;
    }
  }

private:
  void find(const float* field)
  {
    this->Crossings.clear();
    for (std::int64_t i = 0; i + 1 < this->N; ++i)
    {
      const float a = field[i];
      const float b = field[i + 1];
      if ((a < 0.0f) != (b < 0.0f))
      {
        this->Crossings.push_back(static_cast<float>(i) + a / (a - b));
      }
    }
  }

  std::int64_t N;
  LineSamples Samples;
  float Weight;
  std::vector<float> Crossings;
};

/// The transforms of the three families of crossings in two buffers.
class CrossingPasses
{
public:
  CrossingPasses(const ImageView<const float>& field, const Box& samples,
    const DistanceOptions& options, const Int3& work)
      : In(field.Dims), Out(samples.Size), Work(work)
  {
    const double unit = voxelLength(field.Spacing);
    for (int a = 0; a < 3; ++a)
    {
      this->Lines[a] = {samples.Lo[a], options.Step, samples.Size[a]};
      this->Weights[a] = (field.Spacing[a] / unit) * (field.Spacing[a] / unit);
    }
    const double bound = options.Bound * options.Bound * (1.0 + 1e-6);
    this->Bound =
      static_cast<float>(std::min(bound, static_cast<double>(std::numeric_limits<float>::max())));
    // linePass and rowPass only read from their source.
    this->Source = {
      const_cast<float*>(field.Data), this->In[0], this->In[0], this->In[0] * this->In[1]};
  }

  /// The squared distances end in `a`.
  bool run(float* a, float* b, Monitor& monitor) const
  {
    const auto part = [&monitor](int i) { return SubMonitor(monitor, i / 9.0, (i + 1) / 9.0); };
    SubMonitor m[9] = {
      part(0), part(1), part(2), part(3), part(4), part(5), part(6), part(7), part(8)};
    const auto crossings = [this](int axis)
    { return [this, axis]() { return CrossingLine(In[axis], Lines[axis], Weights[axis]); }; };
    const auto envelope = [this](int axis)
    {
      return [this, axis]()
      { return LineEnvelope(In[axis], Lines[axis], Weights[axis], this->Bound); };
    };
    const Int3& n = this->In;
    const Int3& o = this->Out;
    const LineBuffer wideA = this->buffer(a, o[0]);
    const LineBuffer narrowB = this->buffer(b, n[0]);
    const LineBuffer wideB = this->buffer(b, o[0]);
    return rowPass(this->Source, wideA, n[1], n[2], n[0], o[0], m[0], crossings(0)) &&
           linePass(wideA, wideA, 1, n[2], n[1], o[1], m[1], envelope(1)) &&
           linePass(this->Source, narrowB, 1, n[2], n[1], o[1], m[2], crossings(1)) &&
           rowPass(narrowB, wideB, o[1], n[2], n[0], o[0], m[3], envelope(0)) &&
           this->smaller(wideA, wideB, o[1], n[2], m[4]) &&
           linePass(wideA, wideA, 2, o[1], n[2], o[2], m[5], envelope(2)) &&
           linePass(this->Source, narrowB, 2, n[1], n[2], o[2], m[6], crossings(2)) &&
           rowPass(narrowB, wideB, n[1], o[2], n[0], o[0], m[7], envelope(0)) &&
           linePass(wideB, wideB, 1, o[2], n[1], o[1], m[8], envelope(1)) &&
           this->smaller(wideA, wideB, o[1], o[2], m[8]);
  }

private:
  LineBuffer buffer(float* data, std::int64_t width) const
  {
    return {data, width, this->Work[0], this->Work[0] * this->Work[1]};
  }
  bool smaller(const LineBuffer& a, const LineBuffer& b, std::int64_t rows, std::int64_t slices,
    Monitor& monitor) const
  {
    return monitoredFor(0, rows * slices, 16, monitor,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t r = begin; r < end; ++r)
        {
          const std::int64_t at = (r % rows) * a.StrideY + (r / rows) * a.StrideZ;
          for (std::int64_t i = 0; i < a.Width; ++i)
          {
            a.Data[at + i] = std::min(a.Data[at + i], b.Data[at + i]);
          }
        }
      });
  }

  Int3 In;
  Int3 Out;
  Int3 Work;
  std::array<LineSamples, 3> Lines;
  Double3 Weights{};
  float Bound = 0.0f;
  LineBuffer Source;
};

/// Square roots, moved to where the samples belong.
void finish(const Volume<float>& from, Volume<float>& to)
{
  const ImageView<float> view = to.view();
  const ImageView<const float> source = from.view();
  parallelFor(0, view.Dims[1] * view.Dims[2], 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t r = begin; r < end; ++r)
      {
        const std::int64_t j = r % view.Dims[1];
        const std::int64_t k = r / view.Dims[1];
        const float* src = source.row(j, k);
        float* dst = view.row(j, k);
        for (std::int64_t i = 0; i < view.Dims[0]; ++i)
        {
          dst[i] = std::sqrt(src[i]);
        }
      }
    });
}
} // namespace

Result<Volume<float>> crossingDistance(
  const ImageView<const float>& field, const DistanceOptions& options, Monitor& monitor)
{
  if (field.size() <= 0)
  {
    return Status::invalidInput("The image is empty.");
  }
  if (!(options.Bound >= 0.0) || options.Step < 1)
  {
    return Status::invalidParameter("A distance transform needs a bound >= 0 and a step >= 1.");
  }
  Box samples = options.Extent.empty() ? Box{{{0, 0, 0}}, field.Dims} : options.Extent;
  Double3 spacing = field.Spacing;
  Int3 work{};
  for (int a = 0; a < 3; ++a)
  {
    samples.Size[a] = (samples.Size[a] + options.Step - 1) / options.Step;
    spacing[a] *= static_cast<double>(options.Step);
    work[a] = std::max(samples.Size[a], field.Dims[a]);
  }
  Volume<float> a(Box{samples.Lo, work}, spacing);
  {
    Volume<float> b(a.Extent, spacing);
    const CrossingPasses passes(field, samples, options, work);
    if (!passes.run(a.Data.get(), b.Data.get(), monitor))
    {
      return Status::cancelled();
    }
  }
  if (work == samples.Size)
  {
    finish(a, a);
    return a;
  }
  Volume<float> result(samples, spacing);
  finish(a, result);
  return result;
}
} // namespace bsr
