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

/// Elements of a slab of slices that is worked on at a time: enough for the threads, few for
/// memory.
constexpr std::int64_t SlabElements = std::int64_t{1} << 22;
/// The same for crossings along z, and the number of slabs if that is less: for each of them the
/// whole field is read.
constexpr std::int64_t DeepSlabElements = std::int64_t{1} << 25;
constexpr std::int64_t MostDeepSlabs = 8;

/**
 * The transforms of the three families of crossings. Those along x and y need one slice of the
 * field for one slice of their distances in the plane, those along z all of it for one slice of the
 * result: both are worked on in slabs, so that beside the field there is little more than the
 * result.
 */
class CrossingPasses
{
  auto envelope(int axis) const
  {
    return [this, axis]()
    { return LineEnvelope(this->In[axis], this->Lines[axis], this->Weights[axis], this->Bound); };
  }
  auto crossings(int axis, const LineSamples& at) const
  {
    return [this, axis, at]() { return CrossingLine(this->In[axis], at, this->Weights[axis]); };
  }

public:
  CrossingPasses(
    const ImageView<const float>& field, const Box& samples, const DistanceOptions& options)
      : In(field.Dims), Out(samples.Size)
  {
    const double unit = voxelLength(field.Spacing);
    for (int a = 0; a < 3; ++a)
    {
      this->Lines[a] = {samples.Lo[a], options.Step, samples.Size[a]};
      this->Weights[a] = (field.Spacing[a] / unit) * (field.Spacing[a] / unit);
      this->Wide[a] = std::max(field.Dims[a], samples.Size[a]);
    }
    const double bound = options.Bound * options.Bound * (1.0 + 1e-6);
    this->Bound =
      static_cast<float>(std::min(bound, static_cast<double>(std::numeric_limits<float>::max())));
    // linePass and rowPass only read from their source.
    this->Source = {
      const_cast<float*>(field.Data), this->In[0], this->In[0], this->In[0] * this->In[1]};
  }

  /// What `run` needs: slices as wide as the samples, as many as there are in the field at least.
  Int3 work() const { return {{this->Out[0], this->Out[1], this->Wide[2]}}; }

  /// The squared distances, at the start of `result`.
  bool run(float* result, Monitor& monitor) const
  {
    SubMonitor planes(monitor, 0.0, 0.4);
    SubMonitor depths(monitor, 0.4, 0.6);
    SubMonitor along(monitor, 0.6, 1.0);
    const LineBuffer to = this->slices(result, this->Out);
    return this->inPlanes(to, planes) &&
           linePass(
             to, to, 2, this->Out[1], this->In[2], this->Out[2], depths, this->envelope(2)) &&
           this->alongZ(to, along);
  }

private:
  static LineBuffer slices(float* data, const Int3& size)
  {
    return {data, size[0], size[0], size[0] * size[1]};
  }
  static LineBuffer from(const LineBuffer& b, std::int64_t slice)
  {
    return {b.Data + slice * b.StrideZ, b.Width, b.StrideY, b.StrideZ};
  }
  static LineBuffer narrowed(const LineBuffer& b, std::int64_t width)
  {
    return {b.Data, width, b.StrideY, b.StrideZ};
  }
  /// Distances in each plane of the field to the crossings along x and y.
  bool inPlanes(const LineBuffer& to, Monitor& monitor) const
  {
    const std::int64_t plane = this->Wide[0] * this->Wide[1];
    const std::int64_t most = std::max<std::int64_t>(1, SlabElements / plane);
    const Int3 size{{this->Wide[0], this->Wide[1], std::min(most, this->In[2])}};
    Volume<float> first(Box{{}, size}, {});
    Volume<float> second(Box{{}, size}, {});
    const LineBuffer a = slices(first.Data.get(), size);
    const LineBuffer b = slices(second.Data.get(), size);
    const LineBuffer narrowA = narrowed(a, this->Out[0]);
    const auto n = static_cast<double>(this->In[2]);
    for (std::int64_t z = 0; z < this->In[2]; z += most)
    {
      const std::int64_t count = std::min(most, this->In[2] - z);
      const LineBuffer field = from(this->Source, z);
      SubMonitor part(monitor, static_cast<double>(z) / n, static_cast<double>(z + count) / n);
      SubMonitor quiet(part, 0.0, 0.0);
      if (!rowPass(field, a, this->In[1], count, this->In[0], this->Out[0], part,
            this->crossings(0, this->Lines[0])) ||
          !linePass(
            narrowA, narrowA, 1, count, this->In[1], this->Out[1], quiet, this->envelope(1)) ||
          !linePass(field, b, 1, count, this->In[1], this->Out[1], quiet,
            this->crossings(1, this->Lines[1])) ||
          !rowPass(
            b, b, this->Out[1], count, this->In[0], this->Out[0], quiet, this->envelope(0)) ||
          !this->store(a, &b, from(to, z), count, quiet))
      {
        return false;
      }
    }
    return true;
  }

