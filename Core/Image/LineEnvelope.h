#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace bsr
{
/// "No site": an infinite squared distance.
constexpr float FarAway = std::numeric_limits<float>::infinity();

/**
 * Where a line is sampled: `Count` positions First + k * Step, in voxels of the line's own axis
 * relative to the first site of the line.
 */
struct LineSamples
{
  std::int64_t First = 0;
  std::int64_t Step = 1;
  std::int64_t Count = 0;
};

/**
 * One line of the separable squared distance transform: the lower envelope of the parabolas
 * heights[i] + weight * (p - i)^2, evaluated at the samples (Meijster, Roerdink & Hesselink 2000).
 * Heights above `bound` are no sites; a line without sites is FarAway. One object serves many lines
 * of the same axis; it is not shared between threads.
 */
class LineEnvelope
{
public:
  LineEnvelope(std::int64_t sites, const LineSamples& samples, double weight, float bound)
      : Sites(sites),
        Samples(samples),
        Weight(static_cast<float>(weight)),
        Bound(bound),
        HalfInverse(static_cast<std::size_t>(sites) + 1),
        Stack(static_cast<std::size_t>(sites) + 1)
  {
    for (std::int64_t d = 1; d <= sites; ++d)
    {
      this->HalfInverse[d] = 0.5 / (weight * static_cast<double>(d));
    }
  }

  void operator()(const float* heights, float* out)
  {
    const int top = this->build(heights);
    if (top < 0)
    {
      for (std::int64_t k = 0; k < this->Samples.Count; ++k)
      {
        out[k] = FarAway;
      }
      return;
    }
    this->fill(top, out);
  }

private:
  struct Parabola
  {
    float Height;
    float Site;
    std::int32_t Start; ///< first sample where it is the lowest
    float At;           ///< position of that sample
  };

  float at(const Parabola& p, float position) const
  {
    const float d = position - p.Site;
    return this->Weight * d * d + p.Height;
  }

  /// Index of the last parabola of the envelope, or -1.
  int build(const float* heights)
  {
    Parabola* const stack = this->Stack.data();
    const double first = static_cast<double>(this->Samples.First);
    const double inverseStep = 1.0 / static_cast<double>(this->Samples.Step);
    const double count = static_cast<double>(this->Samples.Count);
    int top = -1;
    for (std::int64_t u = 0; u < this->Sites; ++u)
    {
      const float h = heights[u];
      if (!(h <= this->Bound))
      {
        continue;
      }
      const float site = static_cast<float>(u);
      Parabola next{h, site, 0, static_cast<float>(this->Samples.First)};
      while (top >= 0 && this->at(stack[top], stack[top].At) > this->at(next, stack[top].At))
      {
        --top;
      }
      if (top >= 0)
      {
        const Parabola& last = stack[top];
        const std::int64_t gap = u - static_cast<std::int64_t>(last.Site);
        const double meet =
          0.5 * (static_cast<double>(site) + static_cast<double>(last.Site)) +
          (static_cast<double>(h) - static_cast<double>(last.Height)) * this->HalfInverse[gap];
        const double sample = (meet - first) * inverseStep;
        if (sample + 1.0 >= count)
        {
          continue;
        }
        next.Start = static_cast<std::int32_t>(sample) + 1;
        next.At = static_cast<float>(this->Samples.First + next.Start * this->Samples.Step);
      }
      stack[++top] = next;
    }
    return top;
  }

  void fill(int top, float* out) const
  {
    const float step = static_cast<float>(this->Samples.Step);
    const float weight = this->Weight;
    for (int s = 0; s <= top; ++s)
    {
      const Parabola& p = this->Stack[s];
      const std::int32_t begin = p.Start;
      const std::int32_t end =
        s < top ? this->Stack[s + 1].Start : static_cast<std::int32_t>(this->Samples.Count);
      const float offset = p.At - p.Site;
      const float height = p.Height;
      for (std::int32_t k = begin; k < end; ++k)
      {
        const float d = offset + static_cast<float>(k - begin) * step;
        out[k] = weight * d * d + height;
      }
    }
  }

  std::int64_t Sites;
  LineSamples Samples;
  float Weight;
  float Bound;
  std::vector<double> HalfInverse;
  std::vector<Parabola> Stack;
};
} // namespace bsr