  /// Takes the smaller of the distances so far and those to crossings along z.
  bool alongZ(const LineBuffer& to, Monitor& monitor) const
  {
    const std::int64_t plane = this->Wide[0] * this->Wide[1];
    const std::int64_t most = std::max({DeepSlabElements / plane,
      (this->Out[2] + MostDeepSlabs - 1) / MostDeepSlabs, std::int64_t{1}});
    const Int3 size{{this->Wide[0], this->Wide[1], std::min(most, this->Out[2])}};
    Volume<float> slab(Box{{}, size}, {});
    const LineBuffer a = slices(slab.Data.get(), size);
    const LineBuffer narrow = narrowed(a, this->Out[0]);
    const auto n = static_cast<double>(this->Out[2]);
    for (std::int64_t z = 0; z < this->Out[2]; z += most)
    {
      const std::int64_t count = std::min(most, this->Out[2] - z);
      LineSamples at = this->Lines[2];
      at.First += z * at.Step;
      at.Count = count;
      SubMonitor part(monitor, static_cast<double>(z) / n, static_cast<double>(z + count) / n);
      SubMonitor quiet(part, 0.0, 0.0);
      if (!linePass(
            this->Source, a, 2, this->In[1], this->In[2], count, part, this->crossings(2, at)) ||
          !rowPass(a, a, this->In[1], count, this->In[0], this->Out[0], quiet, this->envelope(0)) ||
          !linePass(
            narrow, narrow, 1, count, this->In[1], this->Out[1], quiet, this->envelope(1)) ||
          !this->store(a, nullptr, from(to, z), count, quiet))
      {
        return false;
      }
    }
    return true;
  }

  /// The smallest of `a` and `b`, or without `b` of `a` and what is there.
  bool store(const LineBuffer& a, const LineBuffer* b, const LineBuffer& to, std::int64_t count,
    Monitor& monitor) const
  {
    return monitoredFor(0, this->Out[1] * count, 16, monitor,
      [&](std::int64_t begin, std::int64_t end)
      {
        for (std::int64_t r = begin; r < end; ++r)
        {
          const std::int64_t y = r % this->Out[1];
          const std::int64_t z = r / this->Out[1];
          const auto row = [y, z](const LineBuffer& l)
          { return l.Data + y * l.StrideY + z * l.StrideZ; };
          const float* const one = row(a);
          float* const out = row(to);
          const float* const other = b ? row(*b) : out;
          for (std::int64_t i = 0; i < this->Out[0]; ++i)
          {
            out[i] = std::min(one[i], other[i]);
          }
        }
      });
  }

  Int3 In;
  Int3 Out;
  Int3 Wide{}; ///< the larger of both
  std::array<LineSamples, 3> Lines;
  Double3 Weights{};
  float Bound = 0.0f;
  LineBuffer Source;
};

void takeRoots(Volume<float>& squared)
{
  parallelFor(0, squared.Extent.volume(), std::int64_t{1} << 16,
    [&](std::int64_t begin, std::int64_t end)
    {
      for (std::int64_t i = begin; i < end; ++i)
      {
        squared.Data[i] = std::sqrt(squared.Data[i]);
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
  for (int a = 0; a < 3; ++a)
  {
    samples.Size[a] = (samples.Size[a] + options.Step - 1) / options.Step;
    spacing[a] *= static_cast<double>(options.Step);
  }
  const CrossingPasses passes(field, samples, options);
  Volume<float> result(Box{samples.Lo, passes.work()}, spacing);
  if (!passes.run(result.Data.get(), monitor))
  {
    return Status::cancelled();
  }
  result.Extent = samples; // the slices beyond were needed on the way only
  takeRoots(result);
  return result;
}
} // namespace bsr
